#include "textslam_map/find_image.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "textplane/geometry/quad.hpp"
#include "textplane/landmarks/words.hpp"
#include "textslam/common/report_json.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/map/text_views.hpp"
#include "textslam/report/localisation.hpp"

namespace textslam {
namespace {

// Signs are seen from farther than their hosts, which are the key frames that show them large.
constexpr double kReachOfHosts = 4;

ImageAnswer answer_of(const Relocalisation& found) {
  ImageAnswer answer;
  answer.by = found.by;
  answer.T_w_c = found.T_c_w.inverse();
  answer.position_sigma = found.position_sigma;
  answer.texts = found.texts;
  answer.points = found.inliers;
  return answer;
}

}  // namespace

ImageFinder::ImageFinder(const LoadedMap& map)
    : map_(map), parameters_(at_size(Parameters{}, map.map.width, map.map.height)) {
  // A lost frame leaves some key frames to the next one; a single image has no next one.
  parameters_.place_compared = std::max(parameters_.place_compared, static_cast<int>(map.map.keyframes.size()) + 1);
  std::vector<MappedSign> signs;
  double reach = 0;
  for (const TextObject& text : map.map.texts) {
    const std::string word = textplane::consensus(text.votes);
    if (text.state != TextState::mapped || !textplane::is_read(word)) continue;
    MappedSign sign;
    sign.id = text.id;
    sign.word = word;
    sign.corners = world_corners(map.map, text);
    reach = std::max(reach, (sign.corners[0] - map.map.keyframe(text.host).T_w_c.t).norm());
    signs.push_back(std::move(sign));
  }
  SignIndexOptions options;
  options.reach = kReachOfHosts * reach;
  if (!signs.empty() && textplane::is_ok(SignIndex::build(signs, options, &index_))) search_.emplace(index_);
}

ImageAnswer ImageFinder::find(Image<std::uint8_t> image, std::vector<Detection> detections) {
  Frame frame = make_frame(0, 0, std::move(image), parameters_);
  frame.detections = std::move(detections);
  // A pose from a few corners may end where some points agree by chance, so that the first that holds is not enough.
  Relocalisation best = relocalise(map_.map, parameters_, frame);
  std::vector<FoundPlace> places;
  if (search_) places = search_->find(frame.detections, map_.record.camera).places;
  for (const FoundPlace& place : places) {
    Relocalisation found = recognise_from(map_.map, parameters_, frame, place.T_c_w);
    if (!found.ok || (best.ok && found.shown() <= best.shown())) continue;
    best = std::move(found);
    best.by = FoundBy::texts;
  }
  if (!best.ok) return {};
  ImageAnswer answer = answer_of(best);
  name_place(places, frame.detections, &answer);
  return answer;
}

void ImageFinder::name_place(const std::vector<FoundPlace>& places, const std::vector<Detection>& detections,
                             ImageAnswer* answer) const {
  const SE3d T_c_w = answer->T_w_c.inverse();
  for (const FoundPlace& place : places) {
    std::vector<std::string> words;
    for (const SignSighting& sighting : place.sightings) {
      const TextObject& sign = map_.map.text(static_cast<int>(index_.id(sighting.sign)));
      Quad<double> quad;
      if (!project_text(map_.map, sign, T_c_w, &quad)) break;
      const Quad<double>& seen = detections[static_cast<std::size_t>(sighting.detection)].quad;
      if (!textplane::contains(quad, textplane::centroid(seen))) break;
      words.push_back(textplane::consensus(sign.votes));
    }
    if (words.size() != place.sightings.size()) continue;
    answer->probability = place.probability;
    answer->words = std::move(words);
    return;
  }
}

std::string answer_text(const ImageAnswer& answer) {
  if (answer.by == FoundBy::nothing) return answer.image + ": not found\n";
  char numbers[192];
  std::string text = answer.image + ": found by " + to_string(answer.by);
  for (std::size_t i = 0; i < answer.words.size(); ++i) text += (i == 0 ? " " : ", ") + answer.words[i];
  if (answer.probability) {
    std::snprintf(numbers, sizeof numbers, ", probability %.6f", *answer.probability);
    text += numbers;
  }
  const Vec3 &t = answer.T_w_c.t, forward = answer.T_w_c.R.col(2);
  std::snprintf(numbers, sizeof numbers, "\n  camera  %.4f %.4f %.4f, to %.2g of the depth\n  looks   %.4f %.4f %.4f\n",
                t.x(), t.y(), t.z(), answer.position_sigma, forward.x(), forward.y(), forward.z());
  text += numbers;
  std::snprintf(numbers, sizeof numbers, "  shows   %d texts, %d points of the map\n", answer.texts, answer.points);
  return text + numbers;
}

std::string answers_json(const std::vector<ImageAnswer>& answers) {
  Json list = Json::array();
  for (const ImageAnswer& answer : answers) {
    Json one{{"image", answer.image}, {"found_by", to_string(answer.by)}};
    if (answer.by != FoundBy::nothing) {
      one["T_w_c"] = short_pose(answer.T_w_c);
      one["position_sigma"] = short_number(answer.position_sigma);
      one["texts"] = answer.texts;
      one["points"] = answer.points;
      one["probability"] = answer.probability ? Json(*answer.probability) : Json();
      one["words"] = answer.words;
    }
    list.push_back(std::move(one));
  }
  return Json{{"images", list}}.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace textslam
