#include "logs/event_selection.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/identifier.h"
#include "msgs/message_decoder.h"

namespace fresco {

ChannelFilter::ChannelFilter(const std::vector<std::string>& expressions, const std::string& option) {
  for (const std::string& expression : expressions) {
    try {
      expressions_.emplace_back(expression, std::regex::ECMAScript | std::regex::optimize);
    } catch (const std::regex_error& error) {
      throw UsageError(
          fmt::format("{}: expected a regular expression that matches channels' whole names, e.g. FRESCO_.*; "
                      "found \"{}\" ({})",
                      option, expression, error.what()));
    }
  }
}

bool ChannelFilter::Matches(std::string_view channel) {
  constexpr size_t kMaximumKnown = 4096;  // a limit, since anybody may send names
  if (lets_all_through()) {
    return true;
  }
  if (const auto known = known_.find(channel); known != known_.end()) {
    return known->second;
  }
  const bool matches =
      std::any_of(expressions_.begin(), expressions_.end(), [&](const std::regex& expression) {
        return std::regex_match(channel.begin(), channel.end(), expression);
      });
  if (known_.size() < kMaximumKnown) {
    known_.emplace(channel, matches);
  }
  return matches;
}

EventSelection::EventSelection(const SelectionOptions& options)
    : channels_(options.channels, "--channel"),
      start_us_(options.start_s > 0 ? 1e6 * options.start_s : -std::numeric_limits<double>::infinity()),
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

double EventSelection::SecondsOf(const LcmEvent& event) const {
  return 1e-6 * (static_cast<double>(event.utime) - static_cast<double>(*first_utime_));
}

bool EventSelection::IsOfAnotherRun(const LcmEvent& event) const {
  const auto identity = PeekIdentity(event.message);
  return identity && identity->run_id != 0 && identity->run_id != *run_id_;
}

}  // namespace fresco
