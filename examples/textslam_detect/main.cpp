// textslam-detect: runs a text detector alone, writes its quads in the format of `--detector files`, and compares them
// with the truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "cli/command_line.hpp"
#include "cli/detector_options.hpp"
#include "cli/progress.hpp"
#include "io/evaluate_detections.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "plugins/plugins.hpp"

namespace {

using textslam::kInputError;

// A sequence, or an image by itself.
textslam::Sequence read_input(const std::string& path, const textslam::SequenceOptions& options) {
  if (!textslam::is_image_file(path)) return textslam::read_sequence(path, options);
  textslam::Sequence sequence;
  textslam::FrameRef frame;
  frame.path = path;
  frame.stem = std::filesystem::path(path).stem().string();
  sequence.frames.push_back(frame);
  return sequence;
}

int execute(int argc, char** argv) {
  std::vector<std::string> inputs;
  std::string output;
  std::size_t every = 1;
  bool evaluate = false;
  textslam::SequenceOptions input_options;
  input_options.needs_camera = false;
  textslam::DetectorOptions detector;
  detector.name = "classical";
  CLI::App app{"Finds text in images: OUTPUT/<image stem>.txt, x1,y1,x2,y2,x3,y3,x4,y4,text a line (ICDAR)."};
  app.add_option("INPUT", inputs, "Images, folders with sequences or of images, and videos")->required();
  const CLI::Option* const writes = app.add_option("--output", output, "Folder for the detections");
  app.add_flag("--evaluate", evaluate,
               "Compare with the truth, of a rendered sequence or ICDAR's gt_<stem>.txt, at an overlap (IoU) of 0.5");
  app.add_option("--every", every, "Of a sequence: one frame of so many")->check(CLI::PositiveNumber);
  app.add_option("--detections", input_options.detections,
                 "Of --detector files: their folder, if not the sequence's own");
  textslam::add_detector_options(app, detector);
  const auto check = [&] {
    if (writes->empty() && !evaluate) throw CLI::RequiredError("--output or --evaluate");
  };
  if (const auto code = textslam::parse_command_line(app, "textslam-detect", argc, argv, check)) return *code;
  textslam::DetectionCounts counts;
  for (const std::string& input : inputs) {
    const textslam::Sequence sequence = read_input(input, input_options);
    for (const std::string& note : sequence.notes) std::fprintf(stderr, "textslam-detect: warning: %s\n", note.c_str());
    const auto detect = textslam::make_detector(detector, sequence);
    if (!output.empty()) textslam::create_output_folder(output);
    textslam::Progress progress("detecting");
    for (std::size_t i = 0; i < sequence.frames.size(); i += every) {
      textslam::FrameRef frame = sequence.frames[i];
      const textslam::Image<std::uint8_t> image = textslam::load_image(sequence, i);
      if (detect->wants_colour()) frame.colour = textslam::load_colour(sequence, i);
      const std::vector<textslam::Detection> found = detect->detect(frame, image.view());
      if (!output.empty()) textslam::write_detections(output + "/" + frame.stem + ".txt", found);
      if (evaluate) textslam::count_detections(textslam::read_true_texts(sequence, frame), found, &counts);
      progress.show(i + 1, sequence.frames.size(), frame.stem);
    }
  }
  if (evaluate) std::printf("%s\n", textslam::format_counts(counts).c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  textslam::register_plugins();
  try {
    return execute(argc, argv);
  } catch (const textslam::InputError& error) {
    std::fprintf(stderr, "textslam-detect: %s\n", error.what());
    return kInputError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "textslam-detect: %s\n", error.what());
    return 1;
  }
}
