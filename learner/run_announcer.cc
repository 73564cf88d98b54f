#include "learner/run_announcer.h"

#include <spdlog/spdlog.h>

#include "core/identifier.h"
#include "msgs/protocol_times.h"
#include "nn/mlp.h"

namespace fresco {

RunAnnouncer::RunAnnouncer(const Experiment& experiment, int64_t run_id)
    : run_id_(run_id), config_text_(experiment.Text()) {
  const Network& network = *experiment.network();
  announcement_.protocol_version = kProtocolVersion;
  announcement_.arithmetic_fingerprint = ArithmeticFingerprint();
  announcement_.inputs = network.inputs();
  announcement_.outputs = network.outputs();
  announcement_.parameters = static_cast<int32_t>(network.parameter_count());
  announcement_.values_per_chunk = kValuesPerChunk;
}

bool RunAnnouncer::IsDue(int64_t now_us) {
  const bool due = now_us >= next_us_ - (was_asked_ ? kRunPeriodUs - kAskedRunPeriodUs : 0);
  if (due) {
    was_asked_ = false;
    next_us_ = now_us + kRunPeriodUs;
  }
  return due;
}

std::vector<run_t> RunAnnouncer::Messages(const TrainerProgress& progress, bool finished) {
  const int size = static_cast<int>(config_text_.size());
  announced_ = true;
  announcement_.current_version = progress.current_version;
  announcement_.target_version = progress.target_version;
  announcement_.finished = finished ? 1 : 0;
  announcement_.part_count = (size + kMaximumPartBytes - 1) / kMaximumPartBytes;
  std::vector<run_t> messages(static_cast<size_t>(announcement_.part_count), announcement_);
  for (size_t part = 0; part < messages.size(); ++part) {
    const std::string text = config_text_.substr(part * kMaximumPartBytes, kMaximumPartBytes);
    messages[part].part_index = static_cast<int32_t>(part);
    messages[part].part.assign(text.begin(), text.end());
    messages[part].part_size = static_cast<int32_t>(text.size());
  }
  return messages;
}

bool RunAnnouncer::IsForeign(const run_t& message, const std::string& channel, int64_t now_utime) {
  if (message.run_id == run_id_ && announced_) {
    return false;
  }
  if (message.finished != 0) {
    return true;
  }
  const bool current = IsCurrent(message.utime, now_utime);
  bool& warned = current ? warned_of_foreign_run_ : warned_of_recorded_run_;
  if (!warned) {  // once: whoever floods the bus with runs is not to fill the log
    warned = true;
    spdlog::warn(
        "{}, {}, is on {}: it does no harm, but shares the bandwidth",
        current ? "another run" : "a recording of a run (or a run whose clock differs from this host's)",
        IdentifierText(message.run_id), channel);
  }
  foreign_run_ = current ? message.run_id : foreign_run_;
  return true;
}

}  // namespace fresco
