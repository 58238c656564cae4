#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "core/trace/embree.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// The figures of a scene as one geometry of Embree. Each pose is made when a ray first needs it.
class PosedFigures {
 public:
  /// A piece of a figure in one of its poses.
  struct PlacedPiece {
    Eigen::Matrix<float, 3, 4> window_from_piece;
    Eigen::Vector3f center_m;  ///< Of the sphere around it, in the window.
  };

  explicit PosedFigures(TraceFigures figures);
  PosedFigures(const PosedFigures&) = delete;
  PosedFigures& operator=(const PosedFigures&) = delete;

  [[nodiscard]] const std::vector<TraceFigure>& figures() const { return figures_.figures; }
  /// The pieces of a figure in the pose of a step. Thread-safe.
  [[nodiscard]] const std::vector<PlacedPiece>& PoseAt(std::size_t figure,
                                                       std::uint32_t step) const;

  /// Attaches the figures to a scene of Embree as its geometry 0. They must outlive it.
  ///
  /// A hit names the figure as its instance. Its geometry is the surface, counted from the figure's
  /// first one, and its normal stands in the window's axes.
  void AttachTo(RTCDevice device, RTCScene scene) const;

 private:
  struct Pose {
    std::once_flag once;
    std::vector<PlacedPiece> pieces;
  };

  static void ReportBox(const RTCBoundsFunctionArguments* args);
  static void IntersectRays(const RTCIntersectFunctionNArguments* args);
  /// Returns whether the ray hits a piece nearer than before, and puts the hit into it.
  bool Intersect(std::size_t figure, RayQueryContext& context, RTCRayHit& ray) const;

  TraceFigures figures_;
  std::vector<std::size_t> first_poses_;  ///< By figure, index into `poses_`.
  mutable std::vector<Pose> poses_;
};

}  // namespace railcast
