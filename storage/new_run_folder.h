// Names the folder for the results of a run if the command line does not.
#pragma once

#include <filesystem>

namespace fresco {

/// Returns runs/<time>-<process id> below the current directory; the time is the present one, UTC. Does not
/// make the folder. Any thread may call it.
std::filesystem::path NewRunFolder();

}  // namespace fresco
