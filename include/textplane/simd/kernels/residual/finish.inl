// From sums to normal equations, in double: the projection through mean and s, and the change of parameters
// (docs/equations.md). Include before: residual/frame.inl.

// The symmetric matrix of products of rows from its distinct entries in the order of strip_sums.inl.
TEXTPLANE_SIMD_INLINE void unpack_block(const double* p, int at, double (*S)[8]) noexcept {
  S[at][at] = p[0];
  S[at][at + 1] = S[at + 1][at] = p[1];
  S[at][at + 2] = S[at + 2][at] = p[2];
  S[at + 1][at + 1] = p[3];
  S[at + 1][at + 2] = S[at + 2][at + 1] = p[4];
  S[at + 2][at + 2] = p[5];
}
TEXTPLANE_SIMD_INLINE void set_pair(double (*S)[8], int r, int c, double value) noexcept { S[r][c] = S[c][r] = value; }
TEXTPLANE_SIMD_ENTRY void unpack_products(int form, const double* p, double (*S)[8]) noexcept {
  unpack_block(p, 0, S);
  if (form == 3) return;
  unpack_block(p + 6, 3, S);
  if (form == 6) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) set_pair(S, r, 3 + c, p[12 + 3 * r + c]);
    return;
  }
  set_pair(S, 0, 3, p[12]);
  set_pair(S, 0, 4, p[13]);
  set_pair(S, 1, 3, p[13]);
  set_pair(S, 0, 5, p[14]);
  set_pair(S, 2, 3, p[14]);
  set_pair(S, 1, 4, p[15]);
  set_pair(S, 1, 5, p[16]);
  set_pair(S, 2, 4, p[16]);
  set_pair(S, 2, 5, p[17]);
  // With C = Ax + By: A Cx = A^2 xx + AB xy, and so on.
  set_pair(S, 0, 6, p[3] + p[16]);
  set_pair(S, 0, 7, p[4] + p[17]);
  set_pair(S, 3, 6, p[15] + p[10]);
  set_pair(S, 3, 7, p[16] + p[11]);
  set_pair(S, 1, 6, p[18]);
  set_pair(S, 1, 7, p[19]);
  set_pair(S, 2, 6, p[19]);
  set_pair(S, 2, 7, p[20]);
  set_pair(S, 4, 6, p[21]);
  set_pair(S, 4, 7, p[22]);
  set_pair(S, 5, 6, p[22]);
  set_pair(S, 5, 7, p[23]);
  S[6][6] = p[24];
  set_pair(S, 6, 7, p[25]);
  S[7][7] = p[26];
}

// Sums over all pixels, weighted: products, and with the rows w, w n, w r; of w, w n, w n^2, w r, w n r alone; and
// unweighted those with 1 / N and n.
struct WeightedSums {
  double S[8][8];
  double w1[8], wn[8], wr[8], e[8], jn[8];
  double w[5];
};

// S and wr become H and b of the rows: exact through mean and s, or with both held. (Lanes beyond `form` are not read.)
TEXTPLANE_SIMD_ENTRY void project_sums(int form, bool exact, double s, WeightedSums* k) noexcept {
  const double scale = 1 / (s * s);
  const vd by = setd(scale);
  vd wr = loadd(k->wr);
  if (exact) {
    double p[8], q[8];  // times -scale
    const vd e = loadd(k->e), jn = loadd(k->jn), minus = setd(-scale), mixed = setd(0.5 * scale * k->w[1]);
    const vd by_p = maddd(setd(0.5 * scale * k->w[0]), e, maddd(mixed, jn, muld(minus, loadd(k->w1))));
    const vd by_q = maddd(setd(0.5 * scale * k->w[2]), jn, maddd(mixed, e, muld(minus, loadd(k->wn))));
    stored(p, by_p);
    stored(q, by_q);
    wr = maddd(setd(-k->w[3]), e, maddd(setd(-k->w[4]), jn, wr));
    for (int i = 0; i < form; ++i) {
      const vd by_e = maddd(setd(k->e[i]), by_p, maddd(setd(p[i]), e, muld(by, loadd(k->S[i]))));
      stored(k->S[i], maddd(setd(k->jn[i]), by_q, maddd(setd(q[i]), jn, by_e)));
    }
  } else {
    for (int i = 0; i < form; ++i) stored(k->S[i], muld(by, loadd(k->S[i])));
  }
  stored(k->wr, muld(setd(-scale * s), wr));
}

