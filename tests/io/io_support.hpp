// What the tests of examples/io share: a folder that vanishes, a text with a change, and the check of an InputError.
#ifndef TESTS_IO_IO_SUPPORT_HPP
#define TESTS_IO_IO_SUPPORT_HPP

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <stdlib.h>

#include "io/camera_model.hpp"
#include "io/input_error.hpp"

namespace textslam {

/// A new empty folder that is removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "textplane-XXXXXX").string();
    if (mkdtemp(&name[0]) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  std::string path() const { return path_.string(); }
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file, and the folders on the way to it; returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

/// The camera as the model that most files are of.
inline RadialTangential<double> lens_of(const CameraModel& camera) {
  const auto* lens = camera.raw.get_if<RadialTangential<double>>();
  EXPECT_NE(lens, nullptr) << camera.raw.name();
  return lens ? *lens : RadialTangential<double>{};
}

/// The text with the first `from`, which must be there, replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Runs `action` and expects an InputError at this file and line whose message contains `part`.
template <class Action>
void expect_input_error(Action action, const std::string& file, int line, const std::string& part) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), file);
    EXPECT_EQ(error.line(), line) << error.what();
    EXPECT_NE(error.message().find(part), std::string::npos) << error.what() << " should say " << part;
    const std::string place = line > 0 ? file + ":" + std::to_string(line) : file;
    EXPECT_EQ(error.what(), place + ": " + error.message());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    return;
  }
  ADD_FAILURE() << "no InputError; expected one that says " << part;
}

}  // namespace textslam

#endif  // TESTS_IO_IO_SUPPORT_HPP
