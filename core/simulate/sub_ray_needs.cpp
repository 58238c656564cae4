#include "core/simulate/sub_ray_needs.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "railcast/transform.h"

namespace railcast {
namespace {

// Permitted distance of a neighbour's hit from the plane: roughness of ballast near the sensor,
// float32 rounding, and chords of a millimetre on curved surfaces.
constexpr float kStep_m = 0.01F;
constexpr float kStepPerRange = 3e-4F;
// Permitted distance along the neighbour's own ray: the gap from which on two surfaces are counted.
constexpr float kGap_m = 0.5F;

// Returns whether ray b passes through, or ends before, the plane that ray a hit.
bool Differs(const RayTile& a, std::size_t i, const RayTile& b, std::size_t j) {
  if ((a.surface[i] == 0) != (b.surface[j] == 0)) return true;
  if (a.surface[i] == 0) return false;
  const float nx = a.normal_x[i];
  const float ny = a.normal_y[i];
  const float nz = a.normal_z[i];
  const float dx = b.direction_x[j];
  const float dy = b.direction_y[j];
  const float dz = b.direction_z[j];
  const float x = b.range_m[j] * dx - a.range_m[i] * a.direction_x[i];
  const float y = b.range_m[j] * dy - a.range_m[i] * a.direction_y[i];
  const float z = b.range_m[j] * dz - a.range_m[i] * a.direction_z[i];
  // Both are scaled by the length of the normal.
  const float off = std::fabs(nx * x + ny * y + nz * z);
  const float slope = std::fabs(nx * dx + ny * dy + nz * dz);
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  return off > (kStep_m + kStepPerRange * a.range_m[i]) * length && off > kGap_m * slope;
}

// Maps grid positions to the tracing order, and provides the directions of firings.
class Grid {
 public:
  explicit Grid(const ScanPattern& pattern)
      : pattern_(pattern), place_(std::size_t{pattern.rows} * pattern.columns) {
    for (std::size_t k = pattern.packet_order.size(); k-- > 0;) {
      const std::uint32_t firing = pattern.packet_order[k];
      place_[SlotOf(pattern.row[firing], pattern.column[firing])] = static_cast<std::uint32_t>(k);
    }
  }

  /// Tracing position of the firing at a grid position; nothing outside the grid.
  [[nodiscard]] std::optional<std::uint32_t> At(std::int64_t row, std::int64_t column) const {
    if (row < 0 || row >= pattern_.rows || column < 0 || column >= pattern_.columns) return {};
    return place_[SlotOf(row, column)];
  }

  [[nodiscard]] double Angle_rad(std::size_t k, std::size_t other) const {
    // The chord approximates the angle well enough and makes the most of float32 directions.
    return (DirectionOf(k) - DirectionOf(other)).norm();
  }

 private:
  [[nodiscard]] std::size_t SlotOf(std::int64_t row, std::int64_t column) const {
    return static_cast<std::size_t>(row) * pattern_.columns + static_cast<std::size_t>(column);
  }
  [[nodiscard]] Vector3 DirectionOf(std::size_t k) const {
    const std::uint32_t firing = pattern_.packet_order[k];
    return {static_cast<double>(pattern_.direction_x[firing]),
            static_cast<double>(pattern_.direction_y[firing]),
            static_cast<double>(pattern_.direction_z[firing])};
  }

  const ScanPattern& pattern_;
  std::vector<std::uint32_t> place_;
};

}  // namespace

SubRayNeeds::SubRayNeeds(const ScanPattern& pattern, const BeamSpec& beam, bool everywhere)
    : everywhere_(everywhere) {
  if (everywhere) return;
  const Grid grid(pattern);
  const double widest_rad = 1e-3 * std::max(beam.divergence_mrad[0], beam.divergence_mrad[1]);
  // Half the 1/e^2 width: if firings are closer than that, whatever covers part of the beam is seen
  // at this distance.
  const double wanted_rad = 0.5 * widest_rad;
  // A neighbour farther away than this tells nothing about the beam.
  const double reach_rad = 6.0 * widest_rad;
  const std::size_t num_traced = pattern.packet_order.size();
  neighbours_.reserve(num_traced * kNumNeighbours);
  for (std::size_t k = 0; k < num_traced; ++k) {
    const std::uint32_t firing = pattern.packet_order[k];
    const auto at = [&](std::int64_t row_steps, std::int64_t column_steps) {
      return grid.At(pattern.row[firing] + row_steps, pattern.column[firing] + column_steps);
    };
    for (std::int64_t dr = -1; dr <= 1; ++dr) {
      for (std::int64_t dc = -1; dc <= 1; ++dc) {
        if (dr == 0 && dc == 0) continue;
        auto neighbour = at(dr, dc);
        if (neighbour) {
          const double step_rad = std::max(grid.Angle_rad(k, *neighbour), 1e-3 * wanted_rad);
          const auto num_steps = static_cast<std::int64_t>(wanted_rad / step_rad);
          if (num_steps > 1) neighbour = at(num_steps * dr, num_steps * dc);
        }
        const bool is_near = neighbour && grid.Angle_rad(k, *neighbour) <= reach_rad;
        neighbours_.push_back(is_near ? *neighbour : static_cast<std::uint32_t>(k));
      }
    }
  }
}

void SubRayNeeds::Mark(std::size_t tile,
                       const std::vector<RayTile>& centers,
                       std::uint8_t* marks) const {
  const RayTile& rays = centers[tile];
  if (everywhere_) {
    std::fill_n(marks, rays.num_rays, std::uint8_t{1});
    return;
  }
  for (std::size_t lane = 0; lane < rays.num_rays; ++lane) {
    const std::uint32_t* neighbours = &neighbours_[(tile * kTileSize + lane) * kNumNeighbours];
    marks[lane] = std::any_of(neighbours, neighbours + kNumNeighbours, [&](std::uint32_t k) {
      return Differs(rays, lane, centers[k / kTileSize], k % kTileSize);
    });
  }
}

}  // namespace railcast
