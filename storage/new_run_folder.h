// Where the results of a run go where no folder is named.
#pragma once

#include <filesystem>

namespace fresco {

/// runs/<time>-<process id>, below the present directory; it is not made. The time is UTC, now.
std::filesystem::path NewRunFolder();

}  // namespace fresco
