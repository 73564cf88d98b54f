#include "training/episode_assembly.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "core/memory.h"

namespace fresco {
namespace {

/// Copies the values if they are not here yet; otherwise returns whether they have the same bits.
template <class Value>
bool Merge(std::span<const Value> values, bool are_here, std::span<Value> here) {
  if (!are_here) {
    std::copy(values.begin(), values.end(), here.begin());
    return true;
  }
  return std::memcmp(values.data(), here.data(), values.size_bytes()) == 0;
}

}  // namespace

EpisodeAssembly::EpisodeAssembly(const World& world)
    : state_size_(static_cast<size_t>(world.state_size())),
      mask_size_(static_cast<size_t>(MaskSize(world.actions()))),
      fields_a_part_(static_cast<size_t>(LayoutOf(world).fields)),
      field_parts_((state_size_ + fields_a_part_ - 1) / fields_a_part_) {}

int64_t EpisodeAssembly::BytesFor(const World& world) {
  constexpr int64_t kGrowth = 2;  // a vector that grows may have twice the room that it needs
  const auto parts = static_cast<int64_t>(EpisodeAssembly(world).field_parts_);
  return static_cast<int64_t>(sizeof(EpisodeAssembly)) +
         kGrowth * (LongestEpisodeBytes(world) + HeapBytes(parts * world.longest_episode()));
}

EpisodeAssembly::Arrival EpisodeAssembly::Add(const OrderResult& part) {
  const auto first = static_cast<size_t>(part.first_transition);
  const size_t end = first + part.episode.actions.size();
  if (!EndFits(part, end)) {
    return Arrival::kContradiction;
  }
  MakeRoom(end);
  for (size_t i = 0; i <= part.episode.actions.size(); ++i) {
    if (!MergeState(part, i) || (i < part.episode.actions.size() && !MergeTransition(part, i))) {
      return Arrival::kContradiction;
    }
  }
  Arrival arrival = Arrival::kNothingNew;
  for (size_t transition = first; transition < end; ++transition) {
    uint8_t& arrived = arrived_[transition * field_parts_ + FieldPart(part)];
    if (arrived == 0) {
      arrived = 1;
      ++parts_arrived_;
      arrival = Arrival::kNew;
    }
  }
  if (part.episode.ending != Ending::kNone) {
    length_ = end;
    episode_.ending = part.episode.ending;
  }
  return arrival;
}

void EpisodeAssembly::Clear() {
  episode_.Clear();
  arrived_.clear();
  parts_arrived_ = 0;
  length_ = 0;
}

bool EpisodeAssembly::EndFits(const OrderResult& part, size_t end) const {
  const Ending ending = part.episode.ending;
  if (length_ == 0) {
    return ending == Ending::kNone || end > episode_.actions.size();
  }
  return end <= length_ && ending == (end == length_ ? episode_.ending : Ending::kNone);
}

void EpisodeAssembly::MakeRoom(size_t transitions) {
  if (transitions > episode_.actions.size()) {
    episode_.actions.resize(transitions);
    episode_.rewards.resize(transitions);
    episode_.next_masks.resize(transitions * mask_size_);
    episode_.states.resize((transitions + 1) * state_size_);
    arrived_.resize(transitions * field_parts_);
  }
}

/// Merges transition i of the part, without its states.
bool EpisodeAssembly::MergeTransition(const OrderResult& part, size_t i) {
  const size_t transition = static_cast<size_t>(part.first_transition) + i;
  const bool is_here = AnyIsHere(transition);
  const auto merge = [&](const auto& values, auto& here, size_t size) {
    return Merge(std::span(values).subspan(i * size, size), is_here,
                 std::span(here).subspan(transition * size, size));
  };
  return merge(part.episode.actions, episode_.actions, 1) &&
         merge(part.episode.rewards, episode_.rewards, 1) &&
         merge(part.episode.next_masks, episode_.next_masks, mask_size_);
}

/// Merges the fields of state i of the part. They are here if the transition before or after it is.
bool EpisodeAssembly::MergeState(const OrderResult& part, size_t i) {
  const std::span<const float> fields = part.episode.state(i);
  const size_t state = static_cast<size_t>(part.first_transition) + i;
  const size_t field_part = FieldPart(part);
  const bool is_here = IsHere(state, field_part) || (state > 0 && IsHere(state - 1, field_part));
  return Merge(fields, is_here,
               std::span(episode_.states)
                   .subspan(state * state_size_ + static_cast<size_t>(part.first_field), fields.size()));
}

/// Whether any part with this transition is here.
bool EpisodeAssembly::AnyIsHere(size_t transition) const {
  const auto begin = arrived_.begin() + static_cast<int64_t>(transition * field_parts_);
  return std::find(begin, begin + static_cast<int64_t>(field_parts_), 1) !=
         begin + static_cast<int64_t>(field_parts_);
}

}  // namespace fresco
