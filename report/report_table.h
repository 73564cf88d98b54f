// A table of the report page as HTML. Pure.
#pragma once

#include <string>

#include "report/report.h"

namespace fresco {

/// Columns of numbers are aligned at the right. The table scrolls by itself where it is too wide.
std::string TableHtml(const ReportTable& table);

}  // namespace fresco
