# Finds LCM (Debian's package has no CMake files, and its lcm.pc wants a package it does not
# pull in) and compiles .lcm files with lcm-gen.
include_guard(GLOBAL)

find_path(LCM_INCLUDE_DIR lcm/lcm.h REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)

add_library(fresco_lcm INTERFACE)
target_include_directories(fresco_lcm SYSTEM INTERFACE ${LCM_INCLUDE_DIR})
target_link_libraries(fresco_lcm INTERFACE ${LCM_LIBRARY})

# fresco_lcm_types(target package file.lcm...): an interface target with the generated C++ types,
# included as "<package>/<type>.hpp". Each file.lcm defines exactly the struct of its name.
function(fresco_lcm_types target package)
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/lcm-cpp)
  file(MAKE_DIRECTORY ${directory})
  set(outputs)
  foreach(source IN LISTS ARGN)
    cmake_path(GET source STEM stem)
    set(output ${directory}/${package}/${stem}.hpp)
    add_custom_command(OUTPUT ${output}
      COMMAND ${LCM_GEN} -x --cpp-std c++11 --cpp-hpath ${directory} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source}
      COMMENT "lcm-gen ${source}" VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  add_custom_target(${target}_generate DEPENDS ${outputs})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generate)
  target_include_directories(${target} SYSTEM INTERFACE ${directory})
  target_link_libraries(${target} INTERFACE fresco_lcm)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  set_target_properties(${target} PROPERTIES FRESCO_LCM_SOURCES "${sources}")
endfunction()

# fresco_lcm_java_sources(variable target package): sets the variable to the Java sources of the types of a target
# that fresco_lcm_types made.
function(fresco_lcm_java_sources variable target package)
  get_target_property(sources ${target} FRESCO_LCM_SOURCES)
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/lcm-java)
  file(MAKE_DIRECTORY ${directory})
  set(outputs)
  foreach(source IN LISTS sources)
    cmake_path(GET source STEM stem)
    set(output ${directory}/${package}/${stem}.java)
    add_custom_command(OUTPUT ${output} COMMAND ${LCM_GEN} -j --jpath ${directory} ${source}
      DEPENDS ${source} COMMENT "lcm-gen -j ${stem}.lcm" VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  set(${variable} ${outputs} PARENT_SCOPE)
endfunction()
