// A network file, as it is and with a CRC that holds. What is accepted is written again as the same.
#include "core/bytes.h"
#include "core/error.h"
#include "msgs/proto/network.pb.h"
#include "storage/network_file.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

void CheckOne(std::string_view content) {
  const StoredNetwork network = ParseNetworkFile(content, "an input");
  FRESCO_CHECK(network.parameters.size() == network.experiment.network()->parameter_count());
  const std::string written = SerializeNetworkFile(network);
  FRESCO_CHECK(SerializeNetworkFile(ParseNetworkFile(written, "what was written")) == written);
}

std::string WithRightCrc(proto::NetworkFile file) {
  file.set_crc32c(Crc32c(std::as_bytes(std::span(file.parameters()))));
  return file.SerializeAsString();
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  Accepts([&] { CheckOne(TextOf(data, size)); });
  if (proto::NetworkFile file; file.ParseFromArray(data, static_cast<int>(size))) {
    Accepts([&] { CheckOne(WithRightCrc(file)); });
  }
  return 0;
}
