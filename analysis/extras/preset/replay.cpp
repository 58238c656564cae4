#include "analysis/extras/preset/preset_comparison.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/scene/empty_world.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

/// A world of nothing, in which the vehicle stands.
class StandingWorld final : public EmptyWorld {
 public:
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return Transform::Identity();
  }
};

/// Casts rays from the sensor's origin at the planes of a recorded turn.
class PlaneCaster final : public RayCaster {
 public:
  /// @param surfaces Surface of each cell.
  PlaneCaster(const SeenPlanes& seen,
              const std::vector<double>& rows_rad,
              const std::map<PlaneCell, std::uint32_t>& surfaces)
      : seen_(seen), rows_rad_(rows_rad), surfaces_(surfaces) {
    column_.assign(kSteps, kNoColumn);
    // How far a column reaches to either side; a little more than half a step, so that no gaps are
    // left where the rotor was slower.
    const double reach_rad = 0.6 * seen.scan.column_step_rad;
    std::vector<double> nearest_rad(kSteps, reach_rad);
    for (std::size_t column = 0; column < seen.scan.columns; ++column) {
      const double azimuth_rad = seen.scan.column_azimuth_rad[column];
      if (std::isnan(azimuth_rad)) continue;
      const auto reach = static_cast<std::int64_t>(reach_rad / kStep_rad) + 1;
      for (std::int64_t k = -reach; k <= reach; ++k) {
        const double place_rad = azimuth_rad + static_cast<double>(k) * kStep_rad;
        const std::size_t step = StepOf(place_rad);
        const double apart_rad =
            std::abs(WrappedAngle_rad((static_cast<double>(step) + 0.5) * kStep_rad - azimuth_rad));
        if (apart_rad >= nearest_rad[step]) continue;
        nearest_rad[step] = apart_rad;
        column_[step] = static_cast<std::uint32_t>(column);
      }
    }
  }

  void Cast(RayTile& tile) const override {
    for (std::size_t i = 0; i < tile.num_rays; ++i) {
      const Vector3 direction(static_cast<double>(tile.direction_x[i]),
                              static_cast<double>(tile.direction_y[i]),
                              static_cast<double>(tile.direction_z[i]));
      const std::uint8_t index = PlaneAlong(direction);
      if (index == SeenPlanes::kNone) continue;
      const SeenPlane& plane = seen_.planes[index];
      const Vector3 origin_m(static_cast<double>(tile.origin_x[i]),
                             static_cast<double>(tile.origin_y[i]),
                             static_cast<double>(tile.origin_z[i]));
      const double range_m = plane.RangeAlong_m(direction, origin_m);
      if (!(range_m > 0.0 && range_m < static_cast<double>(tile.range_m[i]))) continue;
      tile.range_m[i] = static_cast<float>(range_m);
      tile.surface[i] = SurfaceOf(CellOf(seen_, index, direction));
      tile.normal_x[i] = static_cast<float>(plane.normal.x());
      tile.normal_y[i] = static_cast<float>(plane.normal.y());
      tile.normal_z[i] = static_cast<float>(plane.normal.z());
    }
  }

 private:
  static constexpr std::size_t kSteps = 36'000;
  static constexpr double kStep_rad = 2.0 * std::numbers::pi / static_cast<double>(kSteps);
  static constexpr std::uint32_t kNoColumn = 0xFFFFFFFFU;

  static std::size_t StepOf(double azimuth_rad) {
    const double wrapped_rad = WrappedAngle_rad(azimuth_rad);
    const double positive_rad =
        wrapped_rad < 0.0 ? wrapped_rad + 2.0 * std::numbers::pi : wrapped_rad;
    return std::min(kSteps - 1, static_cast<std::size_t>(positive_rad / kStep_rad));
  }

  // The nearest cell before this one, or the first, if it is not in the list.
  [[nodiscard]] std::uint32_t SurfaceOf(const PlaneCell& cell) const {
    auto after = surfaces_.upper_bound(cell);
    if (after != surfaces_.begin()) --after;
    return after->second;
  }

