// Which of our benchmarks is compared with which peer's, and how much faster it is meant to be.
#ifndef TEXTPLANE_BENCH_FORMAT_COMPARISONS_HPP
#define TEXTPLANE_BENCH_FORMAT_COMPARISONS_HPP

namespace textplane_bench {

struct Comparison {
  const char* versus;  ///< What the table calls it.
  const char* ours;    ///< Benchmark without target and size.
  const char* target;  ///< "best", or one that the aim is for.
  const char* size;
  const char* peer;  ///< Whole name.
  double aim;        ///< Least ratio of the minima; 0 where there is no aim.
  /// One of several forms of a peer, of which one can be built: no row where it was not run.
  bool alternative = false;
};

inline constexpr const char* kNine = "straightforward double, 9 parameters, Huber";
inline constexpr const char* kTemplate = "the same against our template form, L2, another algorithm";
inline constexpr const char* kManyScales = "cv::findTransformECCMultiScale, 3 levels, from 3 px; exact";
inline constexpr const char* kDescribed =
    "cv::findTransformECCMultiScale from its description, 3 levels, from 3 px; exact";
inline constexpr const char* kFarManyScales = "cv::findTransformECCMultiScale, 3 levels, from 10 px; ESM, then exact";
inline constexpr const char* kFarDescribed =
    "cv::findTransformECCMultiScale from its description, 3 levels, from 10 px; ESM, then exact";
inline constexpr Comparison kComparisons[] = {
    {kNine, "pose_plane", "avx512", "4000", "eigen_double_9/native/4000", 15},
    {kNine, "pose_plane", "avx512", "1000", "eigen_double_9/native/1000", 14},
    {kNine, "pose_plane", "avx512", "256", "eigen_double_9/native/256", 11},
    {kNine, "pose_plane", "avx2", "4000", "eigen_double_9/native/4000", 11},
    {kNine, "pose_plane", "avx2", "1000", "eigen_double_9/native/1000", 0},
    {kNine, "pose_plane", "avx2", "256", "eigen_double_9/native/256", 0},
    {kNine, "pose_plane", "neon", "4000", "eigen_double_9/native/4000", 0},
    {"the same, target prepared", "pose_plane_prepared", "best", "4000", "eigen_double_9/native/4000", 0},
    {"the same, 24 scenes in turn", "pose_plane_cold", "best", "4000", "eigen_double_9/native/4000", 0},
    {"straightforward double, 6 parameters, Huber", "pose", "best", "4000", "eigen_double_6/native/4000", 12},
    {kTemplate, "template_l2", "best", "4000", "eigen_double_9/native/4000", 50},
    {kTemplate, "template_l2", "best", "1000", "eigen_double_9/native/1000", 42},
    {"the same, target prepared", "template_l2_prepared", "best", "1000", "eigen_double_9/native/1000", 0},
    {"straightforward double, 9 parameters, N = 15, one object", "pose_plane", "best", "15", "eigen_double_9/native/15",
     3},
    {"the same, batch of 16 objects", "batch16_pose_plane", "best", "15", "eigen_double_9/native/15", 9},
    {"numeric differences as published, host, target and theta", "host_target_plane", "best", "4000",
     "numeric_differences/native/4000", 250},
    {"numeric differences as published, host, target and theta", "host_target_plane", "best", "1000",
     "numeric_differences/native/1000", 0},
    {"Ceres autodiff, bilinear, residual and J", "pose_plane", "best", "4000", "ceres_rows/native/4000", 12},
    {"Ceres autodiff, bilinear, with J^T J", "pose_plane", "best", "4000", "ceres_equations/native/4000", 18},
    {"cv::findTransformECC given a cut-out, an iteration; exact", "pose_plane", "best", "4000",
     "ecc_iteration/opencv/4000", 25},
    {"cv::findTransformECC given a cut-out, an iteration; exact", "pose_plane", "best", "40x25",
     "ecc_iteration/opencv/1000", 25},
    {"cv::findTransformECC given a cut-out, an iteration; exact", "pose_plane", "best", "16x16",
     "ecc_iteration/opencv/256", 25},
    {"cv::findTransformECC given a cut-out, an iteration; template", "template_l2", "best", "4000",
     "ecc_iteration/opencv/4000", 70},
    {"cv::findTransformECC given a cut-out, an iteration; template", "template_l2", "best", "40x25",
     "ecc_iteration/opencv/1000", 70},
    {"cv::findTransformECC given a cut-out, an iteration; template", "template_l2", "best", "16x16",
     "ecc_iteration/opencv/256", 70},
    {"cv::findTransformECC given the whole frame as ours is, an iteration; exact", "pose_plane", "best", "4000",
     "ecc_iteration_frame/opencv/4000", 25},
    {"cv::findTransformECC given the whole frame as ours is, an iteration; template", "template_l2", "best", "4000",
     "ecc_iteration_frame/opencv/4000", 70},
    {"cv::findTransformECC, to convergence from 3 px; exact", "converge_forward", "best", "4000",
     "ecc_converge/opencv/4000", 20},
    {"cv::findTransformECC, to convergence from 3 px; template, least squares as ECC's", "converge_template_l2", "best",
     "4000", "ecc_converge/opencv/4000", 60},
    {"the same; template, Huber", "converge_template", "best", "4000", "ecc_converge/opencv/4000", 0},
    {kManyScales, "converge_forward", "best", "4000", "ecc_multiscale/opencv/4000", 0, true},
    {kDescribed, "converge_forward", "best", "4000", "ecc_multiscale_described/opencv/4000", 0, true},
    {"cv::findTransformECC, to convergence from 10 px; ESM, then exact", "converge_automatic_far", "best", "4000",
     "ecc_converge_far/opencv/4000", 0},
    {kFarManyScales, "converge_automatic_far", "best", "4000", "ecc_multiscale_far/opencv/4000", 0, true},
    {kFarDescribed, "converge_automatic_far", "best", "4000", "ecc_multiscale_described_far/opencv/4000", 0, true},
    {"dlib::correlation_tracker, a box learnt beforehand, one update from 3 px; exact", "converge_forward", "best",
     "4000", "correlation_tracker/dlib/4000", 0},
    {"cv::warpPerspective, 8-bit in, float out (its float path)", "warp_u8_f32", "best", "100x40",
     "warpPerspective_f32/opencv/100x40", 8},
    {"cv::warpPerspective, 8-bit in and out", "warp_u8_u8", "best", "100x40", "warpPerspective_u8/opencv/100x40", 5},
    {"cv::warpPerspective, float in and out", "warp_f32_f32", "best", "100x40", "warpPerspective_f32/opencv/100x40",
     3.5},
    {"cv::remap with the map made beforehand, 8-bit", "warp_u8_u8", "best", "100x40", "remap_u8/opencv/100x40", 0},
    {"cv::remap with the map made beforehand, float", "warp_f32_f32", "best", "100x40", "remap_f32/opencv/100x40", 0},
    {"cv::FAST with suppression, 640x480", "fast", "best", "640x480", "fast/opencv/640x480", 1.5},
    {"cv::calcOpticalFlowPyrLK, 21x21, 3 levels, a light change", "klt_light", "best", "points",
     "klt_light/opencv/points", 3},
    {"the same, steady light", "klt_steady", "best", "points", "klt_steady/opencv/points", 3},
    {"cv::pyrDown, 3 levels", "pyramid3", "best", "640x480", "pyramid3/opencv/640x480", 0},
    {"ViSP, ZNCC inverse compositional, an iteration", "template_l2", "best", "4000", "visp_zncc_inverse/visp/4000", 0},
    {"ViSP, ZNCC forward additional, an iteration", "pose_plane", "best", "4000", "visp_zncc_forward/visp/4000", 0},
    {"ViSP, SSD ESM, an iteration", "esm", "best", "4000", "visp_ssd_esm/visp/4000", 0},
    {"ours without a lens; radial-tangential, 9 parameters", "pose_plane_radial_tangential", "avx512", "4000",
     "pose_plane/avx512/4000", 1 / 1.2},
    {"ours without a lens; radial-tangential, 6 parameters", "pose_radial_tangential", "avx512", "4000",
     "pose/avx512/4000", 1 / 1.2},
    {"ours without a lens; radial-tangential, 3 parameters", "plane_radial_tangential", "avx512", "4000",
     "plane/avx512/4000", 1 / 1.2},
    {"ours without a lens; radial-tangential, ESM", "esm_radial_tangential", "avx512", "4000", "esm/avx512/4000",
     1 / 1.2},
    {"ours without a lens; radial-tangential, template", "template_huber_radial_tangential", "avx512", "4000",
     "template_huber/avx512/4000", 1 / 1.2},
    {"ours without a lens; radial-tangential, cost", "cost_radial_tangential", "avx512", "4000", "cost/avx512/4000",
     1 / 1.2},
    {"ours without a lens; radial-tangential, 9 parameters", "pose_plane_radial_tangential", "avx2", "4000",
     "pose_plane/avx2/4000", 1 / 1.2},
    {"ours without a lens; Kannala-Brandt, 9 parameters", "pose_plane_kannala_brandt", "avx512", "4000",
     "pose_plane/avx512/4000", 1 / 1.35},
    {"ours without a lens; Kannala-Brandt, 6 parameters", "pose_kannala_brandt", "avx512", "4000", "pose/avx512/4000",
     1 / 1.35},
    {"ours without a lens; Kannala-Brandt, 3 parameters", "plane_kannala_brandt", "avx512", "4000", "plane/avx512/4000",
     1 / 1.35},
    {"ours without a lens; Kannala-Brandt, ESM", "esm_kannala_brandt", "avx512", "4000", "esm/avx512/4000", 1 / 1.35},
    {"ours without a lens; Kannala-Brandt, template", "template_huber_kannala_brandt", "avx512", "4000",
     "template_huber/avx512/4000", 1 / 1.35},
    {"ours without a lens; Kannala-Brandt, cost", "cost_kannala_brandt", "avx512", "4000", "cost/avx512/4000",
     1 / 1.35},
    {"ours without a lens; Kannala-Brandt, 9 parameters", "pose_plane_kannala_brandt", "avx2", "4000",
     "pose_plane/avx2/4000", 1 / 1.35},
    {"ours without a lens; double sphere, 9 parameters", "pose_plane_double_sphere", "avx512", "4000",
     "pose_plane/avx512/4000", 1 / 1.35},
    {"ours without a lens; double sphere, 6 parameters", "pose_double_sphere", "avx512", "4000", "pose/avx512/4000",
     1 / 1.35},
    {"ours without a lens; double sphere, 3 parameters", "plane_double_sphere", "avx512", "4000", "plane/avx512/4000",
     1 / 1.35},
    {"ours without a lens; double sphere, ESM", "esm_double_sphere", "avx512", "4000", "esm/avx512/4000", 1 / 1.35},
    {"ours without a lens; double sphere, template", "template_huber_double_sphere", "avx512", "4000",
     "template_huber/avx512/4000", 1 / 1.35},
    {"ours without a lens; double sphere, cost", "cost_double_sphere", "avx512", "4000", "cost/avx512/4000", 1 / 1.35},
    {"ours without a lens; double sphere, 9 parameters", "pose_plane_double_sphere", "avx2", "4000",
     "pose_plane/avx2/4000", 1 / 1.35},
};

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_COMPARISONS_HPP
