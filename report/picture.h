// Turns gnuplot scripts into picture files (SVG and PNG), and makes the parts that all figures share: legend,
// title, axes. The same picture gives the same bytes on the same machine. Any thread may call these
// functions.
#pragma once

#include <filesystem>
#include <string>
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

struct Picture {
  int width_px = 0;   ///< of the SVG file; the PNG file is twice as wide
  int height_px = 0;  ///< of the SVG file; the PNG file is twice as high
  /// The gnuplot commands, without those that set the terminal. GnuplotString makes the texts in it.
  std::string script;
};

/// Writes `<stem>.svg` and `<stem>.png`, each completely or not at all. If gnuplot fails, writes neither.
/// Throws what RunGnuplot and WriteFileAtomically throw.
void WritePicture(const Picture& picture, const std::filesystem::path& stem);

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
