#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace fresco {

void CheckFailed(const char* file, int line, const char* condition) {
  std::fprintf(stderr, "%s:%d: check failed: %s (a defect in Fresco; please report it)\n", file, line,
               condition);
  std::abort();
}

}  // namespace fresco
