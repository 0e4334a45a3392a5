// Constellation: from one sign's pose to all detections that the signs around it explain, and what that is worth.
#ifndef TEXTSLAM_SIGN_INDEX_CONSTELLATION_HPP
#define TEXTSLAM_SIGN_INDEX_CONSTELLATION_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "sign_index/place_seeds.hpp"
#include "sign_index/sign_pose.hpp"

namespace textslam {

class Constellation {
 public:
  Constellation(const SignIndex& index, const PlaceOptions& options) : index_(index), options_(options) {}

  /// The better of the two places that the seed's quad allows; nothing where the quad does not fit the sign.
  std::optional<FoundPlace> grow(const QueryView& view, const PlaceSeed& seed);

 private:
  struct Near {
    std::uint32_t sign;
    Vec3 centre;
  };
  struct Pair {
    std::size_t query = 0, near = 0;
    double gain = 0;
  };

  void keep_in_view(const QueryView& view, std::uint32_t seed, const SE3d& T_c_w);
  std::optional<Pair> best_pair(const QueryView& view, const SignPose& pose, const std::vector<Pair>& refused) const;
  bool extend(const QueryView& view, SignPose* pose);
  double absent(const QueryView& view, const SignPose& pose) const;
  std::optional<FoundPlace> place(const QueryView& view, const PlaceSeed& seed, const SE3d& T_c_w);

  const SignIndex& index_;
  const PlaceOptions& options_;
  std::vector<Near> near_;
  // Of the place that grows.
  std::vector<SignSighting> sightings_;
  std::vector<SeenSign> seen_;
  std::vector<std::uint8_t> query_taken_;
};

}  // namespace textslam

#endif  // TEXTSLAM_SIGN_INDEX_CONSTELLATION_HPP
