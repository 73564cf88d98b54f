// Makes the HTML of a table of the report page. A pure function; any thread may call it.
#pragma once

#include <string>

#include "report/report.h"

namespace fresco {

/// Returns the table's HTML. Columns of numbers are aligned at the right. If the table is too wide, it can be
/// scrolled.
std::string TableHtml(const ReportTable& table);

}  // namespace fresco
