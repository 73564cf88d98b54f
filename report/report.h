// Makes the report page: one HTML file with the numbers, figures and episodes of a run or of a study. The
// page loads nothing from the network or from other files. Its templates and scripts are the other files in
// report/, which are embedded into the program. A pure function; any thread may call it.
#pragma once

#include <string>
#include <vector>

#include "worlds/episode.h"

namespace fresco {

struct ReportFigure {
  std::string title;
  std::string caption;  ///< may be empty
  std::string svg;      ///< the text of an SVG document; its ids may be those of other figures
};

/// A table, or a list of names and values if `header` is empty. The first column names the row. Every row has
/// as many cells as the header, or as the first row if there is no header.
struct ReportTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct ReportEpisode {
  std::string name;  ///< its name on the page: "this run (DQN)", "exact optimum"
  Episode episode;
};

/// All texts are plain text; the page shows every character of them as it is. Empty members are left out of
/// the page.
struct ReportContents {
  std::string title;
  std::string summary;
  std::vector<ReportTable> tables;
  std::vector<ReportFigure> figures;
  std::vector<ReportEpisode> episodes;  ///< all of `world`; left out if there is no drawing (drawings.h)
  const World* world = nullptr;         ///< must be set if there are episodes
  std::string configuration;            ///< in text format
};

/// Returns the page. If a figure's text is not an SVG document, the page says so in its place.
std::string ReportPage(const ReportContents& contents);

}  // namespace fresco
