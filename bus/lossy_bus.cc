#include "bus/lossy_bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <mutex>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace fresco {
namespace {

struct Probability {
  std::string_view name;
  double LossOptions::*value;
};
constexpr Probability kProbabilities[] = {{"drop", &LossOptions::drop},
                                          {"duplicate", &LossOptions::duplicate},
                                          {"delay", &LossOptions::delay},
                                          {"corrupt", &LossOptions::corrupt}};

class LossyBus : public Bus {
 public:
  LossyBus(Bus& inner, LossOptions options)
      : inner_(&inner), options_(options), stream_(options.seed, RandomPurpose::kTest, 0, 0) {
    for (const Probability& probability : kProbabilities) {
      FRESCO_CHECK(options.*(probability.value) >= 0 && options.*(probability.value) <= 1);
    }
  }
  LossyBus(std::unique_ptr<Bus> inner, LossOptions options) : LossyBus(*inner, options) {
    owned_ = std::move(inner);
  }

  bool Publish(const std::string& channel, std::span<const std::byte> message) override {
    const std::lock_guard lock(mutex_);
    Held fate{channel, {message.begin(), message.end()}, 0};
    const bool dropped = Happens(options_.drop);
    const bool duplicated = Happens(options_.duplicate);
    const bool delayed = Happens(options_.delay);
    if (Happens(options_.corrupt) && !fate.message.empty()) {
      const auto bit = stream_.NextBelow(static_cast<uint32_t>(fate.message.size()) * 8);
      fate.message[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
    fate.publishes_left = delayed ? 1 + static_cast<int>(stream_.NextBelow(kLongestDelay)) : 0;
    ReleaseHeld();
    if (dropped) {
      return true;
    }
    if (delayed) {
      held_.push_back(fate);
    } else {
      inner_->Publish(fate.channel, fate.message);
    }
    return !duplicated || inner_->Publish(fate.channel, fate.message);
  }

  void Subscribe(const std::string& channel, BusHandler handler, int queue_capacity) override {
    inner_->Subscribe(channel, std::move(handler), queue_capacity);
  }

  void SubscribeToAll(BusEventHandler handler) override { inner_->SubscribeToAll(std::move(handler)); }

  int Poll(int64_t timeout_us, int maximum_messages) override {
    return inner_->Poll(timeout_us, maximum_messages);
  }

  int64_t refused_messages() const override { return inner_->refused_messages(); }

  UnheardTraffic unheard() const override { return inner_->unheard(); }

 private:
  static constexpr uint32_t kLongestDelay = 16;

  struct Held {
    std::string channel;
    std::vector<std::byte> message;
    int publishes_left;
  };

  bool Happens(double probability) { return stream_.NextUniform() < probability; }

  /// Called once for each published message; sends the messages that were held back for long enough.
  void ReleaseHeld() {
    for (Held& held : held_) {
      if (--held.publishes_left == 0) {
        inner_->Publish(held.channel, held.message);
      }
    }
    std::erase_if(held_, [](const Held& held) { return held.publishes_left <= 0; });
  }

  std::unique_ptr<Bus> owned_;  // null if this object does not own inner_
  Bus* inner_;
  LossOptions options_;
  std::mutex mutex_;
  RandomStream stream_;
  std::vector<Held> held_;
};

}  // namespace

std::unique_ptr<Bus> MakeLossyBus(Bus& inner, LossOptions options) {
  return std::make_unique<LossyBus>(inner, options);
}

std::unique_ptr<Bus> MakeLossyBus(std::unique_ptr<Bus> inner, LossOptions options) {
  return std::make_unique<LossyBus>(std::move(inner), options);
}

LossOptions ParseLossOptions(const std::string& text) {
  LossOptions options;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const size_t equals = std::min(part.find('='), part.size());
    const std::string name = part.substr(0, equals);
    const std::string value = part.substr(std::min(equals + 1, part.size()));
    const auto known = std::find_if(std::begin(kProbabilities), std::end(kProbabilities),
                                    [&](const auto& entry) { return entry.name == name; });
    const char* end = value.data() + value.size();
    std::from_chars_result read{value.data(), std::errc::invalid_argument};
    bool in_range = true;
    if (name == "seed") {
      read = std::from_chars(value.data(), end, options.seed);
    } else if (known != std::end(kProbabilities)) {
      double& probability = options.*(known->value);
      read = std::from_chars(value.data(), end, probability);
      in_range = probability >= 0 && probability <= 1;
    }
    if (read.ec != std::errc() || read.ptr != end || !in_range) {
      throw UsageError(fmt::format(
          "disturbance \"{}\": expected drop, duplicate, delay or corrupt with a probability of 0 to "
          "1, or seed with an integer, found \"{}\"; for example: drop=0.01,delay=0.05,seed=3",
          text, part));
    }
  }
  return options;
}

std::string ToText(const LossOptions& options) {
  std::string text = fmt::format("seed={}", options.seed);
  for (const auto& [name, value] : kProbabilities) {
    text += fmt::format(",{}={}", name, options.*value);
  }
  return text;
}

}  // namespace fresco
