// The page of the report without its data: examples/viewer in one piece. The .cpp is made when the program is built
// (examples/viewer/embed.cmake).
#ifndef TEXTSLAM_REPORT_REPORT_TEMPLATE_HPP
#define TEXTSLAM_REPORT_REPORT_TEMPLATE_HPP

#include <string_view>

namespace textslam {

/// Holds `@RUN@` and `@DATA@` once each, where the JSON goes.
std::string_view report_template();

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_TEMPLATE_HPP
