#include "tests/report/picture_files.h"

#include <cstdlib>
#include <iterator>
#include <sstream>

namespace fresco {

int FileCount(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

bool ParsesAsXml(const std::filesystem::path& path) {
  const std::string command =
      "python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' '" + path.string() + "'";
  return std::system(command.c_str()) == 0;
}

std::pair<unsigned, unsigned> PngSize(const std::string& content) {
  const std::string signature("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  const std::string end("IEND\xAE\x42\x60\x82", 8);
  if (!content.starts_with(signature) || !content.ends_with(end)) {
    return {0, 0};
  }
  const auto number = [&](size_t at) {
    unsigned value = 0;
    for (size_t i = at; i < at + 4; ++i) {
      value = value << 8 | static_cast<unsigned char>(content[i]);
    }
    return value;
  };
  return {number(16), number(20)};
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

std::vector<std::vector<double>> DataBlock(const std::string& script, const std::string& name) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(script);
  std::string line;
  while (std::getline(lines, line) && line != "$" + name + " << END") {
  }
  while (std::getline(lines, line) && line != "END") {
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      rows.back().push_back(std::strtod(word.c_str(), nullptr));
    }
  }
  return rows;
}

}  // namespace fresco
