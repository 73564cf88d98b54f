#include "msgs/order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace fresco {
namespace {

constexpr size_t EncodedBytes(int transitions, int fields, int actions) {
  const auto count = static_cast<size_t>(transitions);
  return Description<transitions_t>::EncodedBytes(count, count + 1, static_cast<size_t>(fields),
                                                  static_cast<size_t>(actions + 7) / 8);
}
static_assert(EncodedBytes(1, 1, kMaximumActions) <= kMaximumEncodedBytes);
static_assert(EncodedBytes(kMaximumTransitionsPerMessage + 1, 1, 1) > kMaximumEncodedBytes);
static_assert(EncodedBytes(1, transitions_t::MAXIMUM_FIELD_COUNT, 1) > kMaximumEncodedBytes);
static_assert(8 * transitions_t::MAXIMUM_MASK_SIZE >= kMaximumActions);

/// Copies `count` values from `first` on.
template <class From, class To>
void CopyRange(const std::vector<From>& from, int first, int count, std::vector<To>& to) {
  const auto begin = from.begin() + first;
  to.assign(begin, begin + count);
}

/// Rows that a message does not need now, with their room.
template <class Value>
using SpareRows = std::vector<std::vector<Value>>;

template <class Value>
void ResizeRows(int32_t count, std::vector<std::vector<Value>>& rows, SpareRows<Value>& spare) {
  const auto size = static_cast<size_t>(count);
  for (; rows.size() > size; rows.pop_back()) {
    spare.push_back(std::move(rows.back()));
  }
  for (; rows.size() < size && !spare.empty(); spare.pop_back()) {
    rows.push_back(std::move(spare.back()));
  }
  rows.resize(size);
}

/// A message that is written again and again. Allocates nothing once it has had as many transitions.
struct ReusedMessage {
  transitions_t message{};
  SpareRows<float> states = {};
  SpareRows<uint8_t> masks = {};
};

/// Writes the part of the result from transition `first` and field `first_field` on into the message.
void WriteMessage(const World& world, const OrderResult& result, MessageLayout part, int first,
                  int first_field, ReusedMessage& reused) {
  const Episode& episode = result.episode;
  transitions_t& message = reused.message;
  message.transition_count = part.transitions;
  message.state_count = part.transitions + 1;
  message.field_count = part.fields;
  message.mask_size = MaskSize(world.actions());
  message.order_index = result.order_index;
  message.seed = static_cast<int64_t>(result.seed);
  message.first_transition = first;
  message.first_field = first_field;
  message.ending =
      static_cast<int8_t>(first + part.transitions == episode.transitions() ? episode.ending : Ending::kNone);
  CopyRange(episode.actions, first, part.transitions, message.action);
  CopyRange(episode.rewards, first, part.transitions, message.reward);
  CopyRange(result.td_errors, first, part.transitions, message.td_error);
  ResizeRows(message.state_count, message.state, reused.states);
  for (int i = 0; i < message.state_count; ++i) {
    CopyRange(episode.states, (first + i) * world.state_size() + first_field, part.fields,
              message.state[static_cast<size_t>(i)]);
  }
  ResizeRows(message.transition_count, message.next_mask, reused.masks);
  for (int i = 0; i < message.transition_count; ++i) {
    CopyRange(episode.next_masks, (first + i) * message.mask_size, message.mask_size,
              message.next_mask[static_cast<size_t>(i)]);
  }
}

/// Whether the message has whole states or one of the parts that LayoutOf cuts them into.
bool FieldsMatch(const World& world, const transitions_t& message) {
  const int size = world.state_size();
  const int step = LayoutOf(world).fields;
  return message.first_field >= 0 && message.first_field < size && message.first_field % step == 0 &&
         message.field_count == std::min(step, size - message.first_field);
}

bool SizesMatch(const World& world, const transitions_t& message) {
  return message.transition_count >= 1 && message.state_count == message.transition_count + 1 &&
         FieldsMatch(world, message) && message.mask_size == MaskSize(world.actions()) &&
         message.first_transition >= 0 &&
         message.first_transition <= world.longest_episode() - message.transition_count &&
         message.order_index >= 0 && message.ending >= 0 && message.ending <= 2;
}

/// Writes the rows one behind the other. All rows have `width` values.
template <class From, class To>
void JoinRows(const std::vector<std::vector<From>>& rows, int32_t width, std::vector<To>& joined) {
  joined.resize(rows.size() * static_cast<size_t>(width));
  auto to = joined.begin();
  for (const std::vector<From>& row : rows) {
    to = std::copy(row.begin(), row.end(), to);
  }
}

bool AreFinite(const std::vector<float>& values) {
  bool finite = true;
  for (const float value : values) {
    finite &= std::abs(value) <= std::numeric_limits<float>::max();
  }
  return finite;
}

}  // namespace

