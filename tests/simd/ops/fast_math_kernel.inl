TEXTPLANE_SIMD_ENTRY void clamp_to_int(const float* p, float low, float high, int* out) noexcept {
  storei(out, to_int(min_(max_(load(p), set1(low)), set1(high))));
}
