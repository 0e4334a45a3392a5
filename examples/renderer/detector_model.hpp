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
};

/// A sign that a detector can find: at least 60 % visible, at least 9 px high, not seen at more than 72 degrees.
bool is_legible(const SignView& view);

/// The detections of one frame, corners clamped to the image. Signs that leave the image or are partly hidden stay
/// unread.
std::vector<Detection> detect(const std::vector<SignView>& views, const std::vector<Sign>& signs,
                              const CameraModel& camera, const DetectorErrors& errors, Random random);

}  // namespace textslam

#endif  // TEXTSLAM_RENDERER_DETECTOR_MODEL_HPP
