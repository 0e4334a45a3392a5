// parse_number(): decimal numbers of text files, whatever the program's locale.
#ifndef TEXTPLANE_CORE_PARSE_NUMBER_HPP
#define TEXTPLANE_CORE_PARSE_NUMBER_HPP

#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>

#include "textplane/core/numeric.hpp"
#include "textplane/core/status.hpp"

TEXTPLANE_BEGIN_NAMESPACE

/// Without blanks (space, tab, carriage return, form feed) at both ends.
inline std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view blank = " \t\r\v\f";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return text.substr(text.size());
  return text.substr(first, text.find_last_not_of(blank) + 1 - first);
}

/// A finite decimal number, correctly rounded, and nothing else but blanks at its ends. Status::non_finite for NaN and
/// infinity in words, invalid_argument for anything else and for what S cannot hold; *value is then untouched. It is
/// compiled where it is called, and needs the standard library's std::from_chars of S (libstdc++ 11).
template <class S>
Status parse_number(std::string_view text, S* value) noexcept {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  S parsed{};
  const std::from_chars_result read = std::from_chars(text.data(), end, parsed);
  if (read.ec != std::errc() || read.ptr != end) return Status::invalid_argument;
  if (!is_finite(parsed)) return Status::non_finite;
  *value = parsed;
  return Status::ok;
}

TEXTPLANE_END_NAMESPACE

#endif  // TEXTPLANE_CORE_PARSE_NUMBER_HPP
