// The report page: one HTML file with the numbers, figures and flights of a run or of a study. It
// needs nothing but itself: no network, no other file. Its parts stand in report/ and are
// embedded into the program. Pure; any thread.
#pragma once

#include <string>
#include <vector>

#include "worlds/uav/flight.h"

namespace fresco {

struct ReportFigure {
  std::string title;
  std::string caption;  ///< may be empty
  std::string svg;      ///< the text of an SVG document; any ids: figures do not see each other
};

/// A table, or a list of names and values where `header` is empty. The first column names the row.
/// Every row has as many cells as the header (as the first row, where there is none).
struct ReportTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

struct ReportFlight {
  std::string name;  ///< what the reader chooses it by: "this run (DQN)", "exact optimum"
  Flight flight;
};

/// All texts are plain: the page shows them as they are, whatever they contain. What is empty is
/// left out of the page.
struct ReportContents {
  std::string title;
  std::string summary;
  std::vector<ReportTable> tables;
  std::vector<ReportFigure> figures;
  std::vector<ReportFlight> flights;  ///< all in `world`; the first is shown first
  const World* world = nullptr;       ///< must be given where there are flights
  std::string configuration;          ///< text format
};

/// The page. A figure whose text is no SVG document is reported in its place. Sizes: the page carries
/// every AoI of every slot, about 4 bytes each.
std::string ReportPage(const ReportContents& contents);

}  // namespace fresco
