#include "io/output_file.hpp"

#include <csignal>

#include <sys/resource.h>
#include <unistd.h>

#include "io/io_support.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace io_output_file_test {

template <class Action>
void expect_failure(Action action, const std::string& path) {
  try {
    action();
  } catch (const InputError& error) {
    ADD_FAILURE() << "output is no input: " << error.what();
    return;
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).compare(0, path.size() + 2, path + ": "), 0) << error.what();
    return;
  }
  ADD_FAILURE() << "no error for " << path;
}

std::size_t entries(const std::string& folder) {
  const std::filesystem::directory_iterator begin(folder);
  return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
}

TEST(OutputFile, WritesAndReplaces) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.bin"), bytes("x\0\r\ny", 5);
  write_file(path, bytes);
  EXPECT_EQ(read_file(path), bytes);
  write_file(path, "");
  EXPECT_EQ(read_file(path), "");
  EXPECT_EQ(entries(folder.path()), 1u) << "nothing temporary stays";
}

TEST(OutputFile, FailureNamesThePath) {
  const TemporaryFolder folder;
  const std::string no_folder = folder.path("none/a.txt"), under_file = folder.write("file", "") + "/a.txt";
  expect_failure([&] { write_file(no_folder, "x"); }, no_folder);
  expect_failure([&] { write_file(under_file, "x"); }, under_file);
  // The bytes can be written, the name is taken by a folder: the old thing stands and the part goes.
  create_output_folder(folder.path("taken/inner"));
  expect_failure([&] { write_file(folder.path("taken"), "x"); }, folder.path("taken"));
  EXPECT_TRUE(std::filesystem::is_directory(folder.path("taken/inner")));
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(OutputFile, NoPermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
  const TemporaryFolder folder;
  create_output_folder(folder.path("locked"));
  std::filesystem::permissions(folder.path("locked"),
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const std::string file = folder.path("locked/a.txt"), inner = folder.path("locked/b");
  expect_failure([&] { write_file(file, "x"); }, file);
  expect_failure([&] { create_output_folder(inner); }, inner);
  std::filesystem::permissions(folder.path("locked"), std::filesystem::perms::owner_all);
}

// A limit on file size stands in for a full disk: the write fails half-way in the same place.
TEST(OutputFile, FullDiskKeepsTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.txt");
  write_file(path, "old");
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 4096;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const std::size_t size : {std::size_t(5000), std::size_t(1) << 20}) {
    expect_failure([&] { write_file(path, std::string(size, 'n')); }, path);
  }
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(OutputFile, Folders) {
  const TemporaryFolder folder;
  create_output_folder(folder.path("a/b/c"));
  create_output_folder(folder.path("a/b/c"));
  create_output_folder(folder.path("d/"));
  EXPECT_TRUE(std::filesystem::is_directory(folder.path("a/b/c")));
  EXPECT_TRUE(std::filesystem::is_directory(folder.path("d")));
  const std::string file = folder.write("file", "");
  expect_failure([&] { create_output_folder(file); }, file);
  expect_failure([&] { create_output_folder(file + "/x"); }, file + "/x");
  expect_failure([&] { create_output_folder(""); }, "");
}

}  // namespace io_output_file_test
}  // namespace textslam
