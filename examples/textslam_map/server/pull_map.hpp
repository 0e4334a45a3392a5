// A map of a server into a map file.
#ifndef TEXTSLAM_MAP_SERVER_PULL_MAP_HPP
#define TEXTSLAM_MAP_SERVER_PULL_MAP_HPP

#include <cstdint>
#include <optional>
#include <string>

namespace textslam {

struct Pulled {
  bool known = false;         ///< The file had all of it.
  std::int64_t revision = 0;  ///< Of the server's map.
  std::int64_t rows = 0;      ///< Received.
};

/// Writes the server's map of this name into the file, in one transaction; what the file held of a map goes. Nothing of
/// the server is trusted: all that loading looks at is looked at before the file is written. A file that is there has
/// to be one that was the same as this map of the server, and was not saved since then: else it holds what no server
/// has. With `replaces` it may be any map that was saved so often. InputError where not, where there is no such map,
/// and for all that the server refuses; then the file is as before.
Pulled pull_map(const std::string& database, const std::string& map, const std::string& file,
                std::optional<std::int64_t> replaces = {});

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_PULL_MAP_HPP
