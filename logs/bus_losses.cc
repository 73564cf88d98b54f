#include "logs/bus_losses.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "logs/socket_drops.h"

namespace fresco {

std::string BusLossText(const Bus& bus) {
  const UnheardTraffic unheard = bus.unheard();
  std::string text;
  const auto add = [&](int64_t count, const char* what) {
    text += count > 0 ? fmt::format(", {} {}", count, what) : "";
  };
  add(DroppedDatagrams(), "packets LOST");
  add(unheard.refused_packets, "packets REFUSED");
  add(unheard.incomplete_messages, "messages INCOMPLETE");
  return text;
}

void WarnOfBusLosses(const Bus& bus) {
  if (const int64_t lost = DroppedDatagrams(); lost > 0) {
    spdlog::warn(
        "{} packets were lost before this program saw them, since its receive buffer was full; raise "
        "recv_buf_size in the URL (the sysctl net.core.rmem_max limits it)",
        lost);
  }
  const UnheardTraffic unheard = bus.unheard();
  if (unheard.refused_packets > 0) {
    spdlog::warn("{} packets were refused: they are not LCM's, are damaged, or contradict others",
                 unheard.refused_packets);
  }
  if (unheard.incomplete_messages > 0) {
    spdlog::warn("{} messages of several packets are missing: not all of their packets arrived",
                 unheard.incomplete_messages);
  }
}

}  // namespace fresco
