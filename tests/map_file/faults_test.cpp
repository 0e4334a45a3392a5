// Saving where it cannot be done: the old map stays whole, and one line names the file.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam/map_file/database.hpp"
#include "textslam/map_file/schema.hpp"
#include "textslam_map/map_queries.hpp"
#include "textslam_map/prune_map.hpp"

namespace textslam {
namespace faults_test {

using namespace map_file_support;

constexpr uid_t kNobody = 65534;

// No file of this process grows beyond `bytes` while it lives: that stands in for a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(std::uintmax_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class Faults : public MapFileTest {
 protected:
  // What `step` says; empty: it did what it should.
  template <class Step>
  static std::string said(const Step& step) {
    try {
      step();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  void expect_one_line(const std::string& message, const std::string& place) const {
    EXPECT_EQ(message.find(place + ": "), 0u) << "it says '" << message << "'";
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
  }
  void expect_whole(std::int64_t revision) const {
    EXPECT_EQ(problems_of(file), std::vector<std::string>());
    EXPECT_EQ(load().record.revision, revision);
  }
  // The map with more in it than before: key frames with images of noise.
  LoadedMap grown() const {
    LoadedMap loaded = load();
    for (int i = 0; i < 12; ++i) {
      const SE3d T_c_w = moved({0.1 * i, 0.1, 0}, {0, 0, 0.1 * i});
      loaded.map.keyframes.push_back({frame_at(T_c_w), T_c_w.inverse(), {}});
      loaded.record.sources[loaded.map.newest_keyframe()] = {1, "more.png"};
    }
    return loaded;
  }
};

TEST_F(Faults, AFullDiskLeavesTheOldMap) {
  save();
  const LoadedMap more = grown();
  const std::string whole = read_file(file);
  const auto old_bytes = std::filesystem::file_size(file);
  save_map(folder.path("more.db"), more.map, [&] {
    MapRecord first = more.record;
    first.revision = 0;
    return first;
  }());
  const auto new_bytes = std::filesystem::file_size(folder.path("more.db"));
  ASSERT_GT(new_bytes, old_bytes + 20000);
  int failed = 0, tried = 0;
  // From no room at all, where the journal fails, to one page short of what is needed.
  for (std::uintmax_t bytes = 4096; bytes < new_bytes; bytes += (new_bytes - 4096) / 24, ++tried) {
    std::string message;
    {
      const SmallDisk disk(bytes);
      message = said([&] { save_map(file, more.map, more.record); });
    }
    if (message.empty()) {  // pages of the old map were free
      folder.write("map.db", whole);
      continue;
    }
    ++failed;
    expect_one_line(message, file);
    expect_whole(1);
  }
  EXPECT_GT(failed, tried / 2);
  save_map(file, more.map, more.record);
  expect_whole(2);
}

TEST_F(Faults, AFullDiskTakesNoFirstSave) {
  save_map(folder.path("elsewhere.db"), map, record);
  const std::uintmax_t needed = std::filesystem::file_size(folder.path("elsewhere.db"));
  for (const std::uintmax_t bytes : {std::uintmax_t{512}, std::uintmax_t{4096}, needed / 3, needed - 4096}) {
    std::string message;
    {
      const SmallDisk disk(bytes);
      message = said([&] { save(); });
    }
    expect_one_line(message, file);
    const std::string left = std::filesystem::exists(file) ? refusal() : "";
    EXPECT_TRUE(left.empty() || left == file + ": empty: it holds no map") << left;
  }
  save();
  expect_whole(1);
}

// Pruning, the vacuum or nothing fails: the map is the old one, or all of the new one.
TEST_F(Faults, AFullDiskLeavesPruningWhole) {
  save();
  const std::string whole = read_file(file);
  PruneRules rules;
  rules.max_sigma = 0;
  int failed = 0;
  for (std::uintmax_t bytes = 512; bytes < whole.size(); bytes += whole.size() / 24) {
    std::filesystem::remove(file + "-journal");
    folder.write("map.db", whole);
    std::string message;
    {
      const SmallDisk disk(bytes);
      message = said([&] { prune_map(file, rules, false); });
    }
    const std::int64_t revision = load().record.revision;
    expect_whole(revision);
    EXPECT_EQ(open_map(file).integer("select count(*) from texts"), revision == 1 ? 3 : 0);
    if (message.empty()) continue;
    ++failed;
    expect_one_line(message, file);
    EXPECT_EQ(message.find("the file is as long as before") != std::string::npos, revision == 2) << message;
  }
  EXPECT_GT(failed, 0);
}

// Root may write anywhere, so a child that is nobody tries it.
class ReadOnly : public Faults {
 protected:
  // What `step` says as somebody without rights.
  template <class Step>
  std::string said_without_rights(const Step& step) const {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      std::string message = "no rights were given up";
      if (geteuid() != 0 || (setgid(kNobody) == 0 && setuid(kNobody) == 0)) message = said(step);
      const ssize_t written = write(ends[1], message.data(), message.size());
      _exit(written == static_cast<ssize_t>(message.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string message(4096, '\0');
    message.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends[0], &message[0], message.size()))));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return message;
  }
};

TEST_F(ReadOnly, AFolderOrFileLeavesTheOldMap) {
  save();
  const LoadedMap more = grown();
  const std::string before = read_file(file);
  PruneRules rules;
  rules.max_sigma = 0;
  struct Rights {
    mode_t folder, file;
  };
  for (const Rights& rights : {Rights{0555, 0444}, Rights{0777, 0444}, Rights{0555, 0666}}) {
    ASSERT_EQ(chmod(folder.path().c_str(), rights.folder), 0);
    ASSERT_EQ(chmod(file.c_str(), rights.file), 0);
    SCOPED_TRACE(testing::Message() << std::oct << "folder " << rights.folder << ", file " << rights.file);
    const std::string nothing = said_without_rights([&] { problems_of(file); });
    if (nothing == "no rights were given up") GTEST_SKIP() << "root may not become nobody here";
    EXPECT_EQ(nothing, "") << "it can be read";
    expect_one_line(said_without_rights([&] { save_map(file, more.map, more.record); }), file);
    expect_one_line(said_without_rights([&] { prune_map(file, rules, false); }), file);
    expect_one_line(said_without_rights([&] { check_can_save(file); }), file);
    if (rights.folder == 0555) {
      const std::string other = folder.path("new.db");
      expect_one_line(said_without_rights([&] { save_map(other, map, record); }), other);
    }
    EXPECT_EQ(read_file(file), before);
    EXPECT_FALSE(std::filesystem::exists(file + "-journal"));
  }
  ASSERT_EQ(chmod(folder.path().c_str(), 0700), 0);
}

TEST_F(Faults, WhereNoFileCanBe) {
  const std::string in_file = folder.write("a_file", "x") + "/map.db", nowhere = folder.path("no/folder/map.db");
  for (const std::string& path : {in_file, nowhere}) {
    expect_one_line(said([&] { save_map(path, map, record); }), path);
    expect_one_line(said([&] { check_can_save(path); }), path);
  }
  EXPECT_EQ(read_file(folder.path("a_file")), "x");
}

// Another program writes and does not end: the save waits, then says so.
TEST_F(Faults, AWriterThatStaysIsNamed) {
  save();
  const LoadedMap more = grown();
  {
    Database other(file, Access::write);
    Transaction transaction(other);
    other.execute("update points set x = 0");
    const std::string message = said([&] { save_map(file, more.map, more.record); });
    expect_one_line(message, file);
    EXPECT_NE(message.find("locked"), std::string::npos) << message;
  }
  expect_whole(1);
  save_map(file, more.map, more.record);
  expect_whole(2);
}

// Several programs add their sessions at once. Who comes too late is told so, and what was saved stays.
TEST_F(Faults, WritersAtOnceLoseNothing) {
  constexpr int kWriters = 4, kSaves = 6;
  save();
  std::vector<pid_t> children;
  for (int i = 0; i < kWriters; ++i) {
    children.push_back(fork());
    ASSERT_GE(children.back(), 0);
    if (children.back() != 0) continue;
    int wrong = 0;
    for (int saved = 0; saved < kSaves;) {
      LoadedMap loaded = load();
      SavedSession session = loaded.record.sessions.back();
      ++session.id;
      session.sequence = std::to_string(i) + "/" + std::to_string(saved);
      loaded.record.sessions.push_back(session);
      const std::string message = said([&] { save_map(file, loaded.map, loaded.record); });
      if (message.empty())
        ++saved;
      else if (message.find(file + ": another session was saved") != 0)
        ++wrong;
    }
    _exit(wrong == 0 ? 0 : 1);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "it was told something else";
  }
  expect_whole(1 + kWriters * kSaves);
  const LoadedMap loaded = load();
  ASSERT_EQ(loaded.record.sessions.size(), 1u + kWriters * kSaves);
  for (int i = 0; i < kWriters; ++i)
    for (int saved = 0; saved < kSaves; ++saved) {
      const std::string name = std::to_string(i) + "/" + std::to_string(saved);
      EXPECT_EQ(std::count_if(loaded.record.sessions.begin(), loaded.record.sessions.end(),
                              [&](const SavedSession& session) { return session.sequence == name; }),
                1)
          << name;
    }
}

}  // namespace faults_test
}  // namespace textslam
