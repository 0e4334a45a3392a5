// Geometry of one residual call, in double (simd/residual.hpp). Include before: kernels/sample.inl, kernels/lens.inl.

TEXTPLANE_SIMD_INLINE double abs_d(double x) noexcept { return x < 0 ? -x : x; }

// The corners of a square around the origin, repeated to fill a vector.
constexpr float kCornerX[kMostLanes] = {-1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1};
constexpr float kCornerY[kMostLanes] = {-1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1};

// True if the points (u, v) are in front of both cameras and project into the bounds of `sample`, with a margin for
// rounding here and in the warp.
TEXTPLANE_SIMD_INLINE bool corners_inside(const ResidualFrame& f, const SampleFrame& sample, vf u, vf v) noexcept {
  const float *g = f.warp.g, margin = 1e-3F;
  const vf x = madd(set1(g[0]), u, madd(set1(g[1]), v, set1(g[2]))),
           y = madd(set1(g[3]), u, madd(set1(g[4]), v, set1(g[5])));
  const vf z = madd(set1(g[6]), u, madd(set1(g[7]), v, set1(g[8])));
  const vf rho = madd(set1(f.rho[0]), u, madd(set1(f.rho[1]), v, set1(f.rho[2])));
  const vm ahead = and_(gt(z, set1(margin)), gt(rho, mul(set1(1e-6F), abs_(set1(f.rho[2])))));
  const vm across = and_(gt(x, mul(set1(sample.x_low + margin), z)), lt(x, mul(set1(sample.x_last - margin), z)));
  const vm down = and_(gt(y, mul(set1(sample.y_low + margin), z)), lt(y, mul(set1(sample.y_last - margin), z)));
  return all_true(and_(ahead, and_(across, down)));
}

// The patch is visible if the corners of its box are: every quantity that must be positive is affine in u and v.
TEXTPLANE_SIMD_INLINE bool box_inside(const ResidualFrame& f, const SampleFrame& sample,
                                      const simd::PointBounds& bounds) noexcept {
  if (f.lens.on) {
    const float *box = f.lens.box, margin = 1e-3F;
    return box[0] <= box[2] && box[0] > sample.x_low + margin && box[1] > sample.y_low + margin &&
           box[2] < sample.x_last - margin && box[3] < sample.y_last - margin;
  }
  const vf ru = set1(bounds.x_high - f.warp.hx + 1e-3F), rv = set1(bounds.y_high - f.warp.hy + 1e-3F);
  bool inside = true;
  for (int k = 0; k < 4; k += kLanes)
    inside = inside && corners_inside(f, sample, mul(ru, load(kCornerX + k)), mul(rv, load(kCornerY + k)));
  return inside;
}

// The border of the same square, four points a side from a corner on, and which are not corners.
constexpr float kBorderX[kMostLanes] = {-1, -.5F, 0, .5F, 1, 1, 1, 1, 1, .5F, 0, -.5F, -1, -1, -1, -1};
constexpr float kBorderY[kMostLanes] = {-1, -1, -1, -1, -1, -.5F, 0, .5F, 1, 1, 1, 1, 1, .5F, 0, -.5F};
constexpr float kBetweenCorners[kMostLanes] = {0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1};

// Least and largest of the positions p[1] to p[kMostLanes] of a border, which bound those inside: the lens has an
// inverse where it holds. What the border does between two points, a share of its second difference says. Writes p[0]
// and p[kMostLanes + 1].
TEXTPLANE_SIMD_INLINE void bound_border(float* p, float* low, float* high) noexcept {
  p[0] = p[kMostLanes];
  p[kMostLanes + 1] = p[1];
  vf least = load(p + 1), most = least, bend = zero();
  for (int k = 0; k < kMostLanes; k += kLanes) {
    const vf here = load(p + 1 + k), turn = sub(add(load(p + k), load(p + 2 + k)), add(here, here));
    least = min_(here, least);
    most = max_(here, most);
    bend = max_(mul(abs_(turn), load(kBetweenCorners + k)), bend);
  }
  const float margin = 0.5F * reduce_max(bend);
  *low = reduce_min(least) - margin;
  *high = reduce_max(most) + margin;
}

