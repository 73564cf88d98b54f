# Finds libsodium (Debian's package has no CMake files).
include_guard(GLOBAL)

find_path(SODIUM_INCLUDE_DIR sodium.h REQUIRED)
find_library(SODIUM_LIBRARY sodium REQUIRED)

add_library(fresco_sodium INTERFACE)
target_include_directories(fresco_sodium SYSTEM INTERFACE ${SODIUM_INCLUDE_DIR})
target_link_libraries(fresco_sodium INTERFACE ${SODIUM_LIBRARY})
