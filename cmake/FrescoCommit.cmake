# The commit that the programs are built from, as they show it: kSourceCommit (core/installation.h). Run as a script
# (by the command below), it writes FILE, a C++ source with the commit that FOLDER is at, if it is not the same already.
if(CMAKE_SCRIPT_MODE_FILE)
  # Only FOLDER's own history counts, not that of a repository that a tarball was unpacked in.
  execute_process(COMMAND git --git-dir=${FOLDER}/.git --work-tree=${FOLDER} describe --always --dirty
    WORKING_DIRECTORY ${FOLDER} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    set(commit unknown)
  endif()
  file(CONFIGURE OUTPUT ${FILE} CONTENT [[
#include "core/installation.h"
const char* const fresco::kSourceCommit = "${commit}";
]])
  return()
endif()
include_guard(GLOBAL)

# A library of its own, which only programs have: a new commit compiles one line and links the programs, no test.
set(commit_source ${CMAKE_BINARY_DIR}/source_commit.cc)
add_custom_target(fresco_commit_source
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_SOURCE_DIR} -DFILE=${commit_source} -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${commit_source} COMMENT "" VERBATIM)
add_library(fresco_commit STATIC ${commit_source})
add_dependencies(fresco_commit fresco_commit_source)
target_link_libraries(fresco_commit PRIVATE fresco_compile_options fresco_warnings)
