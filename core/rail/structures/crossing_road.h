#pragma once

#include <optional>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/structures/structure_track.h"
#include "railcast/lineside.h"

namespace railcast {

/// The road of a level crossing, in the frame of a chunk. Lateral positions `d_m` are left of the
/// alignment.
///
/// In every track that it crosses, the road lies in the plane of the rails as far as kPanelEdge_m
/// from the axis. Between neighbouring tracks it is straight. Beyond the outermost ones it is level
/// for 3 m, and then comes down over up to 12 m to the ground, whose mean across the road's width
/// it follows.
class CrossingRoad {
 public:
  /// Half the width of what carries the road between and beside the rails of a track.
  static constexpr double kPanelEdge_m = 1.60;
  /// Width of the shoulder beside the road, over which it falls to the ground.
  static constexpr double kShoulderWidth_m = 1.0;

  /// A track in the road.
  struct Lane {
    StructureTrack track;
    double d_m{};     ///< Its axis in the middle of the road.
    double edge_m{};  ///< Half the width of its panels; less than kPanelEdge_m near a neighbour.
  };

  CrossingRoad(const ChunkContext& context, const LevelCrossingSpec& crossing);

  [[nodiscard]] double begin_s_m() const { return middle_s_m_ - half_width_m_; }
  [[nodiscard]] double end_s_m() const { return middle_s_m_ + half_width_m_; }
  [[nodiscard]] double right_d_m() const { return right_d_m_; }
  [[nodiscard]] double left_d_m() const { return left_d_m_; }
  [[nodiscard]] const std::vector<Lane>& lanes() const { return lanes_; }  ///< From right to left.

  /// The edge of a lane's panels on that side (+1 left, -1 right), where asphalt begins.
  [[nodiscard]] Vector3 PanelEdge(const Lane& lane, double side, double s_m) const;
  /// The surface of the road. @pre `d_m` lies on the road.
  [[nodiscard]] Vector3 PointAt(double s_m, double d_m) const;

  /// Whether the place lies on the road.
  [[nodiscard]] bool Covers(double s_m, double d_m) const;
  /// The greatest height of ground at a place on or beside the road; absent elsewhere.
  [[nodiscard]] std::optional<double> GroundLimit_m(double s_m, double d_m) const;

 private:
  [[nodiscard]] double AxisHeight_m(double s_m) const;
  [[nodiscard]] double GroundOnRoad_m(double d_m) const;
  [[nodiscard]] double HeightBeyond_m(const Lane& lane, double side, double s_m, double d_m) const;

  const ChunkContext* context_;
  double middle_s_m_;
  double half_width_m_;
  double right_d_m_{};
  double left_d_m_{};
  std::vector<Lane> lanes_;
  std::vector<double> ground_m_;  ///< Relative to top of rail of the axis, every metre from right.
};

/// The roads of those level crossings that have a part in the range or close beside it.
[[nodiscard]] std::vector<CrossingRoad> RoadsNear(const ChunkContext& context,
                                                  const ChainageRange& range);

}  // namespace railcast
