#include "logs/event_selection.h"

#include <fmt/format.h>

#include "core/error.h"
#include "msgs/message_peek.h"
#include "msgs/settings.h"

namespace fresco {

EventSelection::EventSelection(const SelectionOptions& options)
    : channels_(options.channels, "--channel"),
      start_us_(1e6 * options.start_s),
      stop_us_(1e6 * options.stop_s) {
  if (!(options.start_s < options.stop_s)) {
    throw UsageError(fmt::format("--stop: expected more than --start ({} s), found {} s", options.start_s,
                                 options.stop_s));
  }
  if (!options.dropped.empty()) {
    dropped_.emplace(options.dropped, "--drop");
  }
  if (!options.run.empty()) {
    run_id_ = ParseRunId(options.run);
  }
}

bool EventSelection::Wants(const LcmEvent& event) {
  if (!first_utime_) {
    first_utime_ = event.utime;
  }
  const double time_us = static_cast<double>(event.utime) - static_cast<double>(*first_utime_);
  return time_us >= start_us_ && time_us < stop_us_ && channels_.Matches(event.channel) &&
         !(dropped_ && dropped_->Matches(event.channel)) && !(run_id_ && IsOfAnotherRun(event));
}

bool EventSelection::IsOfAnotherRun(const LcmEvent& event) const {
  const auto identity = PeekIdentity(event.message);
  return identity && identity->run_id != 0 && identity->run_id != *run_id_;
}

}  // namespace fresco
