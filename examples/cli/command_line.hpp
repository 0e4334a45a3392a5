// What every program does with its command line. Needs CLI11.
#ifndef TEXTSLAM_CLI_COMMAND_LINE_HPP
#define TEXTSLAM_CLI_COMMAND_LINE_HPP

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "io/text_file.hpp"
#include "textplane/config.hpp"

namespace textslam {

constexpr int kInputError = 2;

/// A number of [low, high]. CLI::Range and CLI::PositiveNumber let NaN pass.
inline CLI::Validator within(double low, double high) {
  const std::string range = shortest(low) + " to " + shortest(high);
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0;
        const bool fits = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return fits ? std::string() : "should be " + range + ", not '" + text + "'";
      },
      range);
}

/// Parses the command line of the program `name`, then calls `check`, which may throw CLI::ParseError. Empty: go on.
/// Else the exit code: 0 after --help and --version, kInputError after one line that says what is wrong.
inline std::optional<int> parse_command_line(
    CLI::App& app, const std::string& name, int argc, char** argv, const std::function<void()>& check = [] {}) {
  app.set_version_flag("--version", name + " " + TEXTPLANE_VERSION_STRING, "Print the version and stop");
  try {
    app.parse(argc, argv);
    check();
    return std::nullopt;
  } catch (const CLI::Success& done) {
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    std::string problem = error.what();
    // CLI11 tells first what is missing: of a mistyped --ouput that --output is required.
    for (const std::string& word : app.remaining(true)) {
      if (word.size() < 2 || word.front() != '-') continue;
      problem = "there is no option " + word;
      break;
    }
    std::fprintf(stderr, "%s: %s (see %s --help)\n", name.c_str(), problem.c_str(), name.c_str());
    return kInputError;
  }
}

}  // namespace textslam

#endif  // TEXTSLAM_CLI_COMMAND_LINE_HPP
