// Lines of ICDAR's files of detections, as detectors and annotators write them: x1,y1,x2,y2,x3,y3,x4,y4,word.
//
// The word is all that follows, commas and quotes included. Nothing here opens a file, throws but for memory, or looks
// at the locale.
#ifndef TEXTPLANE_LANDMARKS_ICDAR_HPP
#define TEXTPLANE_LANDMARKS_ICDAR_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "textplane/core/parse_number.hpp"
#include "textplane/landmarks/text_map_input.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// What stands between the corners and the end of a line. A word may be a number, so a line does not tell by itself.
enum class IcdarForm : std::uint8_t {
  word,        ///< The word, which may be missing.
  score_word,  ///< A score, then the same.
};

/// Where a line is broken.
struct IcdarFault {
  int field = 0;          ///< From 0: the first one that is no number, or how many there are.
  std::string_view text;  ///< That field, a part of the line.
};

/// The `count` numbers at the front of a line. `rest` receives what follows the comma after the last of them. too_few
/// where the line ends before, as parse_number() where a field is no number; *fault, unless null, then says where,
/// *rest is untouched, and the numbers are of no use.
TEXTPLANE_DEFERRED
Status parse_icdar_numbers(std::string_view line, int count, double* numbers, std::string_view* rest,
                           IcdarFault* fault = nullptr) noexcept {
  for (int i = 0; i < count; ++i) {
    const std::size_t comma = line.find(',');
    const std::string_view field = line.substr(0, comma);
    const bool last = comma == std::string_view::npos;
    const Status status = parse_number(field, &numbers[i]);
    if (!is_ok(status) || (last && i + 1 < count)) {
      if (fault) *fault = is_ok(status) ? IcdarFault{i + 1, {}} : IcdarFault{i, field};
      return is_ok(status) ? Status::too_few : status;
    }
    line.remove_prefix(last ? line.size() : comma + 1);
  }
  *rest = line;
  return Status::ok;
}

/// The detection of a line, with or without its line end. A byte-order mark at the front is dropped, and blanks round
/// numbers; the word's bytes stay as they are, and kUnreadText stands for a missing one. too_few for a blank line and
/// for fewer numbers than the form has, non_finite and invalid_argument as parse_number() has them; *out is then
/// untouched, and *fault, unless null, says where.
TEXTPLANE_DEFERRED
Status parse_icdar_line(std::string_view line, TextDetection* out, IcdarForm form = IcdarForm::word,
                        IcdarFault* fault = nullptr) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (line.substr(0, byte_order_mark.size()) == byte_order_mark) line.remove_prefix(byte_order_mark.size());
  for (const char end : {'\n', '\r'})
    if (!line.empty() && line.back() == end) line.remove_suffix(1);
  if (trimmed(line).empty()) {
    if (fault) *fault = {};
    return Status::too_few;
  }
  std::array<double, 9> v{};
  v[8] = 1;
  const Status status = parse_icdar_numbers(line, form == IcdarForm::score_word ? 9 : 8, v.data(), &line, fault);
  if (!is_ok(status)) return status;
  for (std::size_t i = 0; i < 4; ++i) out->quad.corner[i] = {v[2 * i], v[2 * i + 1]};
  out->word = line.empty() ? std::string_view(kUnreadText) : line;
  out->score = v[8];
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_LANDMARKS_ICDAR_HPP
