#include "textslam/calibrate/self_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "io/interrupt.hpp"
#include "io/text_file.hpp"
#include "textslam/input/make_frame.hpp"
#include "textslam/input/sequence_camera.hpp"
#include "textslam/system/system.hpp"

namespace textslam {
namespace {

// A pass: the frames mapped by points with one camera, and what the map makes of it.
struct Pass {
  MapCalibration found;
  std::size_t frames = 0, tracked = 0;
};

class Calibrator {
 public:
  Calibrator(const Sequence& sequence, const std::vector<std::size_t>& frames, const Parameters& parameters,
             const std::function<void(std::size_t, std::size_t)>& progress)
      : sequence_(sequence), frames_(frames), parameters_(parameters), progress_(progress) {
    parameters_.mode = Mode::points;
    parameters_.real_time = false;
  }

  Pass run(const CameraModel& camera, const CameraModel& guess, const CalibrationPriors& priors, int most) {
    Pass pass;
    const SequenceCamera view(camera);
    const Parameters sized = at_size(parameters_, camera.width, camera.height);
    System system(view.view(), camera.width, camera.height, parameters_, camera.shutter);
    pass.frames = std::min(frames_.size(), static_cast<std::size_t>(most));
    for (std::size_t i = 0; i < pass.frames && interrupted() == 0; ++i) {
      const std::size_t at = frames_[i];
      system.process(make_frame(static_cast<int>(i), sequence_.frames[at].timestamp, load_frame(sequence_, at), sized));
      progress_(i + 1, pass.frames);
    }
    system.finish();
    pass.tracked = system.live_frames();
    pass.found = calibrate(system.map(), camera, guess, sized, priors);
    // So little passes for a shutter that takes all rows at once.
    constexpr double kLeastReadout = 1e-3;  // s
    double& readout = pass.found.camera.shutter.readout;
    if (parameters_.estimate_readout && std::abs(readout) < kLeastReadout) readout = 0;
    return pass;
  }

 private:
  const Sequence& sequence_;
  const std::vector<std::size_t>& frames_;
  Parameters parameters_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
};

// A camera to begin with.
struct Guess {
  CameraModel camera;
  std::string origin;
  double focal_sigma;  // as a share
};

std::vector<Guess> guesses_of(const Sequence& sequence, const CalibrationOptions& options) {
  const CameraModel& camera = sequence.camera;
  const auto view = [](double degrees) {
    return "a field of view of " + shortest(std::round(10 * degrees) / 10) + " degrees";
  };
  switch (sequence.camera_origin) {
    case CameraOrigin::fov: return {{camera, view(sequence.approximate_fov) + ", given", options.given_focal}};
    case CameraOrigin::exif: return {{camera, view(sequence.approximate_fov) + ", by EXIF", options.given_focal}};
    case CameraOrigin::file: return {{camera, kCameraFile, options.given_focal}};
    default: break;
  }
  std::vector<Guess> out;
  for (const double degrees : options.guesses)
    out.push_back(
        {camera_from_fov(degrees, camera.width, camera.height), view(degrees) + ", assumed", options.assumed_focal});
  return out;
}

}  // namespace

void take_over(const MapCalibration& found, std::size_t frames, SelfCalibration* out) {
  out->camera = found.camera;
  out->sigma = found.sigma;
  out->frames = frames;
  out->observations = found.observations;
  out->reprojection_px = found.reprojection_px;
  out->determined = true;
}

SelfCalibration self_calibrate(const Sequence& sequence, const std::vector<std::size_t>& frames,
                               const Parameters& parameters, const CalibrationOptions& options,
                               const std::function<void(std::size_t, std::size_t)>& progress) {
  Calibrator calibrator(sequence, frames, parameters, progress);
  const std::vector<Guess> guesses = guesses_of(sequence, options);
  SelfCalibration out;
  out.camera = out.start = guesses.front().camera;
  out.origin = guesses.front().origin;
  CalibrationPriors priors = options.priors;
  priors.focal = guesses.front().focal_sigma;
  const auto useful = [&](const Pass& pass) {
    return pass.found.determined &&
           static_cast<double>(pass.tracked) >= options.least_tracked * static_cast<double>(pass.frames);
  };
  // The guess whose map fits best what the frames show.
  for (const Guess& guess : guesses) {
    const CameraModel start = with_lens(guess.camera);
    const Pass pass = calibrator.run(start, start, priors, options.probe_frames);
    if (!useful(pass) || (out.determined && pass.found.reprojection_px >= out.reprojection_px)) continue;
    take_over(pass.found, pass.frames, &out);
    out.start = guess.camera;
    out.origin = guess.origin;
  }
  const CameraModel start = with_lens(out.start);
  for (int i = 0; i < options.passes && interrupted() == 0; ++i) {
    const CameraModel camera = out.determined ? out.camera : start;
    const Pass pass = calibrator.run(camera, start, priors, options.most_frames);
    if (!useful(pass)) break;
    ++out.passes;
    take_over(pass.found, pass.frames, &out);
    const double focal_moved = std::abs(camera.pinhole().fx - out.camera.pinhole().fx);
    if (camera_distance(camera, out.camera) < options.converged_px ||
        focal_moved < options.converged_sigma * out.sigma[0])
      break;
  }
  return out;
}

SelfCalibration take_estimated_camera(Sequence* sequence, const std::vector<std::size_t>& frames, Parameters parameters,
                                      bool knows_shutter,
                                      const std::function<void(std::size_t, std::size_t)>& progress) {
  // What the shutter of a fast camera does passes for a lens: where neither is known they are found together. The run
  // does not take the readout over: a truth that knows nothing of rows would call it worse (docs/cameras.md).
  parameters.estimate_readout = sequence->camera_origin != CameraOrigin::file && !knows_shutter;
  SelfCalibration found = self_calibrate(*sequence, frames, parameters, CalibrationOptions(), progress);
  if (!found.determined) return found;
  found.camera.fps = sequence->camera.fps;
  found.camera.shutter = sequence->camera.shutter;
  sequence->camera = found.camera;
  sequence->approximate_fov = 0;
  return found;
}

}  // namespace textslam
