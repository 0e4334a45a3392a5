// textslam-map: questions to the text map of an output folder, or to a map file.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "io/input_error.hpp"
#include "plugins/plugins.hpp"
#include "textslam_map/file_commands.hpp"
#include "textslam_map/image_commands.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/server_commands.hpp"
#include "textslam_map/text_query.hpp"

namespace {

using textslam::kInputError;
constexpr int kNotFound = 1;

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

void print_angles(const std::vector<textslam::IndexedText>& texts, const textslam::LargestAngle& largest) {
  std::printf("%4s  %-20s %5s  %-22s  degrees to text", "text", "word", "votes", "normal");
  for (const textslam::IndexedText& text : texts) std::printf(" %5d", text.id);
  std::printf("\n");
  for (const textslam::IndexedText& text : texts) {
    const auto& n = text.normal;
    std::printf("%4d  %-20s %3.0f %%  %7.3f %7.3f %7.3f %15s", text.id, text.text.c_str(), 100 * text.score, n.x(),
                n.y(), n.z(), "");
    for (const textslam::IndexedText& other : texts) std::printf(" %5.1f", angle_between(text, other));
    std::printf("\n");
  }
  if (texts.size() > 1)
    std::printf("largest angle %.2f degrees, between texts %d and %d\n", largest.degrees, largest.first,
                largest.second);
}

// Exit code 1 where no text was found, or, with a limit, where two normals are farther apart.
int show_angles(const std::vector<textslam::IndexedText>& texts, double within, bool json) {
  const textslam::LargestAngle largest = textslam::largest_angle(texts);
  if (json)
    std::printf("%s", textslam::angles_json(texts).c_str());
  else
    print_angles(texts, largest);
  if (!(largest.degrees > within)) return 0;
  std::fprintf(stderr, "textslam-map: an angle of %.2f degrees is more than %g\n", largest.degrees, within);
  return kNotFound;
}

std::vector<textslam::IndexedText> read_texts(const std::string& map) {
  return std::filesystem::is_regular_file(map) ? textslam::read_map_texts(map)
                                               : textslam::read_text_index(map + "/text_index.json");
}

int execute(int argc, char** argv) {
  std::string folder, word;
  std::vector<std::string> words;
  double within = 180;
  bool json = false;
  CLI::App app{"Questions to the text map that textslam wrote."};
  app.require_subcommand(1);
  CLI::App* query = app.add_subcommand(
      "query", "Where is a word? Position and normal in the world frame, and the key frame that shows it best");
  const char* const kMap = "Output folder of textslam, or a map file";
  query->add_option("MAP", folder, kMap)->required();
  query->add_option("WORD", word, "Or a part of it, or one like it; letters' case does not matter")->required();
  query->add_flag("--json", json, "Print it as text_index.json has it");
  CLI::App* angles = app.add_subcommand("angles", "How do texts lie to each other? The angles between their normals");
  angles->add_option("MAP", folder, kMap)->required();
  angles->add_option("WORD", words, "Of each the text that query finds first; without any, all texts of the map");
  angles->add_flag("--json", json, "Print texts, the angles between them and the largest as JSON");
  angles->add_option("--within", within, "Degrees: exit code 1 where two normals are farther apart")
      ->check(textslam::within(0, 180));
  textslam::FileCommands file(app);
  textslam::ServerCommands server(app);
  textslam::FindCommand find(app);
  textslam::ImportCommand importer(app);
  if (const auto code = textslam::parse_command_line(app, "textslam-map", argc, argv)) return *code;
  if (const auto code = file.run({argv, argv + argc})) return *code;
  if (const auto code = server.run()) return *code;
  if (find.parsed()) return find.run();
  if (importer.parsed()) return importer.run();
  const std::vector<textslam::IndexedText> texts = read_texts(folder);
  if (angles->parsed() && words.empty()) return show_angles(texts, within, json);
  if (query->parsed()) words = {word};
  std::vector<textslam::IndexedText> found;
  for (const std::string& wanted : words) {
    const auto alike = textslam::query(texts, wanted);
    if (alike.empty()) {
      std::fprintf(stderr, "textslam-map: no text of %s reads like '%s'\n", folder.c_str(), wanted.c_str());
      return kNotFound;
    }
    found.insert(found.end(), alike.begin(), angles->parsed() ? alike.begin() + 1 : alike.end());
  }
  if (angles->parsed()) return show_angles(found, within, json);
  if (json)
    std::printf("%s", textslam::text_index_json(found).c_str());
  else
    for (const textslam::IndexedText& text : found) print(text);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  textslam::register_plugins();
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
