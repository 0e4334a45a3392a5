#include "textslam/text/text_refiner.hpp"

#include "textplane/landmarks/text_life.hpp"
#include "textplane/landmarks/text_refiner.hpp"
#include "textslam/map/text_views.hpp"

namespace textslam {

void refine_texts(Map& map, const Parameters& parameters) {
  textplane::TextRefiner refiner(parameters.text, textplane::KeyframeLookup(map));
  const SurfacePoints kept{map, parameters.point_sigma};
  const textplane::PointLookup points(kept);
  for (TextObject& text : map.texts)
    if (text.state == TextState::mapped &&
        !(is_detected(text, parameters.text) && refiner.refine(text, &points) == textplane::Refinement::refined))
      drop(text);
}

}  // namespace textslam
