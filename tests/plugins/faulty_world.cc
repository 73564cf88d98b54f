// A plug-in that misbehaves as its settings say, for tests.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include "plugins/fresco/world.h"

namespace {

std::string fault;

struct Faulty {
  fresco_quantity state[2] = {{"steps", "s"}, {"seed", ""}};
  const char* actions[2] = {"go", "stay"};
  fresco_world_description description{};
};

struct Walk {
  uint64_t seed = 0;
  int steps = 0;
};

void Misbehave(const char* call) {
  if (fault == std::string("crash in ") + call) {
    std::raise(SIGSEGV);
  } else if (fault == std::string("abort in ") + call) {
    std::abort();
  } else if (fault == std::string("hang in ") + call) {
    std::this_thread::sleep_for(std::chrono::hours(1));
  } else if (fault == std::string("throw in ") + call) {
    throw std::runtime_error("thrown on purpose");
  } else if (fault == std::string("exit in ") + call) {
    std::_Exit(0);
  }
}

bool Fails(const char* call, char* error, size_t error_size) {
  const bool fails = fault == std::string("fail in ") + call;
  if (fails) {
    std::snprintf(error, error_size, "failed on purpose");
  }
  return fails;
}

void* Create(const char* settings, char* error, size_t error_size) {
  fault = settings;
  Misbehave("create");
  if (Fails("create", error, error_size)) {
    return nullptr;
  }
  auto* world = new Faulty;
  fresco_world_description& description = world->description;
  description = {"faulty", 2, world->state, 2, world->actions, 10, 0.9, 5, "walked"};
  description.state_size = fault == "no state" ? 0 : (fault == "a huge state" ? 2'000'000'000 : 2);
  description.action_count = fault == "negative actions" ? -1 : 2;
  description.longest_episode = fault == "an endless episode" ? 100'001 : 10;
  description.discount = fault == "a discount of NaN" ? std::nan("") : 0.9;
  description.name = fault == "no name" ? nullptr : (fault == "a bad name" ? "Faulty World" : "faulty");
  description.without_chance =
      fault == "no chance" || fault == "hidden chance" ? 1 : (fault == "half a chance" ? 2 : 0);
  world->state[1].name = fault == "a field without a name" ? "" : "seed";
  world->actions[1] = fault == "an action without a name" ? nullptr : "stay";
  return world;
}

void Destroy(void* world) {
  delete static_cast<Faulty*>(world);
}

const fresco_world_description* Describe(const void* world) {
  Misbehave("describe");
  return fault == "no description" ? nullptr : &static_cast<const Faulty*>(world)->description;
}

void* Make(const void*, char* error, size_t error_size) {
  Misbehave("make");
  return Fails("make", error, error_size) ? nullptr : new Walk;
}

void Release(void* walk) {
  delete static_cast<Walk*>(walk);
}

void WriteState(const Walk& walk, float* state, uint8_t* mask) {
  state[0] = fault == "a state of NaN" && walk.steps == 3 ? std::nanf("") : static_cast<float>(walk.steps);
  state[1] = static_cast<float>(walk.seed % 7);
  if (walk.steps == 3) {
    if (fault == "an empty mask") {
      mask[0] = mask[1] = 0;
    } else if (fault == "a mask of nonsense") {
      mask[1] = 7;
    }
  }
}

int32_t Reset(void* pointer, uint64_t seed, float* state, uint8_t* mask, char* error, size_t error_size) {
  Misbehave("reset");
  Walk& walk = *static_cast<Walk*>(pointer);
  walk = {fault == "no chance" ? 0 : seed, 0};
  WriteState(walk, state, mask);
  return Fails("reset", error, error_size) ? 0 : 1;
}

int32_t Step(void* pointer, int32_t action, double* reward, int32_t* ending, float* state, uint8_t* mask,
             char* error, size_t error_size) {
  Walk& walk = *static_cast<Walk*>(pointer);
  ++walk.steps;
  if (walk.steps == 3) {
    Misbehave("step");
  }
  *reward = fault == "a reward of infinity" && walk.steps == 3 ? HUGE_VAL : (action == 0 ? 1 : 0);
  *ending = fault == "a bad ending" && walk.steps == 3
                ? 9
                : (walk.steps == 6 && walk.seed % 2 == 0 ? FRESCO_TERMINAL : 0);
  static int calls = 0;
  if (fault == "a clock") {
    *reward += ++calls;
  }
  WriteState(walk, state, mask);
  return walk.steps == 3 && Fails("step", error, error_size) ? 0 : 1;
}

}  // namespace

const fresco_world_functions* fresco_world(void) {
#ifdef FRESCO_OTHER_ABI
  constexpr uint32_t kVersion = FRESCO_WORLD_ABI_VERSION + 1;
#else
  constexpr uint32_t kVersion = FRESCO_WORLD_ABI_VERSION;
#endif
  static const fresco_world_functions functions = {kVersion, Create,  Destroy, Describe,
                                                   Make,     Release, Reset,   Step};
  return &functions;
}
