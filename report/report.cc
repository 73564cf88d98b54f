#include "report/report.h"

#include <fmt/format.h>

#include <string_view>

#include "core/error.h"
#include "core/installation.h"
#include "report/drawings.h"
#include "report/report_html.h"

namespace fresco {
namespace {

constexpr std::string_view kPage =
#include "report/page.html.inc"
    ;
constexpr std::string_view kStyle =
#include "report/page.css.inc"
    ;
constexpr std::string_view kScript =
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

std::string ConfigurationHtml(const std::string& text) {
  return "<details>\n<summary>The experiment in text format</summary>\n<pre tabindex=\"0\">" +
         EscapedHtml(text) + "</pre>\n</details>\n";
}

/// How the page draws the episodes; null if it shows none.
const Drawing* DrawingFor(const ReportContents& contents) {
  FRESCO_CHECK(contents.episodes.empty() || contents.world != nullptr);
  return contents.episodes.empty() ? nullptr : DrawingOf(*contents.world);
}

std::vector<Section> Sections(const ReportContents& contents, const Drawing* drawing) {
  std::vector<Section> sections;
  if (!contents.tables.empty()) {
    sections.push_back({"numbers", "Numbers", TablesHtml(contents.tables)});
  }
  if (!contents.figures.empty()) {
    sections.push_back({"figures", "Figures", FiguresHtml(contents.figures)});
  }
  if (drawing != nullptr) {
    sections.push_back({drawing->id, drawing->heading, drawing->html(*contents.world, contents.episodes)});
  }
  if (!contents.configuration.empty()) {
    sections.push_back({"configuration", "Configuration", ConfigurationHtml(contents.configuration)});
  }
  return sections;
}

/// Whether numbers and figures are few enough to stand side by side, so that a large screen shows the flight
/// below them, too.
bool HasOverview(const ReportContents& contents) {
  constexpr size_t kMostFigures = 2;
  return !contents.tables.empty() && !contents.figures.empty() && contents.figures.size() <= kMostFigures;
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
  const Drawing* drawing = DrawingFor(contents);
  const std::vector<Section> sections = Sections(contents, drawing);
  return FilledTemplate(
      kPage,
      {{"title", EscapedHtml(contents.title)},
       {"style", std::string(kStyle)},
       {"summary",
        contents.summary.empty() ? "" : "<p class=\"summary\">" + EscapedHtml(contents.summary) + "</p>"},
       {"links", sections.size() > 1 ? LinksHtml(sections) : ""},
       {"arrangement", HasOverview(contents) ? " class=\"overview\"" : ""},
       {"sections", SectionsHtml(sections)},
       {"version", kSoftwareVersion},
       {"footnote", drawing == nullptr ? "" : " " + std::string(drawing->footnote)},
       {"script", std::string(drawing == nullptr ? "" : drawing->script) + std::string(kScript)}});
}

}  // namespace fresco
