// The tables of a map file: docs/map.md describes them. A new version is a step in schema.cpp; files of older versions
// are brought up to date by the steps that they lack.
#ifndef TEXTSLAM_MAP_FILE_SCHEMA_HPP
#define TEXTSLAM_MAP_FILE_SCHEMA_HPP

#include "textslam/map_file/database.hpp"

namespace textslam {

constexpr std::int64_t kMapApplication = 0x54504d70;  ///< PRAGMA application_id: "TPMp".

/// PRAGMA user_version of the files that this program writes.
int schema_version();

/// Opens a map for reading. One of an older version is brought up to date in memory. InputError where the file is
/// missing, holds nothing, is no map of textslam, or is of a newer version.
Database open_map(const std::string& path);

/// Opens a file for a map: a map, or one that is missing or empty. InputError for any other.
Database open_for_map(const std::string& path);

/// Brings the schema up to date, in the caller's transaction.
void migrate(Database& database);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_SCHEMA_HPP
