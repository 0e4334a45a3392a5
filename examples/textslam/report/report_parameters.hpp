// The parameters as JSON. The list of them is made from parameters.hpp when the program is built (examples/viewer/
// parameters.cmake), so none can be forgotten.
#ifndef TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP
#define TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP

#include "textslam/common/parameters.hpp"
#include "textslam/common/report_json.hpp"

namespace textslam {

/// [[section, name, value, comment], ...] in the order of the struct.
Json parameters_json(const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP
