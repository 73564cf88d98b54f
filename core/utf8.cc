#include "core/utf8.h"

#include <algorithm>

namespace fresco {

size_t Utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const size_t length = byte(0) < 0x80                      ? 1
                        : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                        : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                        : byte(0) >= 0xF0 && byte(0) < 0xF5 ? 4
                                                            : 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const unsigned first_two = byte(0) << 8 | byte(1);
  const bool overlong = length > 2 && (first_two < 0xE0A0 || (first_two >= 0xF080 && first_two < 0xF090));
  const bool surrogate = length == 3 && first_two >= 0xEDA0 && first_two < 0xEE00;
  const bool beyond = length == 4 && first_two >= 0xF490;
  const bool not_a_character = length == 3 && first_two == 0xEFBF && byte(2) >= 0xBE;  // U+FFFE, U+FFFF
  return overlong || surrogate || beyond || not_a_character ? 0 : length;
}

size_t CharacterCount(std::string_view text) {
  size_t count = 0;
  for (; !text.empty(); ++count) {
    text.remove_prefix(std::max<size_t>(Utf8Length(text), 1));
  }
  return count;
}

std::string_view FirstCharacters(std::string_view text, size_t characters) {
  size_t bytes = 0;
  for (; characters > 0 && bytes < text.size(); --characters) {
    bytes += std::max<size_t>(Utf8Length(text.substr(bytes)), 1);
  }
  return text.substr(0, bytes);
}

std::string Printable(std::string_view text) {
  std::string printable;
  while (!text.empty()) {
    const size_t length = Utf8Length(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    text.remove_prefix(character.size());
    const auto first = static_cast<unsigned char>(character[0]);
    const bool control = (length == 1 && (first < 0x20 || first == 0x7F)) ||
                         (length == 2 && first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
    printable += control ? " " : length == 0 ? "\uFFFD" : std::string(character);
  }
  return printable;
}

}  // namespace fresco
