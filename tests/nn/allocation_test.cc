// No heap use in forward, backward and Adam once warm: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <memory>

#include "nn/adam.h"
#include "tests/nn/literal_network.h"
#include "tests/support/allocation_count.h"

#ifndef FRESCO_SANITIZED

namespace fresco {
namespace {

TEST(Allocations, AreSeenByThisTest) {
  const int64_t before = AllocationCount();
  const auto memory = std::make_unique<Matrix>(Matrix::Zero(10, 10));
  EXPECT_GE(AllocationCount() - before, 2);
}

TEST(Allocations, DoNotHappenInForwardBackwardAndAdamOnceWarm) {
  constexpr int kBatch = 200;
  const Mlp mlp(MlpShape({7, 200, 256, 20}));
  Vector parameters = InitialParameters(mlp.shape(), 1);
  MlpWorkspace workspace(mlp.shape(), kBatch);
  workspace.input().setOnes();
  const Matrix output_gradient = Matrix::Ones(20, kBatch);
  Vector gradient(parameters.size());
  Adam adam(parameters.size(), {});
  const std::span<float> gradient_span(gradient.data(), static_cast<size_t>(gradient.size()));
  const auto update = [&](int batch) {
    mlp.Forward(SpanOf(parameters), batch, workspace);
    mlp.Backward(SpanOf(parameters), batch, output_gradient, workspace, gradient_span);
    adam.Step(gradient_span, 1e-3, {parameters.data(), static_cast<size_t>(parameters.size())});
  };
  update(kBatch);
  const int64_t before = AllocationCount();
  for (const int batch : {kBatch, 1, 17, kBatch}) {
    update(batch);
  }
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace
}  // namespace fresco

#endif
