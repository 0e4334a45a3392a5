// The frames of a sequence by name and time: from a list, or from the names in a folder.
//
//   images.txt, rgb.txt   `timestamp path` a line, times strictly increasing, `#` comments; the path is relative to the
//                         folder and runs to the end of the line
//   a folder of images    .png .jpg .jpeg .pgm .ppm, in the natural order of their names: digits by value, so that
//                         9.png comes before 10.png. Hidden files are skipped. Times: 0, 1/fps, 2/fps, ...
#ifndef TEXTSLAM_IO_FRAME_LIST_HPP
#define TEXTSLAM_IO_FRAME_LIST_HPP

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/names.hpp"

namespace textslam {

struct FrameRef {
  double timestamp = 0;  ///< s
  std::string path;      ///< the image, or the video
  std::string stem;      ///< of its detections' name: the file name without extension, or the number in a video
  int line = 0;          ///< in the list that names it; 0: no list
  /// Of a video's frame on its way to a detector that wants_colour(): see load_colour(). Else empty.
  Image<std::uint8_t> colour = {};
};

/// The path of images.txt, else of rgb.txt; empty where the folder has neither.
std::string find_list(const std::string& folder);

/// The frames of such a list, paths resolved against `folder`. Throws InputError with the line for a bad number, a
/// missing path or times that do not increase, and for a list without images.
std::vector<FrameRef> read_frame_list(const std::string& folder, const std::string& list);

/// The names of the images in a folder, in order. Throws InputError where the folder cannot be read, and where it has
/// no images: then it says which formats are read, and which of the folder's are not.
std::vector<std::string> image_names(const std::string& folder);

/// Frames for these names, `fps` (positive) a second.
std::vector<FrameRef> number_frames(const std::string& folder, const std::vector<std::string>& names, double fps);

/// The natural order of names. Strict: names that differ only in leading zeros are ordered, too.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace textslam

#endif  // TEXTSLAM_IO_FRAME_LIST_HPP
