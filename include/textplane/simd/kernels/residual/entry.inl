// Entry points of the residual kernels (simd/residual.hpp). Include before: residual/large.inl, residual/small.inl.

// `parameters` 3, 6, 9: normal equations; 0: the cost alone, and H and b are null.
TEXTPLANE_SIMD_INLINE void residual_any(int parameters, const simd::ResidualArgs& a, simd::ResidualInfo* info,
                                        double* H, double* b) noexcept {
  simd::PointBounds bounds = a.bounds;
  if (bounds.n != a.n) find_bounds(a.x, a.y, a.n, &bounds);
  ResidualFrame f;
  info->status = Status::unsupported;
  if (!make_frame(a, bounds, &f)) return;
  ResidualArrays s;
  make_arrays(a.scratch, a.n, &s);
  // Host intensities that are not finite show in their sums: only then, a second time without them.
  for (int attempt = 0; attempt < 2; ++attempt) {
    const HostPixels pixels = host_pixels(a, f, attempt == 1, s, info);
    info->status = Status::too_few;
    if (pixels.n < 1 || pixels.n < a.min_visible) return;
    if (kInt16Tiles != 0 && pixels.n > kRowPixels) choose_tiles(a, bounds, pixels, &f);
    if (parameters == 0)
      info->status =
          pixels.n <= kRowPixels ? evaluate_small(a, f, pixels, s, info) : evaluate_large(a, f, pixels, s, info);
    else
      info->status = pixels.n <= kRowPixels ? linearise_small(parameters, a, f, pixels, s, info, H, b)
                                            : linearise_large(parameters, a, f, pixels, s, info, H, b);
    if (info->status == Status::ok && !finite_d(info->cost)) info->status = Status::unsupported;
    if (info->status != Status::non_finite) return;
  }
  info->status = Status::unsupported;
}

// Eight lanes hold a few pixels as well as sixteen do, and sum them sooner.
enum : int { kFewLanes = simd::lanes(simd::Target::TEXTPLANE_SIMD_REGION_FEW) };
TEXTPLANE_SIMD_INLINE bool leave_few(int n) noexcept { return kFewLanes != kLanes && n <= 2 * kLanes; }
TEXTPLANE_SIMD_ENTRY void linearise_plane(const simd::ResidualArgs& a, simd::ResidualInfo* info, double* H,
                                          double* b) noexcept {
  if (leave_few(a.n)) return TEXTPLANE_SIMD_REGION_FEW::linearise_plane(a, info, H, b);
  residual_any(3, a, info, H, b);
}
TEXTPLANE_SIMD_ENTRY void linearise_pose(const simd::ResidualArgs& a, simd::ResidualInfo* info, double* H,
                                         double* b) noexcept {
  if (leave_few(a.n)) return TEXTPLANE_SIMD_REGION_FEW::linearise_pose(a, info, H, b);
  residual_any(6, a, info, H, b);
}
TEXTPLANE_SIMD_ENTRY void linearise_pose_plane(const simd::ResidualArgs& a, simd::ResidualInfo* info, double* H,
                                               double* b) noexcept {
  if (leave_few(a.n)) return TEXTPLANE_SIMD_REGION_FEW::linearise_pose_plane(a, info, H, b);
  residual_any(9, a, info, H, b);
}
TEXTPLANE_SIMD_ENTRY void evaluate(const simd::ResidualArgs& a, simd::ResidualInfo* info) noexcept {
  if (leave_few(a.n)) return TEXTPLANE_SIMD_REGION_FEW::evaluate(a, info);
  residual_any(0, a, info, nullptr, nullptr);
}