// d j / d parameter: columns v, omega, theta of the matrix M, which takes rows of the pixel homography to rows of the
// parameters. Rows 0 to 7 of the result hold columns 0 to 7; row 8 holds column 8.
TEXTPLANE_SIMD_ENTRY void parameter_matrix(const simd::ResidualArgs& a, const ResidualFrame& f,
                                           double (*M)[8]) noexcept {
  const double fx = f.fx, fy = f.fy, ix = 1 / fx, iy = 1 / fy, c = f.c, d = f.d;
  const double fxy = fx * iy, fyx = fy * ix, cx = c * ix, dy = d * iy;
  for (int k = 0; k < 9; ++k) {
    // The generator dH H^-1 of this parameter is left^T right, or [e]x.
    double m0 = 0, m1 = 0, m2 = 0, m3 = 0, m4 = 0, m5 = 0, m6 = 0, m7 = 0;
    if (k >= 3 && k < 6) {
      m0 = m6 = k == 4 ? 1 : 0;
      m3 = m7 = k == 3 ? -1 : 0;
      m2 = k == 5 ? -1 : 0;
      m4 = -m2;
    } else {
      const double* right = k < 3 ? f.q : f.inverse + 3 * (k - 6);
      const double l0 = k < 3 ? (k == 0 ? 1 : 0) : a.t[0], l1 = k < 3 ? (k == 1 ? 1 : 0) : a.t[1];
      const double l2 = k < 3 ? (k == 2 ? 1 : 0) : a.t[2];
      m0 = l0 * right[2];
      m1 = l0 * right[0] - l2 * right[2];
      m2 = l0 * right[1];
      m3 = l1 * right[2];
      m4 = l1 * right[0];
      m5 = l1 * right[1] - l2 * right[2];
      m6 = -l2 * right[0];
      m7 = -l2 * right[1];
    }
    double* out = k < 8 ? &M[0][k] : M[8];
    const int step = k < 8 ? 8 : 1;
    const double both = cx * m6 + dy * m7;
    out[0] = fx * m0 - c * m1 - fxy * d * m2 + c * both;
    out[step] = m1 - cx * m6 - both;
    out[2 * step] = fxy * m2 - c * iy * m7;
    out[3 * step] = fy * m3 - fyx * c * m4 - d * m5 + d * both;
    out[4 * step] = fyx * m4 - d * ix * m6;
    out[5 * step] = m5 - both - dy * m7;
    out[6 * step] = m6 * ix;
    out[7 * step] = m7 * iy;
  }
}

// The row of `left` times the rows of eight columns. Two sums shorten the chain of dependent additions.
TEXTPLANE_SIMD_INLINE vd row_product(const double* left, std::ptrdiff_t step, const double (*rows)[8]) noexcept {
  const vd one = setd(1.0);
  vd even = muld(setd(left[0]), loadd(rows[0])), odd = muld(setd(left[step]), loadd(rows[1]));
  even = maddd(setd(left[2 * step]), loadd(rows[2]), even);
  odd = maddd(setd(left[3 * step]), loadd(rows[3]), odd);
  even = maddd(setd(left[4 * step]), loadd(rows[4]), even);
  odd = maddd(setd(left[5 * step]), loadd(rows[5]), odd);
  even = maddd(setd(left[6 * step]), loadd(rows[6]), even);
  odd = maddd(setd(left[7 * step]), loadd(rows[7]), odd);
  return maddd(one, even, odd);
}

// H = M^T S M (9 x 9) and b = M^T g.
TEXTPLANE_SIMD_ENTRY void change_parameters(const double (*M)[8], const double (*S)[8], const double* g, double* H,
                                            double* b) noexcept {
  double T[8][8], last[8], row[8];
  for (int r = 0; r < 8; ++r) stored(T[r], row_product(S[r], 1, M));
  stored(last, row_product(M[8], 1, S));  // column 8 of S M
  for (int r = 0; r < 8; ++r) stored(H + 9 * r, row_product(&M[0][r], 8, T));
  stored(H + 72, row_product(M[8], 1, T));
  stored(b, row_product(g, 1, M));
  stored(row, muld(loadd(last), loadd(M[8])));
  H[80] = ((row[0] + row[1]) + (row[2] + row[3])) + ((row[4] + row[5]) + (row[6] + row[7]));
  stored(row, muld(loadd(g), loadd(M[8])));
  b[8] = ((row[0] + row[1]) + (row[2] + row[3])) + ((row[4] + row[5]) + (row[6] + row[7]));
  for (int r = 0; r < 8; ++r) H[9 * r + 8] = H[72 + r];
  // The two products of an off-diagonal pair round differently.
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < r; ++c) H[9 * r + c] = H[9 * c + r];
}

// True if H, b and the costs are finite. The diagonal decides for all of H: its sums bound the other products, and a
// change of parameters spreads what is not finite over all entries.
TEXTPLANE_SIMD_ENTRY bool finite_sums(int parameters, const simd::ResidualInfo& info, const double* H,
                                      const double* b) noexcept {
  double sum = info.cost;
  for (int i = 0; i < parameters; ++i) sum += H[(parameters + 1) * i] + b[i];
  return finite_d(sum);
}
