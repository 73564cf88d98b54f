# Lcm::lcm, the library LCM. Debian's package has no CMake files, and its lcm.pc wants a package that it does not pull in.
# An installation of Fresco uses this file, too.
find_path(LCM_INCLUDE_DIR lcm/lcm.h)
find_library(LCM_LIBRARY lcm)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Lcm REQUIRED_VARS LCM_LIBRARY LCM_INCLUDE_DIR)
if(Lcm_FOUND AND NOT TARGET Lcm::lcm)
  add_library(Lcm::lcm UNKNOWN IMPORTED)
  set_target_properties(Lcm::lcm PROPERTIES
    IMPORTED_LOCATION ${LCM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${LCM_INCLUDE_DIR})
endif()
