// A better host for a mapped text: a new key frame that shows it whole, much larger than its host does, and as sharp.
//
// A sign is first detected from afar, often aslant. Its patch then holds few pixels of it, and what the tracker and the
// adjustment compare with every later image is the poorest view of all. A key frame that shows it better takes the
// host's place: the plane and its covariance are carried over and refined there, the quad is where the plane puts it in
// the new image, so that the object stays the one it was, and the old host becomes one of its targets. Each change asks
// for a view larger by a pyramid level, so there are few of them in a text's life, and the views from afar are compared
// with the new patch on its next level, at one scale.
#ifndef TEXTSLAM_TEXT_TEXT_HOSTING_HPP
#define TEXTSLAM_TEXT_TEXT_HOSTING_HPP

#include "textslam/map/map.hpp"

namespace textslam {

/// Makes key frame `id`, one of the text's targets, its host where that shows more of it. False, and the text as it
/// was, where the text is not mapped, the key frame is no target of it or was culled, does not show all of it inside
/// the border, shows it less than rehost_area times as large or more slanted than the host by rehost_slant, or where
/// the images agree with the patch of this key frame clearly less than with that of the host, as they do with one that
/// is blurred.
bool rehost(const Map& map, const Parameters& parameters, int id, TextObject& text);

}  // namespace textslam

#endif  // TEXTSLAM_TEXT_TEXT_HOSTING_HPP
