// Truth: where the signs' texts stand in the world and in each frame, written for those who measure.
#ifndef TEXTSLAM_RENDERER_TRUTH_HPP
#define TEXTSLAM_RENDERER_TRUTH_HPP

#include <string>
#include <vector>

#include "io/sequence.hpp"
#include "renderer/scene.hpp"

namespace textslam {

/// A sign in one frame.
struct SignView {
  int sign = -1;         ///< its id
  Quad<double> quad;     ///< raw px, also where it leaves the image; clockwise from the text's top left
  double visible = 0.0;  ///< share of the text's area that lies in the image and that nothing hides
  double cosine = 0.0;   ///< of the angle between the normal and the view to the centre
};

/// Whether the camera sees the place: inside the image, and the first thing on its ray at that time. T_c_w is the
/// inverse of T_w_c.
bool sees(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c, const SE3d& T_c_w, const Vector3<double>& p,
          double time);

/// The signs that face the camera at T_w_c, stand in front of it with all corners, and of which something is visible at
/// that time.
std::vector<SignView> views_of_signs(const Scene& scene, const CameraModel& camera, const SE3d& T_w_c,
                                     double time = 0.0);

/// Moves the quads to where the rows of a rolling shutter show them: each corner at the pose of its own row's time.
/// `time` is the frame's. A corner that no row shows stays where the frame's pose has it.
void place_in_rows(const CameraModel& camera, const Motion& motion, const std::vector<Sign>& signs, double time,
                   std::vector<SignView>* views);

/// truth/quads/<stem>.txt: `x1,y1,x2,y2,x3,y3,x4,y4,text,sign,visible` a line; the numbers survive the round trip.
std::string format_truth_quads(const std::vector<SignView>& views, const std::vector<Sign>& signs);

/// truth/signs.json: {"signs":[{"id":0,"text":"EXIT","corners":[[x,y,z],... 4],"normal":[x,y,z],"radius":0},...]};
/// world, metres. A text with a radius is written on an upright cylinder: it is not planar. A sign that moves is left
/// out: no one place is right.
std::string format_signs(const std::vector<Sign>& signs);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_TRUTH_HPP
