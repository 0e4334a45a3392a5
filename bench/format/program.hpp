// What the programs that write pages have in common: their arguments, and their end where something is wrong.
#ifndef TEXTPLANE_BENCH_FORMAT_PROGRAM_HPP
#define TEXTPLANE_BENCH_FORMAT_PROGRAM_HPP

#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "format/page.hpp"
#include "format/results.hpp"

namespace textplane_bench {

/// run(argc, argv), or the message of what it throws and exit code 1.
template <class Run>
int guarded(const char* program, int argc, char** argv, Run run) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << program << ": " << e.what() << "\n";
    return 1;
  }
}

/// The whole of a program `PROGRAM RUN.json PAGE.md`: tables(run) replaces the page's block `mark`.
template <class Tables>
int fill_block(const char* program, const char* mark, int argc, char** argv, Tables tables) {
  return guarded(program, argc, argv, [&](int count, char** given) {
    if (count != 3) {
      std::cerr << "usage: " << program << " RUN.json PAGE.md\n";
      return 2;
    }
    if (!replace_block(given[2], mark, tables(read_json(given[1]))))
      throw std::runtime_error(std::string(given[2]) + " has no marks for the tables");
    return 0;
  });
}

}  // namespace textplane_bench

#endif  // TEXTPLANE_BENCH_FORMAT_PROGRAM_HPP
