"""Drawn mutants that no test can kill: {(header, text, text instead): why}. They do not count."""

EQUIVALENT = {
    ("core/cameras/lens.hpp", "const S tolerance = std::numeric_limits<S>::epsilon() < S(1e-10) ? S(1e-12) : S(1e-6);",
     "const S tolerance = std::numeric_limits<S>::epsilon() < S(1e-11) ? S(1e-12) : S(1e-6);"):
        "no type has an epsilon between the two",
    ("core/cameras/lens.hpp", "for (int i = 0; i < iterations; ++i) {",
     "for (int i = 1; i < iterations; ++i) {"):
        "a step fewer of 20, after which careful ones begin, and of their 60, which end long before",
    ("core/cameras/lens.hpp",
     "S(1) - theta2 / S(2) * (S(1) - theta2 / S(12) * (S(1) - theta2 / S(30) * (S(1) - theta2 / S(56))))};",
     "S(1) - theta2 / S(2) * (S(1) - theta2 / S(12) * (S(1) - theta2 / S(30) * (S(1) - theta2 / S(57))))};"):
        "less than 2 % of the last term of a series, which is 2.5e-17",
    ("core/numeric.hpp", "for (int i = N - 1; i >= 0; --i)",
     "for (int i = N + 1; i >= 0; --i)"):
        "rows beyond the last subtract nothing: there is no column behind them",
    ("core/se3.hpp", "e = S(1) / S(12) + x2 * (S(1) / S(720) + x2 * (S(1) / S(30240) + x2 / S(1209600)));",
     "e = S(1) / S(12) + x2 * (S(1) / S(720) + x2 * (S(1) / S(30240) + x2 / S(1209601)));"):
        "less than 1e-6 of the last term of a series, below its rounding",
    ("features/align.hpp", "const bool worse = c.zncc < result.zncc && step_x * step_x + step_y * step_y > 0.0625F;",
     "const bool worse = c.zncc < result.zncc && step_x * step_x + step_y * step_y > 0.125F;"):
        "the path of the iteration, not where it ends",
    ("features/align.hpp", "if (!(vv > kScale * kScale * n * least) || !(vv > 1e-6 * kScale * kScale * n)) return c;",
     "if (!(vv > kScale * kScale * n * least) || !(vv > 2e-06 * kScale * kScale * n)) return c;"):
        "fixed-point samples have no contrast between the two: one of 441 samples that is off by 1/32 has more",
    ("geometry/quad.hpp", "const S t = detail::significant_turn(quad.corner[i], quad.corner[(i + 1) % 4], quad.corner[(i + 2) % 4]);",
     "const S t = detail::significant_turn(quad.corner[i], quad.corner[(i + 1) % 4], quad.corner[(i + 3) % 4]);"):
        "the same four triangles of corners, each begun at another corner",
    ("geometry/triangulate.hpp", "const W rounding = W(64) * epsilon * (system.cost + W(64) * epsilon);",
     "const W rounding = W(63) * epsilon * (system.cost + W(64) * epsilon);"):
        "when to stop: a rounding error or a little less of one",
    ("geometry/triangulate.hpp", "damping = damping > W(1e-6) ? W(10) * damping : W(1e-4);",
     "damping = damping > W(2e-06) ? W(10) * damping : W(1e-4);"):
        "the path of the damping, not where it ends",
    ("landmarks/text_surface.hpp",
     "if (p.z() > 0 && (camera.project(p) - middle).norm() <= reach) depths.push_back(p.z());",
     "if (p.z() >= 0 && (camera.project(p) - middle).norm() <= reach) depths.push_back(p.z());"):
        "a point in the plane of the camera has no pixel within any reach: its distance is infinite or a NaN",
    ("photometry/template_patch.hpp", "static constexpr double kRange = 8191;  // of the int16 columns",
     "static constexpr double kRange = 8190;  // of the int16 columns"):
        "columns are rounded to a step 1.0001 times as large, within the stated bounds",
    ("photometry/world_parameters.hpp", "double W[6][9], *to = out->H.data();",
     "double W[7][9], *to = out->H.data();"):
        "a longer array, whose end nobody reads",
    ("simd/batch.hpp", "std::ptrdiff_t pose_step = 12, t_offset = 9;",
     "std::ptrdiff_t pose_step = 12, t_offset = 10;"):
        "TextBatch, its one user, sets it",
    ("simd/kernels/residual/batch.inl", "const int lanes = members - lane < kLanes ? members - lane : static_cast<int>(kLanes);",
     "const int lanes = members - lane <= kLanes ? members - lane : static_cast<int>(kLanes);"):
        "both are the number of members where they are equal",
    ("simd/kernels/residual/batch.inl", "if (parameters > 6) {",
     "if (parameters > 7) {"):
        "the numbers of parameters are 3, 6 and 9",
    ("simd/kernels/residual/batch.inl", "vf e[9], c[9]; / if (parameters > 0) {",
     "vf e[9], c[9]; / if (parameters >= 0) {"):
        "without parameters the means are computed, of rows that nobody reads",
    ("simd/kernels/residual/collect.inl",
     "float a0 = (g[0] - x * g[6]) * z, b0 = (g[1] - x * g[7]) * z, c0 = (g[3] - y * g[6]) * z, d0 = (g[4] - y * g[7]) * z;",
     "float a0 = (g[0] - x * g[6]) * z, b0 = (g[1] - x * g[7]) * z, c0 = (g[3] - y * g[6]) * z, d0 = (g[4] - y * g[8]) * z;"):
        "a guess about where tiles pay: the bits are the same with tiles and without",
    ("simd/kernels/residual/collect.inl", "if (kInt16Tiles != 0 && f.tiles.guess.likely) {",
     "if (kInt16Tiles != 1 && f.tiles.guess.likely) {"):
        "without tiles: the same bits by a slower way",
    ("simd/kernels/residual/collect.inl", "front += static_cast<int>(in_front >> k & 1U);",
     "front -= static_cast<int>(in_front >> k & 1U);"):
        "the number behind is compared with that of candidates alone, and equals it if and only if none is in front",
    ("simd/kernels/residual/esm.inl", "for (int begin = 0; begin < weighted; begin += kStrip) {",
     "for (int begin = 0; begin <= weighted; begin += kStrip) {"):
        "an empty strip adds nothing",
    ("simd/kernels/residual/frame.inl", "const vf rho = madd(set1(f.rho[0]), u, madd(set1(f.rho[1]), v, set1(f.rho[2])));",
     "const vf rho = nmadd(set1(f.rho[0]), u, madd(set1(f.rho[1]), v, set1(f.rho[2])));"):
        "the box is symmetric about its middle: the same four corners in another order",
    ("simd/kernels/residual/frame.inl", "constexpr float kCornerX[kMostLanes] = {-1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1};",
     "constexpr float kCornerX[kMostLanes] = {-1, 1, -1, 1, -0, 1, -1, 1, -1, 1, -1, 1, -1, 1, -1, 1};"):
        "lanes beyond the fourth repeat a corner of the box; a point between two of them asks for nothing more",
    ("simd/kernels/residual/large.inl", "const int n = host.n; / for (int begin = 0; begin < n; begin += kStrip) {",
     "const int n = host.n; / for (int begin = 0; begin <= n; begin += kStrip) {"):
        "an empty strip adds nothing",
    ("simd/kernels/residual/small.inl", "cross_few(r0, r1, n, sum[2]); / } / if (parameters > 6) {",
     "cross_few(r0, r1, n, sum[2]); / } / if (parameters > 7) {"):
        "the numbers of parameters are 3, 6 and 9",
    ("simd/kernels/residual/strip_sums.inl",
     "TEXTPLANE_SIMD_INLINE int product_count(int form) noexcept { return form == 3 ? 6 : form == 6 ? 21 : 27; }",
     "TEXTPLANE_SIMD_INLINE int product_count(int form) noexcept { return form == 3 ? 6 : form == 5 ? 21 : 27; }"):
        "the sums of six rows lie where those of eight do, for whoever writes and reads them",
    ("simd/kernels/residual/template.inl", "if (!kManyRegisters || !rows || i % kStep != 0) return;",
     "if (kManyRegisters || !rows || i % kStep != 0) return;"):
        "what is prefetched changes no number",
    ("simd/kernels/residual/template_model.inl", "unpack_products(8, other, sums->S);",
     "unpack_products(7, other, sums->S);"):
        "it tells 3, 6 and others apart",
    ("simd/kernels/residual/weights.inl", "if (n - j < kLanes) weight = keep(first_n(n - j), weight);",
     "if (n - j <= kLanes) weight = keep(first_n(n - j), weight);"):
        "all lanes are kept where the vector is full, by either way",
    ("simd/kernels/sample.inl", "const double size = (z < 0 ? -z : z) + 50 * ((h[6] < 0 ? -h[6] : h[6]) + (h[7] < 0 ? -h[7] : h[7]));",
     "const double size = (z < 0 ? -z : z) + 51 * ((h[6] < 0 ? -h[6] : h[6]) + (h[7] < 0 ? -h[7] : h[7]));"):
        "the scale of a homography: what is divided by it is so on both sides, up to rounding within the stated bounds",
    ("simd/kernels/warp.inl", "const double steep = ay0 > ay1 ? ay0 : ay1, wide = ax0 > ax1 ? ax0 : ax1, narrow = ax0 < ax1 ? ax0 : ax1;",
     "const double steep = ay0 > ay1 ? ay0 : ay1, wide = ax0 > ax1 ? ax0 : ax1, narrow = ax0 <= ax1 ? ax0 : ax1;"):
        "the same number where both are equal",
    ("simd/kernels/warp.inl", "t->leftwards = nx0 < 0.0;",
     "t->leftwards = nx0 <= 0.0;"):
        "a guess about where tiles pay, where both directions are one",
    ("simd/residual.hpp", "double q[3];            // theta^T H^-1",
     "double q[4];            // theta^T H^-1"):
        "a longer array, whose end nobody reads",
    ("simd/residual.hpp", "float rho[3];           // rho = theta^T m~ of a host pixel: rho0 u + rho1 v + rho2",
     "float rho[4];           // rho = theta^T m~ of a host pixel: rho0 u + rho1 v + rho2"):
        "a longer array, whose end nobody reads",
    ("simd/warp.hpp", "double x[3], y[3], z[3];",
     "double x[3], y[4], z[3];"):
        "a longer array, whose end nobody reads",
    ("simd/warp.hpp", "float upper[2 * kWarpBlockWidth], lower[2 * kWarpBlockWidth];",
     "float upper[2 * kWarpBlockWidth], lower[3 * kWarpBlockWidth];"):
        "a longer array, whose end nobody reads",
    ("solver/window_calibration.hpp",
     "if (parameter_[6 * b + k] == 0 && ratio_ > 0) out(r, k) += ratio_ * J(r, 1);",
     "if (parameter_[5 * b + k] == 0 && ratio_ > 0) out(r, k) += ratio_ * J(r, 1);"):
        "parameter 0 can only be the first unknown, of the first block",
    ("solver/window_problem.hpp", "double cost_tolerance = 1e-6;",
     "double cost_tolerance = 1e-7;"):
        "when to stop: more iterations to the same minimum, within what the tolerance allows",
    ("solver/window_problem.hpp", "double step_tolerance = 1e-9;",
     "double step_tolerance = 1e-10;"):
        "when to stop: a step of 1e-9 of the depth is below what the cost's tolerance lets pass",
    ("solver/window_structure.hpp", "int scale_a = -1, scale_b = -1;  ///< Frames whose distance is held, or -1.",
     "int scale_a = -2, scale_b = -1;  ///< Frames whose distance is held, or -1."):
        "build() sets it before anybody reads it",
    ("solver/window_terms.hpp", "return n > 0 ? sum / n : 1;",
     "return n > 0 ? sum / n : 0;"):
        "build() lets no window without active observations pass, and these stay in front of their cameras",
}
