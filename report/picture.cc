#include "report/picture.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "core/child_process.h"
#include "core/error.h"
#include "core/files.h"
#include "core/utf8.h"

namespace fresco {
namespace {

/// A file in memory, used for gnuplot's input and output instead of a pipe. Neither side waits for the other,
/// so there are no full or closed pipes to handle.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& content = "") : descriptor_(memfd_create("gnuplot", MFD_CLOEXEC)) {
    std::ofstream stream(path(), std::ios::binary);
    stream << content << std::flush;
    if (!stream) {
      throw Failure(std::string("gnuplot: can't make a file in memory: ") + std::strerror(errno));
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }
  std::string Content() const { return ReadFile(path()); }

 private:
  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

  int descriptor_;
};

/// Returns the character escaped. A backquote becomes "\\140", since it would run a command even after a
/// backslash.
std::string OctalEscape(char character) {
  const auto digit = [&](int shift) { return static_cast<char>('0' + ((character >> shift) & 7)); };
  return {'\\', digit(6), digit(3), digit(0)};
}

constexpr int kFontPx = 14;
constexpr int kTitlePx = 16;
// Every system has Arial or a font with the same widths.
constexpr const char* kFont = "Arial";

constexpr double kPointsPerPixel = 0.75;

/// The SVG terminal counts fonts in pixels, the PNG terminal in points.
std::string TerminalScript(const Picture& picture, bool png) {
  const std::string common = fmt::format("noenhanced background '#FFFFFF' font '{},{}'", kFont,
                                         png ? kFontPx * kPointsPerPixel : kFontPx);
  const std::string terminal =
      png ? fmt::format(
                "set terminal pngcairo size {},{} {} fontscale 2 linewidth 2 pointscale 3.3 dashlength 2\n",
                2 * picture.width_px, 2 * picture.height_px, common)
          : fmt::format("set terminal svg name 'fresco' size {},{} {}\n", picture.width_px, picture.height_px,
                        common);
  return terminal + fmt::format("title_font = ',{}'\n", png ? kTitlePx * kPointsPerPixel : kTitlePx);
}

std::string Render(const Picture& picture, bool png) {
  std::string content = RunGnuplot(TerminalScript(picture, png) + picture.script);
  if (content.empty()) {
    throw Failure("gnuplot drew nothing, though it reported no error; is it Debian's gnuplot-nox?");
  }
  return content;
}

// Lengths of a legend, in pixels.
constexpr double kLinePx = 36;
constexpr double kPointPx = 14;
constexpr double kSampleToTextPx = 8;
constexpr double kBetweenEntriesPx = 28;
constexpr int kRowPx = 24;
constexpr int kBelowPx = 10;

constexpr double kEdgePx = 18;  // from the middle of an axis's label to the picture's edge or the legend

/// Estimates the width of a text in Arial. The legend does not need the exact width.
double TextWidthPx(const std::string& text) {
  double width = 0;
  for (const char letter : text) {
    const bool narrow = std::string_view("Iijlft.,:;'()[]|!- ").find(letter) != std::string_view::npos;
    const bool wide = (letter >= 'A' && letter <= 'Z') || letter == 'm' || letter == 'w';
    const bool continues = (static_cast<unsigned char>(letter) & 0xC0) == 0x80;  // UTF-8
    width += continues ? 0 : narrow ? 0.29 : wide ? 0.72 : 0.54;
  }
  return kFontPx * width;
}

double SamplePx(const LegendEntry& entry) {
  return entry.line.empty() ? kPointPx : kLinePx;
}

double EntryWidthPx(const LegendEntry& entry) {
  return SamplePx(entry) + kSampleToTextPx + TextWidthPx(entry.name);
}

}  // namespace

std::string RunGnuplot(const std::string& script, int64_t timeout_us) {
  const MemoryFile input(script);
  const MemoryFile output;
  const MemoryFile errors;
  ChildProcess gnuplot({"gnuplot", "-d"}, {input.descriptor(), output.descriptor(), errors.descriptor()});
  const std::optional<int> status = gnuplot.Wait(timeout_us);
  if (!status) {
    throw Failure(fmt::format("gnuplot did not finish within {} ms and was killed", timeout_us / 1000));
  }
  if (*status == ChildProcess::kCannotRun) {
    throw Failure(
        "figures are drawn by the program gnuplot, which is not in PATH; install the Debian package "
        "gnuplot-nox (apt-get install gnuplot-nox)");
  }
  if (*status != 0) {
    throw Failure(fmt::format(
        "gnuplot failed with {}: {}",
        *status > 128 ? fmt::format("signal {}", *status - 128) : fmt::format("exit status {}", *status),
        errors.Content()));
  }
  return output.Content();
}

