// textslam: SLAM with planar text on a sequence of images, or on one that it renders itself.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "cli/command_line.hpp"
#include "cli/detector_options.hpp"
#include "cli/progress.hpp"
#include "cli/sequence_options.hpp"
#include "io/input_error.hpp"
#include "io/interrupt.hpp"
#include "plugins/plugins.hpp"
#include "renderer/render_sequence.hpp"
#include "textslam/run.hpp"

namespace {

using textslam::kInputError;
constexpr int kNoMap = 3;
constexpr int kSignal = 128;  // plus the signal's number, as shells have it

struct Command {
  textslam::RunOptions run;
  textslam::RenderOptions render;  // without a kind: nothing is rendered
  bool render_only = false;
};

void add_run_options(CLI::App& app, textslam::RunOptions& run) {
  using textslam::Mode;
  app.add_option("SEQUENCE", run.sequence, textslam::kSequenceHelp);
  app.add_option("--output", run.output, "Folder for the results")->required();
  const std::map<std::string, Mode> modes = {{"text", Mode::text}, {"points", Mode::points}, {"loose", Mode::loose}};
  app.add_option_function<std::string>(
         "--mode", [&run, modes](const std::string& name) { run.parameters.mode = modes.at(name); },
         "text: points and text; points: points alone; loose: as points, text planes fitted to the points")
      ->check(CLI::IsMember({"text", "points", "loose"}))
      ->default_str("text");
  textslam::add_sequence_options(app, run.input);
  app.add_flag_callback(
      "--calibrate", [&run] { run.calibrate = textslam::Calibrate::always; },
      "Estimate the camera from the images first, beginning with the one given; so it is by itself where there is no "
      "camera file");
  app.add_flag_callback(
         "--no-calibrate", [&run] { run.calibrate = textslam::Calibrate::never; },
         "Take the camera as it is given, by --fov too; else a camera file that the map shows to be off is mended, and "
         "the frames are mapped again")
      ->excludes("--calibrate");
  textslam::add_detector_options(app, run.detector);
  app.add_option_function<std::string>(
         "--readout",
         [&run](const std::string& text) {
           run.parameters.estimate_readout = text == "auto";
           run.readout = run.parameters.estimate_readout ? 0 : std::stod(text);
         },
         "Of a rolling shutter, from the first row to the last, s, in place of what the camera file says; 0: all rows "
         "at once; auto: estimated by the turns of the camera and with the map. Where nobody says it, auto if "
         "fast turns tell one that counts")
      ->check(CLI::IsMember({"auto"}) | CLI::Range(-textslam::kLongestReadout, textslam::kLongestReadout));
  app.add_flag("--real-time", run.parameters.real_time,
               "Frames come at their time stamps; the adjustments and the detector run in threads of their own. "
               "Without it each step waits for the one before, and the same input gives the same bytes");
  app.add_flag("!--no-loop-closure", run.parameters.loop_closure,
               "Do not correct the drift where the camera comes back to a place");
  app.add_option("--first", run.first, "Index of the first frame")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--last", run.last, "Index of the last frame")->check(CLI::NonNegativeNumber);
  app.add_option("--every", run.every, "Use one frame of so many")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_flag("--skip-broken", run.skip_broken,
               "Pass over frames that cannot be read, and say how many they are; without it the first ends the run");
  app.add_flag("!--no-report", run.report, "Leave out report.html");
  app.add_flag("--json-lines", run.json_lines,
               "Print a JSON object for each frame as it is processed, then one with the metrics, and no table");
}

void add_map_options(CLI::App& app, textslam::RunOptions& run) {
  CLI::Option* save = app.add_option(
      "--save-map", run.save_map, "Save the map into this file, for later sessions; a map that is there is replaced");
  CLI::Option* map = app.add_option("--map", run.map,
                                    "Go on in the map of this file: the frames are found in it, and what is new is "
                                    "added. It is saved there, or where --save-map says");
  app.add_flag("--localise", run.localise, "Only find the frames in the map of --map, which stays as it is")
      ->needs(map)
      ->excludes(save);
  app.add_option_function<std::vector<std::string>>(
      "--scale",
      [&run](const std::vector<std::string>& texts) {
        for (const std::string& text : texts)
          if (!textslam::parse_known_length(text, &run.lengths.emplace_back()))
            throw CLI::ValidationError(
                "--scale", "should be WORD=WIDTH or WORD..WORD=DISTANCE in metres, or with :SIGMA, not '" + text + "'");
      },
      "WORD=WIDTH[:SIGMA], in metres: the word is written so wide on its sign. WORD..WORD=DISTANCE[:SIGMA]: the "
      "centres "
      "of two signs are so far apart. Makes the map metric; may be given several times");
}

// The renderer checks the ranges.
void add_render_options(CLI::App& app, Command& command) {
  textslam::RenderOptions& render = command.render;
  app.add_option("--render", render.kind, "Render a sequence of this kind into OUTPUT/sequence and run on it")
      ->check(CLI::IsMember(textslam::render_kinds()));
  app.add_option("--seed", render.seed, "Seed of the rendered sequence; the system itself draws nothing at random")
      ->capture_default_str();
  app.add_option("--walk", render.walk,
                 "Another visit to the same scene: another path, light and errors of the detector; 0: the kind's own")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--frames", render.frames, "Number of rendered frames; by default what the kind needs")
      ->check(CLI::PositiveNumber);
  app.add_flag("--render-only", command.render_only, "Render, and do not run");
  const auto add = [&](const char* name, auto& value, const char* what) {
    return app.add_option(name, value, what)
        ->group("Conditions of --render, each in place of the kind's")
        ->needs("--render");
  };
  add("--blur", render.conditions.blur, "Motion blur of every frame, px");
  add("--gain", render.conditions.gain, "Gain of the sensor, constant in time");
  add("--noise", render.conditions.noise, "Standard deviation of the noise, grey levels");
  add("--jitter", render.detector.corner_sigma, "Standard deviation of detected corners, px")->capture_default_str();
  add("--missed", render.detector.missed, "Share of the signs that the detector misses, 0 to 1")->capture_default_str();
  add("--false", render.detector.false_per_frame, "Mean number of false detections a frame")->capture_default_str();
  add("--spanning", render.detector.spanning, "Mean number of places in view that span two planes and pass for texts")
      ->capture_default_str();
}

// Where no terminal shows how far it is, every quarter has a line, unless a program reads them.
void render(const textslam::RenderOptions& options, bool quiet) {
  textslam::Progress progress("rendering");
  textslam::render_sequence(options, [&](int done, int total) {
    progress.show(static_cast<std::size_t>(done), static_cast<std::size_t>(total), options.kind);
    if (quiet || progress.on_terminal() || 4 * done / total == 4 * (done - 1) / total) return;
    std::printf("rendering %s: %d of %d frames\n", options.kind.c_str(), done, total);
    std::fflush(stdout);
  });
}

// Runs and prints; returns the exit code.
int run_and_print(const textslam::RunOptions& options) {
  const textslam::RunResult result = textslam::run(options);
  if (!options.json_lines)
    std::printf("%s  %-22s %s\n", textslam::describe(result.summary).table.c_str(), "output",
                (result.report.empty() ? options.output : result.report).c_str());
  for (const std::string& warning : textslam::warnings(result.summary))
    std::fprintf(stderr, "textslam: warning: %s\n", warning.c_str());
  if (result.error.empty() && !result.unmapped.empty()) {
    std::fprintf(stderr, "textslam: %s\n", result.unmapped.c_str());
    return kNoMap;
  }
  if (result.error.empty() && result.summary.tracked > 0) return 0;
  if (result.error.empty()) {
    std::fprintf(
        stderr,
        "textslam: none of the %zu frames could be tracked, so there is no map: the images show too little, or "
        "move too little\n",
        result.summary.frames);
    return kNoMap;
  }
  std::fprintf(stderr, "textslam: %s\n", result.error.c_str());
  return result.interrupted ? kSignal + textslam::interrupted() : kInputError;
}

int execute(int argc, char** argv) {
  Command command;
  textslam::RunOptions& options = command.run;
  command.render.kind.clear();
  options.command.assign(argv, argv + argc);
  CLI::App app{"SLAM with points and planar text: a sequence of images becomes a trajectory and a 3D text map."};
  add_run_options(app, options);
  add_map_options(app, options);
  add_render_options(app, command);
  const auto check = [&] {
    if (options.sequence.empty() == command.render.kind.empty())
      throw CLI::ValidationError("give either SEQUENCE or --render KIND");
  };
  if (const auto code = textslam::parse_command_line(app, "textslam", argc, argv, check)) return *code;
  if (!command.render.kind.empty()) {
    options.sequence = command.render.output = options.output + "/sequence";
    render(command.render, options.json_lines);
    if (command.render_only) return 0;
  }
  return run_and_print(options);
}

}  // namespace

int main(int argc, char** argv) {
  textslam::note_interrupts();
  textslam::register_plugins();
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
