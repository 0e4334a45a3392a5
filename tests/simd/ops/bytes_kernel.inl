// Every operation of the byte vectors, applied to arrays: what bytes_kernels_test.cpp compares with plain C++.

TEXTPLANE_SIMD_ENTRY void run_bytes(const textplane_test::ByteArrays& t) noexcept {
  t.result->bits = 0;
  t.result->any = false;
  t.result->lowest = -1;
  for (int i = 0; i < 64; i += kBytes) {
    const vb a = loadb(t.a + i), b = loadb(t.b + i);
    storeb(t.result->sum + i, addsb(a, b));
    storeb(t.result->difference + i, subsb(a, b));
    storeb(t.result->least + i, minb(a, b));
    storeb(t.result->most + i, maxb(a, b));
    storeb(t.result->both + i, andb(a, b));
    storeb(t.result->either + i, orb(a, b));
    storeb(t.result->not_less + i, geb(a, b));
    storeb(t.result->constant + i, setb(t.a[0]));
    storeb(t.result->mean + i,
           mean4b(loadb(t.a + 2 * i), loadb(t.a + 2 * i + kBytes), loadb(t.b + 2 * i), loadb(t.b + 2 * i + kBytes)));
    const std::uint64_t bits = bitsb(geb(a, b));
    if (bits != 0 && t.result->lowest < 0) t.result->lowest = i + lowest_bit(bits);
    t.result->bits |= bits << i;
    t.result->any = t.result->any || anyb(subsb(a, b));
  }
}

// Copies n bytes, at most one vector of them a step.
TEXTPLANE_SIMD_ENTRY void copy_parts(const std::uint8_t* from, int n, std::uint8_t* to) noexcept {
  for (int i = 0; i < n; i += kBytes) {
    const int m = n - i < kBytes ? n - i : kBytes;
    const vb part = loadb_n(from + i, m);
    storeb_n(to + i, part, m);
    std::uint8_t lanes[64];
    storeb(lanes, part);
    for (int k = m; k < kBytes; ++k) to[i] = lanes[k] == 0 ? to[i] : static_cast<std::uint8_t>(to[i] + 1);
  }
}

TEXTPLANE_SIMD_ENTRY void run_shorts(const textplane_test::ShortArrays& t) noexcept {
  t.result->dot = t.result->dot_twice = 0;
  for (int i = 0; i < 32; i += k16Lanes) {
    const v16 a = load16(t.a + i), b = load16(t.b + i);
    store16(t.result->sum + i, add16(a, b));
    store16(t.result->difference + i, sub16(a, b));
    store16(t.result->both + i, and16(a, b));
    store16(t.result->half + i, half16(a));
    store16(t.result->product + i, mul15(a, b));
    store16(t.result->first + i, first16(t.n - i));
    store16(t.result->constant + i, set16(t.n));
    store16(t.result->mixed + i, mix_pairs(t.pixels + i, and16(pair_weights(64 - t.n, t.n), first16(31 - i))));
    store16(t.result->grey + i, grey_to_fixed(t.grey + i));
    const vw once = add_dot16(vw{}, a, b);
    t.result->dot += sumw(once);
    t.result->dot_twice += sumw(add_dot16(once, b, b));
  }
}
