// Every operation of the vectors on arrays of one vector; results of kLanes elements each, in the order of
// vec_test.cpp.

TEXTPLANE_SIMD_ENTRY void float_operations(const float* pa, const float* pb, const float* pc, float* out) noexcept {
  const vf a = load(pa), b = load(pb), c = load(pc);
  int k = 0;
  store(out + kLanes * k++, add(a, b));
  store(out + kLanes * k++, sub(a, b));
  store(out + kLanes * k++, mul(a, b));
  store(out + kLanes * k++, div(a, b));
  store(out + kLanes * k++, madd(a, b, c));
  store(out + kLanes * k++, nmadd(a, b, c));
  store(out + kLanes * k++, add(mul(a, b), c));
  store(out + kLanes * k++, sub(c, mul(a, b)));
  store(out + kLanes * k++, min_(a, b));
  store(out + kLanes * k++, max_(a, b));
  store(out + kLanes * k++, sqrt_(a));
  store(out + kLanes * k++, abs_(a));
  store(out + kLanes * k++, neg(a));
  store(out + kLanes * k++, floor_(a));
  store(out + kLanes * k++, select(lt(a, b), a, c));
  store(out + kLanes * k++, keep(lt(a, b), a));
  store(out + kLanes * k++, set1(pa[0]));
  store(out + kLanes * k++, zero());
  store(out + kLanes * k++, iota());
}

// As above, of vectors of doubles. Returns the number of their lanes.
TEXTPLANE_SIMD_ENTRY int double_operations(const double* pa, const double* pb, const double* pc, double* out) noexcept {
  const vp a = load_p(pa), b = load_p(pb), c = load_p(pc);
  int k = 0;
  store_p(out + kDoubles * k++, add_p(a, b));
  store_p(out + kDoubles * k++, sub_p(a, b));
  store_p(out + kDoubles * k++, mul_p(a, b));
  store_p(out + kDoubles * k++, div_p(a, set_p(4.0)));
  store_p(out + kDoubles * k++, madd_p(a, b, c));
  store_p(out + kDoubles * k++, min_p(a, b));
  store_p(out + kDoubles * k++, max_p(a, b));
  store_p(out + kDoubles * k++, abs_p(a));
  store_p(out + kDoubles * k++, trunc_p(a));
  store_p(out + kDoubles * k++, positive_p(a, b, c));
  return kDoubles;
}

TEXTPLANE_SIMD_ENTRY void int_operations(const int* pa, const int* pb, int shift, int* out) noexcept {
  const vi a = loadi(pa), b = loadi(pb);
  int k = 0;
  storei(out + kLanes * k++, addi(a, b));
  storei(out + kLanes * k++, subi(a, b));
  storei(out + kLanes * k++, muli(a, b));
  storei(out + kLanes * k++, mini(a, b));
  storei(out + kLanes * k++, maxi(a, b));
  storei(out + kLanes * k++, andi(a, b));
  storei(out + kLanes * k++, ori(a, b));
  storei(out + kLanes * k++, shl(a, shift));
  storei(out + kLanes * k++, shr(a, shift));
  storei(out + kLanes * k++, shl(a, 3));
  storei(out + kLanes * k++, shr(a, 3));
  storei(out + kLanes * k++, seti(pa[0]));
  storei(out + kLanes * k++, ioti());
}

TEXTPLANE_SIMD_ENTRY void conversions(const float* pa, const int* pb, int* ints, float* floats) noexcept {
  storei(ints, to_int(load(pa)));
  store(floats, to_float(loadi(pb)));
}

TEXTPLANE_SIMD_ENTRY void inverse_roots(const float* p, float* out) noexcept {
  store(out, inverse_root(hold(load(p))));
}

// Masks as bits; the last entries are a count and a truth value.
TEXTPLANE_SIMD_ENTRY void mask_operations(const float* pa, const float* pb, const int* pi, const int* pj,
                                          unsigned* out) noexcept {
  const vf a = load(pa), b = load(pb);
  const vi i = loadi(pi), j = loadi(pj);
  const vm m = lt(a, b), n = eqi(i, j);
  int k = 0;
  out[k++] = bits_from_mask(lt(a, b));
  out[k++] = bits_from_mask(le(a, b));
  out[k++] = bits_from_mask(gt(a, b));
  out[k++] = bits_from_mask(ge(a, b));
  out[k++] = bits_from_mask(eq(a, b));
  out[k++] = bits_from_mask(eqi(i, j));
  out[k++] = bits_from_mask(and_(m, n));
  out[k++] = bits_from_mask(andnot_(m, n));
  out[k++] = static_cast<unsigned>(count_true(m));
  out[k++] = all_true(m) ? 1u : 0u;
}

TEXTPLANE_SIMD_ENTRY void reductions(const float* pa, double* out) noexcept {
  const vf a = load(pa);
  out[0] = static_cast<double>(reduce_sum(a));
  out[1] = reduce_sum_double(a);
  out[2] = static_cast<double>(reduce_min(a));
  out[3] = static_cast<double>(reduce_max(a));
}

// reduce_sum4 of the first four vectors, then reduce_sum8 of all.
TEXTPLANE_SIMD_ENTRY void eight_sums(const float* p, double* out) noexcept {
  float four[4];
  reduce_sum4(load(p), load(p + kLanes), load(p + 2 * kLanes), load(p + 3 * kLanes), four);
  for (int k = 0; k < 4; ++k) out[k] = static_cast<double>(four[k]);
  stored(out + 4, reduce_sum8(p));
}

TEXTPLANE_SIMD_ENTRY void taps(const std::uint32_t* words, float* out) noexcept {
  const taps_t t = load_taps(words);
  store(out, tap_value(t));
  store(out + kLanes, tap_dx(t));
  store(out + 2 * kLanes, tap_dy(t));
  store(out + 3 * kLanes, tap_dxy(t));
}

// A load of n elements, stored whole.
TEXTPLANE_SIMD_ENTRY void partial_load(const float* p, int n, float* out) noexcept { store(out, load_n(p, n)); }
TEXTPLANE_SIMD_ENTRY void partial_store(float* p, const float* from, int n) noexcept { store_n(p, load(from), n); }
TEXTPLANE_SIMD_ENTRY unsigned first_lanes(int n) noexcept { return bits_from_mask(first_n(n)); }

TEXTPLANE_SIMD_ENTRY unsigned read_u16(const std::uint8_t* p) noexcept { return load_u16(p); }
TEXTPLANE_SIMD_ENTRY void copy(void* to, const void* from, int n) noexcept { copy_bytes(to, from, n); }
