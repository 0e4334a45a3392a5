// textslam-map: questions to the text map of an output folder.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "io/input_error.hpp"
#include "textslam/text_index.hpp"

namespace {

constexpr int kNotFound = 1, kInputError = 2;

void print(const textslam::IndexedText& text) {
  const auto& p = text.position;
  const auto& n = text.normal;
  std::printf(
      "%s  (text %d, %.0f %% of the votes)\n  position  %.4f %.4f %.4f\n  normal    %.4f %.4f %.4f\n  image     %s\n",
      text.text.c_str(), text.id, 100 * text.score, p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), text.image.c_str());
  std::printf("  quad     ");
  for (const auto& corner : text.quad.corner) std::printf(" %.1f,%.1f", corner.x(), corner.y());
  std::printf("\n");
}

int execute(int argc, char** argv) {
  std::string folder, word;
  bool json = false;
  CLI::App app{"Questions to the text map that textslam wrote."};
  app.require_subcommand(1);
  CLI::App* query = app.add_subcommand(
      "query", "Where is a word? Position and normal in the world frame, and the key frame that shows it best");
  query->add_option("DIR", folder, "Output folder of textslam")->required();
  query->add_option("WORD", word, "Or a part of it; letters' case does not matter")->required();
  query->add_flag("--json", json, "Print it as text_index.json has it");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "textslam-map: %s (see textslam-map --help)\n", error.what());
    return kInputError;
  }
  const auto found = textslam::query(textslam::read_text_index(folder + "/text_index.json"), word);
  if (json)
    std::printf("%s", textslam::text_index_json(found).c_str());
  else
    for (const textslam::IndexedText& text : found) print(text);
  if (!found.empty()) return 0;
  std::fprintf(stderr, "textslam-map: no text of %s reads like '%s'\n", folder.c_str(), word.c_str());
  return kNotFound;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return execute(argc, argv);
  } catch (const textslam::InputError& error) {
    std::fprintf(stderr, "textslam-map: %s\n", error.what());
    return kInputError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "textslam-map: %s\n", error.what());
    return 1;
  }
}
