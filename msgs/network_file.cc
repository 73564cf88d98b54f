#include "msgs/network_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/atomic_file.h"
#include "core/crc32c.h"
#include "core/error.h"
#include "core/version.h"
#include "msgs/proto/network.pb.h"

namespace fresco {
namespace {

constexpr char kFormat[] = "fresco-network-1";

void Expect(bool condition, const std::filesystem::path& path, const std::string& problem) {
  if (!condition) {
    throw UsageError(path.string() + ": " + problem);
  }
}

Vector ParametersOf(const proto::NetworkFile& file, const MlpShape& shape,
                    const std::filesystem::path& path) {
  const size_t expected = static_cast<size_t>(shape.parameter_count()) * sizeof(float);
  Expect(std::equal(file.layer_sizes().begin(), file.layer_sizes().end(), shape.layer_sizes().begin(),
                    shape.layer_sizes().end()),
         path, "its layer sizes contradict its configuration");
  Expect(file.parameters().size() == expected, path,
         fmt::format("expected {} bytes of parameters, found {}", expected, file.parameters().size()));
  Expect(Crc32c(std::as_bytes(std::span(file.parameters()))) == file.crc32c(), path,
         "the CRC of its parameters does not hold: the file is damaged");
  Vector parameters(shape.parameter_count());
  std::memcpy(parameters.data(), file.parameters().data(), expected);
  return parameters;
}

}  // namespace

std::string SerializeNetworkFile(const StoredNetwork& network) {
  proto::NetworkFile file;
  file.set_format(kFormat);
  const MlpShape shape = network.experiment.network_shape();
  for (const int size : shape.layer_sizes()) {
    file.add_layer_sizes(size);
  }
  const std::span<const float> values(network.parameters.data(),
                                      static_cast<size_t>(network.parameters.size()));
  file.set_parameters(values.data(), values.size_bytes());
  file.set_crc32c(Crc32c(values));
  file.set_version(network.version);
  file.set_updates(network.updates);
  file.set_config_hash(network.experiment.hash());
  file.set_config_text(network.experiment.Text());
  file.set_software_version(kSoftwareVersion);
  return file.SerializeAsString();
}

void WriteNetworkFile(const std::filesystem::path& path, const StoredNetwork& network) {
  WriteFileAtomically(path, SerializeNetworkFile(network));
}

StoredNetwork ReadNetworkFile(const std::filesystem::path& path) {
  proto::NetworkFile file;
  Expect(
      file.ParseFromString(ReadFile(path)) && file.has_format(), path,
      "not a network file of Fresco, or cut short; expected best.network or final.network of a run's folder");
  Expect(file.format() == kFormat, path, fmt::format("expected format {}, found {}", kFormat, file.format()));
  Experiment experiment = Experiment::Parse(file.config_text(), path.string() + " (its configuration)");
  const MlpShape shape = experiment.network_shape();
  Vector parameters = ParametersOf(file, shape, path);
  return {std::move(experiment), file.version(), file.updates(), std::move(parameters)};
}

}  // namespace fresco
