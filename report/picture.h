// A figure as a script that draws it, its legend and its two files: SVG for papers and browsers, PNG for
// everything else. The same picture gives the same bytes on the same machine. Any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fresco {

/// Okabe and Ito's colours, which people with any kind of colour vision can tell apart, as gnuplot's
/// "rgb '#RRGGBB'" wants them.
namespace colour {
inline constexpr const char* kBlack = "#000000";
inline constexpr const char* kOrange = "#E69F00";
inline constexpr const char* kSkyBlue = "#56B4E9";
inline constexpr const char* kGreen = "#009E73";
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kVermillion = "#D55E00";
inline constexpr const char* kPurple = "#CC79A7";
inline constexpr const char* kGrey = "#777777";  // not theirs
inline constexpr const char* kText = "#222222";
inline constexpr const char* kGrid = "#DDDDDD";
}  // namespace colour

struct Picture {
  int width_px = 0;  ///< of the SVG; the PNG has twice as many either way
  int height_px = 0;
  /// What gnuplot is to draw, without a terminal. Texts in it come from GnuplotString.
  std::string script;
};

/// Writes `<stem>.svg` and `<stem>.png`, each of them whole or not at all, and none where gnuplot fails.
/// Throws what RunGnuplot and WriteFileAtomically throw.
void WritePicture(const Picture& picture, const std::filesystem::path& stem);

/// What explains a line or a mark below the plot. gnuplot's own legend has another width in each kind of
/// file, and so doesn't stay in its place.
struct LegendEntry {
  std::string name;
  std::string colour;  ///< gnuplot's option: "linecolor rgb '#000000'"
  std::string line;    ///< other line options; empty: no line
  std::string point;   ///< other point options; empty: no point
};

/// A legend of one or more centred rows along the lower edge of a picture.
class Legend {
 public:
  Legend(std::vector<LegendEntry> entries, int width_px);

  int height_px() const;
  /// The commands that draw it in a picture of that height.
  std::string Script(int picture_height_px) const;

 private:
  struct Row {
    std::vector<LegendEntry> entries;
    double width_px = 0;
  };
  int width_px_;
  std::vector<Row> rows_;
};

/// The part that every figure begins with: title, axes' labels, fonts, colours, margins in pixels.
struct Frame {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string right_label{};  ///< along the right edge
  int left_px = 76;
  int right_px = 24;
  int top_px = 48;
  int bottom_px = 70;  ///< without the legend
};
std::string FrameScript(const Frame& frame, const Picture& picture, const Legend& legend);

}  // namespace fresco
