# docs/first_minutes.md prints the program that the test consumers.single_header builds and runs.
file(READ ${ROOT}/docs/first_minutes.md page)
file(READ ${ROOT}/tests/consumers/single_header/main.cpp program)
string(FIND "${page}" "```cpp\n${program}```" at)
if(at LESS 0)
  message(FATAL_ERROR "docs/first_minutes.md does not hold tests/consumers/single_header/main.cpp as it is")
endif()
