# Compiles .proto files into a static library of their own, without our warnings: the code is protoc's.
include_guard(GLOBAL)

# fresco_proto_library(target file.proto...): headers are included as "msgs/proto/<name>.pb.h".
function(fresco_proto_library target)
  set(outputs)
  foreach(source IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE relative)
    cmake_path(REMOVE_EXTENSION relative OUTPUT_VARIABLE stem)
    set(generated ${CMAKE_BINARY_DIR}/protoc-cpp/${stem}.pb.cc ${CMAKE_BINARY_DIR}/protoc-cpp/${stem}.pb.h)
    add_custom_command(OUTPUT ${generated}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/protoc-cpp
      COMMAND protobuf::protoc --proto_path=${CMAKE_SOURCE_DIR} --cpp_out=${CMAKE_BINARY_DIR}/protoc-cpp ${path}
      DEPENDS ${path} COMMENT "protoc ${relative}" VERBATIM)
    list(APPEND outputs ${generated})
  endforeach()
  add_library(${target} STATIC ${outputs})
  # protoc gives names that every file has to each
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  target_include_directories(${target} SYSTEM PUBLIC $<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/protoc-cpp>)
  target_link_libraries(${target} PUBLIC protobuf::libprotobuf
    PRIVATE $<BUILD_INTERFACE:fresco_compile_options> $<BUILD_INTERFACE:fresco_quick_to_compile>)
endfunction()
