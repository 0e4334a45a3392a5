// What a map file has in common with maps on servers: its table `origins`.
//
// A file that was pushed to or pulled from a map of a server remembers that map's id and revision, and how often the
// file itself had been saved then. So a push knows whether it would take somebody else's work away, and a pull whether
// the file has changes that no server holds. A map that replaces the file's forgets them (save_map with revision 0).
#ifndef TEXTSLAM_MAP_SERVER_ORIGINS_HPP
#define TEXTSLAM_MAP_SERVER_ORIGINS_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "textslam/map_file/database.hpp"

namespace textslam {

struct Origin {
  std::int64_t revision = 0;  ///< Of the server's map: all that it held is in the file.
  std::int64_t saved = 0;     ///< The file's own revision when the two were the same.
};

/// Saves of the file so far.
std::int64_t file_revision(Database& file);

/// Empty: the file was never the same as the server's map of this id.
std::optional<Origin> origin_of(Database& file, const std::string& server_map);

/// In the caller's transaction.
void set_origin(Database& file, const std::string& server_map, const Origin& origin);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_ORIGINS_HPP
