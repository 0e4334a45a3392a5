// The parts of a save and of a load: a group of tables each. map_file.hpp puts them together.
#ifndef TEXTSLAM_MAP_FILE_TABLES_HPP
#define TEXTSLAM_MAP_FILE_TABLES_HPP

#include "textslam/map_file/database.hpp"
#include "textslam/map_file/map_file.hpp"

namespace textslam {

/// Ids above this are taken for damage: memory grows with the largest.
constexpr int kMostId = 100'000'000;

// Each writes into empty tables; what is referred to may come later.
void save_sessions(Database& database, const MapRecord& record);
/// With the images of those that have none in the file yet.
void save_keyframes(Database& database, const Map& map, const MapRecord& record);
void save_points(Database& database, const Map& map);
void save_texts(Database& database, const Map& map);

// Each adds to the map, in this order. InputError for anything that cannot be.
void load_sessions(Database& database, MapRecord* record);
void load_keyframes(Database& database, const Parameters& parameters, MapRecord* record, Map* map);
void load_points(Database& database, Map* map);
void load_texts(Database& database, Map* map);

/// All of them, in the caller's transaction: a map that is not committed yet can be looked at, too.
LoadedMap load_tables(Database& database, const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_MAP_FILE_TABLES_HPP
