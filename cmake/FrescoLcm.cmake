# Compiles .lcm files with lcm-gen.
include_guard(GLOBAL)

find_program(LCM_GEN lcm-gen REQUIRED)
set(FRESCO_DESCRIBE_MESSAGES ${CMAKE_SOURCE_DIR}/msgs/describe_messages.py)

# fresco_lcm_types(target package file.lcm...): an interface target with the generated C++ types,
# included as "<package>/<type>.hpp". Each file.lcm defines exactly the struct of its name. What LCM's own code
# does not tell of them is in "<package>/message_descriptions.hpp".
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
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  set(descriptions ${directory}/${package}/message_descriptions.hpp)
  add_custom_command(OUTPUT ${descriptions}
    COMMAND Python3::Interpreter ${FRESCO_DESCRIBE_MESSAGES} --cpp ${descriptions} ${sources}
    DEPENDS ${FRESCO_DESCRIBE_MESSAGES} ${sources} COMMENT "describe the messages" VERBATIM)
  add_custom_target(${target}_generate DEPENDS ${outputs} ${descriptions})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generate)
  target_include_directories(${target} SYSTEM INTERFACE $<BUILD_INTERFACE:${directory}>)
  target_link_libraries(${target} INTERFACE Lcm::lcm)
  set_target_properties(${target} PROPERTIES FRESCO_LCM_SOURCES "${sources}" FRESCO_LCM_HEADERS ${directory})
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

# fresco_lcm_java_descriptions(variable target): sets the variable to a Java source, MessageTypes.java, that
# describes the messages of a target that fresco_lcm_types made.
function(fresco_lcm_java_descriptions variable target)
  get_target_property(sources ${target} FRESCO_LCM_SOURCES)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/java/MessageTypes.java)
  add_custom_command(OUTPUT ${output}
    COMMAND Python3::Interpreter ${FRESCO_DESCRIBE_MESSAGES} --java ${output} ${sources}
    DEPENDS ${FRESCO_DESCRIBE_MESSAGES} ${sources} COMMENT "describe the messages for Java" VERBATIM)
  set(${variable} ${output} PARENT_SCOPE)
endfunction()

# fresco_lcm_python_package(target package parent folder): the Python package `parent`.`package` of the types of a target
# that fresco_lcm_types made, as a folder in `folder`, and beside it message_types.py, which describes them. The target
# python_`target` makes it.
function(fresco_lcm_python_package target package parent folder)
  get_target_property(sources ${target} FRESCO_LCM_SOURCES)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/lcm-python)
  set(descriptions ${folder}/message_types.py)
  file(MAKE_DIRECTORY ${generated}/${parent}/${package} ${folder})
  file(CREATE_LINK ${generated}/${parent}/${package} ${folder}/${package} SYMBOLIC)
  add_custom_command(OUTPUT ${descriptions}
    COMMAND ${LCM_GEN} -p --ppath ${generated} --package-prefix ${parent} ${sources}
    COMMAND Python3::Interpreter ${FRESCO_DESCRIBE_MESSAGES} --python ${descriptions} ${sources}
    DEPENDS ${FRESCO_DESCRIBE_MESSAGES} ${sources} COMMENT "lcm-gen for Python" VERBATIM)
  add_custom_target(python_${target} ALL DEPENDS ${descriptions})
  set_target_properties(python_${target} PROPERTIES FRESCO_LCM_PYTHON ${generated}/${parent}/${package})
endfunction()
