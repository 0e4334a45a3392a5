// From sums to normal equations, in double: the projection through mean and s, and the change of parameters. See
// docs/equations.md.

// The symmetric matrix of products of rows from its distinct entries in the order of residual_large.inl.
TEXTPLANE_SIMD_INLINE void unpack_block(const double* p, int at, double (*S)[8]) noexcept {
  S[at][at] = p[0];
  S[at][at + 1] = S[at + 1][at] = p[1];
  S[at][at + 2] = S[at + 2][at] = p[2];
  S[at + 1][at + 1] = p[3];
  S[at + 1][at + 2] = S[at + 2][at + 1] = p[4];
  S[at + 2][at + 2] = p[5];
}
TEXTPLANE_SIMD_INLINE void set_pair(double (*S)[8], int r, int c, double value) noexcept { S[r][c] = S[c][r] = value; }
TEXTPLANE_SIMD_INLINE void unpack_products(int form, const double* p, double (*S)[8]) noexcept {
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

// Sums over all pixels, weighted: products, and with the rows w, w n, w r; of w, w n, w n^2, w r, w n r alone; and unweighted
// those with 1 / N and n.
struct WeightedSums {
  double S[8][8];
  double w1[8], wn[8], wr[8], e[8], jn[8];
  double w[5];
};

// S and wr become H and b of the rows: exact through mean and s, or with both held.
TEXTPLANE_SIMD_INLINE void project_sums(int form, bool exact, double s, WeightedSums* k) noexcept {
  const double scale = 1 / (s * s);
  if (exact) {
    double p[8], q[8];
    for (int i = 0; i < form; ++i) {
      p[i] = k->w1[i] - 0.5 * (k->w[0] * k->e[i] + k->w[1] * k->jn[i]);
      q[i] = k->wn[i] - 0.5 * (k->w[2] * k->jn[i] + k->w[1] * k->e[i]);
      k->wr[i] -= k->e[i] * k->w[3] + k->jn[i] * k->w[4];
    }
    for (int i = 0; i < form; ++i)
      for (int j = 0; j < form; ++j)
        k->S[i][j] -= k->e[i] * p[j] + p[i] * k->e[j] + k->jn[i] * q[j] + q[i] * k->jn[j];
  }
  for (int i = 0; i < form; ++i) {
    k->wr[i] /= -s;
    for (int j = 0; j < form; ++j) k->S[i][j] *= scale;
  }
}

// d j / d parameter: columns v, omega, theta of the matrix M, which takes rows of the pixel homography to rows of the parameters.
TEXTPLANE_SIMD_INLINE void parameter_matrix(const simd::ResidualArgs& a, const ResidualFrame& f, double (*M)[9]) noexcept {
  const double fx = a.target_camera[0], fy = a.target_camera[1], c = f.c, d = f.d;
  const double fxy = fx / fy, fyx = fy / fx, cx = c / fx, dy = d / fy;
  for (int k = 0; k < 9; ++k) {
    // The generator dH H^-1 of this parameter is left^T right, or [e]x.
    double m[8];
    if (k >= 3 && k < 6) {
      m[0] = k == 4 ? 1 : 0;
      m[1] = 0;
      m[2] = k == 5 ? -1 : 0;
      m[3] = k == 3 ? -1 : 0;
      m[4] = k == 5 ? 1 : 0;
      m[5] = 0;
      m[6] = k == 4 ? 1 : 0;
      m[7] = k == 3 ? -1 : 0;
    } else {
      const double* right = k < 3 ? f.q : f.inverse + 3 * (k - 6);
      const double l0 = k < 3 ? (k == 0 ? 1 : 0) : a.t[0], l1 = k < 3 ? (k == 1 ? 1 : 0) : a.t[1];
      const double l2 = k < 3 ? (k == 2 ? 1 : 0) : a.t[2];
      m[0] = l0 * right[2];
      m[1] = l0 * right[0] - l2 * right[2];
      m[2] = l0 * right[1];
      m[3] = l1 * right[2];
      m[4] = l1 * right[0];
      m[5] = l1 * right[1] - l2 * right[2];
      m[6] = -l2 * right[0];
      m[7] = -l2 * right[1];
    }
    M[0][k] = fx * m[0] - c * m[1] - fxy * d * m[2] + c * (cx * m[6] + dy * m[7]);
    M[1][k] = m[1] - 2 * cx * m[6] - dy * m[7];
    M[2][k] = fxy * m[2] - c / fy * m[7];
    M[3][k] = fy * m[3] - fyx * c * m[4] - d * m[5] + d * (cx * m[6] + dy * m[7]);
    M[4][k] = fyx * m[4] - d / fx * m[6];
    M[5][k] = m[5] - cx * m[6] - 2 * dy * m[7];
    M[6][k] = m[6] / fx;
    M[7][k] = m[7] / fy;
  }
}

// H = M^T S M, b = M^T g.
TEXTPLANE_SIMD_INLINE void change_parameters(const double (*M)[9], const double (*S)[8], const double* g, double* H,
                                             double* b) noexcept {
  double T[8][9];
  for (int r = 0; r < 8; ++r)
    for (int c = 0; c < 9; ++c) {
      double sum = 0;
      for (int k = 0; k < 8; ++k) sum += S[r][k] * M[k][c];
      T[r][c] = sum;
    }
  for (int r = 0; r < 9; ++r) {
    double sum = 0;
    for (int k = 0; k < 8; ++k) sum += M[k][r] * g[k];
    b[r] = sum;
    for (int c = r; c < 9; ++c) {
      double entry = 0;
      for (int k = 0; k < 8; ++k) entry += M[k][r] * T[k][c];
      H[9 * r + c] = H[9 * c + r] = entry;
    }
  }
}
