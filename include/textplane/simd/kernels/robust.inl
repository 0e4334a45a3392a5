// The costs and weights that weigh all pixels (core/robust.hpp) as vectors. Include before: the operations.

// log(1 + u) within 5e-7 of itself, 0 <= u <= 1e30.
TEXTPLANE_SIMD_INLINE vf log1p_(vf u) noexcept {
  // 1 + u = 2^k (1 + f), 1 + f in [sqrt(1/2), sqrt(2)); with s = f / (2 + f) its logarithm is 2 (s + s^3 / 3 + s^5 / 5
  // + ...).
  const vf one = set1(1.0F);
  const vi y = as_int(add(one, u)), k = shr(subi(y, seti(0x3f3504f3)), 23);
  const vf f = select(eqi(k, seti(0)), u, sub(as_float(subi(y, shl(k, 23))), one));
  const vf s = div(f, add(f, set1(2.0F))), z = mul(s, s);
  const vf series = madd(z, madd(z, madd(z, madd(z, set1(1.0F / 9), set1(1.0F / 7)), set1(0.2F)), set1(1.0F / 3)), one);
  return madd(to_float(k), set1(0.693147181F), mul(add(s, s), series));
}

// What a loop over residuals needs, made before it.
struct RobustVectors {
  vf squared, inverse;  // delta^2, 1 / delta^2
  RobustKind kind;
};
TEXTPLANE_SIMD_INLINE RobustVectors broadcast_robust(RobustKind kind, double delta) noexcept {
  const double d = delta < 1e-12 ? 1e-12 : delta > 1e12 ? 1e12 : delta, squared = d * d;
  return RobustVectors{set1(static_cast<float>(squared)), set1(static_cast<float>(1 / squared)), kind};
}

// The cost of e^2 and the root of its weight.
TEXTPLANE_SIMD_INLINE void robust_vector(const RobustVectors& r, vf squares, vf* rho, vf* root) noexcept {
  const vf one = set1(1.0F), u = mul(squares, r.inverse);
  if (r.kind == RobustKind::tukey) {
    const vf m = min_(u, one), rest = madd(m, madd(m, set1(1.0F / 3), set1(-1.0F)), one);
    *rho = mul(mul(m, r.squared), rest);
    *root = sub(one, m);
  } else {
    const vf bounded = min_(u, set1(1e30F));
    *rho = mul(r.squared, log1p_(bounded));
    *root = inverse_root(add(one, bounded));
  }
}
