#include "storage/network_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/bytes.h"
#include "core/error.h"
#include "core/files.h"
#include "core/installation.h"
#include "msgs/proto/network.pb.h"

namespace fresco {
namespace {

constexpr char kNetworkFormat[] = "fresco-network-1";

Vector ParametersOf(const proto::NetworkFile& file, const Network& network, const std::string& origin) {
  const size_t expected = static_cast<size_t>(network.parameter_count()) * sizeof(float);
  const std::vector<int> sizes = network.layer_sizes();
  Expect(std::equal(file.layer_sizes().begin(), file.layer_sizes().end(), sizes.begin(), sizes.end()), origin,
         "its layer sizes contradict its configuration");
  Expect(file.parameters().size() == expected, origin,
         fmt::format("expected {} bytes of parameters, found {}", expected, file.parameters().size()));
  Expect(Crc32c(std::as_bytes(std::span(file.parameters()))) == file.crc32c(), origin,
         "the CRC of its parameters is wrong: the file is damaged");
  Vector parameters(network.parameter_count());
  std::memcpy(parameters.data(), file.parameters().data(), expected);
  return parameters;
}

}  // namespace

std::string SerializeNetworkFile(const StoredNetwork& network) {
  proto::NetworkFile file;
  file.set_format(kNetworkFormat);
  for (const int size : network.experiment.network()->layer_sizes()) {
    file.add_layer_sizes(size);
  }
  const std::span<const float> values = Values(network.parameters);
  file.set_parameters(values.data(), values.size_bytes());
  file.set_crc32c(Crc32c(values));
  file.set_version(network.version);
  file.set_updates(network.updates);
  file.set_config_hash(network.experiment.hash());
  file.set_config_text(network.experiment.Text());
  file.set_software_version(kSoftwareVersion);
  return file.SerializeAsString();
}

StoredNetwork ParseNetworkFile(std::string_view content, const std::string& origin) {
  proto::NetworkFile file;
  Expect(
      content.size() <= std::numeric_limits<int>::max() &&
          file.ParseFromArray(content.data(), static_cast<int>(content.size())) && file.has_format(),
      origin,
      "not a network file of Fresco, or cut short; expected best.network or final.network of a run's folder");
  Expect(file.format() == kNetworkFormat, origin,
         fmt::format("expected format {}, found {}", kNetworkFormat, file.format()));
  Experiment experiment = Experiment::Parse(file.config_text(), origin + " (its configuration)");
  Vector parameters = ParametersOf(file, *experiment.network(), origin);
  return {std::move(experiment), file.version(), file.updates(), std::move(parameters)};
}

StoredNetwork ReadNetworkFile(const std::filesystem::path& path) {
  return ParseNetworkFile(ReadFile(path), path.string());
}

}  // namespace fresco
