// write_corpus DIRECTORY CONFIG...: valid samples for every fuzz target, a file each in DIRECTORY/TARGET, and
// words of text formats in DIRECTORY/TARGET.dictionary. Made at build time, from the formats as they are.
#include <google/protobuf/descriptor.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "core/error.h"
#include "core/files.h"
#include "logs/event_log_writer.h"
#include "storage/checkpoint_file.h"
#include "storage/network_file.h"
#include "tests/fuzz/fuzzed_worlds.h"
#include "tests/msgs/message_samples.h"

namespace fresco {
namespace {

using Bytes = std::vector<std::byte>;

/// Samples of one target, numbered.
class Corpus {
 public:
  Corpus(const std::filesystem::path& directory, const std::string& target) : directory_(directory / target) {
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  void Add(std::string_view sample) {
    WriteFileAtomically(directory_ / ("sample_" + std::to_string(count_++)), sample);
  }
  void Add(std::span<const std::byte> sample) {
    Add(std::string_view(reinterpret_cast<const char*>(sample.data()), sample.size()));
  }

 private:
  std::filesystem::path directory_;
  int count_ = 0;
};

template <class Message>
void AddMessages(RandomStream& stream, uint8_t type, Corpus& corpus) {
  constexpr uint8_t kOwnTrailer = 0x80;
  for (const uint8_t flag : std::array<uint8_t, 3>{0, 0, kOwnTrailer}) {
    Bytes sample = {static_cast<std::byte>(type | flag)};
    const Bytes encoded = Encoded(RandomMessage<Message>(stream));
    const auto kept = static_cast<int64_t>(encoded.size() - (flag != 0 ? 0 : kTrailerBytes));
    sample.insert(sample.end(), encoded.begin(), encoded.begin() + kept);
    corpus.Add(sample);
  }
}

void WriteWire(const std::filesystem::path& directory) {
  Corpus corpus(directory, "wire_fuzz");
  RandomStream stream(1, RandomPurpose::kTest, 0, 0);
  uint8_t type = 0;
  ForEachMessageType([&]<class Message>(const Message&) { AddMessages<Message>(stream, type++, corpus); });
}

void WriteTransitions(const std::filesystem::path& directory) {
  Corpus corpus(directory, "transitions_fuzz");
  for (uint8_t number = 0; number < kFuzzedWorlds; ++number) {
    const World& world = FuzzedWorld(number);
    for (int64_t index = 0; index < kFuzzedOrders; ++index) {
      Bytes sample = {static_cast<std::byte>(number)};
      RandomStream stream(2, RandomPurpose::kTest, static_cast<uint32_t>(index), number);
      const OrderResult result = RandomResult(world, FuzzedOrder(index), stream);
      SplitResult(world, result, 3, [&](transitions_t& message) {
        Stamp(message, {1, 2}, 1);
        const Bytes bytes = Encoded(message);
        const auto encoding = std::span(bytes).first(bytes.size() - kTrailerBytes);
        sample.push_back(static_cast<std::byte>(encoding.size() >> 8));
        sample.push_back(static_cast<std::byte>(encoding.size()));
        sample.insert(sample.end(), encoding.begin(), encoding.end());
      });
      corpus.Add(sample);
    }
  }
}

void WriteTexts(const std::filesystem::path& directory, std::span<char*> configs) {
  Corpus experiments(directory, "experiment_fuzz");
  for (const char* path : configs) {
    experiments.Add(ReadFile(path));
    experiments.Add(Experiment::Load(path).Text());
  }
  Corpus settings(directory, "settings_fuzz");
  for (const char* lines :
       {"schedule.seed=3\nagent.hidden_layers=64,64\n1f", "scenario.sensor[0].x_m=30\n0123456789abcdef",
        "run.lcm_url=udpm://239.255.76.67:7667?ttl=1\nrun.channel_prefix=\"A_b-9\"",
        "cartpole.maximum_steps=12\nschedule.evaluation_episodes=10",
        "agent.double_dqn=true\nagent.exponential.unit=EPISODES\nscenario.coverage_radius_m=1e2"}) {
    settings.Add(lines);
  }
  Corpus urls(directory, "lcm_url_fuzz");
  for (const char* url : {"udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304", "udpm://224.0.0.1:1",
                          "tcpq://localhost:7700", "memq://", "FRESCO", "FRESCO_2"}) {
    urls.Add(url);
  }
}

void AddWords(const google::protobuf::Descriptor& descriptor, std::set<std::string>& words) {
  for (int i = 0; i < descriptor.field_count(); ++i) {
    const google::protobuf::FieldDescriptor& field = *descriptor.field(i);
    words.insert(field.name());
    if (field.message_type() != nullptr) {
      AddWords(*field.message_type(), words);
    }
  }
}

/// The names of a configuration's fields, for the targets that read text format.
void WriteDictionaries(const std::filesystem::path& directory) {
  std::set<std::string> words = {"{",    "}",   "[",   "]",   ":",  "=",
                                 "true", "inf", "nan", "1e9", "-1", "2147483647"};
  AddWords(*proto::ExperimentConfig::descriptor(), words);
  std::string dictionary;
  for (const std::string& word : words) {
    dictionary += "\"" + word + "\"\n";
  }
  for (const std::string target :
       {"experiment_fuzz", "settings_fuzz", "network_file_fuzz", "checkpoint_fuzz"}) {
    WriteFileAtomically(directory / (target + ".dictionary"), dictionary);
  }
}

/// Of a field so small that whole files fit an input.
Experiment SmallExperiment() {
  return Experiment::Parse(
      "scenario { grid { columns: 2 rows: 2 } slots: 4 start { row: 0 } stop { row: 1 } random_sensors "
      "{ count: 1 } } agent { hidden_layers: [2] }",
      "the small experiment");
}

void WriteFiles(const std::filesystem::path& directory) {
  const Experiment experiment = SmallExperiment();
  const Vector parameters = experiment.network()->InitialParameters(1);
  Corpus(directory, "network_file_fuzz").Add(SerializeNetworkFile({experiment, 3, 300, parameters}));
  Checkpoint checkpoint{experiment, 1, 2};
  TrainingState& training = checkpoint.training;
  training.orders.push_back({{.index = 0, .epsilon = 0.5, .seed = 1}, 0});
  training.versions.push_back({{NetworkKind::kCurrent, 0}, 0, std::make_shared<const Vector>(parameters)});
  training.current = training.target = parameters;
  training.adam = {1, 0.9, 0.999, parameters, parameters};
  RandomStream stream(3, RandomPurpose::kTest, 0, 0);
  for (int64_t index = 0; index < 2; ++index) {
    training.replay.push_back(std::make_shared<const Episode>(
        RandomResult(experiment.world(), FuzzedOrder(index), stream).episode));
  }
  training.best = {{1, 100, 5, 1, {5, 30, 30}}, std::make_shared<const Vector>(parameters)};
  training.last_evaluation = training.delivered = training.best->evaluation;
  training.partial_evaluation = {1, 1, {5, 30, 30}, {5}};
  checkpoint.metrics = "version,total_aoi\n1,30\n";
  checkpoint.counters = {{"received", 3}};
  Corpus(directory, "checkpoint_fuzz").Add(SerializeCheckpoint(checkpoint));
}

/// A whole log, one that is cut, one with damage in its midst, and one whose messages hold a log.
void WriteLogs(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / "log_of_the_corpus";
  const auto log_of = [&](std::span<const std::byte> message) {
    std::filesystem::remove(path);
    EventLogWriter writer(path);
    for (const std::string channel : {"FRESCO_RUN", "A", "FRESCO_TRANSITIONS"}) {
      writer.Write({0, 1'700'000'000'000'000, channel, message});
    }
    writer.Flush();
    return ReadFile(path);
  };
  RandomStream stream(1, RandomPurpose::kTest, 1, 0);
  const std::string log = log_of(Encoded(OrdersOf(stream, 2)));
  Corpus corpus(directory, "event_log_fuzz");
  corpus.Add(log);
  corpus.Add(std::string_view(log).substr(0, log.size() - 9));
  corpus.Add(log.substr(0, log.size() / 2) + log);
  corpus.Add(log_of(std::as_bytes(std::span(log))));
  std::filesystem::remove(path);
}

std::string BigEndian(uint64_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    text += static_cast<char>(value >> shift);
  }
  return text;
}

/// A datagram of sender 1, as message_assembler_fuzz.cc reads it.
std::string Sent(const std::string& datagram) {
  return BigEndian(1, 1) + BigEndian(datagram.size(), 2) + datagram;
}

/// Whole messages, and one of three fragments in some orders.
void WriteDatagrams(const std::filesystem::path& directory) {
  Corpus corpus(directory, "message_assembler_fuzz");
  const std::string name("A\0", 2);
  const auto fragment = [&](uint64_t number) {
    const std::string data = (number == 0 ? name : "") + std::string(10, static_cast<char>('a' + number));
    return Sent("LC03" + BigEndian(7, 4) + BigEndian(30, 4) + BigEndian(10 * number, 4) +
                BigEndian(number, 2) + BigEndian(3, 2) + data);
  };
  corpus.Add(Sent("LC02" + BigEndian(7, 4) + name + "content") + Sent("LC02" + BigEndian(8, 4) + name));
  corpus.Add(fragment(0) + fragment(1) + fragment(2));
  corpus.Add(fragment(2) + fragment(0) + fragment(0) + fragment(1));
}

}  // namespace
}  // namespace fresco

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: write_corpus DIRECTORY CONFIG...\n");
    return 2;
  }
  try {
    const std::filesystem::path directory = argv[1];
    fresco::WriteWire(directory);
    fresco::WriteTransitions(directory);
    fresco::WriteTexts(directory, std::span(argv + 2, static_cast<size_t>(argc - 2)));
    fresco::WriteFiles(directory);
    fresco::WriteDictionaries(directory);
    fresco::WriteLogs(directory);
    fresco::WriteDatagrams(directory);
    return 0;
  } catch (const fresco::Error& error) {
    std::fprintf(stderr, "write_corpus: %s\n", error.what());
    return error.exit_status();
  }
}
