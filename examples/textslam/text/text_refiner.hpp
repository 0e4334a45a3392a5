// TextRefiner: the final planes of the texts, once the poses of the key frames are known.
//
// Each text is compared between its views, from several hosts, with all its pixels, each pair at the same blur
// (textplane/photometry/blur.hpp). Each host samples narrow strokes differently, so the hosts' planes are averaged;
// their scatter, and the disagreement of the views (jackknife.hpp), go into the covariance. Last, the map points of the
// surface count, if the text lies on it (text_surface.hpp). What is bent (text_planarity.hpp), uncertain, or too seldom
// detected is no text.
#ifndef TEXTSLAM_TEXT_TEXT_REFINER_HPP
#define TEXTSLAM_TEXT_TEXT_REFINER_HPP

#include <vector>

#include "textplane/photometry/blur.hpp"
#include "textplane/solver/plane.hpp"
#include "textslam/map/map.hpp"
#include "textslam/text/text_planarity.hpp"

namespace textslam {

class TextRefiner {
 public:
  TextRefiner(Map& map, const Parameters& parameters) : map_(map), parameters_(parameters) {}

  /// Refines every mapped text, and drops those that are not planar, whose normal stays uncertain, that the detector
  /// saw too seldom, or of which no two whole views agree: their planes rest on parts, or on map points alone.
  void refine();

 private:
  struct View {
    int keyframe;
    SE3d T_c_w;
    Quad<double> quad;
    double area;
  };
  struct Estimate {
    Vec3 theta;  // in the text's host
    Eigen::Matrix3d covariance;
    double zncc;
    Bend bend;
  };

  std::vector<View> views_of(const TextObject& text) const;
  bool estimate(const TextObject& text, const View& host, const std::vector<View>& views, Estimate* out);
  bool add_target(const textplane::TextPatch& patch, const Vec3& theta, const View& host, const View& view);
  bool drop_dissimilar(const Vec3& theta);
  Eigen::Matrix3d disagreement(const Vec3& theta);
  bool is_bent(const std::vector<Estimate>& estimates) const;
  void refine(TextObject& text);

  Map& map_;
  const Parameters& parameters_;
  textplane::BlurFilter filter_;
  textplane::PlaneWorkspace workspace_;
  textplane::PhotometricWorkspace photometric_;
  std::vector<textplane::PlaneTarget> targets_;
  std::vector<textplane::TextPatch> patches_;             // as each target's blur shows the host
  std::vector<textplane::Image<std::uint8_t>> filtered_;  // the targets, where the text is
};

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_REFINER_HPP
