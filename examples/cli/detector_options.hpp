// The options of a detector on the command line, the same for every program that has one. Needs CLI11.
#ifndef TEXTSLAM_CLI_DETECTOR_OPTIONS_HPP
#define TEXTSLAM_CLI_DETECTOR_OPTIONS_HPP

#include <CLI/CLI.hpp>

#include "textslam/detect/text_detector.hpp"

namespace textslam {

/// The plug-ins are registered.
inline void add_detector_options(CLI::App& app, DetectorOptions& options) {
  std::vector<std::string> words = {"auto", "none"};
  for (const std::string& name : reader_names()) words.push_back(name);
  app.add_option("--detector", options.name,
                 "files: the sequence's detections; classical: built in; dnn, tesseract: plug-ins")
      ->check(CLI::IsMember(detector_names()))
      ->capture_default_str();
  app.add_option(
      "--model", options.model,
      "Network of --detector dnn, DB or EAST, any file that OpenCV loads; by default scripts/get-detector's");
  app.add_option("--words", options.words,
                 "Who reads what a detector left unread, and the texts of the map; auto: after dnn the recogniser dnn, "
                 "where its model is, else tesseract; after tesseract that")
      ->check(CLI::IsMember(words))
      ->capture_default_str();
  app.add_option("--words-model", options.words_model,
                 "Network of --words dnn, a recogniser with its list of letters beside it (.txt); by default "
                 "scripts/get-detector's --reader");
}

}  // namespace textslam

#endif  // TEXTSLAM_CLI_DETECTOR_OPTIONS_HPP
