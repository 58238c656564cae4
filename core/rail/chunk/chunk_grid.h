#pragma once

#include <Eigen/Core>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// The line divided into chunks of equal length from chainage 0; the last one may be shorter.
/// Immutable and thread-safe; takes 16 bytes per chunk.
class ChunkGrid {
 public:
  /// @param ground_half_width_m Extent of the chunks' ground to either side of the axis.
  ChunkGrid(const Alignment& alignment, double chunk_length_m, double ground_half_width_m);

  [[nodiscard]] int num_chunks() const { return static_cast<int>(centres_m_.size()); }
  [[nodiscard]] double BeginOf(int chunk) const { return chunk * chunk_length_m_; }
  [[nodiscard]] double EndOf(int chunk) const;
  /// The chunk at a chainage; beyond the line, the first or last chunk.
  [[nodiscard]] int ChunkAt(double s_m) const;
  /// Frame of a chunk: origin on the axis at the chunk's middle, x along the heading there, z
  /// vertical.
  [[nodiscard]] Transform WorldFromChunk(int chunk) const;

  /// The chunks whose ground lies within `reach_m` in plan of the axis of `home_chunk`, in
  /// ascending order. None is missing. Extra ones are at most 1.5 kSampling_m too far away, or
  /// somewhat more if the ground is wider than the tightest radius. A line that returns to itself
  /// is included wherever it is near.
  [[nodiscard]] std::vector<int> WithinReach(int home_chunk, double reach_m) const;

  /// Spacing of the samples from which distances are computed.
  static constexpr double kSampling_m = 5.0;

 private:
  [[nodiscard]] Eigen::Vector2d CentreOf(int chunk) const {
    return centres_m_[static_cast<std::size_t>(chunk)];
  }
  [[nodiscard]] std::vector<AxisPoint> AxisSamples(int chunk) const;

  Alignment alignment_;
  double chunk_length_m_;
  double ground_half_width_m_;
  double reach_slack_m_;
  /// Axis points at the chunks' middles. No point of a chunk's axis is farther away than half the
  /// chunk's length, whether straight or curved.
  std::vector<Eigen::Vector2d> centres_m_;
};

}  // namespace railcast
