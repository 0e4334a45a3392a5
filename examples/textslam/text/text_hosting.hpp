// A better host for a mapped text: a new key frame that shows it whole, much larger than its host does, and as sharp.
//
// A sign is first detected from afar, often aslant: the poorest view of all is then compared with every later image. So
// the plane and its covariance move to the better view and are refined there; the quad is where the plane puts it in
// the new image; the old host becomes a view. Each change asks for a view larger by a pyramid level, so there are few.
#ifndef TEXTSLAM_TEXT_TEXT_HOSTING_HPP
#define TEXTSLAM_TEXT_TEXT_HOSTING_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Makes key frame `id`, one of the text's views, its host. False, and the text as it was, where it shows the text less
/// than rehost_area times as large, more slanted by rehost_slant, or not whole; or where the other views agree with its
/// patch clearly less (rehost_max_dissimilarity), as with a blurred one.
bool rehost(const Map& map, const Parameters& parameters, int id, TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_HOSTING_HPP
