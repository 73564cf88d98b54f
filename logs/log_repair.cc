#include "logs/log_repair.h"

#include <fmt/format.h>

#include "core/clock.h"
#include "core/error.h"
#include "core/live_line.h"
#include "core/signals.h"
#include "logs/event_log_reader.h"
#include "logs/event_log_writer.h"
#include "msgs/message_decoder.h"

namespace fresco {
namespace {

using Loss = LogRepair::Loss;

void AddLoss(const Loss& loss, LogRepair& repair) {
  if (loss.begin == loss.end) {
    return;
  }
  ++repair.losses;
  repair.lost_bytes += loss.end - loss.begin;
  if (repair.listed.size() < LogRepair::kMaximumListed) {
    repair.listed.push_back(loss);
  }
}

const char* KindText(Loss::Kind kind) {
  switch (kind) {
    case Loss::Kind::kDamaged:
      return "damaged: no event";
    case Loss::Kind::kTorn:
      return "the end of the log, in the middle of an event";
    case Loss::Kind::kDamagedMessage:
      return "an event with a damaged message";
  }
  return "";
}

}  // namespace

LogRepair RepairLog(const std::filesystem::path& log, const std::filesystem::path& out) {
  constexpr int64_t kEventsPerLook = 4096;
  EventLogReader reader(log, EventLogReader::Beginning::kMaybeDamaged);
  auto event = reader.Next();
  if (!event) {
    throw UsageError(
        fmt::format("{}: expected an LCM event log with at least one whole event; found none in {} bytes",
                    log.string(), reader.position() + reader.torn_bytes()));
  }
  EventLogWriter writer(out);
  MessageDecoder decoder;
  LogRepair repair;
  constexpr int64_t kQuietUs = 1'000'000;  // no progress is shown before
  const int64_t line_from_us = MonotonicMicroseconds() + kQuietUs;
  LiveLine line(true);
  int64_t end = 0;  // of the event before
  for (int64_t looked_at = 0; event; event = reader.Next()) {
    const int64_t begin = reader.position() - EventLogWriter::EventBytes(*event);
    AddLoss({Loss::Kind::kDamaged, end, begin}, repair);
    end = reader.position();
    if (decoder.Decode(event->message, [](const auto&) {}) == MessageDecoder::Result::kDamaged) {
      AddLoss({Loss::Kind::kDamagedMessage, begin, end}, repair);
    } else {
      writer.Write(*event);
    }
    if (++looked_at % kEventsPerLook == 0) {
      if (MonotonicMicroseconds() > line_from_us) {
        line.Show(fmt::format("read {:.1f} MB", 1e-6 * static_cast<double>(end)));
      }
      if (StopSignal::Requested()) {
        throw Failure("interrupted before the end of the log; " + out.string() + " has the events before");
      }
    }
  }
  line.Finish();
  AddLoss({Loss::Kind::kDamaged, end, reader.position()}, repair);
  repair.read_bytes = reader.position() + reader.torn_bytes();
  AddLoss({Loss::Kind::kTorn, reader.position(), repair.read_bytes}, repair);
  writer.Flush();
  repair.events = writer.events();
  repair.bytes = writer.bytes();
  return repair;
}

std::string RepairText(const LogRepair& repair, const std::filesystem::path& log,
                       const std::filesystem::path& out) {
  std::string text = fmt::format("{}: {} events, {} bytes\n", out.string(), repair.events, repair.bytes);
  if (repair.losses == 0) {
    return text + fmt::format("nothing is lost: {} has no damage\n", log.string());
  }
  text += fmt::format("lost: {} of {} bytes of {}, at {} places\n", repair.lost_bytes, repair.read_bytes,
                      log.string(), repair.losses);
  for (const Loss& loss : repair.listed) {
    text +=
        fmt::format("  from byte {}: {} bytes, {}\n", loss.begin, loss.end - loss.begin, KindText(loss.kind));
  }
  if (const auto more = repair.losses - static_cast<int64_t>(repair.listed.size()); more > 0) {
    text += fmt::format("  and {} more places\n", more);
  }
  return text;
}

}  // namespace fresco