// Bounds of the patch's image positions behind a lens, from the border of its box, to the frame.
TEXTPLANE_SIMD_ENTRY void bound_lens(const simd::PointBounds& bounds, ResidualFrame* f) noexcept {
  const vf ru = set1(bounds.x_high - f->warp.hx + 1e-3F), rv = set1(bounds.y_high - f->warp.hy + 1e-3F);
  float x[kMostLanes + 2], y[kMostLanes + 2], *box = f->lens.box;
  const WarpVectors warp = broadcast_warp(f->warp);
  box[0] = box[1] = 1;
  box[2] = box[3] = -1;
  for (int k = 0; k < kMostLanes; k += kLanes) {
    const vf pu = mul(ru, load(kBorderX + k)), pv = mul(rv, load(kBorderY + k));
    const vf z = madd(warp.g6, pu, madd(warp.g7, pv, warp.g8)), inverse = div(set1(1.0F), z);
    const vf rho = madd(set1(f->rho[0]), pu, madd(set1(f->rho[1]), pv, set1(f->rho[2])));
    const vf px = mul(madd(warp.g0, pu, madd(warp.g1, pv, warp.g2)), inverse),
             py = mul(madd(warp.g3, pu, madd(warp.g4, pv, warp.g5)), inverse);
    vf at_x, at_y;
    lens_or_outside(f->lens, px, py, &at_x, &at_y);
    store(x + 1 + k, at_x);
    store(y + 1 + k, at_y);
    const vm ahead = and_(gt(z, set1(1e-3F)), gt(rho, mul(set1(1e-6F), abs_(set1(f->rho[2])))));
    if (!all_true(and_(ahead, gt(at_x, set1(-1e8F))))) return;
  }
  bound_border(x, &box[0], &box[2]);
  bound_border(y, &box[1], &box[3]);
}

// H^-1 and theta^T H^-1, to the frame. (Arguments one by one: arrays would pass through memory.)
TEXTPLANE_SIMD_INLINE bool invert(double h0, double h1, double h2, double h3, double h4, double h5, double h6,
                                  double h7, double h8, const double* p, ResidualFrame* f) noexcept {
  const double i0 = h4 * h8 - h5 * h7, i1 = h2 * h7 - h1 * h8, i2 = h1 * h5 - h2 * h4;
  const double i3 = h5 * h6 - h3 * h8, i4 = h0 * h8 - h2 * h6, i5 = h2 * h3 - h0 * h5;
  const double i6 = h3 * h7 - h4 * h6, i7 = h1 * h6 - h0 * h7, i8 = h0 * h4 - h1 * h3;
  const double det = h0 * i0 + h1 * i3 + h2 * i6;
  if (!(abs_d(det) > 1e-9)) return false;
  const double idet = 1 / det;
  f->inverse[0] = i0 * idet;
  f->inverse[1] = i1 * idet;
  f->inverse[2] = i2 * idet;
  f->inverse[3] = i3 * idet;
  f->inverse[4] = i4 * idet;
  f->inverse[5] = i5 * idet;
  f->inverse[6] = i6 * idet;
  f->inverse[7] = i7 * idet;
  f->inverse[8] = i8 * idet;
  f->q[0] = (p[0] * i0 + p[1] * i3 + p[2] * i6) * idet;
  f->q[1] = (p[0] * i1 + p[1] * i4 + p[2] * i7) * idet;
  f->q[2] = (p[0] * i2 + p[1] * i5 + p[2] * i8) * idet;
  return true;
}

