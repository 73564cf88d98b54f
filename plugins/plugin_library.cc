#include "plugins/plugin_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <vector>

#include "core/error.h"
#include "plugins/call_guard.h"

namespace fresco {
namespace {

constexpr size_t kMaximumUnitBytes = 15;

/// Room for the text of an error.
class ErrorText {
 public:
  char* data() { return text_.data(); }
  size_t size() const { return text_.size(); }
  /// What the plug-in wrote; it may have forgotten the closing zero.
  std::string text() const {
    const auto end = std::find(text_.begin(), text_.end(), '\0');
    return end == text_.begin() ? "it gave no reason" : std::string(text_.begin(), end);
  }

 private:
  std::array<char, 1000> text_{};
};

/// Whether the text is printable and not too long; `identifier`: as the name of a quantity.
bool IsText(const char* text, size_t maximum_bytes, bool identifier) {
  const std::string_view view =
      text == nullptr ? std::string_view() : std::string_view(text, strnlen(text, 1000));
  return !view.empty() && view.size() <= maximum_bytes && std::all_of(view.begin(), view.end(), [&](char c) {
    return identifier ? (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' : c >= ' ' && c <= '~';
  });
}

/// What is wrong with a description; "" if nothing is.
std::string ProblemOf(const fresco_world_description& world) {
  const auto out_of_range = [](const char* field, double value, double low, double high) {
    return value >= low && value <= high
               ? std::string()
               : fmt::format("{} is {}; allowed: {} to {}", field, value, low, high);
  };
  for (const std::string& problem :
       {out_of_range("state_size", world.state_size, 1, kMaximumStateSize),
        out_of_range("action_count", world.action_count, 1, kMaximumActions),
        out_of_range("longest_episode", world.longest_episode, 1, kMaximumEpisode),
        out_of_range("discount", world.discount, 0, 1),
        out_of_range("without_chance", world.without_chance, 0, 1)}) {
    if (!problem.empty()) {
      return problem;
    }
  }
  if (!std::isfinite(world.success_return)) {
    return "success_return is not finite";
  }
  if (!IsText(world.name, kMaximumNameBytes, true) || !IsText(world.success, kMaximumNameBytes, true)) {
    return "name or success is no name";
  }
  if (world.state == nullptr || world.actions == nullptr) {
    return "state or actions is null";
  }
  for (int i = 0; i < world.state_size; ++i) {
    const char* unit = world.state[i].unit;
    const bool has_unit = unit != nullptr && *unit != '\0';
    if (!IsText(world.state[i].name, kMaximumNameBytes, true) ||
        (has_unit && !IsText(unit, kMaximumUnitBytes, false))) {
      return fmt::format("field {} of the state has no name, or its unit is too long", i);
    }
  }
  for (int i = 0; i < world.action_count; ++i) {
    if (!IsText(world.actions[i], kMaximumNameBytes, false)) {
      return fmt::format("action {} has no name, or a too long one", i);
    }
  }
  return "";
}

PluginDescription DescriptionOf(const fresco_world_description& from) {
  PluginDescription to;
  to.success_return = from.success_return;
  WorldDescription& world = to.world;
  world.name = from.name;
  for (int i = 0; i < from.state_size; ++i) {
    const char* unit = from.state[i].unit;
    world.state.push_back({from.state[i].name, unit == nullptr ? "" : unit});
  }
  world.actions.assign(from.actions, from.actions + from.action_count);
  world.observation_size = from.state_size;
  world.longest_episode = from.longest_episode;
  world.discount = from.discount;
  world.repeatable = false;  // the learner does not run its code
  world.random = from.without_chance == 0;
  world.chance = world.random;
  world.figures = {{"return", ""}};
  world.success = from.success;
  return to;
}

/// Calls `function` of the plug-in, guarded. `call` is its name.
template <class Function>
auto Call(const PluginSpec& spec, const char* call, Function&& function) {
  const CallGuard guard(spec.library, call, spec.call_limit_s);
  try {
    return function();
  } catch (const std::exception& exception) {
    throw PluginFailure(
        fmt::format("the plug-in {} threw an exception in {}(): {}", spec.library, call, exception.what()));
  } catch (...) {
    throw PluginFailure(fmt::format("the plug-in {} threw an exception in {}()", spec.library, call));
  }
}

class PluginEnvironment : public Environment {
 public:
  /// All of these must outlive the object.
  PluginEnvironment(const PluginSpec& spec, const fresco_world_functions& functions, const void* world,
                    const WorldDescription& description)
      : spec_(spec),
        functions_(functions),
        description_(description),
        state_(description.state.size()),
        mask_(description.actions.size()) {
    ErrorText error;
    environment_ = Call(spec_, "make", [&] { return functions_.make(world, error.data(), error.size()); });
    if (environment_ == nullptr) {
      Fail("make", error.text());
    }
  }
  ~PluginEnvironment() override {
    try {
      Call(spec_, "release", [&] { functions_.release(environment_); });
    } catch (const std::exception&) {  // it threw; the environment is gone in any case
    }
  }
  PluginEnvironment(const PluginEnvironment&) = delete;
  PluginEnvironment& operator=(const PluginEnvironment&) = delete;

  void Reset(uint64_t seed) override {
    steps_ = 0;
    ended_ = false;
    std::fill(mask_.begin(), mask_.end(), uint8_t{1});
    ErrorText error;
    const int32_t succeeded = Call(spec_, "reset", [&] {
      return functions_.reset(environment_, seed, state_.data(), mask_.data(), error.data(), error.size());
    });
    Check("reset", succeeded, error);
  }

  StepResult Step(int action) override {
    FRESCO_CHECK(!ended_);
    std::fill(mask_.begin(), mask_.end(), uint8_t{1});
    StepResult result;
    int32_t ending = FRESCO_CONTINUES;
    ErrorText error;
    const int32_t succeeded = Call(spec_, "step", [&] {
      return functions_.step(environment_, action, &result.reward, &ending, state_.data(), mask_.data(),
                             error.data(), error.size());
    });
    Check("step", succeeded, error);
    if (!std::isfinite(static_cast<float>(result.reward))) {
      Fail("step", fmt::format("the reward is {}", result.reward));
    }
    if (ending < FRESCO_CONTINUES || ending > FRESCO_TRUNCATED) {
      Fail("step", fmt::format("the ending is {}; allowed: 0 to 2", ending));
    }
    ++steps_;
    const bool too_long = steps_ == description_.longest_episode;
    result.ending = ending == FRESCO_CONTINUES && too_long ? Ending::kTruncated : static_cast<Ending>(ending);
    ended_ = result.ending != Ending::kNone;
    return result;
  }

  void WriteState(std::span<float> state) const override {
    std::copy(state_.begin(), state_.end(), state.begin());
  }
  void WriteMask(std::span<uint8_t> mask) const override {
    std::copy(mask_.begin(), mask_.end(), mask.begin());
  }

 private:
  [[noreturn]] void Fail(const char* call, const std::string& problem) const {
    throw PluginFailure(fmt::format("the plug-in {} failed in {}(): {}", spec_.library, call, problem));
  }

  /// Checks the state and the mask that a call has written.
  void Check(const char* call, int32_t succeeded, const ErrorText& error) const {
    if (succeeded == 0) {
      Fail(call, error.text());
    }
    for (size_t field = 0; field < state_.size(); ++field) {
      if (!std::isfinite(state_[field])) {
        Fail(call, fmt::format("the state's {} is {}", description_.state[field].name, state_[field]));
      }
    }
    const bool bits = std::all_of(mask_.begin(), mask_.end(), [](uint8_t allowed) { return allowed <= 1; });
    if (!bits || std::count(mask_.begin(), mask_.end(), 1) == 0) {
      Fail(call, "the mask has to have ones and zeros, and at least one 1");
    }
  }

  const PluginSpec& spec_;
  const fresco_world_functions& functions_;
  const WorldDescription& description_;
  void* environment_ = nullptr;
  std::vector<float> state_;
  std::vector<uint8_t> mask_;
  int steps_ = 0;
  bool ended_ = false;
};

}  // namespace

// The library stays loaded for as long as the process runs: what it has started (threads, handlers) may still
// use its code.
PluginLibrary::PluginLibrary(const PluginSpec& spec) : spec_(spec) {
  Load();
  ErrorText error;
  void* world = Call(spec_, "create",
                     [&] { return functions_->create(spec_.settings.c_str(), error.data(), error.size()); });
  if (world == nullptr) {
    Refuse("create() refuses the settings: " + error.text());
  }
  world_ = {world, [this](void* made) {
              try {
                Call(spec_, "destroy", [&] { functions_->destroy(made); });
              } catch (const std::exception&) {  // it threw; the world is gone in any case
              }
            }};
  Describe();
}

void PluginLibrary::Refuse(const std::string& problem) const {
  throw UsageError(fmt::format("plugin.library: {}: {}", spec_.library, problem));
}

void PluginLibrary::Load() {
  const std::string path = std::filesystem::absolute(spec_.library).string();
  handle_ = Call(spec_, "dlopen", [&] { return dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL); });
  if (handle_ == nullptr) {
    Refuse(fmt::format("can't be loaded: {}", dlerror()));
  }
  void* symbol = dlsym(handle_, "fresco_world");
  if (symbol == nullptr) {
    Refuse("is no plug-in of Fresco: it does not export the function fresco_world (fresco/world.h)");
  }
  const auto fresco_world_function = reinterpret_cast<decltype(&fresco_world)>(symbol);
  functions_ = Call(spec_, "fresco_world", [&] { return fresco_world_function(); });
  if (functions_ == nullptr) {
    Refuse("fresco_world() returns null");
  }
  if (functions_->abi_version != FRESCO_WORLD_ABI_VERSION) {
    Refuse(fmt::format("is of version {} of fresco/world.h; expected: version {}; build it again",
                       functions_->abi_version, FRESCO_WORLD_ABI_VERSION));
  }
  if (functions_->create == nullptr || functions_->destroy == nullptr || functions_->describe == nullptr ||
      functions_->make == nullptr || functions_->release == nullptr || functions_->reset == nullptr ||
      functions_->step == nullptr) {
    Refuse("a function of its table is null");
  }
}

void PluginLibrary::Describe() {
  const fresco_world_description* world =
      Call(spec_, "describe", [&] { return functions_->describe(world_.get()); });
  if (world == nullptr) {
    Refuse("describe() returns null");
  }
  if (const std::string problem = Call(spec_, "describe", [&] { return ProblemOf(*world); });
      !problem.empty()) {
    Refuse("describes a world that is not allowed: " + problem);
  }
  description_ = DescriptionOf(*world);
}

std::unique_ptr<Environment> PluginLibrary::NewEnvironment() {
  return std::make_unique<PluginEnvironment>(spec_, *functions_, world_.get(), description_.world);
}

}  // namespace fresco
