// How the report page draws the episodes of a world: the table of drawings, a line for each kind of world
// that has one. Any thread may call these functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/report.h"

namespace fresco {

/// The drawing of one kind of world: a section of the page.
struct Drawing {
  /// Whether the world is of this kind. Its name does not tell: a plug-in may have any name.
  bool (*draws)(const World& world);
  std::string_view id;       ///< of the section
  std::string_view heading;  ///< of the section
  /// The section's content, for at least one episode of a world of this kind. All are of one seed.
  std::string (*html)(const World& world, const std::vector<ReportEpisode>& episodes);
  std::string_view script;    ///< runs when the page is loaded
  std::string_view footnote;  ///< of the page
};

/// The drawing of the world's kind; null if it has none.
const Drawing* DrawingOf(const World& world);

}  // namespace fresco
