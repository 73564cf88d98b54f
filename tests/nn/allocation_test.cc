// No heap use in forward, backward and Adam once warm: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>

#include "nn/adam.h"
#include "tests/nn/literal_network.h"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<int64_t> allocations{0};
}  // namespace

// glibc's own functions: everything that asks for memory ends here.
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

void* aligned_alloc(size_t alignment, size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size) {
  ++allocations;
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

namespace fresco {
namespace {

TEST(Allocations, AreSeenByThisTest) {
  const int64_t before = allocations;
  const auto memory = std::make_unique<Matrix>(Matrix::Zero(10, 10));
  EXPECT_GE(allocations - before, 2);
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
  const int64_t before = allocations;
  for (const int batch : {kBatch, 1, 17, kBatch}) {
    update(batch);
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace fresco

#endif
