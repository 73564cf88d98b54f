#include "core/crc32c.h"
#include "core/random.h"
#include "nn/mlp.h"

namespace fresco {
namespace {

uint32_t ComputeFingerprint() {
  constexpr int kBatch = 24;
  const Mlp mlp(MlpShape({7, 200, 256, 20}));
  const Vector parameters = InitialParameters(mlp.shape(), 1);
  MlpWorkspace workspace(mlp.shape(), kBatch);
  RandomStream stream(1, RandomPurpose::kInitialWeights, ~0u, 0);
  for (int column = 0; column < kBatch; ++column) {
    for (int row = 0; row < mlp.shape().inputs(); ++row) {
      workspace.input()(row, column) = static_cast<float>(stream.NextUniform());
    }
  }
  mlp.Forward({parameters.data(), static_cast<size_t>(parameters.size())}, kBatch, workspace);
  const Matrix& output = workspace.output();
  return Crc32c(std::span<const float>(output.data(), static_cast<size_t>(output.size())));
}

}  // namespace

uint32_t ArithmeticFingerprint() {
  static const uint32_t fingerprint = ComputeFingerprint();  // takes milliseconds
  return fingerprint;
}

}  // namespace fresco
