// Evaluations as text for a terminal, as Markdown tables and as CSV, with the same numbers under the same names.
//
// Lengths are in the unit of the truth (m), angles in degrees, shares from 0 to 1. Unknown values are empty in CSV and
// `-` elsewhere. If the trajectory could not be aligned, `status` says why and the errors are unknown.
#ifndef TEXTSLAM_EVAL_FORMAT_HPP
#define TEXTSLAM_EVAL_FORMAT_HPP

#include <string>
#include <vector>

#include "textslam_eval/evaluate_run.hpp"

namespace textslam {

enum class Format { text, markdown, csv };

std::string format_evaluations(const std::vector<RunEvaluation>& runs, Format format);

}  // namespace textslam

#endif  // TEXTSLAM_EVAL_FORMAT_HPP
