// What the tests of figures share: a look at the files of pictures.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace fresco {

/// The number of files in a folder.
int FileCount(const std::filesystem::path& folder);

/// Whether a strict parser of another project (expat, in Python) accepts the file.
bool ParsesAsXml(const std::filesystem::path& path);

/// Width and height in the header of a PNG with its signature and its last chunk; zeros where it is none.
std::pair<unsigned, unsigned> PngSize(const std::string& content);

int Count(const std::string& text, const std::string& part);

/// The numbers of the datablock `$name` of a gnuplot script, line by line; an empty line is an empty row.
std::vector<std::vector<double>> DataBlock(const std::string& script, const std::string& name);

}  // namespace fresco
