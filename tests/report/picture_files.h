// What the tests of figures share: they look into files and scripts of pictures.
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

/// Returns width and height from the header of a PNG; zeros if the text does not begin and end like a PNG.
std::pair<unsigned, unsigned> PngSize(const std::string& content);

int Count(const std::string& text, const std::string& part);

/// Returns the numbers of the datablock `$name` of a gnuplot script, line by line. An empty line is an empty
/// row.
std::vector<std::vector<double>> DataBlock(const std::string& script, const std::string& name);

}  // namespace fresco
