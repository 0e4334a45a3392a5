// The parameters as JSON, for the report.
#ifndef TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP
#define TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP

#include "textslam/common/parameters.hpp"
#include "textslam/common/report_json.hpp"

namespace textslam {

/// [[section, name, value, meaning], ...] in the order of the list.
Json parameters_json(const Parameters& parameters);

}  // namespace textslam

#endif  // TEXTSLAM_REPORT_REPORT_PARAMETERS_HPP
