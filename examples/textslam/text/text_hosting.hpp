// A better host for a mapped text: a new key frame that shows it whole, much larger than its host does, and as sharp.
//
// A sign is first detected from afar, often aslant, so its first host is its poorest view. The plane and its covariance
// move to the better view and are refined there; the plane gives the quad in the new image; the old host becomes a
// view. Each change needs a view that is larger by a pyramid level, so changes are few.
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
