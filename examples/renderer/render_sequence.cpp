#include "renderer/render_sequence.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>

#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "io/text_file.hpp"
#include "io/trajectory.hpp"
#include "renderer/exposure.hpp"
#include "renderer/kinds.hpp"
#include "renderer/spanning.hpp"
#include "renderer/truth.hpp"
#include "renderer/walk.hpp"

namespace textslam {

namespace {

constexpr double kFramesPerSecond = 30.0;
constexpr std::uint64_t kNoiseStream = 7, kDetectorStream = 8, kPlacesStream = 9, kSpanningStream = 10;

std::string stem_of(int frame) {
  char name[16];
  std::snprintf(name, sizeof name, "%06d", frame);
  return name;
}

/// Independent of the locale.
std::string decimals(double value, int n) {
  char text[64];
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, n);
  return std::string(text, result.ptr);
}

CameraModel camera_of(const RenderOptions& options, const Shot& shot) {
  CameraModel camera;
  const double f = shot.focal * options.width;
  const textplane::AnyCamera<double> lens = options.lens.is_pinhole() ? shot.lens : options.lens;
  camera.raw = lens.visit([&](const auto& model) -> textplane::AnyCamera<double> {
    auto parameters = model.parameters();
    parameters.template head<4>() << f, f, 0.5 * (options.width - 1), 0.5 * (options.height - 1);
    return std::decay_t<decltype(model)>::from_parameters(parameters);
  });
  camera.width = options.width;
  camera.height = options.height;
  camera.fps = kFramesPerSecond;
  camera.shutter = {shot.readout, 0.5 * (options.height - 1), options.height};
  camera.knows_readout = true;
  return camera;
}

void check(const RenderOptions& options) {
  const auto refuse = [](const std::string& what) { throw InputError("render options", 0, what); };
  if (options.output.empty()) refuse("no output folder given");
  if (options.walk < 0) refuse("the walk must be 0 or more");
  if (options.frames < 0 || options.frames > 100000) refuse("the number of frames must be 1 to 100000");
  if (options.width < 64 || options.height < 48 || options.width > 4096 || options.height > 4096) {
    refuse("the image size must be 64x48 to 4096x4096");
  }
  const auto demand = [&](const char* what, double value, double low, double high) {
    if (value >= low && value <= high) return;  // NaN is refused
    refuse(std::string(what) + " must be " + shortest(low) + " to " + shortest(high) + ", not " + shortest(value));
  };
  const Conditions& conditions = options.conditions;
  demand("the blur", conditions.blur.value_or(0.0), 0.0, 200.0);
  demand("the gain", conditions.gain.value_or(1.0), 0.0, 100.0);
  demand("the noise", conditions.noise.value_or(0.0), 0.0, 255.0);
  demand("the jitter of detections", options.detector.corner_sigma, 0.0, 1000.0);
  demand("the share of missed detections", options.detector.missed, 0.0, 1.0);
  demand("the number of false detections", options.detector.false_per_frame, 0.0, 100.0);
  demand("the number of spanning detections", options.detector.spanning, 0.0, 20.0);
}

/// Renders and writes single frames; const, so that several threads may share it.
class FrameWriter {
 public:
  FrameWriter(const RenderOptions& options, const CameraModel& camera, const Shot& shot)
      : options_(options),
        walk_(seed_of_walk(options.seed, options.walk)),
        camera_(camera),
        shot_(shot),
        caster_(camera, pixel_grid()),
        places_(spanning_places(shot, camera, options.frames, 1.0 / kFramesPerSecond, options.detector.spanning,
                                hash(options.seed, kPlacesStream))) {}

