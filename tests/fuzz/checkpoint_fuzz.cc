// A checkpoint, as it is and with a CRC that holds. What is accepted is written again as the same.
#include "core/bytes.h"
#include "core/error.h"
#include "msgs/proto/checkpoint.pb.h"
#include "storage/checkpoint_file.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

void CheckOne(std::string_view content) {
  const Checkpoint checkpoint = ParseCheckpoint(content, "an input");
  const std::string written = SerializeCheckpoint(checkpoint);
  FRESCO_CHECK(SerializeCheckpoint(ParseCheckpoint(written, "what was written")) == written);
}

/// With the CRC and the configuration's hash that belong to its content.
std::string WithRightSums(proto::CheckpointFile file) {
  if (proto::Checkpoint checkpoint; checkpoint.ParseFromString(file.content())) {
    Accepts([&] {
      checkpoint.set_config_hash(Experiment::Parse(checkpoint.config_text(), "an input").hash());
      checkpoint.SerializeToString(file.mutable_content());
    });
  }
  file.set_crc32c(Crc32c(std::as_bytes(std::span(file.content()))));
  return file.SerializeAsString();
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  const std::string_view content = TextOf(data, size);
  LooksLikeCheckpoint(content);
  Accepts([&] { CheckOne(content); });
  if (proto::CheckpointFile file; file.ParseFromArray(data, static_cast<int>(size))) {
    Accepts([&] { CheckOne(WithRightSums(file)); });
  }
  return 0;
}