std::string GnuplotString(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const size_t length = Utf8Length(text);
    const std::string_view character = text.substr(0, std::max<size_t>(length, 1));
    text.remove_prefix(character.size());
    if (length == 0) {
      quoted += "\uFFFD";
    } else if (length == 1 && (static_cast<unsigned char>(character[0]) < 0x20 || character[0] == 0x7F)) {
      quoted += ' ';
    } else if (character == ">" && quoted.ends_with("]]")) {
      quoted += " >";  // gnuplot does not escape ">", and XML does not allow "]]>" in text
    } else if (std::string_view("\"\\`").find(character) != std::string_view::npos) {
      quoted += OctalEscape(character[0]);
    } else {
      quoted += character;
    }
  }
  return quoted + "\"";
}

std::string SvgText(const Picture& picture) {
  FRESCO_CHECK(picture.width_px > 0 && picture.height_px > 0);
  return Render(picture, false);
}

void WritePicture(const Picture& picture, const std::filesystem::path& stem) {
  const std::string svg = SvgText(picture);
  const std::string png = Render(picture, true);
  WriteFileAtomically(stem.string() + ".svg", svg);
  WriteFileAtomically(stem.string() + ".png", png);
}

Legend::Legend(std::vector<LegendEntry> entries, int width_px) : width_px_(width_px) {
  for (LegendEntry& entry : entries) {
    const double entry_px = EntryWidthPx(entry);
    if (rows_.empty() || rows_.back().width_px + kBetweenEntriesPx + entry_px > width_px) {
      rows_.emplace_back();
    } else {
      rows_.back().width_px += kBetweenEntriesPx;
    }
    rows_.back().width_px += entry_px;
    rows_.back().entries.push_back(std::move(entry));
  }
}

int Legend::height_px() const {
  return rows_.empty() ? 0 : kRowPx * static_cast<int>(rows_.size()) + kBelowPx;
}

std::string Legend::Script(int picture_height_px) const {
  std::string script;
  double up_px = height_px() - kRowPx / 2.0;
  for (const Row& row : rows_) {
    const double y = up_px / picture_height_px;
    double left_px = (width_px_ - row.width_px) / 2;
    for (const LegendEntry& entry : row.entries) {
      const double sample_px = SamplePx(entry);
      const double middle = (left_px + sample_px / 2) / width_px_;
      if (!entry.line.empty()) {
        script += fmt::format("set arrow from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} nohead {} {}\n",
                              left_px / width_px_, y, (left_px + sample_px) / width_px_, y, entry.colour,
                              entry.line);
      }
      if (!entry.point.empty()) {
        script += fmt::format("set label '' at screen {:.5f},{:.5f} point {} {}\n", middle, y, entry.colour,
                              entry.point);
      }
      script += fmt::format("set label {} at screen {:.5f},{:.5f} left textcolor rgb '{}'\n",
                            GnuplotString(entry.name), (left_px + sample_px + kSampleToTextPx) / width_px_, y,
                            colour::kText);
      left_px += EntryWidthPx(entry) + kBetweenEntriesPx;
    }
    up_px -= kRowPx;
  }
  return script;
}

std::string FrameScript(const Frame& frame, const Picture& picture, const Legend& legend) {
  const double width = picture.width_px;
  const double height = picture.height_px;
  const std::string text = fmt::format("textcolor rgb '{}'", colour::kText);
  std::string script = "set encoding utf8\nunset key\nset format '%h'\n";
  script += fmt::format("set tics nomirror out scale 0.6 {}\n", text);
  script += fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n", frame.left_px / width,
                        1 - frame.right_px / width);
  script += fmt::format("set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
                        (frame.bottom_px + legend.height_px()) / height, 1 - frame.top_px / height);
  // The labels have fixed positions, for the same reason as the legend.
  script += fmt::format("set label {} at graph 0.5, screen {:.5f} center font title_font {}\n",
                        GnuplotString(frame.title), 1 - frame.top_px / 2.0 / height, text);
  script += fmt::format("set label {} at graph 0.5, screen {:.5f} center {}\n", GnuplotString(frame.x_label),
                        (legend.height_px() + kEdgePx) / height, text);
  script += fmt::format("set label {} at screen {:.5f}, graph 0.5 center rotate by 90 {}\n",
                        GnuplotString(frame.y_label), kEdgePx / width, text);
  script += fmt::format("set label {} at screen {:.5f}, graph 0.5 center rotate by 90 {}\n",
                        GnuplotString(frame.right_label), 1 - kEdgePx / width, text);
  return script + legend.Script(picture.height_px);
}

}  // namespace fresco
