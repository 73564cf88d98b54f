// Runs Debian's gnuplot, turns its scripts into picture files (SVG and PNG), and makes the parts that all
// figures share: legend, title, axes. The same picture gives the same bytes on the same machine. Any thread
// may call these functions; every run of gnuplot is a process of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fresco {

/// The colours of Okabe and Ito, which people with any kind of colour vision can distinguish, in gnuplot's
/// form "#RRGGBB".
namespace colour {
inline constexpr const char* kBlack = "#000000";
inline constexpr const char* kOrange = "#E69F00";
inline constexpr const char* kSkyBlue = "#56B4E9";
inline constexpr const char* kGreen = "#009E73";
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kVermillion = "#D55E00";
inline constexpr const char* kPurple = "#CC79A7";
inline constexpr const char* kGrey = "#777777";  // this and the following are not of Okabe and Ito
inline constexpr const char* kText = "#222222";
inline constexpr const char* kGrid = "#DDDDDD";
}  // namespace colour

inline constexpr int64_t kGnuplotTimeoutUs = 60'000'000;

/// Runs gnuplot on `script` without any settings of the user or the system, and returns its standard output.
/// Throws Failure if gnuplot is not in PATH (the error names its Debian package), if gnuplot reports an error
/// (the error quotes it), or if it takes longer than `timeout_us`; it is killed then.
std::string RunGnuplot(const std::string& script, int64_t timeout_us = kGnuplotTimeoutUs);

/// Returns `text` as a quoted string for a script, in which no character is special to gnuplot (the terminal
/// must be `noenhanced`). Characters that a picture can't show become spaces (line ends, control characters)
/// or U+FFFD (bytes that are not UTF-8).
std::string GnuplotString(std::string_view text);

struct Picture {
  int width_px = 0;   ///< of the SVG file; the PNG file is twice as wide
  int height_px = 0;  ///< of the SVG file; the PNG file is twice as high
  /// The gnuplot commands, without those that set the terminal. GnuplotString makes the texts in it.
  std::string script;
};

/// Writes `<stem>.svg` and `<stem>.png`, each completely or not at all. If gnuplot fails, writes neither.
/// Throws what RunGnuplot and WriteFileAtomically throw.
void WritePicture(const Picture& picture, const std::filesystem::path& stem);

/// Returns the text of the SVG file. Throws as RunGnuplot does.
std::string SvgText(const Picture& picture);

/// An entry of the legend below the plot, which explains a line or a mark. (gnuplot's own legend is not used:
/// its width, and so its position, depends on the kind of file.)
struct LegendEntry {
  std::string name;
  std::string colour;  ///< gnuplot's option: "linecolor rgb '#000000'"
  std::string line;    ///< further options of the line; empty: no line
  std::string point;   ///< further options of the point; empty: no point
};

/// A legend of one or more centred rows along the lower edge of a picture.
class Legend {
 public:
  Legend(std::vector<LegendEntry> entries, int width_px);

  int height_px() const;
  /// Returns the commands that draw the legend in a picture of this height.
  std::string Script(int picture_height_px) const;

 private:
  struct Row {
    std::vector<LegendEntry> entries;
    double width_px = 0;
  };
  int width_px_;
  std::vector<Row> rows_;
};

/// What every figure begins with: title, labels of the axes, margins.
struct Frame {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string right_label{};  ///< label along the right edge
  int left_px = 76;
  int right_px = 24;
  int top_px = 48;
  int bottom_px = 70;  ///< without the legend
};
/// Returns the commands for the frame, the fonts and the colours of a figure.
std::string FrameScript(const Frame& frame, const Picture& picture, const Legend& legend);

}  // namespace fresco
