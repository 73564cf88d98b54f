#include "storage/checkpoint_file.h"

#include <fmt/format.h>

#include <limits>

#include "core/crc32c.h"
#include "core/error.h"
#include "core/version.h"
#include "storage/training_state_codec.h"

namespace fresco {
namespace {

constexpr char kCheckpointFamily[] = "fresco-checkpoint-";
constexpr char kCheckpointFormat[] = "fresco-checkpoint-2";

/// Returns the checkpoint in the file after checking its format and CRC.
proto::Checkpoint Unwrap(std::string_view content, const std::string& origin) {
  Expect(content.size() <= std::numeric_limits<int>::max(), origin,
         fmt::format("not a checkpoint of Fresco: {} bytes; allowed: 2 GB", content.size()));
  proto::CheckpointFile file;
  const bool parsed = file.ParseFromArray(content.data(), static_cast<int>(content.size()));
  Expect(parsed || LooksLikeCheckpoint(content), origin, "not a checkpoint of Fresco");
  Expect(parsed, origin, fmt::format("the checkpoint is cut short, at {} bytes", content.size()));
  Expect(file.format().starts_with(kCheckpointFamily), origin, "not a checkpoint of Fresco");
  Expect(file.format() == kCheckpointFormat, origin,
         fmt::format("expected format {}, found {} of Fresco {}; use that release", kCheckpointFormat,
                     file.format(), file.software_version()));
  Expect(Crc32c(std::as_bytes(std::span(file.content()))) == file.crc32c(), origin,
         "the checkpoint is damaged: its CRC is wrong");
  proto::Checkpoint checkpoint;
  Expect(checkpoint.ParseFromString(file.content()), origin,
         "the checkpoint is damaged, though its CRC is right");
  return checkpoint;
}

}  // namespace

std::string SerializeCheckpoint(const Checkpoint& checkpoint) {
  proto::Checkpoint to;
  to.set_run_id(checkpoint.run_id);
  to.set_arithmetic_fingerprint(checkpoint.arithmetic_fingerprint);
  to.set_config_hash(checkpoint.experiment.hash());
  to.set_config_text(checkpoint.experiment.Text());
  WriteTrainingState(checkpoint.training, to);
  to.set_resumptions(checkpoint.resumptions);
  to.set_wall_s(checkpoint.wall_s);
  to.set_metrics(checkpoint.metrics);
  for (const auto& [name, value] : checkpoint.counters) {
    proto::CheckpointCounter& counter = *to.add_counters();
    counter.set_name(name);
    counter.set_value(value);
  }
  constexpr size_t kLargest = (size_t{1} << 31) - (1 << 20);
  if (to.ByteSizeLong() > kLargest) {
    throw Failure(
        fmt::format("a checkpoint of this run is too large: {} bytes; allowed: {} (Protobuf's limit)",
                    to.ByteSizeLong(), kLargest));
  }
  proto::CheckpointFile file;
  file.set_format(kCheckpointFormat);
  file.set_software_version(kSoftwareVersion);
  to.SerializeToString(file.mutable_content());
  file.set_crc32c(Crc32c(std::as_bytes(std::span(file.content()))));
  return file.SerializeAsString();
}

int64_t CheckpointBytes(int64_t parameters, int64_t versions, int64_t actions) {
  constexpr int64_t kCopies = 3;       // Protobuf's message, its content, the file
  constexpr int64_t kCopied = 4;       // current and target network, Adam's moments; others are shared
  constexpr int64_t kBest = 1;         // the best evaluated network
  constexpr int64_t kVarintBytes = 2;  // of an action in content and file: below 2^14
  const int64_t network = parameters * static_cast<int64_t>(sizeof(Vector::Scalar));
  const int64_t of_action = sizeof(int16_t) + sizeof(int32_t) + (kCopies - 1) * kVarintBytes;
  return kCopied * network + kCopies * (kCopied + kBest + versions) * network + of_action * actions;
}

bool LooksLikeCheckpoint(std::string_view content) {
  // The format is the file's first field: a tag and a length before it.
  constexpr size_t kBefore = 2;
  return content.size() > kBefore && content.substr(kBefore).starts_with(kCheckpointFamily);
}

Checkpoint ParseCheckpoint(std::string_view content, const std::string& origin) {
  const proto::Checkpoint from = Unwrap(content, origin);
  Experiment experiment = Experiment::Parse(from.config_text(), origin + " (its configuration)");
  Expect(experiment.hash() == from.config_hash(), origin,
         fmt::format("its configuration has hash {:08x}, expected {:08x}", experiment.hash(),
                     from.config_hash()));
  const int64_t parameters = experiment.network_shape().parameter_count();
  Checkpoint checkpoint{std::move(experiment), from.arithmetic_fingerprint(), from.run_id(),
                        ReadTrainingState(from, parameters, origin)};
  checkpoint.resumptions = from.resumptions();
  checkpoint.wall_s = from.wall_s();
  checkpoint.metrics = from.metrics();
  for (const proto::CheckpointCounter& counter : from.counters()) {
    checkpoint.counters[counter.name()] = counter.value();
  }
  return checkpoint;
}

}  // namespace fresco
