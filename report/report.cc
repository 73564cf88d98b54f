#include "report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "core/installation.h"
#include "report/report_html.h"
#include "report/result_display.h"

namespace fresco {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::string_view kPage =
#include "report/page.html.inc"
    ;
constexpr std::string_view kStyle =
#include "report/page.css.inc"
    ;
constexpr std::string_view kFlightPlayer =
#include "report/flight_player.html.inc"
    ;
// The page's script. Each file uses functions of the files before it.
constexpr std::string_view kScript =
#include "report/aoi_bars.js.inc"
#include "report/flight_data.js.inc"
#include "report/flight_map.js.inc"
#include "report/flight_player.js.inc"
#include "report/page.js.inc"
    ;

struct Section {
  std::string_view id;
  std::string_view heading;
  std::string html;
};

std::string TablesHtml(const std::vector<ReportTable>& tables) {
  std::string html = "<div class=\"tables\">\n";
  for (const ReportTable& table : tables) {
    html += TableHtml(table);
  }
  return html + "</div>\n";
}

bool IsSvgDocument(std::string_view text) {
  return text.find("<svg") != std::string_view::npos && text.find("</svg>") != std::string_view::npos;
}

/// Returns the figure as an image. So its ids do not clash with those of other figures, its scripts do not
/// run, and it can't load anything.
std::string FigureImage(const ReportFigure& figure) {
  if (!IsSvgDocument(figure.svg)) {
    return fmt::format(
        "<p class=\"error\">This figure is missing: expected an SVG document, found {} bytes without "
        "&lt;svg&gt; and &lt;/svg&gt;.</p>\n",
        figure.svg.size());
  }
  return fmt::format("<img alt=\"{}\" src=\"data:image/svg+xml,{}\">\n", EscapedHtml(figure.title),
                     PercentEncoded(figure.svg));
}

std::string FiguresHtml(const std::vector<ReportFigure>& figures) {
  std::string html = "<div class=\"figures\">\n";
  for (const ReportFigure& figure : figures) {
    const std::string caption = figure.caption.empty() ? "" : "<p>" + EscapedHtml(figure.caption) + "</p>";
    html += fmt::format("<figure>\n{}<figcaption><h3>{}</h3>{}</figcaption>\n</figure>\n",
                        FigureImage(figure), EscapedHtml(figure.title), caption);
  }
  return html + "</div>\n";
}

OrderedJson CellJson(Cell cell) {
  return {{"column", cell.column}, {"row", cell.row}};
}

OrderedJson WorldJson(const UavWorld& world) {
  const Scenario& scenario = world.scenario();
  OrderedJson sensors = OrderedJson::array();
  for (const Sensor& sensor : scenario.sensors) {
    sensors.push_back({{"x_m", sensor.x_m}, {"y_m", sensor.y_m}, {"weight", sensor.weight}});
  }
  return {{"columns", scenario.columns},
          {"rows", scenario.rows},
          {"cell_m", scenario.cell_m},
          {"slots", scenario.slots},
          {"start", CellJson(scenario.start)},
          {"stop", CellJson(scenario.stop)},
          {"coverage_radius_m", scenario.coverage_radius_m},
          {"sensors", std::move(sensors)}};
}

/// Returns what `fresco evaluate --format json` prints, and adds for each slot whether the scheduled sensor
/// is collected, that is, covered.
OrderedJson FlightDataJson(const UavWorld& world, const Episode& flight) {
  OrderedJson json = OrderedJson::parse(EpisodeJson(world.Tell(flight), ""));
  for (size_t slot = 0; slot <= flight.actions.size(); ++slot) {
    const Cell cell = CellIn(flight.state(slot));
    const int scheduled = ActionIn(world, flight, slot).schedule;
    json["flight"][slot]["collected"] = scheduled > 0 && world.Covers(cell, scheduled - 1);
  }
  return json;
}

std::string FlightsHtml(const UavWorld& world, const std::vector<ReportFlight>& flights) {
  OrderedJson array = OrderedJson::array();
  for (const ReportFlight& flight : flights) {
    array.push_back(FlightDataJson(world, flight.flight));
    array.back()["policy"] = flight.name;
  }
  const OrderedJson data = {{"world", WorldJson(world)}, {"flights", std::move(array)}};
  // Bytes of a name that are not UTF-8 become replacement characters.
  const std::string text = data.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  return FilledTemplate(kFlightPlayer, {{"data", EscapedJson(text)}});
}

std::string ConfigurationHtml(const std::string& text) {
  return "<details>\n<summary>The experiment in text format</summary>\n<pre tabindex=\"0\">" +
         EscapedHtml(text) + "</pre>\n</details>\n";
}

std::vector<Section> Sections(const ReportContents& contents) {
  std::vector<Section> sections;
  if (!contents.tables.empty()) {
    sections.push_back({"numbers", "Numbers", TablesHtml(contents.tables)});
  }
  if (!contents.figures.empty()) {
    sections.push_back({"figures", "Figures", FiguresHtml(contents.figures)});
  }
  if (!contents.flights.empty()) {
    FRESCO_CHECK(contents.world != nullptr);
    sections.push_back({"flights", "Flights", FlightsHtml(*contents.world, contents.flights)});
  }
  if (!contents.configuration.empty()) {
    sections.push_back({"configuration", "Configuration", ConfigurationHtml(contents.configuration)});
  }
  return sections;
}

std::string LinksHtml(const std::vector<Section>& sections) {
  std::string html = "<nav aria-label=\"Sections\">\n";
  for (const Section& section : sections) {
    html += fmt::format("<a href=\"#{}\">{}</a>\n", section.id, section.heading);
  }
  return html + "</nav>";
}

std::string SectionsHtml(const std::vector<Section>& sections) {
  std::string html;
  for (const Section& section : sections) {
    html += fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-heading\">\n<h2 "
        "id=\"{0}-heading\">{1}</h2>\n{2}</section>\n",
        section.id, section.heading, section.html);
  }
  return html;
}

}  // namespace

std::string ReportPage(const ReportContents& contents) {
  const std::vector<Section> sections = Sections(contents);
  return FilledTemplate(
      kPage,
      {{"title", EscapedHtml(contents.title)},
       {"style", std::string(kStyle)},
       {"summary",
        contents.summary.empty() ? "" : "<p class=\"summary\">" + EscapedHtml(contents.summary) + "</p>"},
       {"links", sections.size() > 1 ? LinksHtml(sections) : ""},
       {"sections", SectionsHtml(sections)},
       {"version", kSoftwareVersion},
       {"footnote", contents.world != nullptr ? " AoI is age of information, in slots." : ""},
       {"script", std::string(kScript)}});
}

}  // namespace fresco
