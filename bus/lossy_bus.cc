#include "bus/lossy_bus.h"

#include <mutex>
#include <vector>

#include "core/check.h"
#include "core/random.h"

namespace fresco {
namespace {

class LossyBus : public Bus {
 public:
  LossyBus(Bus& inner, LossOptions options)
      : inner_(&inner), options_(options), stream_(options.seed, RandomPurpose::kTest, 0, 0) {
    for (const double probability : {options.drop, options.duplicate, options.delay, options.corrupt}) {
      FRESCO_CHECK(probability >= 0 && probability <= 1);
    }
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

  int Poll(int64_t timeout_us, int maximum_messages) override {
    return inner_->Poll(timeout_us, maximum_messages);
  }

  int64_t refused_messages() const override { return inner_->refused_messages(); }

 private:
  static constexpr uint32_t kLongestDelay = 16;

  struct Held {
    std::string channel;
    std::vector<std::byte> message;
    int publishes_left;
  };

  bool Happens(double probability) { return stream_.NextUniform() < probability; }

  /// Counts a publish and sends what has waited long enough.
  void ReleaseHeld() {
    for (Held& held : held_) {
      if (--held.publishes_left == 0) {
        inner_->Publish(held.channel, held.message);
      }
    }
    std::erase_if(held_, [](const Held& held) { return held.publishes_left <= 0; });
  }

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

}  // namespace fresco
