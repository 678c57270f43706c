# cmake -DSOURCES=… -DOUTPUT=… -P commit.cmake: writes OUTPUT, in which the millscope command reads of which commit it is, where that has
# changed. Sources that are no git checkout of their own have none, whatever repository they lie in.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git -C ${SOURCES} rev-parse --show-toplevel OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(commit "")
if(top)
  file(REAL_PATH "${top}" top)
  file(REAL_PATH "${SOURCES}" sources)
  if(top STREQUAL sources)
    execute_process(COMMAND git -C ${SOURCES} describe --always --dirty --abbrev=12 OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                    ERROR_QUIET)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Written by commit.cmake.
namespace millscope::base {
const char* commit();
const char* commit() { return \"${commit}\"; }
}  // namespace millscope::base
")
