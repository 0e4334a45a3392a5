# Makes one page of index.html and the style sheet and scripts that it names, and a .cpp that holds the page.
# Run as: cmake -DVIEWER=<this folder> -DOUTPUT=<file.cpp> -P embed.cmake
set(PAGE ${VIEWER}/index.html)
set(FOLDERS ${VIEWER})
set(output ${OUTPUT})
set(OUTPUT ${output}.html)
include(${CMAKE_CURRENT_LIST_DIR}/inline.cmake)

# As numbers: a page is longer than a string literal may be.
file(READ ${output}.html bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
file(WRITE ${output} "#include \"textslam/report/report_template.hpp\"

namespace textslam {
namespace {

constexpr unsigned char kPage[] = {
${bytes}
};

}  // namespace

std::string_view report_template() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace textslam
")
