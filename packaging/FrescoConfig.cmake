# find_package(Fresco): the libraries Fresco::worlds, Fresco::planner, Fresco::nn, Fresco::msgs and Fresco::storage, with what they need.
# Includes are those of the source tree: "worlds/world.h", "msgs/experiment.h", "msgs/proto/experiment.pb.h",
# "fresco/run_t.hpp". The header of plug-ins is <fresco/world.h>.
set(fresco_module_path ${CMAKE_MODULE_PATH})
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
set(fresco_missing)
foreach(fresco_needed IN ITEMS Threads:g++ CLI11:libcli11-dev Eigen3:libeigen3-dev fmt:libfmt-dev Lcm:liblcm-dev
    PNG:libpng-dev Protobuf:libprotobuf-dev Sodium:libsodium-dev nlohmann_json:nlohmann-json3-dev spdlog:libspdlog-dev)
  string(REPLACE ":" ";" fresco_needed ${fresco_needed})  # CMake's name, and Debian's of the package that has it
  list(POP_BACK fresco_needed fresco_debian_package)
  find_package(${fresco_needed} QUIET)
  if(NOT ${fresco_needed}_FOUND)
    list(APPEND fresco_missing ${fresco_debian_package})
  endif()
endforeach()
set(CMAKE_MODULE_PATH ${fresco_module_path})

if(fresco_missing)
  list(JOIN fresco_missing " " fresco_missing)
  set(Fresco_FOUND FALSE)
  set(Fresco_NOT_FOUND_MESSAGE "Fresco's libraries need the Debian packages ${fresco_missing}, which are not there. \
Install them: apt-get install ${fresco_missing}")
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/FrescoTargets.cmake)
