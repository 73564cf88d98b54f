# Writes FILE, a header with the commit that FOLDER is at, if it is not the same already.
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY ${FOLDER}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define FRESCO_BENCH_COMMIT \"${commit}\"\n")
