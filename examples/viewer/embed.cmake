# Makes one page of index.html and the style sheet and scripts that it names, and a .cpp that holds the page.
# Run as: cmake -DVIEWER=<this folder> -DOUTPUT=<file.cpp> -P embed.cmake
file(READ ${VIEWER}/index.html page)
foreach(name IN ITEMS style.css maths.js scene.js view.js playback.js plots.js table.js provenance.js main.js)
  file(READ ${VIEWER}/${name} text)
  if(name MATCHES "css$")
    set(link "<link rel=\"stylesheet\" href=\"${name}\">")
    set(inline "<style>\n${text}</style>")
  else()
    set(link "<script src=\"${name}\"></script>")
    set(inline "<script>\n${text}</script>")
  endif()
  string(FIND "${page}" "${link}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "index.html does not name ${name}")
  endif()
  string(REPLACE "${link}" "${inline}" page "${page}")
endforeach()
if(page MATCHES "(src|href)=\"[a-z]+[.](js|css)\"")
  message(FATAL_ERROR "index.html names a file that embed.cmake does not: ${CMAKE_MATCH_0}")
endif()

# As numbers: a page is longer than a string literal may be.
file(WRITE ${OUTPUT}.html "${page}")
file(READ ${OUTPUT}.html bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"textslam/report/report_template.hpp\"

namespace textslam {
namespace {

constexpr unsigned char kPage[] = {
${bytes}
};

}  // namespace

std::string_view report_template() { return {reinterpret_cast<const char*>(kPage), sizeof kPage}; }

}  // namespace textslam
")
