// Whole files, or none: what is written here is either completely there after a crash or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fresco {

/// Writes `content` to a temporary file beside `path`, syncs it, renames it over `path` and syncs
/// the directory. Throws Failure naming the path and the cause (a full disk, say); `path` is then
/// what it was before.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

/// Whether this is the temporary file of WriteFileAtomically, left by a process that was killed.
bool IsTemporaryOfAtomicFile(const std::filesystem::path& path);

/// The content of a file. Throws UsageError naming the path where it can't be read.
std::string ReadFile(const std::filesystem::path& path);

}  // namespace fresco