bool SearchFits(const Order& order, const proto::Schedule& schedule, int longest_episode) {
  return order.search_width == 0 ||
         (order.kind == OrderKind::kTrain && schedule.has_search() &&
          order.search_width == schedule.search().width() && order.search_from < longest_episode);
}

order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt) {
  order_t message{};
  message.index = order.index;
  message.actor_id = actor_id;
  message.attempt = attempt;
  message.kind = static_cast<int8_t>(order.kind);
  message.epsilon = order.epsilon;
  message.search_width = order.search_width;
  message.search_from = order.search_from;
  message.seed = static_cast<int64_t>(order.seed);
  message.current_version = order.current_version;
  message.target_version = order.target_version;
  return message;
}

bool FromWire(const order_t& message, Order& order) {
  order = {message.index,           static_cast<OrderKind>(message.kind),
           message.epsilon,         message.search_width,
           message.search_from,     static_cast<uint64_t>(message.seed),
           message.current_version, message.target_version};
  return message.index >= 0 && message.index < (int64_t{1} << 32) &&
         (message.kind == 0 || message.kind == 1) && message.epsilon >= 0 && message.epsilon <= 1 &&
         message.search_width >= 0 && message.search_from >= 0 && message.current_version >= 0 &&
         message.target_version >= 0 && message.attempt >= 0;
}

MessageLayout LayoutOf(int state_size, int actions) {
  // Bytes grow linearly, with the transitions and with the fields.
  const size_t of_none = EncodedBytes(0, state_size, actions);
  const size_t of_one = EncodedBytes(1, state_size, actions);
  if (of_one <= kMaximumEncodedBytes) {
    return {static_cast<int>((kMaximumEncodedBytes - of_none) / (of_one - of_none)), state_size};
  }
  const size_t without_fields = EncodedBytes(1, 0, actions);
  const size_t of_field = EncodedBytes(1, 1, actions) - without_fields;
  return {1, static_cast<int>((kMaximumEncodedBytes - without_fields) / of_field)};
}

void SplitResult(const World& world, const OrderResult& result, int64_t actor_id,
                 const std::function<void(transitions_t&)>& send) {
  thread_local ReusedMessage reused;
  const MessageLayout layout = LayoutOf(world);
  const int transitions = result.episode.transitions();
  for (int first = 0; first < transitions; first += layout.transitions) {
    for (int first_field = 0; first_field < world.state_size(); first_field += layout.fields) {
      const MessageLayout part = {std::min(layout.transitions, transitions - first),
                                  std::min(layout.fields, world.state_size() - first_field)};
      WriteMessage(world, result, part, first, first_field, reused);
      reused.message.actor_id = actor_id;
      send(reused.message);
    }
  }
}

bool FromWire(const World& world, const transitions_t& message, OrderResult& result) {
  if (!SizesMatch(world, message)) {
    return false;
  }
  result.order_index = message.order_index;
  result.seed = static_cast<uint64_t>(message.seed);
  result.first_transition = message.first_transition;
  result.first_field = message.first_field;
  result.td_errors = message.td_error;
  Episode& episode = result.episode;
  episode.ending = static_cast<Ending>(message.ending);
  episode.actions = message.action;
  episode.rewards = message.reward;
  JoinRows(message.state, message.field_count, episode.states);
  JoinRows(message.next_mask, message.mask_size, episode.next_masks);
  const auto is_action = [&](int16_t action) { return action >= 0 && action < world.actions(); };
  return std::all_of(episode.actions.begin(), episode.actions.end(), is_action) &&
         AreFinite(episode.states) && AreFinite(episode.rewards) && AreFinite(result.td_errors);
}

int64_t LongestResultBytes(const World& world) {
  const auto td_errors = world.longest_episode() * static_cast<int64_t>(sizeof(float));
  return LongestEpisodeBytes(world) + static_cast<int64_t>(sizeof(OrderResult) - sizeof(Episode)) + td_errors;
}

}  // namespace fresco
