// Whether results can be written to a folder: asked before anything is done.
#pragma once

#include <filesystem>
#include <string>

namespace fresco {

/// Throws UsageError, naming `option` and the cause, unless `folder` is a folder that this process may write
/// to, or can be made. Makes nothing.
void CheckOutputFolder(const std::filesystem::path& folder, const std::string& option = "--out");

}  // namespace fresco
