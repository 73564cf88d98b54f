// Reads the map of a scenario from a picture. Any thread may call this function.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fresco {

/// Reads a PNG file with a pixel for each cell, and returns the cells as `scenario.map_row` has them, the
/// northern row first. The colours are those of public data sets of this field: red no flying (N), green
/// blocks radio (R), yellow both (B), blue start and landing (S), black or white free (.). Each of red, green
/// and blue has to be 0 or 255; what is transparent counts as black. Throws UsageError if the file can't be
/// read, is no PNG, has another colour (it names the pixel) or too many pixels.
std::vector<std::string> ReadMapFile(const std::filesystem::path& path);

}  // namespace fresco
