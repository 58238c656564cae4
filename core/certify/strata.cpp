#include "core/certify/strata.h"

#include <cmath>
#include <type_traits>

namespace railcast {
namespace {

constexpr float kEdgeMixedShare = 1e-3F;
constexpr float kEdgeStep_m = 0.5F;

// The loops below pass over every firing of every frame: they have no branches, and each one writes
// one array, so that the compiler makes vectors of them.

/// @param stride As Frame::returns, a constant where there is one return.
template <typename Stride>
void MarkEdges(const Frame& frame, Stride stride, std::vector<std::uint8_t>& edges) {
  const std::size_t columns = frame.columns;
  const std::size_t num_cells = edges.size();
  const std::uint32_t* const label = frame.label.data();
  const std::uint32_t* const instance = frame.instance.data();
  const float* const range_m = frame.true_range_m.data();
  const float* const mixed_share = frame.mixed_share.data();
  // Bytes may alias anything, vectors' pointers too, unless it is said that they do not.
  std::uint8_t* const __restrict edge = edges.data();
  for (std::size_t cell = 0; cell < num_cells; ++cell) {
    edge[cell] = static_cast<std::uint8_t>(mixed_share[cell * stride] >= kEdgeMixedShare);
  }
  std::vector<std::uint8_t> row(columns);
  std::uint8_t* const __restrict differs = row.data();
  const auto mark = [&](std::size_t first, std::size_t apart, std::size_t num) {
    for (std::size_t i = 0; i < num; ++i) edge[first + i] |= differs[i];
    for (std::size_t i = 0; i < num; ++i) edge[first + apart + i] |= differs[i];
  };
  for (std::size_t begin = 0; begin < num_cells; begin += columns) {
    for (std::size_t i = 0; i + 1 < columns; ++i) {
      const std::size_t a = (begin + i) * stride;
      const std::size_t b = (begin + i + 1) * stride;
      differs[i] = static_cast<std::uint8_t>(
          static_cast<int>(((label[a] ^ label[b]) | (instance[a] ^ instance[b])) != 0) |
          static_cast<int>(std::abs(range_m[a] - range_m[b]) > kEdgeStep_m));
    }
    mark(begin, 1, columns - 1);
    if (begin + columns == num_cells) break;
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t a = (begin + i) * stride;
      const std::size_t b = (begin + columns + i) * stride;
      differs[i] =
          static_cast<std::uint8_t>(((label[a] ^ label[b]) | (instance[a] ^ instance[b])) != 0);
    }
    mark(begin, columns, columns);
  }
}

// @param edge 1 at one.
std::uint8_t KindOf(float range_m, std::uint32_t edge, Outcome outcome) {
  return static_cast<std::uint8_t>(4 * StratumBinOf(range_m) + 2 * edge +
                                   std::uint32_t{HasPoint(outcome)});
}

/// @param stride As above.
template <typename Stride>
void AddKinds(const Frame& frame, Stride stride, std::vector<std::uint8_t>& kinds) {
  const float* const range_m = frame.true_range_m.data();
  const auto* const outcome = frame.outcome.data();
  const std::size_t num_cells = kinds.size();
  std::uint8_t* const __restrict kind = kinds.data();
  for (std::size_t cell = 0; cell < num_cells; ++cell) {
    kind[cell] = KindOf(range_m[cell * stride], kind[cell], outcome[cell * stride]);
  }
}

// As MarkEdges() does, of one cell.
bool IsEdge(const Frame& frame, std::size_t cell) {
  const std::size_t columns = frame.columns;
  const std::size_t a = cell * frame.returns;
  const auto is_other_at = [&](std::size_t neighbour) {
    const std::size_t b = neighbour * frame.returns;
    return frame.label[a] != frame.label[b] || frame.instance[a] != frame.instance[b];
  };
  const auto is_beyond_step = [&](std::size_t neighbour) {
    const std::size_t b = neighbour * frame.returns;
    return is_other_at(neighbour) ||
           std::abs(frame.true_range_m[a] - frame.true_range_m[b]) > kEdgeStep_m;
  };
  const std::size_t column = cell % columns;
  return frame.mixed_share[a] >= kEdgeMixedShare || (column > 0 && is_beyond_step(cell - 1)) ||
         (column + 1 < columns && is_beyond_step(cell + 1)) ||
         (cell >= columns && is_other_at(cell - columns)) ||
         (cell + columns < frame.rows * columns && is_other_at(cell + columns));
}

}  // namespace

std::vector<std::uint8_t> EdgesOf(const Frame& frame) {
  std::vector<std::uint8_t> edges(frame.rows * frame.columns);
  if (frame.returns == 1) {
    MarkEdges(frame, std::integral_constant<std::size_t, 1>(), edges);
  } else {
    MarkEdges(frame, frame.returns, edges);
  }
  return edges;
}

std::vector<std::uint8_t> StratumKindsOf(const Frame& frame,
                                         const std::vector<std::uint8_t>& edges) {
  std::vector<std::uint8_t> kinds = edges;
  if (frame.returns == 1) {
    AddKinds(frame, std::integral_constant<std::size_t, 1>(), kinds);
  } else {
    AddKinds(frame, frame.returns, kinds);
  }
  return kinds;
}

std::vector<std::uint8_t> StratumKindsAt(const Frame& frame, std::span<const std::uint32_t> cells) {
  std::vector<std::uint8_t> kinds;
  kinds.reserve(cells.size());
  for (const std::uint32_t cell : cells) {
    const std::size_t slot = cell * frame.returns;
    kinds.push_back(
        KindOf(frame.true_range_m[slot], IsEdge(frame, cell) ? 1U : 0U, frame.outcome[slot]));
  }
  return kinds;
}

}  // namespace railcast
