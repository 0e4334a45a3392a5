// Cauchy's and Tukey's costs of kLanes squared residuals, and the roots of their weights.
TEXTPLANE_SIMD_ENTRY void robust_costs(RobustKind kind, double delta, const float* squares, float* rho,
                                       float* root) noexcept {
  vf cost, weight;
  robust_vector(broadcast_robust(kind, delta), load(squares), &cost, &weight);
  store(rho, cost);
  store(root, weight);
}
