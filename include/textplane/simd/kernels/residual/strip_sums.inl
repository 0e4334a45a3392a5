// Sums over strips of many pixels. Include before: residual/rows.inl, residual/sums.inl, residual/moments.inl.
//
// `form` is 3 (rows of theta), 6 (rows of v and omega) or 8 (rows of the pixel homography). Sums lie one after the
// other: products of rows (6, 21, 27), then sums with three factors, one for each row: (1, I, d) for all pixels, (w, w
// n, w r) for weighted ones.

TEXTPLANE_SIMD_INLINE int product_count(int form) noexcept { return form == 3 ? 6 : form == 6 ? 21 : 27; }

// Pixels summed at once where no rows are stored: their arrays fit the first-level cache.
enum : int { kBlock = 4 * kStrip };

// Everything one strip needs besides its pixels.
struct RowStrip {
  float row[6][kStrip];
};

// Rows of the n pixels x, y, a, b, and to `acc` their products; where `plain`, their sums too. With kManyRegisters each
// loop computes the homography's rows again, which is faster than memory; `rows` is not used, and n may exceed a strip.
TEXTPLANE_SIMD_INLINE void add_strip_products(int form, bool plain, const RowConstants& k, const float* x,
                                              const float* y, const float* a, const float* b, int n, RowStrip* rows,
                                              bool fresh, float* acc) noexcept {
  float(*r)[kStrip] = rows->row;
  float* sums = acc + (plain ? product_count(form) : kMostSums) * kLanes;  // or where nobody reads
  if (form == 3) {
    plane_rows(k, x, y, a, b, n, kStrip, r[0]);
    if (plain)
      add_squares_sums3(r[0], r[1], r[2], n, fresh, acc, sums);
    else
      add_squares3(r[0], r[1], r[2], n, fresh, acc);
  } else if (form == 6) {
    pose_rows(k, x, y, a, b, n, kStrip, r[0]);
    if (plain) {
      add_squares_sums3(r[0], r[1], r[2], n, fresh, acc, sums);
      add_squares_sums3(r[3], r[4], r[5], n, fresh, acc + 6 * kLanes, sums + 3 * kLanes);
    } else {
      add_squares3(r[0], r[1], r[2], n, fresh, acc);
      add_squares3(r[3], r[4], r[5], n, fresh, acc + 6 * kLanes);
    }
    add_products33(r[0], r[1], r[2], r[3], r[4], r[5], n, fresh, acc + 12 * kLanes);
  } else if (kManyRegisters) {
    add_moments(x, y, a, b, n, fresh, acc, sums);
    add_cubic_moments(x, y, a, b, n, fresh, acc + 18 * kLanes, sums + 6 * kLanes);
  } else {
    homography_rows(x, y, a, b, n, r);
    add_squares_sums3(a, r[0], r[1], n, fresh, acc, sums);
    add_squares_sums3(b, r[2], r[3], n, fresh, acc + 6 * kLanes, sums + 3 * kLanes);
    add_mixed(a, r[0], r[1], b, r[2], r[3], r[4], r[5], n, fresh, acc + 12 * kLanes, sums + 6 * kLanes);
    add_cubic(r[0], r[1], r[2], r[3], r[4], r[5], n, fresh, acc + 18 * kLanes);
  }
}

// Sums of the rows times p to `first` and times q to `second`. Where q is p, `second` is the same or stays.
TEXTPLANE_SIMD_INLINE void add_strip_sums(int form, const float* x, const float* y, const float* a, const float* b,
                                          const RowStrip& rows, const float* p, const float* q, int n, bool fresh,
                                          float* first, float* second) noexcept {
  const float(*r)[kStrip] = rows.row;
  if (form == 3) {
    add_products3(r[0], r[1], r[2], p, q, n, fresh, first, second);
  } else if (form == 6) {
    add_products3(r[0], r[1], r[2], p, q, n, fresh, first, second);
    add_products3(r[3], r[4], r[5], p, q, n, fresh, first + 3 * kLanes, second + 3 * kLanes);
  } else if (kManyRegisters) {
    if (p == q)
      add_products8(x, y, a, b, p, n, fresh, first);
    else
      add_two_products8(x, y, a, b, p, q, n, fresh, first, second);
  } else {
    add_products4(a, r[0], r[1], b, p, q, n, fresh, first, second);
    add_products4(r[2], r[3], r[4], r[5], p, q, n, fresh, first + 4 * kLanes, second + 4 * kLanes);
  }
}

// Adds the partial sums to the totals; where `first`, sets them; `sums` is rounded up to a multiple of eight.
TEXTPLANE_SIMD_ENTRY void fold(const float* acc, int sums, bool first, double* total) noexcept {
  for (int k = 0; k < sums; k += 8) {
    const vd eight = reduce_sum8(acc + k * kLanes);
    stored(total + k, first ? eight : maddd(setd(1.0), eight, loadd(total + k)));
  }
}
// Zeroes what fold() reads beyond the sums.
TEXTPLANE_SIMD_INLINE void zero_rest(int sums, float* acc) noexcept {
  for (int k = sums; k % 8 != 0; ++k) store(acc + k * kLanes, zero());
}
