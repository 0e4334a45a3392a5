// The tables of a server: those of a map file, each with the column `map` before its own, in the schema `textslam`.
//
// They are read from the tables that schema.cpp makes, so that the two cannot differ. The file's two indices have
// their own form: of `text_boxes` the boxes are a table like the others, and for `words` there are indices of pg_trgm
// on the readings and on the texts' words, where the server has that extension.
#ifndef TEXTSLAM_MAP_SERVER_TABLES_HPP
#define TEXTSLAM_MAP_SERVER_TABLES_HPP

#include <optional>
#include <string>
#include <vector>

#include "textslam_map/server/connection.hpp"

namespace textslam {

struct ServerColumn {
  std::string name;
  Kind kind = Kind::integer;
  bool needed = true;  ///< Not null.
};

struct ServerTable {
  std::string name;
  std::vector<ServerColumn> columns;     ///< Without `map`.
  std::vector<std::string> key;          ///< Likewise.
  std::vector<std::string> constraints;  ///< Of the file: references to other tables, as SQL of the server.
  std::vector<std::string> indices;      ///< What is looked up when rows that others refer to go.

  /// The columns with commas between them.
  std::string list() const;
  std::vector<Kind> kinds() const;
};

/// Of the newest version of the file's schema, but what belongs to a file alone.
std::vector<ServerTable> server_tables();

/// The register of maps: textslam.maps.
struct ServerMap {
  std::string id;             ///< A map that is removed and made again is another one.
  std::int64_t revision = 0;  ///< Counts the pushes.
};

/// The map of this name; empty: there is none. `lock`: nobody else pushes it until the transaction ends. InputError
/// where the server's tables are not ours, where they lack columns, or where the map is of a newer version.
std::optional<ServerMap> find_server_map(Connection& connection, const std::string& map, bool lock);

/// Makes the tables, or adds what older versions of them lack. It changes nothing where all is there, and then needs no
/// rights to make any. InputError where the schema holds tables of others.
void prepare_server(Connection& connection);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_SERVER_TABLES_HPP
