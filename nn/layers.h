// What networks do with one layer: forward and backward passes over some columns of a batch, the gradient of
// some parameters. For nn/ only. Any thread may call the functions; those that share a matrix need columns or
// parts of their own.
#pragma once

#include <span>

#include "nn/arithmetic_kernels.h"
#include "nn/network.h"

namespace fresco {

/// So many columns go through all layers of a chain before the next ones.
inline constexpr int kColumnsAtOnce = 200;

/// The rows of a matrix whose columns hold so many units: columns begin at lines of the cache, but not all at
/// lines of the same set of it.
int PaddedRows(int units);

/// above = finish(biases + weights below) for some columns.
Product ForwardProduct(std::span<const float> parameters, const Layer& layer, const Matrix& below,
                       ColumnRange columns, Finish finish, Matrix& above);

/// Writes the part's weights to the transpose of its layer's, [inputs x outputs].
void TransposePart(std::span<const float> parameters, const Layer& layer, const ParameterPart& part,
                   Matrix& transposed);

/// below = transposed above for some columns, for d loss / d layer's inputs; 0 where `activations`, the
/// inputs, are not above 0.
Product BackwardProduct(const Layer& layer, const Matrix& transposed, const Matrix& above,
                        ColumnRange columns, const Matrix& activations, Matrix& below);

/// The gradient of a part of a layer's parameters over the first `columns` columns. `above`: d loss / d
/// layer's outputs; `below`: its inputs.
void PartGradient(const Layer& layer, const ParameterPart& part, const Matrix& above, const Matrix& below,
                  int columns, std::span<float> gradient);

}  // namespace fresco
