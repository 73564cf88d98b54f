// Whole updates a second as the learner makes them, with the paper's network 7-200-256-20, on one thread.
//
// The roof is the time of the update's matrix products alone: for each product the fastest of three
// libraries, measured alone, with its operands in the cache. It counts every product as dense, as a library
// would do it.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "nn/mlp.h"
#include "tests/bench/products.h"
#include "tests/bench/pytorch.h"
#include "tests/bench/subjects.h"
#include "tests/bench/update_loop.h"

namespace fresco {
namespace {

std::shared_ptr<const Mlp> PaperNetwork() {
  return std::make_shared<Mlp>(MlpShape({7, 200, 256, 20}));
}

DqnOptions OptionsWith(int batch, bool double_dqn) {
  DqnOptions options;
  options.double_dqn = double_dqn;
  options.batch_size = batch;
  return options;
}

/// So many updates a second, beside the roof of these products.
Results UpdateBesideRoof(const std::string& name, std::shared_ptr<const Network> network,
                         const DqnOptions& options, const std::vector<ProductShape>& products,
                         double seconds) {
  UpdateLoop loop(std::move(network), options);
  std::vector<Work> works;
  for (const ProductShape& product : products) {
    for (const Work& work : ProductWorks(product)) {
      works.push_back(work);
    }
  }
  const Speeds speeds = Alternate(
      [&] {
        loop.Step();
        return 1.0;
      },
      works, seconds);
  double roof_s = 0;
  std::array<int, kProductLibraries> fastest_count{};
  for (size_t product = 0; product < products.size(); ++product) {
    const auto first = speeds.references.begin() + static_cast<int64_t>(product * kProductLibraries);
    const auto fastest = std::max_element(first, first + kProductLibraries);
    roof_s += products[product].times / *fastest;
    ++fastest_count[static_cast<size_t>(fastest - first)];
  }
  std::string reference =
      fmt::format("its {} matrix products alone, each by its fastest library:", products.size());
  for (size_t library = 0; library < kProductLibraries; ++library) {
    reference += fmt::format("{} {} {}", library == 0 ? "" : ",", fastest_count[library],
                             ProductLibraryNames()[library]);
  }
  return {{MoreIsBetter(name, speeds.value, "updates/s", reference, 1 / roof_s)}, {}};
}

/// The UAV's network for sets, with ten sensors.
Results UpdateOfSets(double seconds) {
  const SetShape shape{12, 10, 12, 5, {64, 64}, {128, 128}, {64}};
  return UpdateBesideRoof("update_sets", std::make_shared<SetNetwork>(shape), OptionsWith(200, false),
                          ProductsOfUpdate(shape, 200), seconds);
}

Results UpdateBesidePyTorch(double seconds) {
  constexpr int kUpdatesPerRequest = 8;  // so that asking takes no time, and about one turn
  std::string reason;
  const auto peers = PyTorchUpdates::StartAll(seconds / 20, reason);
  if (peers.empty()) {
    return AllAbsent({"update_pytorch"}, reason);
  }
  std::vector<Work> works;
  for (const auto& peer : peers) {
    works.push_back([&peer] {
      peer->Make(kUpdatesPerRequest);
      return static_cast<double>(kUpdatesPerRequest);
    });
  }
  UpdateLoop loop(PaperNetwork(), OptionsWith(200, false));
  const Speeds speeds = Alternate(
      [&] {
        for (int i = 0; i < kUpdatesPerRequest; ++i) {
          loop.Step();
        }
        return static_cast<double>(kUpdatesPerRequest);
      },
      works, seconds);
  const auto fastest = std::max_element(speeds.references.begin(), speeds.references.end());
  const auto& peer = peers[static_cast<size_t>(fastest - speeds.references.begin())];
  return {{MoreIsBetter("update_pytorch", speeds.value, "updates/s",
                        "the same update on one thread by " + peer->description(), *fastest)},
          {}};
}

/// Two threads beside one.
Results UpdateByThreads(double seconds) {
  UpdateLoop one(PaperNetwork(), OptionsWith(200, false), 1);
  UpdateLoop two(PaperNetwork(), OptionsWith(200, false), 2);
  const auto work = [](UpdateLoop& loop) {
    return [&loop] {
      loop.Step();
      return 1.0;
    };
  };
  const Speeds speeds = Alternate(work(two), {work(one)}, seconds);
  return {{MoreIsBetter("update_threads", speeds.value, "updates/s", "one thread; the value is that of two",
                        speeds.references.front())},
          {}};
}

}  // namespace

std::vector<Subject> UpdateSubjects() {
  // Q(s, a) and the target network in s' take two forward passes; Double DQN adds the current network in s'.
  const auto beside_roof = [](const std::string& name, int batch, bool double_dqn) {
    return Subject{{name}, [=](double seconds) {
                     return UpdateBesideRoof(
                         name, PaperNetwork(), OptionsWith(batch, double_dqn),
                         ProductsOfUpdate(PaperNetwork()->shape(), batch, double_dqn ? 3 : 2), seconds);
                   }};
  };
  return {beside_roof("update_roof", 200, false),      beside_roof("update_roof_batch_64", 64, false),
          beside_roof("update_double_dqn", 200, true), {{"update_sets"}, UpdateOfSets},
          {{"update_pytorch"}, UpdateBesidePyTorch},   {{"update_threads"}, UpdateByThreads}};
}

}  // namespace fresco
