#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/simulate/window.h"
#include "railcast/lidar.h"
#include "railcast/scene.h"
#include "railcast/simulator.h"

namespace railcast {

/// The rule for a sensor: rays without width unless effect footprint is on, full detail if the spec
/// or effect dense_footprint, the yardstick, demands it. It is the same in all frames, and goes by
/// frame 0 where the pattern does not repeat.
[[nodiscard]] DetailRule DetailOf(const SimulatorSpec& spec, const ScanPattern& pattern);

/// The angle between neighbouring firings where the pattern is dense: the square root of the solid
/// angle per firing, in cells of one square degree, that one firing in ten falls below.
[[nodiscard]] double RaySpacing_rad(const ScanPattern& pattern);

/// The sector of the firings, widened by what the vehicle's motion on its springs, cant and errors
/// of the mount may turn them: all around if some go steeply up or down or the pattern does not
/// repeat.
[[nodiscard]] ScanSector SectorOf(const ScanPattern& pattern, const Transform& vehicle_from_sensor);

/// How far apart in time the poses of an object that bends may be at a distance from the sensor.
///
/// Of who walks at 2 m/s, poses that are `pose_step_ns` apart keep 98 % of all points within 2 mm
/// of where they are between them, others within the square of the ratio (tested with the gait).
/// It may be an eighth of the spacing of the firings there, and of the beams' width, if they have
/// any.
[[nodiscard]] std::int64_t CoarserPoseStep_ns(const DetailRule& rule,
                                              double distance_m,
                                              std::int64_t pose_step_ns);

/// Chooses the models of the placements in a window, and the form of its chunks. They depend on
/// nothing but the placement or chunk, the home chunk and the rule: what counts is the least
/// distance to the places that the sensor can have while the vehicle is in the home chunk.
class DetailChoice {
 public:
  DetailChoice(const World& world, int home_chunk, const DetailRule& rule);

  /// Whether anything may be coarser: the rule is not for full detail, and the vehicle's poses are
  /// known.
  [[nodiscard]] bool may_be_coarser() const { return !sensors_window_m_.empty(); }

  /// The level of the coarsest model that the rule permits at the placement's distance: 0 is the
  /// finest, k is placement.coarser[k - 1].
  [[nodiscard]] std::size_t LevelOf(const Placement& placement,
                                    const Eigen::Affine3d& window_from_model);
  /// The level of the coarsest of a chunk's forms that the rule permits, by the least distance in
  /// plan between its surfaces and the sensor: 0 is the finest, k is forms[k - 1]. Of a chunk that
  /// no firing can meet, the coarsest of all.
  [[nodiscard]] std::size_t LevelOf(std::span<const CoarserSurfaces> forms,
                                    const Transform& window_from_chunk) const;
  /// @pre may_be_coarser()
  [[nodiscard]] double Distance_m(const Placement& placement,
                                  const Eigen::Affine3d& window_from_model);

 private:
  [[nodiscard]] bool Permits(double ray_spacing_m, double beam_width_m, double distance_m) const;
  [[nodiscard]] bool TakesCoarser(const CoarserSurfaces& surfaces,
                                  const Transform& chunk_from_window) const;
  [[nodiscard]] bool IsInSight(const Eigen::AlignedBox2d& area_m,
                               const Transform& chunk_from_window) const;

  DetailRule rule_;
  std::vector<Vector3> sensors_window_m_;
  std::vector<Vector3> sights_window_;  ///< The middle of the scan's sector, for each of them.
  std::map<const Model*, Eigen::AlignedBox3d> boxes_;
};

/// The model of a placement at a level.
[[nodiscard]] inline const std::shared_ptr<const Model>& ModelAt(const Placement& placement,
                                                                 std::size_t level) {
  return level == 0 ? placement.model : (*placement.coarser)[level - 1].model;
}

}  // namespace railcast
