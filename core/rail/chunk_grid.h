#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/line/alignment.h"

namespace railcast {

/// The line cut into chunks of equal length from chainage 0; the last one may be shorter.
/// Immutable, thread-safe; 16 bytes a chunk.
class ChunkGrid {
 public:
  /// @param ground_half_width_m How far the chunks' ground reaches to either side of the axis.
  ChunkGrid(const Alignment& alignment, double chunk_length_m, double ground_half_width_m);

  [[nodiscard]] int num_chunks() const { return static_cast<int>(centres_m_.size()); }
  [[nodiscard]] double BeginOf(int chunk) const;
  [[nodiscard]] double EndOf(int chunk) const;
  /// The first or last chunk for chainages beyond the line.
  [[nodiscard]] int ChunkAt(double s_m) const;
  /// Origin on the axis at the chunk's middle, x along the heading there, z the world's.
  [[nodiscard]] Transform WorldFromChunk(int chunk) const;

  /// The chunks whose ground comes within `reach_m` in plan of the axis of `home_chunk`, ascending;
  /// never too few, and too many only by kReachSlack_m. A line that comes back to itself counts
  /// wherever it is near.
  [[nodiscard]] std::vector<int> WithinReach(int home_chunk, double reach_m) const;

  /// Between the samples that distances are taken from.
  static constexpr double kSampling_m = 5.0;
  /// Of half a step along the home axis and half a step along the ground, whose outer edge is up to
  /// twice as long as the axis.
  static constexpr double kReachSlack_m = 1.5 * kSampling_m;

 private:
  [[nodiscard]] Eigen::Vector2d CentreOf(int chunk) const {
    return centres_m_[static_cast<std::size_t>(chunk)];
  }
  [[nodiscard]] std::vector<AxisPoint> AxisSamples(int chunk) const;

  Alignment alignment_;
  double chunk_length_m_;
  double ground_half_width_m_;
  std::vector<Eigen::Vector2d> centres_m_;  ///< On the axis at the chunk's middle: no point of the
                                            ///< axis is further than half the length, arc or not.
};

}  // namespace railcast
