// Files that are no maps, or no longer: one clear line, and the file stays as it is.
#include <gtest/gtest.h>

#include <fstream>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map_file/database.hpp"
#include "textslam/map_file/schema.hpp"

namespace textslam {
namespace damage_test {

using namespace map_file_support;

void change(const std::string& file, const std::string& sql) {
  Database database(file, Access::write);
  database.execute("pragma foreign_keys = off; " + sql);
}

void write(const std::string& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

TEST_F(MapFileTest, AMissingFileIsNamed) { EXPECT_EQ(refusal(), file + ": no such file"); }

TEST_F(MapFileTest, AForeignFileIsRefusedAndStays) {
  for (const std::string& bytes : {std::string("a picture of something"), std::string(5000, 'x')}) {
    write(file, bytes);
    EXPECT_EQ(refusal(), file + ": no map of textslam: not an SQLite database");
    EXPECT_THROW(check_can_save(file), InputError);
    EXPECT_THROW(save(), InputError);
    EXPECT_EQ(read_file(file), bytes);
  }
}

TEST_F(MapFileTest, AnotherDatabaseIsRefusedAndStays) {
  Database(file, Access::write).execute("create table recipes (name text)");
  const std::string before = read_file(file);
  EXPECT_EQ(refusal(), file + ": an SQLite database, but no map of textslam");
  EXPECT_THROW(save(), InputError);
  EXPECT_EQ(read_file(file), before);
}

TEST_F(MapFileTest, AnEmptyFileHoldsNoMapButTakesOne) {
  write(file, "");
  EXPECT_EQ(refusal(), file + ": empty: it holds no map");
  check_can_save(file);
  save();
  EXPECT_EQ(refusal(), "");
}

// What can be known before the run is said before it, and leaves nothing behind.
TEST_F(MapFileTest, APlaceThatTakesNoFileIsRefusedAtOnce) {
  check_can_save(file);
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_THROW(check_can_save(folder.path("no/such/folder/map.db")), std::runtime_error);
  save();
  const std::string before = read_file(file);
  check_can_save(file);
  EXPECT_EQ(read_file(file), before);
}

TEST_F(MapFileTest, AFolderIsNoMap) {
  std::filesystem::create_directory(file);
  EXPECT_EQ(refusal(), file + ": a folder, not a map");
  EXPECT_THROW(check_can_save(file), InputError);
}

TEST_F(MapFileTest, ANewerMapIsRefused) {
  save();
  change(file, "pragma user_version = 99");
  EXPECT_NE(refusal().find("schema version 99"), std::string::npos) << refusal();
  EXPECT_THROW(save(), InputError);
}

// Whatever a single value is changed to, it is refused or the map holds nothing out of range.
TEST_F(MapFileTest, BrokenValuesAreRefused) {
  const char* const changes[] = {
      "update keyframes set x = 'far' where id = 2",
      "update keyframes set qw = 9 where id = 2",
      "update keyframes set qw = 1e999 where id = 2",
      "delete from keyframes where id = 0",
      "delete from keyframes where id = 2",
      "update keyframes set id = 2000000000 where id = 2",
      "update images set bytes = x'89504e47' where keyframe = 2",
      "update images set format = 'gif'",
      "delete from images where keyframe = 0",
      "update points set y = 1e999 where id = 1",
      "update points set found = -1 where id = 1",
      "delete from points where id = 1",
      "update points set id = -5 where id = 1",
      "delete from observations where point = 1 and number = 0",
      "update observations set keyframe = 1 where point = 1",
      "update observations set keyframe = -1 where point = 1",
      "update texts set theta_x = 0, theta_y = 0, theta_z = 0",
      "update texts set host = 1",
      "update texts set host = 77",
      "update texts set x1 = x3, y1 = y3",
      "update texts set zncc = 'good'",
      "update patches set pixels = x'00' where text = 1",
      "update patches set arrays = 6 where text = 1",
      "update patches set pixels = zeroblob(20 * 3 + 4) where text = 1",
      "delete from patches where text = 1",
      "delete from patches where text = 1 and level = 0",
      "update text_views set keyframe = 1 where text = 1",
      "update votes set score = 'many'",
      "delete from cameras",
      "update cameras set model = 'pinhole camera'",
      "update cameras set fx = -1",
      "update cameras set coefficients = 'k1'",
      "update cameras set width = 319",
      "update cameras set height = 0",
      "insert into cameras values (2, 'pinhole', 320, 240, -1, 262, 159.5, 119.5, '', 30, 0, 0)",
      ("insert into cameras values (2, 'pinhole', 320, 240, 262, 262, 159.5, 119.5, '', 30, 0, 0), "
       "(3, 'pinhole', 320, 240, 262, 262, 159.5, 119.5, '', 30, 0, 0)"),
      "delete from sessions",
      "update sessions set frames = 1.5",
      "drop table points",
      "delete from map",
  };
  save();
  const std::string whole = read_file(file);
  for (const char* sql : changes) {
    write(file, whole);
    change(file, sql);
    const std::string said = refusal();
    EXPECT_EQ(said.find(file), 0u) << sql;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << sql;
  }
}

// Cut anywhere, or with bytes of it overwritten, it is refused or read; nothing crashes.
TEST_F(MapFileTest, AnyDamageIsRefusedOrHarmless) {
  save();
  const std::string whole = read_file(file);
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 1; at < whole.size(); at += whole.size() / 40, ++tried) {
    write(file, whole.substr(0, at));
    refused += refusal().empty() ? 0u : 1u;
  }
  EXPECT_EQ(refused, tried) << "a file that was cut";
  for (std::size_t at = 0; at < whole.size(); at += whole.size() / 60) {
    std::string damaged = whole;
    for (std::size_t i = at; i < std::min(at + 64, damaged.size()); ++i) damaged[i] = static_cast<char>(~damaged[i]);
    write(file, damaged);
    refusal();
  }
}

}  // namespace damage_test
}  // namespace textslam
