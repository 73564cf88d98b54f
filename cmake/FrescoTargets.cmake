# One place for what every target of Fresco is compiled with.
include_guard(GLOBAL)

add_library(fresco_compile_options INTERFACE)
target_compile_features(fresco_compile_options INTERFACE cxx_std_20)
target_include_directories(fresco_compile_options INTERFACE $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>)
target_compile_options(fresco_compile_options INTERFACE
  # The same expression must give the same bits for every processor and wherever it is inlined: the compiler may not
  # decide by itself which multiplications and additions it fuses. There is no -march: only the networks' arithmetic
  # (nn/) needs instructions that not every processor has, and chooses them at the start.
  -ffp-contract=off
  # Nobody reads errno after a square root; lets loops with one be vectorised, with the same bits.
  -fno-math-errno)
if(FRESCO_SANITIZE)
  list(JOIN FRESCO_SANITIZE "," fresco_sanitizers)
  target_compile_options(fresco_compile_options INTERFACE
    -fsanitize=${fresco_sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(fresco_compile_options INTERFACE -fsanitize=${fresco_sanitizers}
    # gcc's shared libubsan writes to standard error where libasan is there too, whatever log_path says.
    $<$<CXX_COMPILER_ID:GNU>:-static-libasan;-static-libubsan>)
endif()

add_library(fresco_warnings INTERFACE)
target_compile_options(fresco_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast -Wcast-qual -Wunused
  # gcc 12 reports values of std::optional that were checked
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  $<$<BOOL:${FRESCO_WARNINGS_AS_ERRORS}>:-Werror>)

# Most of the compiler's time is the optimiser's. So what no run spends time in, the command line, the reports and
# the tests, is compiled with little optimisation; with a sanitizer it and most rooms are compiled without any.
add_library(fresco_quick_to_compile INTERFACE)
target_compile_options(fresco_quick_to_compile INTERFACE
  $<$<NOT:$<CONFIG:Debug>>:$<IF:$<BOOL:${FRESCO_SANITIZE}>,-O0,-O1>>
  # gcc 12 reports code of std::string at -O1, which is sound
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict>)
# Rooms that tests and fuzzing spend their time in, so they have the optimiser with a sanitizer too.
set(FRESCO_ROOMS_OPTIMISED_WITH_SANITIZER fresco_core fresco_nn fresco_worlds fresco_planner fresco_bus fresco_msgs fresco_training)

# fresco_library(name sources... ): a folder's library, compiled with the common options.
function(fresco_library name)
  add_library(${name} STATIC ${ARGN})
  target_link_libraries(${name} PUBLIC fresco_compile_options PRIVATE $<BUILD_INTERFACE:fresco_warnings>)
  if(FRESCO_SANITIZE AND NOT name IN_LIST FRESCO_ROOMS_OPTIMISED_WITH_SANITIZER)
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:fresco_quick_to_compile>)
  endif()
endfunction()

# fresco_executable(name sources...)
function(fresco_executable name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE fresco_commit fresco_compile_options fresco_warnings)
endfunction()

add_library(fresco_test_options INTERFACE)
target_link_libraries(fresco_test_options INTERFACE fresco_quick_to_compile fresco_compile_options fresco_warnings)
target_compile_definitions(fresco_test_options INTERFACE $<$<BOOL:${FRESCO_SANITIZE}>:FRESCO_SANITIZED>)

# fresco_test_headers(name LIBRARIES ... HEADERS ...): headers that are compiled once for many tests.
function(fresco_test_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LIBRARIES;HEADERS")
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)  # CMake wants one, to know the language
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} fresco_test_options GTest::gmock GTest::gtest)
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
endfunction()

# Builds every test program that carries the label unit, and no more than that.
add_custom_target(unit_tests)

# fresco_test(name LABEL label SOURCES ... LIBRARIES ...): one gtest program, one CTest entry. STARTS_FIRST: it takes
# the longest, so CTest starts it before the others.
function(fresco_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STARTS_FIRST" "LABEL;TIMEOUT" "SOURCES;LIBRARIES")
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 600)
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} fresco_test_options GTest::gmock GTest::gtest GTest::gtest_main)
  # tests/CMakeLists.txt has the two. Eigen comes with everything that knows of networks.
  if(arg_LIBRARIES MATCHES "fresco_(nn|msgs|training|storage|actors|learner|logs|processes|report|paper|soak|tools)")
    target_precompile_headers(${name} REUSE_FROM fresco_eigen_test_headers)
  else()
    target_precompile_headers(${name} REUSE_FROM fresco_test_headers)
  endif()
  if(arg_LABEL STREQUAL "unit")
    add_dependencies(unit_tests ${name})
  endif()
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL} TIMEOUT ${arg_TIMEOUT})
  if(arg_STARTS_FIRST)
    set_tests_properties(${name} PROPERTIES COST 100)
  endif()
endfunction()

# fresco_optimise_with_sanitizer(sources...): sources of tests that take most of the tests' time with a sanitizer, such as
# slow literal versions. They have the optimiser there, which other sources of tests have not.
macro(fresco_optimise_with_sanitizer)
  if(FRESCO_SANITIZE)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O1 SKIP_PRECOMPILE_HEADERS ON)
  endif()
endmacro()
