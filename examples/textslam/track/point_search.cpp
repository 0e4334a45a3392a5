#include "textslam/track/point_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "textplane/features/klt.hpp"
#include "textplane/geometry/homography.hpp"
#include "textplane/landmarks/text_noise.hpp"

namespace textslam {
namespace {

// The lens's derivative d m_d / d m.
Eigen::Matrix2d lens_slope(const textplane::LensMap& lens, const Vec3& m) {
  Eigen::Matrix2d D;
  lens.distort({m.x() / m.z(), m.y() / m.z()}, &D);
  return D;
}

// Plane of the point's surface in its host: parallel to the image where no normal is known.
Vec3 surface_in_host(const Vec3& p, const Vec3& normal) {
  constexpr double kLeastFacing = 0.2;  // a cosine; a surface at a greater slant was fitted from other views
  if (normal.isZero(0)) return Vec3(0, 0, 1 / p.z());
  const double height = normal.dot(p);
  return height > kLeastFacing * p.norm() ? Vec3(normal / height) : Vec3(p / p.squaredNorm());
}

bool affine_to_host(const CameraView& camera, const SE3d& T_t_h, const Vec2& host_px, const Vec3& theta,
                    double max_area, Eigen::Matrix2f* A) {
  const Vec3 m = ray_of(camera, host_px);
  const Eigen::Matrix3d H = textplane::plane_homography(theta, T_t_h);
  const Vec3 q = H * m;
  if (!camera.in_domain(q)) return false;
  Eigen::Matrix<double, 2, 3> P;
  P << 1 / q.z(), 0, -q.x() / (q.z() * q.z()), 0, 1 / q.z(), -q.y() / (q.z() * q.z());
  Eigen::Matrix2d forward = P * H.leftCols<2>();
  if (camera.lens) forward = lens_slope(*camera.lens, q) * forward * lens_slope(*camera.lens, m).inverse();
  forward.row(0) *= camera.pinhole.fx;
  forward.row(1) *= camera.pinhole.fy;
  forward.col(0) /= camera.pinhole.fx;
  forward.col(1) /= camera.pinhole.fy;
  const double det = forward(0, 0) * forward(1, 1) - forward(0, 1) * forward(1, 0);
  if (!(std::abs(det) > 1 / max_area) || std::abs(det) > max_area) return false;
  Eigen::Matrix2d inverse;
  inverse << forward(1, 1), -forward(0, 1), -forward(1, 0), forward(0, 0);
  *A = (inverse / det).cast<float>();
  return true;
}

}  // namespace

bool predict_point(const Map& map, const Parameters& parameters, const MapPoint& point, const CameraView& camera,
                   const SE3d& T_c_w, const Vec3& centre, PointPrediction* out) {
  if (!show(camera, T_c_w * point.p_w, &out->px)) return false;
  const double border = parameters.point_patch_radius + 3;
  const Vec2& px = out->px;
  if (!(px.x() >= border && px.y() >= border && px.x() < map.width - border && px.y() < map.height - border))
    return false;

  constexpr double kTie = 1e-3;  // between equal views the older one stays
  double best = parameters.min_view_cosine;
  out->host = nullptr;
  const Vec3 ray = (point.p_w - centre).normalized();
  for (const PointObservation& o : point.observations) {
    const double cosine = ray.dot((point.p_w - map.keyframe(o.keyframe).T_w_c.t).normalized());
    if (cosine <= best + kTie) continue;
    best = cosine;
    out->host = &o;
  }
  if (!out->host) return false;
  const SE3d& T_w_h = map.keyframe(out->host->keyframe).T_w_c;
  const Vec3 in_host = T_w_h.inverse() * point.p_w;
  return in_host.z() > 0 && affine_to_host(map.camera, T_c_w * T_w_h, out->host->px,
                                           surface_in_host(in_host, T_w_h.R.transpose() * point.normal_w),
                                           parameters.point_patch_max_area, &out->A);
}

bool find_point(const Map& map, const Parameters& parameters, const PointPrediction& prediction, const Frame& frame,
                int coarsest, Vec2f* px) {
  const Frame& host_frame = map.keyframe(prediction.host->keyframe).frame;
  const Pyramid& host = *host_frame.image;
  const Vec2f host_px = prediction.host->px.cast<float>();
  // Where the host shows the patch larger than the frame, its next coarser level is the sharpest that does not alias.
  const int shift = std::sqrt(std::abs(prediction.A.determinant())) > parameters.point_patch_coarser ? 1 : 0;
  textplane::KltOptions options;
  textplane::PointPatch patch;
  for (int level = coarsest; level >= 0; --level) {
    const int host_level = std::min(level + shift, host.levels() - 1);
    const float scale = std::ldexp(1.0F, level - host_level);
    const auto status =
        textplane::extract_point_patch(host.level(host_level), textplane::point_to_level(host_px, host_level),
                                       scale * prediction.A, parameters.point_patch_radius, &patch);
    if (!textplane::is_ok(status)) {
      if (level > 0) continue;
      return false;
    }
    const float limit = level > 0 ? parameters.min_coarse_point_zncc : parameters.min_point_zncc;
    const auto contrast = static_cast<double>(patch.contrast());
    options.min_zncc = static_cast<float>(
        zncc_limit(parameters.text, static_cast<double>(limit), level, host_frame, contrast, frame, contrast));
    const auto result =
        textplane::align_point_patch(patch, frame.image->level(level), textplane::point_to_level(*px, level), options);
    if (textplane::is_ok(result.status)) {
      *px = textplane::point_from_level(result.px, level);
    } else if (level == 0) {
      return false;
    }
  }
  return has_ray(map.camera, px->cast<double>());
}

}  // namespace textslam
