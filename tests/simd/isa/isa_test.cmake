# Compiles and checks (isa_check.cpp): cmake -DCOMPILER=... -DFLAGS=... -DOBJECTS=<prefix> -DCHECK=<isa_check> [...] -P isa_test.cmake
#   MODE=regions  SOURCE, HEADERS, EXPECT   compiles SOURCE for the baseline and checks where its instructions are
#   MODE=object   OBJECT, HEADERS, EXPECT   checks an object that the build has made
#   MODE=shared   SOURCE, WIDE, EXPECT      compiles SOURCE for the baseline and with the flags WIDE, and checks what they share
#   MODE=mixed    SOURCE, MAIN, EMULATOR    links SOURCE for three CPUs with MAIN, runs it here and, if given, in the EMULATOR
# EXPECT is the exit code of the checker that makes the test pass.
separate_arguments(FLAGS)
separate_arguments(WIDE)
separate_arguments(EMULATOR)
string(REPLACE "|" ";" HEADERS "${HEADERS}")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${result}: ${command}")
  endif()
endfunction()

function(compile source object)
  run(${COMPILER} -std=c++17 ${FLAGS} ${ARGN} -c ${source} -o ${OBJECTS}${object})
endfunction()

function(check)
  execute_process(COMMAND ${CHECK} ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL EXPECT)
    message(FATAL_ERROR "the checker says ${result}, expected ${EXPECT}")
  endif()
endfunction()

if(MODE STREQUAL "regions")
  compile(${SOURCE} baseline.o)
  check(regions ${OBJECTS}baseline.o ${HEADERS})
elseif(MODE STREQUAL "object")
  check(regions ${OBJECT} ${HEADERS})
elseif(MODE STREQUAL "shared")
  compile(${SOURCE} baseline.o)
  compile(${SOURCE} wide.o ${WIDE})
  check(shared ${OBJECTS}baseline.o ${OBJECTS}wide.o)
elseif(MODE STREQUAL "mixed")
  compile(${SOURCE} baseline.o -DTEXTPLANE_TEST_UNIT=baseline_unit)
  compile(${SOURCE} avx2.o -DTEXTPLANE_TEST_UNIT=avx2_unit -march=x86-64-v3)
  compile(${SOURCE} avx512.o -DTEXTPLANE_TEST_UNIT=avx512_unit -march=x86-64-v4)
  compile(${MAIN} main.o)
  check(regions ${OBJECTS}baseline.o)
  check(shared ${OBJECTS}baseline.o ${OBJECTS}avx2.o)
  check(shared ${OBJECTS}baseline.o ${OBJECTS}avx512.o)
  # The wide units first: the linker keeps the first copy of what is shared.
  run(${COMPILER} ${OBJECTS}avx512.o ${OBJECTS}avx2.o ${OBJECTS}baseline.o ${OBJECTS}main.o -o ${OBJECTS}mixed)
  run(${OBJECTS}mixed)
  if(EMULATOR)
    run(${EMULATOR} ${OBJECTS}mixed)
  endif()
else()
  message(FATAL_ERROR "MODE=${MODE}")
endif()
