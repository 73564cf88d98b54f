#include "tests/bench/products.h"

#include <cblas.h>
#include <dnnl.h>

#include <algorithm>
#include <memory>

#include "core/error.h"

// oneDNN has no function for it; Debian's takes its threads from gcc's OpenMP. <omp.h> is not there for
// clang.
extern "C" void omp_set_num_threads(int);

namespace fresco {
namespace {

struct Operands {
  explicit Operands(const ProductShape& p)
      : product(p),
        a(Matrix::Random(p.transpose_a ? p.depth : p.rows, p.transpose_a ? p.rows : p.depth)),
        b(Matrix::Random(p.transpose_b ? p.columns : p.depth, p.transpose_b ? p.depth : p.columns)),
        c(Matrix::Zero(p.rows, p.columns)) {}
  ProductShape product;
  Matrix a;
  Matrix b;
  Matrix c;
};

void MultiplyByEigen(Operands& o) {
  if (o.product.transpose_a) {
    o.c.noalias() = o.a.transpose() * o.b;
  } else if (o.product.transpose_b) {
    o.c.noalias() = o.a * o.b.transpose();
  } else {
    o.c.noalias() = o.a * o.b;
  }
}

void MultiplyByOpenBlas(Operands& o) {
  const ProductShape& p = o.product;
  cblas_sgemm(CblasColMajor, p.transpose_a ? CblasTrans : CblasNoTrans,
              p.transpose_b ? CblasTrans : CblasNoTrans, p.rows, p.columns, p.depth, 1, o.a.data(),
              static_cast<int>(o.a.rows()), o.b.data(), static_cast<int>(o.b.rows()), 0, o.c.data(), p.rows);
}

/// oneDNN's matrices are row-major, so it computes the transpose: C' = op(B)' op(A)'.
void MultiplyByOneDnn(Operands& o) {
  const ProductShape& p = o.product;
  FRESCO_CHECK(dnnl_sgemm(p.transpose_b ? 'T' : 'N', p.transpose_a ? 'T' : 'N', p.columns, p.rows, p.depth, 1,
                          o.b.data(), o.b.rows(), o.a.data(), o.a.rows(), 0, o.c.data(),
                          p.rows) == dnnl_success);
}

/// Forward and backward products of layers that follow each other.
void AddLayers(const std::vector<int>& sizes, int columns, int forward_passes, bool gradient_of_input,
               std::vector<ProductShape>& products) {
  for (size_t layer = 0; layer + 1 < sizes.size(); ++layer) {
    const int inputs = sizes[layer];
    const int outputs = sizes[layer + 1];
    products.push_back({.rows = outputs, .columns = columns, .depth = inputs, .times = forward_passes});
    products.push_back({.rows = outputs, .columns = inputs, .depth = columns, .transpose_b = true});
    if (layer > 0 || gradient_of_input) {
      products.push_back({.rows = inputs, .columns = columns, .depth = outputs, .transpose_a = true});
    }
  }
}

}  // namespace

std::vector<ProductShape> ProductsOfUpdate(const MlpShape& shape, int batch, int forward_passes) {
  std::vector<ProductShape> products;
  AddLayers(shape.layer_sizes(), batch, forward_passes, false, products);
  return products;
}

std::vector<ProductShape> ProductsOfUpdate(const SetShape& shape, int batch) {
  const SetNetwork network(shape);
  const std::vector<int> sizes = network.layer_sizes();
  const auto trunk = std::find(sizes.begin(), sizes.end(), 0);
  const auto head = std::find(trunk + 1, sizes.end(), 0);
  const std::vector<int> head_sizes(head + 1, sizes.end());
  const int items = batch * shape.items;
  std::vector<ProductShape> products;
  AddLayers({sizes.begin(), trunk}, items, 2, false, products);
  AddLayers({trunk + 1, head}, batch, 2, true, products);
  AddLayers(head_sizes, batch, 1, true, products);
  const int hidden_units = shape.trunk_layers.back();
  products.push_back({.rows = head_sizes[1], .columns = batch, .depth = hidden_units});
  products.push_back({.rows = head_sizes[1], .columns = items, .depth = head_sizes[0] - hidden_units});
  for (size_t layer = 1; layer + 1 < head_sizes.size(); ++layer) {
    products.push_back({.rows = head_sizes[layer + 1], .columns = items, .depth = head_sizes[layer]});
  }
  return products;
}

std::array<std::string, kProductLibraries> ProductLibraryNames() {
  return {"Eigen", std::string("OpenBLAS (") + openblas_get_corename() + ")", "oneDNN"};
}

std::array<Work, kProductLibraries> ProductWorks(const ProductShape& product) {
  openblas_set_num_threads(1);
  omp_set_num_threads(1);
  const auto work = [&](void (*multiply)(Operands&)) {
    return [operands = std::make_shared<Operands>(product), multiply] {
      multiply(*operands);
      return 1.0;
    };
  };
  return {work(MultiplyByEigen), work(MultiplyByOpenBlas), work(MultiplyByOneDnn)};
}

}  // namespace fresco
