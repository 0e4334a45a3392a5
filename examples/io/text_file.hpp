// Text input: whole files, lines with their numbers, strict numbers. All readers of this folder use it.
#ifndef TEXTSLAM_IO_TEXT_FILE_HPP
#define TEXTSLAM_IO_TEXT_FILE_HPP

#include <string>
#include <string_view>
#include <vector>

#include "io/input_error.hpp"
#include "textplane/core/parse_number.hpp"

namespace textslam {

/// The bytes of a file of at most 1 GiB. Throws InputError with the system's reason when it cannot be opened or read.
std::string read_file(const std::string& path);

struct TextLine {
  std::string text;  ///< without line end
  int number = 0;    ///< from 1
};

/// The lines of a text file that are not blank; LF or CR LF; a byte-order mark is dropped. Throws InputError for a file
/// that cannot be read, and with the line for a NUL byte, which no text has.
std::vector<TextLine> read_lines(const std::string& path);

using textplane::trimmed;  ///< Without blanks at both ends.
/// The runs of characters between blanks.
std::vector<std::string_view> split_blanks(std::string_view text);

/// A finite decimal number and nothing else but blanks at its ends; independent of the locale. False for NaN, infinity
/// and overflow.
bool parse_number(std::string_view text, double* value);
/// parse_number(), or InputError that quotes the text and says that `what` should be a number.
double require_number(std::string_view text, const std::string& file, int line, const std::string& what);
/// What it throws.
InputError not_a_number(std::string_view text, const std::string& file, int line, const std::string& what);
/// The text for a message: at most 40 characters, with '?' for characters that cannot be printed.
std::string shown(std::string_view text);
/// The shortest decimal that reads back as the same double; "-0" becomes "0".
std::string shortest(double value);
/// The text with every byte that is not part of well-formed UTF-8 replaced by U+FFFD.
std::string well_formed_utf8(std::string_view text);

}  // namespace textslam

#endif  // TEXTSLAM_IO_TEXT_FILE_HPP
