#include "io/text_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>

namespace textslam {

namespace {

constexpr std::size_t kMaxFileSize = std::size_t(1) << 30;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Length of the well-formed UTF-8 sequence (Unicode table 3-7) at the front of `s`, or 0.
std::size_t utf8_length(std::string_view s) {
  const auto byte = [&](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0U; };
  const auto in = [&](std::size_t i, unsigned low, unsigned high) { return byte(i) >= low && byte(i) <= high; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return in(1, 0x80, 0xBF) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    const bool second = in(1, lead == 0xE0 ? 0xA0 : 0x80, lead == 0xED ? 0x9F : 0xBF);
    return second && in(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    const bool second = in(1, lead == 0xF0 ? 0x90 : 0x80, lead == 0xF4 ? 0x8F : 0xBF);
    return second && in(2, 0x80, 0xBF) && in(3, 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

}  // namespace

std::string read_file(const std::string& path) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path, 0, std::strerror(errno));
  std::string bytes;
  std::string block(std::size_t(1) << 16, '\0');
  while (const std::size_t n = std::fread(&block[0], 1, block.size(), file.get())) {
    if (bytes.size() + n > kMaxFileSize) throw InputError(path, 0, "the file is larger than 1 GiB");
    bytes.append(block, 0, n);
  }
  if (std::ferror(file.get())) throw InputError(path, 0, std::strerror(errno));
  return bytes;
}

std::vector<TextLine> read_lines(const std::string& path) {
  const std::string bytes = read_file(path);
  std::string_view rest = bytes;
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest.remove_prefix(kByteOrderMark.size());
  std::vector<TextLine> lines;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.find('\0') != std::string_view::npos) throw InputError(path, number, "this is not a text file");
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (!trimmed(line).empty()) lines.push_back({std::string(line), number});
  }
  return lines;
}

std::vector<std::string_view> split_blanks(std::string_view text) {
  std::vector<std::string_view> words;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    std::size_t n = 0;
    while (n < text.size() && !is_blank(text[n])) ++n;
    words.push_back(text.substr(0, n));
    text.remove_prefix(n);
  }
  return words;
}

bool parse_number(std::string_view text, double* value) {
  return textplane::is_ok(textplane::parse_number(text, value));
}

double require_number(std::string_view text, const std::string& file, int line, const std::string& what) {
  double value = 0;
  if (!parse_number(text, &value)) throw not_a_number(text, file, line, what);
  return value;
}

InputError not_a_number(std::string_view text, const std::string& file, int line, const std::string& what) {
  return {file, line, what + " should be a finite number, not " + shown(trimmed(text))};
}

std::string shown(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kShown)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > kShown ? "...'" : "'");
}

std::string shortest(double value) {
  char digits[32];
  if (value == 0) value = 0;
  const auto result = std::to_chars(digits, digits + sizeof digits, value);
  return std::string(digits, result.ptr);
}

std::string well_formed_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = utf8_length(text);
    if (n == 0) {
      out += "\xEF\xBF\xBD";
    } else {
      out += text.substr(0, n);
    }
    text.remove_prefix(n == 0 ? 1 : n);
  }
  return out;
}

}  // namespace textslam
