// The matrix products of an update, by each library that might be the fastest. On one thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "nn/mlp.h"
#include "nn/set_network.h"
#include "tests/bench/alternate.h"

namespace fresco {

/// C [rows x columns] = op(A) op(B), column-major, where op may transpose; `depth` is what is summed over.
struct ProductShape {
  int rows;
  int columns;
  int depth;
  bool transpose_a = false;
  bool transpose_b = false;
  int times = 1;  ///< in one update
};

/// Forward passes, gradients of the weights, gradients of the hidden layers' outputs.
std::vector<ProductShape> ProductsOfUpdate(const MlpShape& shape, int batch, int forward_passes);

/// The same of a network for sets, without Double DQN: the head computes all items in s', one item in s.
std::vector<ProductShape> ProductsOfUpdate(const SetShape& shape, int batch);

inline constexpr int kProductLibraries = 3;
/// Eigen, OpenBLAS, oneDNN, with the kernel that OpenBLAS chose.
std::array<std::string, kProductLibraries> ProductLibraryNames();

/// The product by each library, in the order of the names; each call multiplies once and returns 1.
std::array<Work, kProductLibraries> ProductWorks(const ProductShape& product);

}  // namespace fresco
