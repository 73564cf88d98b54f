// The plug-in that hosts Python: runs an object with Gymnasium's interface as a world. Settings, a line each:
// module:Class, the folder of the module, steps of the longest episode, the return of an episode that
// succeeds. The functions are those of fresco/world.h; Python runs in the calling thread.
#include <pybind11/embed.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugins/fresco/world.h"

namespace py = pybind11;

namespace {

/// The last line of a Python error and where it happened.
std::string TextOf(const std::exception& error) {
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

void WriteError(const std::string& text, char* error, size_t error_size) {
  const size_t size = std::min(text.size(), error_size - 1);
  std::memcpy(error, text.data(), size);
  error[size] = '\0';
}

/// Calls `function`. An exception becomes the error's text and the result `failed`.
template <class Result, class Function>
Result Guarded(char* error, size_t error_size, Result failed, Function&& function) {
  try {
    return function();
  } catch (const std::exception& exception) {
    WriteError(TextOf(exception), error, error_size);
    return failed;
  }
}

struct World {
  py::object type;  // the class
  std::vector<std::string> texts;
  std::vector<fresco_quantity> state;
  std::vector<const char*> actions;
  std::string name;
  fresco_world_description description{};
};

/// An instance of the class.
struct Instance {
  py::object object;
  size_t state_size;
  size_t actions;
};

/// The number of values of a space such as Box(4,): the product of its shape.
int32_t SizeOf(const py::object& space) {
  int64_t size = 1;
  for (const py::handle& length : space.attr("shape").cast<py::tuple>()) {
    size *= length.cast<int64_t>();
  }
  if (size < 1 || size > 10'000) {
    throw std::runtime_error("observation_space has " + std::to_string(size) +
                             " values; allowed: 1 to 10000");
  }
  return static_cast<int32_t>(size);
}

/// Names for the fields of the state: the object's `observation_names` if it has them.
std::vector<std::string> StateNames(const py::object& object, int32_t size) {
  std::vector<std::string> names;
  if (py::hasattr(object, "observation_names")) {
    names = object.attr("observation_names").cast<std::vector<std::string>>();
    if (names.size() != static_cast<size_t>(size)) {
      throw std::runtime_error("observation_names has " + std::to_string(names.size()) + " names for " +
                               std::to_string(size) + " values");
    }
    return names;
  }
  for (int32_t i = 0; i < size; ++i) {
    names.push_back("observation_" + std::to_string(i));
  }
  return names;
}

std::vector<std::string> ActionNames(const py::object& object, int32_t count) {
  std::vector<std::string> names;
  if (py::hasattr(object, "action_names")) {
    names = object.attr("action_names").cast<std::vector<std::string>>();
    if (names.size() != static_cast<size_t>(count)) {
      throw std::runtime_error("action_names has " + std::to_string(names.size()) + " names for " +
                               std::to_string(count) + " actions");
    }
    return names;
  }
  for (int32_t i = 0; i < count; ++i) {
    names.push_back("action " + std::to_string(i));
  }
  return names;
}

/// "CartPole" becomes "cartpole": the name of a world has small letters, digits and underscores.
std::string WorldName(const std::string& class_name) {
  std::string name;
  for (const char c : class_name) {
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

std::unique_ptr<World> MakeWorld(const std::string& settings) {
  std::istringstream lines(settings);
  std::string object_name;
  std::string folder;
  std::getline(lines, object_name);
  std::getline(lines, folder);
  auto world = std::make_unique<World>();
  lines >> world->description.longest_episode >> world->description.success_return;
  const size_t colon = object_name.find(':');
  if (!lines || colon == std::string::npos) {
    throw std::runtime_error("expected module:Class, a folder, steps and a return, a line each");
  }
  py::module_::import("sys").attr("path").attr("insert")(0, folder);
  const std::string class_name = object_name.substr(colon + 1);
  world->type = py::module_::import(object_name.substr(0, colon).c_str()).attr(class_name.c_str());
  const py::object object = world->type();
  const int32_t state_size = SizeOf(object.attr("observation_space"));
  const auto actions = object.attr("action_space").attr("n").cast<int32_t>();
  for (std::vector<std::string> names : {StateNames(object, state_size), ActionNames(object, actions)}) {
    world->texts.insert(world->texts.end(), names.begin(), names.end());
  }
  for (int32_t i = 0; i < state_size; ++i) {
    world->state.push_back({world->texts[static_cast<size_t>(i)].c_str(), nullptr});
  }
  for (size_t i = static_cast<size_t>(state_size); i < world->texts.size(); ++i) {
    world->actions.push_back(world->texts[i].c_str());
  }
  world->name = WorldName(class_name);
  fresco_world_description& description = world->description;
  description.name = world->name.c_str();
  description.state_size = state_size;
  description.state = world->state.data();
  description.action_count = actions;
  description.actions = world->actions.data();
  description.discount = 0.99;
  description.success = "succeeded";
  description.without_chance =
      py::hasattr(object, "without_chance") && object.attr("without_chance").cast<bool>() ? 1 : 0;
  return world;
}

void* Create(const char* settings, char* error, size_t error_size) {
  // Without Python's signal handlers, so that Ctrl-C still reaches the program. Python runs until the process
  // ends: many modules can't be loaded twice.
  if (Py_IsInitialized() == 0) {
    py::initialize_interpreter(false);
  }
  return Guarded<void*>(error, error_size, nullptr, [&] { return MakeWorld(settings).release(); });
}

void Destroy(void* world) {
  delete static_cast<World*>(world);
}

const fresco_world_description* Describe(const void* world) {
  return &static_cast<const World*>(world)->description;
}

void* Make(const void* pointer, char* error, size_t error_size) {
  return Guarded<void*>(error, error_size, nullptr, [&] {
    const auto& world = *static_cast<const World*>(pointer);
    return new Instance{world.type(), world.state.size(), world.actions.size()};
  });
}

void Release(void* environment) {
  delete static_cast<Instance*>(environment);
}

/// Appends the numbers of a number, a sequence of them or a NumPy array, row by row.
void Flatten(const py::handle& value, std::vector<float>& numbers) {
  if (py::hasattr(value, "tolist")) {  // NumPy's arrays and numbers
    Flatten(value.attr("tolist")(), numbers);
  } else if (PyNumber_Check(value.ptr()) != 0) {
    numbers.push_back(value.cast<float>());
  } else if (py::isinstance<py::sequence>(value) && !py::isinstance<py::str>(value)) {
    for (const py::handle& element : value.cast<py::sequence>()) {
      Flatten(element, numbers);
    }
  } else {
    throw std::runtime_error("the observation is no array of numbers");
  }
}

void WriteObservation(const Instance& instance, const py::handle& observation, float* state) {
  std::vector<float> values;
  Flatten(observation, values);
  if (values.size() != instance.state_size) {
    throw std::runtime_error("the observation has " + std::to_string(values.size()) + " values; expected " +
                             std::to_string(instance.state_size) + ", as observation_space says");
  }
  std::copy(values.begin(), values.end(), state);
}

void WriteMask(const Instance& instance, uint8_t* mask) {
  if (!py::hasattr(instance.object, "action_mask")) {
    return;
  }
  py::object given = instance.object.attr("action_mask");
  if (PyCallable_Check(given.ptr()) != 0) {
    given = given();
  }
  std::vector<float> allowed;
  Flatten(given, allowed);
  if (allowed.size() != instance.actions) {
    throw std::runtime_error("action_mask has " + std::to_string(allowed.size()) + " values for " +
                             std::to_string(instance.actions) + " actions");
  }
  std::transform(allowed.begin(), allowed.end(), mask,
                 [](float value) { return static_cast<uint8_t>(value != 0); });
}

int32_t Reset(void* pointer, uint64_t seed, float* state, uint8_t* mask, char* error, size_t error_size) {
  return Guarded<int32_t>(error, error_size, 0, [&] {
    const auto& instance = *static_cast<const Instance*>(pointer);
    const py::object result = instance.object.attr("reset")(py::arg("seed") = seed);
    // Gymnasium returns (observation, info).
    const bool has_info = py::isinstance<py::tuple>(result) && py::len(result) == 2;
    WriteObservation(instance, has_info ? result.cast<py::tuple>()[0].cast<py::object>() : result, state);
    WriteMask(instance, mask);
    return 1;
  });
}

int32_t Step(void* pointer, int32_t action, double* reward, int32_t* ending, float* state, uint8_t* mask,
             char* error, size_t error_size) {
  return Guarded<int32_t>(error, error_size, 0, [&] {
    const auto& instance = *static_cast<const Instance*>(pointer);
    const py::object result = instance.object.attr("step")(action);
    if (!py::isinstance<py::tuple>(result) || py::len(result) != 5) {
      throw std::runtime_error("step() has to return (observation, reward, terminated, truncated, info)");
    }
    const auto values = result.cast<py::tuple>();
    WriteObservation(instance, values[0], state);
    *reward = values[1].cast<double>();
    *ending = values[2].cast<bool>() ? FRESCO_TERMINAL
                                     : (values[3].cast<bool>() ? FRESCO_TRUNCATED : FRESCO_CONTINUES);
    WriteMask(instance, mask);
    return 1;
  });
}

}  // namespace

const fresco_world_functions* fresco_world(void) {
  static const fresco_world_functions functions = {
      FRESCO_WORLD_ABI_VERSION, Create, Destroy, Describe, Make, Release, Reset, Step,
  };
  return &functions;
}
