// Detector model: what a text detector reports about a frame, with misses, errors and false hits.
#ifndef TEXTSLAM_RENDERER_DETECTOR_MODEL_HPP
#define TEXTSLAM_RENDERER_DETECTOR_MODEL_HPP

#include <vector>

#include "io/detections.hpp"
#include "renderer/random.hpp"
#include "renderer/truth.hpp"

namespace textslam {

/// Errors of the detector and reader.
struct DetectorErrors {
  double corner_sigma = 1.5;     ///< px, each coordinate of each corner, normal and independent
  double missed = 0.15;          ///< share of the legible signs
  double false_per_frame = 0.1;  ///< mean number of quads without text (only where the scene has signs)
  double words_right = 0.9;      ///< share of the words; half of the others are unread, half have a wrong letter
  double spanning = 0.0;         ///< mean number in view of places that it takes for texts (spanning.hpp)
};

/// A sign that a detector can find: at least 60 % visible, at least 9 px high, not seen at more than 72 degrees.
bool is_legible(const SignView& view);

/// The detections of one frame, corners clamped to the image. Signs that leave the image or are partly hidden stay
/// unread.
std::vector<Detection> detect(const std::vector<SignView>& views, const std::vector<Sign>& signs,
                              const CameraModel& camera, const DetectorErrors& errors, Random random);

// Its parts.
/// A box of a word's shape somewhere in the image.
Quad<double> stray_quad(const CameraModel& camera, Random& random);
/// Do their upright bounding boxes meet?
bool boxes_meet(const Quad<double>& a, const Quad<double>& b);
/// Each coordinate with an error of its own, normal.
Quad<double> jittered(const Quad<double>& quad, double sigma, Random& random);
/// Clamps the corners to the image.
void keep_inside(Quad<double>& quad, const CameraModel& camera);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_DETECTOR_MODEL_HPP
