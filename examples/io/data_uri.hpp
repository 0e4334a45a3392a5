// Data URIs: images inside of HTML and SVG files.
#ifndef TEXTSLAM_IO_DATA_URI_HPP
#define TEXTSLAM_IO_DATA_URI_HPP

#include <string>
#include <string_view>

namespace textslam {

/// `data:image/jpeg;base64,...` of a JPEG's bytes.
std::string jpeg_uri(std::string_view jpeg);

}  // namespace textslam

#endif  // TEXTSLAM_IO_DATA_URI_HPP