  // The plane that the recorded firing nearest to this direction has met.
  [[nodiscard]] std::uint8_t PlaneAlong(const Vector3& direction) const {
    const ScanTable& scan = seen_.scan;
    const double elevation_rad = std::asin(std::clamp(direction.z(), -1.0, 1.0));
    const auto above = std::lower_bound(rows_rad_.begin(), rows_rad_.end(), elevation_rad);
    auto row = static_cast<std::size_t>(above - rows_rad_.begin());
    if (row == rows_rad_.size() ||
        (row > 0 && elevation_rad - rows_rad_[row - 1] < rows_rad_[row] - elevation_rad)) {
      --row;
    }
    const double azimuth_rad = std::atan2(direction.y(), direction.x());
    const std::uint32_t column = column_[StepOf(azimuth_rad - scan.row_azimuth_rad[row])];
    return column == kNoColumn ? SeenPlanes::kNone : seen_.PlaneOf(row, column);
  }

  const SeenPlanes& seen_;
  const std::vector<double>& rows_rad_;  ///< Elevations of the rows, rising.
  const std::map<PlaneCell, std::uint32_t>& surfaces_;
  std::vector<std::uint32_t> column_;  ///< By azimuth in steps of 0.01 deg, from 0 on.
};

const Material& MaterialNamed(const ScenarioSpec& scenario, const std::string& name) {
  const auto found = std::ranges::find(scenario.materials, name, &Material::name);
  if (found == scenario.materials.end()) {
    throw InputError("/materials: must have the material \"" + name +
                     "\", of which planes are made");
  }
  return *found;
}

ScanTable ScanOf(const ScanPattern& pattern) {
  auto scan = MakeScanTable(pattern);
  if (!scan) throw InputError("/lidar/scan: must be a grid of rings and columns");
  return *std::move(scan);
}

}  // namespace

Replay::Replay(const ScenarioSpec& scenario)
    : scenario_(scenario),
      pattern_(BuildScanPattern(scenario.lidar.scan)),
      scan_(ScanOf(pattern_)) {
  (void)MaterialNamed(scenario_, "asphalt");
  (void)MaterialNamed(scenario_, "concrete");
}

std::vector<Frame> Replay::Scan(const SeenPlanes& seen,
                                const std::map<PlaneCell, double>& reflectivities,
                                const std::vector<std::uint32_t>& frame_indices) const {
  std::vector<Material> materials;
  std::vector<Surface> surfaces(1);
  std::map<PlaneCell, std::uint32_t> surface_of;
  for (const auto& [cell, reflectivity] : reflectivities) {
    const bool is_ground = seen.planes[cell.plane].is_ground();
    materials.push_back(MaterialNamed(scenario_, is_ground ? "asphalt" : "concrete"));
    materials.back().name = "cell " + std::to_string(materials.size());
    materials.back().reflectivity = reflectivity;
    surface_of[cell] = static_cast<std::uint32_t>(surfaces.size());
    surfaces.push_back({.instance = static_cast<std::uint32_t>(cell.plane + 1),
                        .reflectivity = static_cast<float>(reflectivity),
                        .material = static_cast<std::uint16_t>(materials.size())});
  }
  SimulatorSpec spec{.detector = DetectorSpecOf(scenario_, scenario_.lidar, EffectsOf(scenario_))};
  // Errors of intensities and textures are drawn, and say nothing about a preset's laws.
  EffectSet& effects = spec.detector.effects;
  effects.intensity_noise = effects.channel_gain = effects.texture = false;
  Simulator simulator(std::make_shared<StandingWorld>(), pattern_, MaterialLibrary(materials), spec,
                      0);
  const PlaneCaster caster(seen, scan_.elevation_rad, surface_of);
  std::vector<Frame> frames;
  for (const std::uint32_t index : frame_indices) {
    simulator.Scan(index, {caster, Transform::Identity(), surfaces}, frames.emplace_back());
  }
  return frames;
}

}  // namespace railcast
