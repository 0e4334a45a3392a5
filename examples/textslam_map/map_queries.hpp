// Questions to a map file (textslam/map_file): what is in it, its texts, and whether it is whole.
#ifndef TEXTSLAM_MAP_MAP_QUERIES_HPP
#define TEXTSLAM_MAP_MAP_QUERIES_HPP

#include <optional>
#include <string>
#include <vector>

#include "textslam/common/report_json.hpp"
#include "textslam/map_file/map_file.hpp"
#include "textslam/report/text_index.hpp"

namespace textslam {

/// Texts as text_index.json has them. `image` and `quad` are those of the text's host.
std::vector<IndexedText> read_map_texts(const std::string& path);

struct MapInfo {
  std::int64_t version = 0, revision = 0;
  std::int64_t bytes = 0;  ///< Of the file.
  std::int64_t keyframes = 0, points = 0, observations = 0, texts = 0, words = 0;
  CameraModel camera;
  std::optional<CameraModel> given_camera;  ///< As MapRecord has it.
  std::vector<SavedSession> sessions;
  std::vector<std::int64_t> keyframes_of, texts_of;  ///< Of each session.
};

MapInfo read_map_info(const std::string& path);
/// For people, and as JSON.
std::string info_text(const MapInfo& info);
std::string info_json(const MapInfo& info);
/// {"id", "started", "sequence", "mode", "version", "frames", "tracked", "keyframes", "texts"} of a session; the last
/// two are those in the map.
Json session_json(const SavedSession& session, std::int64_t keyframes, std::int64_t texts);

/// What is wrong with the file, a line each; none: all is well. Integrity, references, finite numbers, the two indices,
/// and everything that loading checks. Throws InputError where it is no map at all.
std::vector<std::string> problems_of(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_MAP_QUERIES_HPP
