// A map file to a map of a server.
#ifndef TEXTSLAM_MAP_SERVER_PUSH_MAP_HPP
#define TEXTSLAM_MAP_SERVER_PUSH_MAP_HPP

#include <cstdint>
#include <string>

namespace textslam {

/// What a push did.
struct Pushed {
  bool refused = false;       ///< The server holds what the file does not come from: nothing was changed.
  bool known = false;         ///< The server had all of it, so nothing was sent.
  std::int64_t revision = 0;  ///< Of the server's map, now.
  std::int64_t rows = 0;      ///< Sent.
};

/// Puts the file's map in the place of the server's of this name, or makes it, in one transaction: readers see the map
/// of before or the new one, and whatever ends the push, nothing else stays. It is refused where the server's map has a
/// revision that the file does not come from. The file remembers the new revision; else it stays as it is. InputError
/// where the file is no map or is damaged, and for all that the server refuses.
Pushed push_map(const std::string& file, const std::string& database, const std::string& map);

/// For people, a line without its end.
std::string pushed_text(const Pushed& pushed, const std::string& map);

/// The same where another was faster: takes the server's map, joins the file's with it (merge_branches.hpp), and pushes
/// that, as often as others are faster. Then the file is pulled: it holds what the server does. InputError where the
/// two have no common place, too. The string says in a line what was done.
std::string push_merged(const std::string& file, const std::string& database, const std::string& map);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_PUSH_MAP_HPP
