// textslam: SLAM with planar text on a sequence of images, or on one that it renders itself.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/detect/detector_options.hpp"
#include "textslam/input/sequence_options.hpp"
#include "textslam/report/progress.hpp"
#include "textslam/run.hpp"

namespace {

constexpr int kInputError = 2;
constexpr int kSignal = 128;  // plus the signal's number, as shells have it

// What a rendered sequence has in place of what its kind says; the renderer checks the ranges.
void add_conditions(CLI::App& app, textslam::RenderOptions& render) {
  const auto add = [&](const char* name, auto& value, const char* what) {
    return app.add_option(name, value, what)
        ->group("Conditions of --render, each in place of the kind's")
        ->needs("--render");
  };
  add("--blur", render.conditions.blur, "Motion blur of every frame, px");
  add("--gain", render.conditions.gain, "Gain of the sensor, constant in time");
  add("--noise", render.conditions.noise, "Standard deviation of the noise, grey levels");
  add("--jitter", render.detector.corner_sigma, "Of the corners of detections, px")->capture_default_str();
  add("--missed", render.detector.missed, "Share of the signs that the detector misses, 0 to 1")->capture_default_str();
  add("--false", render.detector.false_per_frame, "False detections a frame, in the mean")->capture_default_str();
}

int execute(int argc, char** argv) {
  textslam::RunOptions options;
  textslam::RenderOptions render;
  render.kind.clear();
  std::string mode = "text";
  bool only_render = false;

  CLI::App app{"SLAM with points and planar text: a sequence of images becomes a trajectory and a 3D text map."};
  app.add_option("SEQUENCE", options.sequence, textslam::kSequenceHelp);
  app.add_option("--render", render.kind, "Render a sequence of this kind into OUTPUT/sequence and run on it")
      ->check(CLI::IsMember(textslam::render_kinds()));
  app.add_option("--output", options.output, "Folder for the results")->required();
  app.add_option("--mode", mode,
                 "text: points and text; points: points alone; loose: as points, text planes fitted to the points")
      ->check(CLI::IsMember({"text", "points", "loose"}))
      ->capture_default_str();
  textslam::add_sequence_options(app, options.input);
  textslam::add_detector_options(app, options.detector);
  app.add_flag("--real-time", options.parameters.real_time,
               "Frames come at the times of their stamps; local adjustment and the detector have threads of their own; "
               "without it, all is done in step and the same input gives the same bytes");
  app.add_flag("!--no-loop-closure", options.parameters.loop_closure,
               "Leave drift as it is where the camera comes back to a place");
  app.add_option("--first", options.first, "Index of the first frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--last", options.last, "Index of the last frame")->check(CLI::NonNegativeNumber);
  app.add_option("--seed", render.seed, "Of the rendered sequence; the system itself draws nothing at random")
      ->capture_default_str();
  app.add_option("--frames", render.frames, "Number of rendered frames; by default as many as the kind goes for")
      ->check(CLI::PositiveNumber);
  add_conditions(app, render);
  bool no_report = false;
  app.add_flag("--no-report", no_report, "Leave out report.html");
  app.add_flag("--json-lines", options.json_lines,
               "A JSON object a frame on standard output, as it is processed, then one with the metrics; no table");
  app.add_flag("--render-only", only_render, "Render without running on it");
  try {
    app.parse(argc, argv);
    if (options.sequence.empty() == render.kind.empty())
      throw CLI::ValidationError("give either SEQUENCE or --render KIND");
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "textslam: %s (see textslam --help)\n", error.what());
    return kInputError;
  }

  options.parameters.mode = mode == "points"  ? textslam::Mode::points
                            : mode == "loose" ? textslam::Mode::loose
                                              : textslam::Mode::text;
  if (!render.kind.empty()) {
    options.sequence = render.output = options.output + "/sequence";
    textslam::Progress progress("rendering");
    textslam::render_sequence(render, [&](int done, int total) {
      progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total), render.kind);
    });
    if (only_render) return 0;
  }
  options.report = !no_report;
  options.command.assign(argv, argv + argc);
  const textslam::RunResult result = textslam::run(options);
  if (!options.json_lines)
    std::printf("%s  %-22s %s\n", textslam::describe(result.summary).table.c_str(), "output",
                (result.report.empty() ? options.output : result.report).c_str());
  for (const std::string& warning : textslam::warnings(result.summary))
    std::fprintf(stderr, "textslam: warning: %s\n", warning.c_str());
  if (result.error.empty()) return 0;
  std::fprintf(stderr, "textslam: %s\n", result.error.c_str());
  return result.interrupted ? kSignal + textslam::interrupted() : kInputError;
}

}  // namespace

int main(int argc, char** argv) {
  textslam::note_interrupts();
  try {
    return execute(argc, argv);
  } catch (const textslam::InputError& error) {
    std::fprintf(stderr, "textslam: %s\n", error.what());
    return kInputError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "textslam: %s\n", error.what());
    return 1;
  }
}
