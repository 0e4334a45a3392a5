# Compiles all kernels by clang++ for MSVC's target, and looks for those of each SIMD target in the object. MSVC's own
# headers cannot be had here: those of MinGW and its libstdc++ stand in, which take __GNUC__ and these macros for granted.
# Nothing is linked or run.
#   CLANG, GCC (of MinGW), MINGW (its headers), EIGEN, NM, ROOT, OBJECT
execute_process(COMMAND ${GCC} -print-file-name=include/c++ OUTPUT_VARIABLE library OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CLANG} -print-resource-dir OUTPUT_VARIABLE own OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)

# compile(WHAT FLAGS...)
function(compile what)
  execute_process(COMMAND ${CLANG} --target=x86_64-pc-windows-msvc -fms-compatibility -fms-extensions
    -fms-compatibility-version=19.30 -fgnuc-version=12 -D__declspec=__declspec -Wno-\#warnings -nostdinc++
    -isystem ${ROOT}/tests/msvc -isystem ${library} -isystem ${library}/x86_64-w64-mingw32 -isystem ${own}/include
    -isystem ${MINGW} -isystem ${EIGEN} -I ${ROOT}/include -std=c++17 -O1 -DNDEBUG -Wall -Wextra -Werror
    -DTEXTPLANE_EXTERN_KERNELS ${ARGN} -c ${ROOT}/cmake/kernels.cpp -o ${OBJECT} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "clang++ does not compile the kernels ${what}")
  endif()
  execute_process(COMMAND ${NM} ${OBJECT} OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE ${OBJECT})
  foreach(target scalar sse41 avx2 avx512)
    if(NOT names MATCHES " T \\?linearise_pose@${target}@")
      message(FATAL_ERROR "the object ${what} has no kernels of ${target}")
    endif()
  endforeach()
endfunction()

compile("for MSVC's target")
# What MSVC itself is given: no pragmas, vectors that are unions, and its own building blocks. It would take the
# instructions without asking.
compile("as MSVC" "-DTEXTPLANE_UNION_VECTORS=\"simd/union_vectors.hpp\"" -I ${ROOT}/tests -fno-lax-vector-conversions
  -mavx2 -mfma -mpopcnt -mavx512f -mavx512bw -mavx512dq -mavx512vl -mavx512vnni)
