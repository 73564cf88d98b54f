#include "report/drawings.h"

#include <algorithm>
#include <iterator>

#include "report/flight_player.h"

namespace fresco {
namespace {

const Drawing* const kDrawings[] = {&kFlightPlayer};

}  // namespace

const Drawing* DrawingOf(const World& world) {
  const auto found = std::find_if(std::begin(kDrawings), std::end(kDrawings),
                                  [&](const Drawing* drawing) { return drawing->draws(world); });
  return found == std::end(kDrawings) ? nullptr : *found;
}

}  // namespace fresco
