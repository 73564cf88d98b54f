#include "logs/merged_event_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fresco {
namespace {

void Add(const EventLogReader& reader, MergedEventLogs::Totals& totals) {
  totals.bytes += reader.position() + reader.torn_bytes();
  totals.damaged_bytes += reader.damaged_bytes();
  totals.torn_bytes += reader.torn_bytes();
}

}  // namespace

std::vector<std::string> MergedEventLogs::Totals::Problems() const {
  std::vector<std::string> problems;
  if (damaged_bytes > 0) {
    problems.push_back(fmt::format("{} bytes of the log are damaged and were skipped", damaged_bytes));
  }
  if (torn_bytes > 0) {
    problems.push_back(fmt::format(
        "the log is cut short: its last event ({} bytes) is incomplete; all events before it were read",
        torn_bytes));
  }
  return problems;
}

MergedEventLogs::MergedEventLogs(const std::vector<std::filesystem::path>& paths) {
  for (const auto& path : paths) {
    EventLogReader reader(path);
    if (const auto first = reader.Next()) {
      waiting_.push_back({path, waiting_.size(), first->utime});
    } else {
      Add(reader, closed_);
    }
  }
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [](const Log& a, const Log& b) { return a.first_utime < b.first_utime; });
}

std::optional<LcmEvent> MergedEventLogs::Next() {
  if (handed_out_ != nullptr) {
    Advance(*handed_out_);
  }
  OpenThoseThatBegin();
  const auto earliest = std::min_element(
      open_.begin(), open_.end(), [](const Log& a, const Log& b) { return a.next->utime < b.next->utime; });
  handed_out_ = earliest == open_.end() ? nullptr : &*earliest;
  return handed_out_ == nullptr ? std::nullopt : handed_out_->next;
}

MergedEventLogs::Totals MergedEventLogs::totals() const {
  Totals totals = closed_;
  for (const Log& log : open_) {
    Add(*log.reader, totals);
  }
  return totals;
}

void MergedEventLogs::Advance(Log& log) {
  log.next = log.reader->Next();
  if (!log.next) {
    Add(*log.reader, closed_);
    open_.erase(open_.begin() + (&log - open_.data()));
  }
}

/// Opens the waiting logs whose first event is not later than the next event of every open log.
void MergedEventLogs::OpenThoseThatBegin() {
  const auto begins = [this] {
    return std::all_of(open_.begin(), open_.end(),
                       [this](const Log& log) { return waiting_.front().first_utime <= log.next->utime; });
  };
  while (!waiting_.empty() && begins()) {
    Log log = std::move(waiting_.front());
    waiting_.pop_front();
    log.reader = std::make_unique<EventLogReader>(log.path);
    log.next = log.reader->Next();
    const auto behind = std::find_if(open_.begin(), open_.end(),
                                     [&](const Log& other) { return other.position > log.position; });
    open_.insert(behind, std::move(log));
  }
}

}  // namespace fresco
