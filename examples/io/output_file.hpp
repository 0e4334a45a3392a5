// Output files that are whole or absent: written under a temporary name in the same folder, then renamed.
#ifndef TEXTSLAM_IO_OUTPUT_FILE_HPP
#define TEXTSLAM_IO_OUTPUT_FILE_HPP

#include <string>
#include <string_view>

namespace textslam {

/// Replaces the file `path` by `bytes`. A reader sees the old file or the new one, never a part: the bytes go to
/// `path`.part first. Throws std::runtime_error that names the path and the cause (no permission, disk full); the old
/// file then remains, and the temporary one is removed. Two writers of one path must take turns.
void write_file(const std::string& path, std::string_view bytes);

/// Makes the folder and its parents where they do not exist. Throws std::runtime_error that names the path when that
/// fails or something else has that name.
void create_output_folder(const std::string& path);

}  // namespace textslam

#endif  // TEXTSLAM_IO_OUTPUT_FILE_HPP
