#include "core/identifier.h"

#include <random>

namespace fresco {

int64_t DrawIdentifier() {
  std::random_device device;
  return static_cast<int64_t>(((uint64_t{device()} << 32) ^ device()) & INT64_MAX) | 1;
}

}  // namespace fresco
