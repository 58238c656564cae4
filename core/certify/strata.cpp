#include "core/certify/strata.h"

#include <cmath>

namespace railcast {
namespace {

constexpr float kEdgeMixedShare = 1e-3F;
constexpr float kEdgeStep_m = 0.5F;

}  // namespace

std::vector<std::uint8_t> EdgesOf(const Frame& frame) {
  const std::size_t returns = frame.returns;
  const std::size_t columns = frame.columns;
  const std::size_t num_cells = frame.rows * columns;
  const std::uint32_t* const label = frame.label.data();
  const std::uint32_t* const instance = frame.instance.data();
  const float* const range_m = frame.true_range_m.data();
  std::vector<std::uint8_t> edges(num_cells);
  // Without branches, since this passes over every firing of every frame.
  const auto mark = [&](std::size_t a, std::size_t b, bool is_edge) {
    edges[a] |= static_cast<std::uint8_t>(is_edge);
    edges[b] |= static_cast<std::uint8_t>(is_edge);
  };
  for (std::size_t cell = 0; cell < num_cells; ++cell) {
    edges[cell] = static_cast<std::uint8_t>(frame.mixed_share[cell * returns] >= kEdgeMixedShare);
  }
  for (std::size_t begin = 0; begin < num_cells; begin += columns) {
    for (std::size_t cell = begin; cell + 1 < begin + columns; ++cell) {
      const std::size_t a = cell * returns;
      const std::size_t b = a + returns;
      mark(cell, cell + 1,
           ((label[a] ^ label[b]) | (instance[a] ^ instance[b])) != 0 ||
               std::abs(range_m[a] - range_m[b]) > kEdgeStep_m);
    }
  }
  for (std::size_t cell = columns; cell < num_cells; ++cell) {
    const std::size_t a = (cell - columns) * returns;
    const std::size_t b = cell * returns;
    mark(cell - columns, cell, ((label[a] ^ label[b]) | (instance[a] ^ instance[b])) != 0);
  }
  return edges;
}

}  // namespace railcast
