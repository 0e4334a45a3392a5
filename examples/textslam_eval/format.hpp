// Evaluations as text for a terminal, as Markdown tables, and as CSV. All three hold the same numbers under the same names.
//
// Lengths are in the unit of the truth (m), angles in degrees, shares between 0 and 1. What is not known is empty in CSV and
// `-` elsewhere; where the trajectory could not be aligned, `status` says why and the errors are not known.
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
