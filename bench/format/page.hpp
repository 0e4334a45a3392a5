// Writes pages, whole or between marks.
#ifndef TEXTPLANE_BENCH_FORMAT_PAGE_HPP
#define TEXTPLANE_BENCH_FORMAT_PAGE_HPP

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace textplane_bench {

inline void write(const std::string& path, const std::string& content) {
  std::ofstream file(path);
  file << content;
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

/// Replaces what stands between `<!-- MARK: begin -->` and `<!-- MARK: end -->` of a file. False, and the file
/// unchanged, where it has no such marks.
inline bool replace_block(const std::string& path, const std::string& mark, const std::string& content) {
  std::ifstream in(path);
  std::stringstream all;
  all << in.rdbuf();
  std::string text = all.str();
  const std::string begin = "<!-- " + mark + ": begin -->\n", end = "<!-- " + mark + ": end -->";
  const std::size_t a = text.find(begin), b = text.find(end);
  if (a == std::string::npos || b == std::string::npos || b < a) return false;
  text.replace(a + begin.size(), b - a - begin.size(), content);
  write(path, text);
  return true;
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_PAGE_HPP