  /// Writes image, detections and quads; returns the frame's line of truth/frames.txt.
  std::string write(int frame) const {
    const double time = frame / kFramesPerSecond;
    const std::uint64_t number = static_cast<std::uint64_t>(frame);
    Blur blur = blur_of(shot_.scene, camera_, shot_.motion, time, shot_.exposure);
    Image<double> light = expose(shot_.scene, caster_, shot_.motion, time, shot_.exposure, instants_for(blur.max));
    if (const double length = options_.conditions.blur.value_or(0.0); length > 0.0) {
      light = blur_along(light, image_direction(shot_.scene, camera_, shot_.motion, time), length);
      blur = {length, length};
    }
    const SensorState state = shot_.sensor(time);
    const Image<std::uint8_t> picture = develop(light, state, hash(walk_, kNoiseStream, number));
    const std::string name = stem_of(frame);
    save_png(options_.output + "/images/" + name + ".png", picture.view());

    const std::vector<Sign>& signs = shot_.scene.signs();
    const SE3d T_w_c = shot_.motion(time);
    std::vector<SignView> views = views_of_signs(shot_.scene, camera_, T_w_c, time);
    place_in_rows(camera_, shot_.motion, signs, time, &views);
    write_file(options_.output + "/truth/quads/" + name + ".txt", format_truth_quads(views, signs));
    const Random random(hash(walk_, kDetectorStream, number));
    std::vector<Detection> found = detect(views, signs, camera_, options_.detector, random);
    const Random apart(hash(walk_, kSpanningStream, number));
    for (const Detection& d : detect_spanning(places_, shot_.scene, camera_, T_w_c, time, options_.detector, apart))
      found.push_back(d);
    write_detections(options_.output + "/detections/" + name + ".txt", found);
    return decimals(time, 9) + ' ' + decimals(shot_.exposure, 6) + ' ' + decimals(blur.median, 3) + ' ' +
           decimals(blur.max, 3) + ' ' + decimals(state.gain, 4) + ' ' + decimals(state.bias, 2) + '\n';
  }

 private:
  const RenderOptions& options_;
  std::uint64_t walk_;  // seed
  const CameraModel& camera_;
  const Shot& shot_;
  RayCaster caster_;
  std::vector<SpanningPlace> places_;
};

/// Renders all frames on options.threads threads. The first exception of any of them ends all and is thrown here.
std::vector<std::string> write_frames(const FrameWriter& writer, const RenderOptions& options,
                                      const std::function<void(int, int)>& progress) {
  std::vector<std::string> lines(static_cast<std::size_t>(options.frames));
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (int frame = next++; frame < options.frames; frame = next++) {
      try {
        lines[static_cast<std::size_t>(frame)] = writer.write(frame);
        const std::lock_guard<std::mutex> lock(mutex);
        ++done;
        if (progress) progress(done, options.frames);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = options.frames;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < std::clamp(options.threads, 1, 64); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return lines;
}

}  // namespace

void render_sequence(const RenderOptions& asked, const std::function<void(int done, int total)>& progress) {
  check(asked);
  RenderOptions options = asked;
  if (options.frames == 0) options.frames = default_frames(options.kind);
  Shot shot = make_shot(options.kind, options.seed, options.width, options.height, options.walk);
  apply(options.conditions, &shot);
  const CameraModel camera = camera_of(options, shot);
  for (const char* folder : {"/images", "/detections", "/truth/quads"}) create_output_folder(options.output + folder);

  std::vector<StampedPose> poses;
  std::string list = "# timestamp path\n";
  for (int frame = 0; frame < options.frames; ++frame) {
    const double time = frame / kFramesPerSecond;
    poses.push_back({time, shot.motion(time)});
    list += decimals(time, 9) + " images/" + stem_of(frame) + ".png\n";
  }
  write_file(options.output + (shot.calibrated ? "/camera.yaml" : "/true_camera.yaml"), format_camera(camera));
  write_tum(options.output + "/groundtruth.txt", poses);
  write_file(options.output + "/truth/signs.json", format_signs(shot.scene.signs()));

  const FrameWriter writer(options, camera, shot);
  std::string frames = "# timestamp exposure blur_median blur_max gain bias\n";
  for (const std::string& line : write_frames(writer, options, progress)) frames += line;
  write_file(options.output + "/truth/frames.txt", frames);
  // Last: a folder without it is not a sequence, so that an aborted render is not taken for one.
  write_file(options.output + "/images.txt", list);
}

}  // namespace textslam
