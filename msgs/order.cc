#include "msgs/order.h"

#include <algorithm>
#include <cmath>

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

transitions_t MessageOf(const World& world, const OrderResult& result, MessageLayout part, int first,
                        int first_field) {
  const Episode& episode = result.episode;
  transitions_t message{};
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
  for (int i = first; i <= first + part.transitions; ++i) {
    const auto fields = episode.state(static_cast<size_t>(i))
                            .subspan(static_cast<size_t>(first_field), static_cast<size_t>(part.fields));
    message.state.emplace_back(fields.begin(), fields.end());
  }
  for (int i = first; i < first + part.transitions; ++i) {
    const auto at = static_cast<size_t>(i);
    const auto mask = episode.next_masks.begin() + i * message.mask_size;
    message.action.push_back(episode.actions[at]);
    message.reward.push_back(episode.rewards[at]);
    message.td_error.push_back(result.td_errors[at]);
    message.next_mask.emplace_back(mask, mask + message.mask_size);
  }
  return message;
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

bool ReadTransition(const World& world, const transitions_t& message, size_t i, OrderResult& result) {
  result.episode.actions.push_back(message.action[i]);
  result.episode.rewards.push_back(message.reward[i]);
  result.td_errors.push_back(message.td_error[i]);
  for (const auto byte : message.next_mask[i]) {
    result.episode.next_masks.push_back(static_cast<uint8_t>(byte));
  }
  return message.action[i] >= 0 && message.action[i] < world.actions() && std::isfinite(message.reward[i]) &&
         std::isfinite(message.td_error[i]);
}

}  // namespace

order_t ToWire(const Order& order, int64_t actor_id, int32_t attempt) {
  order_t message{};
  message.index = order.index;
  message.actor_id = actor_id;
  message.attempt = attempt;
  message.kind = static_cast<int8_t>(order.kind);
  message.epsilon = order.epsilon;
  message.seed = static_cast<int64_t>(order.seed);
  message.current_version = order.current_version;
  message.target_version = order.target_version;
  return message;
}

bool FromWire(const order_t& message, Order& order) {
  order = {message.index,           static_cast<OrderKind>(message.kind),
           message.epsilon,         static_cast<uint64_t>(message.seed),
           message.current_version, message.target_version};
  return message.index >= 0 && message.index < (int64_t{1} << 32) &&
         (message.kind == 0 || message.kind == 1) && message.epsilon >= 0 && message.epsilon <= 1 &&
         message.current_version >= 0 && message.target_version >= 0 && message.attempt >= 0;
}

MessageLayout LayoutOf(int state_size, int actions) {
  MessageLayout layout{0, state_size};
  while (EncodedBytes(layout.transitions + 1, state_size, actions) <= kMaximumEncodedBytes) {
    ++layout.transitions;
  }
  if (layout.transitions == 0) {
    layout.transitions = 1;
    while (EncodedBytes(1, layout.fields, actions) > kMaximumEncodedBytes) {
      --layout.fields;
    }
  }
  return layout;
}

void SplitResult(const World& world, const OrderResult& result, int64_t actor_id,
                 const std::function<void(const transitions_t&)>& send) {
  const MessageLayout layout = LayoutOf(world);
  const int transitions = result.episode.transitions();
  for (int first = 0; first < transitions; first += layout.transitions) {
    for (int first_field = 0; first_field < world.state_size(); first_field += layout.fields) {
      const MessageLayout part = {std::min(layout.transitions, transitions - first),
                                  std::min(layout.fields, world.state_size() - first_field)};
      transitions_t message = MessageOf(world, result, part, first, first_field);
      message.actor_id = actor_id;
      send(message);
    }
  }
}

bool FromWire(const World& world, const transitions_t& message, OrderResult& result) {
  result.episode.Clear();
  result.td_errors.clear();
  if (!SizesMatch(world, message)) {
    return false;
  }
  result.order_index = message.order_index;
  result.seed = static_cast<uint64_t>(message.seed);
  result.first_transition = message.first_transition;
  result.first_field = message.first_field;
  result.episode.ending = static_cast<Ending>(message.ending);
  for (const std::vector<float>& state : message.state) {
    result.episode.states.insert(result.episode.states.end(), state.begin(), state.end());
  }
  bool valid = std::all_of(result.episode.states.begin(), result.episode.states.end(),
                           [](float value) { return std::isfinite(value); });
  for (size_t i = 0; valid && i < static_cast<size_t>(message.transition_count); ++i) {
    valid = ReadTransition(world, message, i, result);
  }
  return valid;
}

int64_t LongestResultBytes(const World& world) {
  const auto td_errors = world.longest_episode() * static_cast<int64_t>(sizeof(float));
  return LongestEpisodeBytes(world) + static_cast<int64_t>(sizeof(OrderResult) - sizeof(Episode)) + td_errors;
}

}  // namespace fresco
