// The kernel of simd/zncc.hpp. Include before: residual/template_model.inl.

TEXTPLANE_SIMD_ENTRY void zncc_candidates(const simd::ZnccArgs& z) noexcept {
  simd::ResidualArgs a = z.base;
  a.robust = RobustKind::l2;
  a.flags = nullptr;
  for (int i = 0; i < z.count; ++i) {
    const double *R = z.pose + i * z.pose_step, *t = R + z.t_offset;
    for (int r = 0; r < 3; ++r) {
      a.t[r] = t[r];
      for (int c = 0; c < 3; ++c) a.R[3 * r + c] = R[3 * c + r];
    }
    simd::ResidualInfo info = simd::ResidualInfo();
    template_any(*z.model, a, z.values, false, &info, nullptr, nullptr);
    const double half = 0.5 * info.error;  // in [0, 2] but for rounding
    z.zncc[i] = info.status == Status::ok ? static_cast<float>(half < 0.0   ? 1.0
                                                               : half > 2.0 ? -1.0
                                                                            : 1.0 - half)
                : info.status == Status::no_contrast || info.status == Status::too_few ? -1.0F
                                                                                       : simd::kZnccUnknown;
  }
}