// The warp to the target's pinhole image, and how the image is read.
TEXTPLANE_SIMD_INLINE bool make_target(const simd::ResidualArgs& a, const double* G, float hx, float hy,
                                       ResidualFrame* f) noexcept {
  if (f->lens.on ? !make_warp_around(G, hx, hy, f->lens.ox, f->lens.oy, &f->warp)
                 : !make_centred_warp(G, hx, hy, a.target.width, a.target.height, &f->warp))
    return false;
  make_sample_frame(a.target, f->warp.ox, f->warp.oy, &f->sample);
  return true;
}

// False where the numbers exceed float, or H has no inverse.
TEXTPLANE_SIMD_ENTRY bool make_frame(const simd::ResidualArgs& a, const simd::PointBounds& bounds,
                                     ResidualFrame* f) noexcept {
  // Plain locals: in arrays they would pass through memory.
  const double p0 = a.theta[0], p1 = a.theta[1], p2 = a.theta[2], t0 = a.t[0], t1 = a.t[1], t2 = a.t[2];
  const double h0 = a.R[0] + t0 * p0, h1 = a.R[1] + t0 * p1, h2 = a.R[2] + t0 * p2;
  const double h3 = a.R[3] + t1 * p0, h4 = a.R[4] + t1 * p1, h5 = a.R[5] + t1 * p2;
  const double h6 = a.R[6] + t2 * p0, h7 = a.R[7] + t2 * p1, h8 = a.R[8] + t2 * p2;

  // Float cannot centre larger patches, nor those with a position at infinity. (A NaN compares false.)
  const double wide = static_cast<double>(bounds.x_high) - static_cast<double>(bounds.x_low);
  const double high = static_cast<double>(bounds.y_high) - static_cast<double>(bounds.y_low);
  if (!finite_d(wide) || !finite_d(high) || wide > 32768 || high > 32768) return false;
  const float hx = middle_x(bounds), hy = middle_y(bounds);

  // K_t H K_h^-1 as a function of u, v, and rho likewise; (mu, mv) is the ray where both are 0.
  const double ifx = 1 / a.host_camera[0], ify = 1 / a.host_camera[1];
  const double mu = (static_cast<double>(hx) - a.host_camera[2]) * ifx,
               mv = (static_cast<double>(hy) - a.host_camera[3]) * ify;
  f->lens.on = false;
  if (a.lens && !make_lens_frame(*a.lens, a.target_camera, a.target.width, a.target.height, &f->lens)) return false;
  const double* camera = a.lens ? f->lens.camera : a.target_camera;
  const double fx = camera[0], fy = camera[1], cx = camera[2], cy = camera[3];
  const double s6 = h6 * ifx, s7 = h7 * ify, s8 = h6 * mu + h7 * mv + h8;
  const double G[9] = {fx * (h0 * ifx) + cx * s6,
                       fx * (h1 * ify) + cx * s7,
                       fx * (h0 * mu + h1 * mv + h2) + cx * s8,
                       fy * (h3 * ifx) + cy * s6,
                       fy * (h4 * ify) + cy * s7,
                       fy * (h3 * mu + h4 * mv + h5) + cy * s8,
                       s6,
                       s7,
                       s8};
  if (!make_target(a, G, hx, hy, f)) return false;
  f->c = cx - f->warp.ox;
  f->d = cy - f->warp.oy;
  f->fx = fx;
  f->fy = fy;
  f->ifx = 1 / fx;
  f->ify = 1 / fy;
  const double r0 = p0 * ifx, r1 = p1 * ify, r2 = p2 + p0 * mu + p1 * mv;
  f->rho[0] = static_cast<float>(r0);
  f->rho[1] = static_cast<float>(r1);
  f->rho[2] = static_cast<float>(r2);
  if (!(abs_d(r0) < 1e30 && abs_d(r1) < 1e30 && abs_d(r2) < 1e30)) return false;

  if (!invert(h0, h1, h2, h3, h4, h5, h6, h7, h8, a.theta, f)) return false;
  if (a.lens) bound_lens(bounds, f);
  f->inside = bounds.n == a.n && box_inside(*f, f->sample, bounds);
  f->tiles.guess.likely = false;
  return true;
}
