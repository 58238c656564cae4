#include "core/simulate/sub_ray_needs.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

// What a neighbour may be off the plane: the roughness of ballast nearby, float32 and chords of a
// millimetre, ...
constexpr float kStep_m = 0.01F;
constexpr float kStepPerRange = 3e-4F;
// ... or along its own ray the gap from which on two surfaces are counted.
constexpr float kGap_m = 0.5F;

// Whether ray b passes the plane that ray a has hit, or ends before it.
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
  // Both times the normal's length.
  const float off = std::fabs(nx * x + ny * y + nz * z);
  const float slope = std::fabs(nx * dx + ny * dy + nz * dz);
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  return off > (kStep_m + kStepPerRange * a.range_m[i]) * length && off > kGap_m * slope;
}

}  // namespace

SubRayNeeds::SubRayNeeds(const ScanPattern& pattern, const BeamSpec& beam, bool everywhere)
    : everywhere_(everywhere) {
  if (everywhere) return;
  const std::size_t num_slots = std::size_t{pattern.rows} * pattern.columns;
  std::vector<std::uint32_t> place(num_slots);
  const auto slot_of = [&](std::uint32_t firing) {
    return std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing];
  };
  const std::size_t num_traced = pattern.packet_order.size();
  for (std::size_t k = num_traced; k-- > 0;) {
    place[slot_of(pattern.packet_order[k])] = static_cast<std::uint32_t>(k);
  }
  // No farther away than this many beam widths, or a neighbour says nothing about the beam.
  const double reach_rad = 1e-3 * 6.0 * std::max(beam.divergence_mrad[0], beam.divergence_mrad[1]);
  const auto least_cosine = static_cast<float>(std::cos(reach_rad));
  neighbours_.reserve(num_traced * kNumNeighbours);
  for (std::size_t k = 0; k < num_traced; ++k) {
    const std::uint32_t firing = pattern.packet_order[k];
    const auto row = static_cast<std::int64_t>(pattern.row[firing]);
    const auto column = static_cast<std::int64_t>(pattern.column[firing]);
    for (std::int64_t dr = -1; dr <= 1; ++dr) {
      for (std::int64_t dc = -1; dc <= 1; ++dc) {
        if (dr == 0 && dc == 0) continue;
        const std::int64_t r = row + dr;
        const std::int64_t c = column + dc;
        auto neighbour = static_cast<std::uint32_t>(k);
        if (r >= 0 && r < pattern.rows && c >= 0 && c < pattern.columns) {
          const std::uint32_t there =
              place[static_cast<std::size_t>(r) * pattern.columns + static_cast<std::size_t>(c)];
          const std::uint32_t other = pattern.packet_order[there];
          const float cosine = pattern.direction_x[firing] * pattern.direction_x[other] +
                               pattern.direction_y[firing] * pattern.direction_y[other] +
                               pattern.direction_z[firing] * pattern.direction_z[other];
          if (cosine >= least_cosine) neighbour = there;
        }
        neighbours_.push_back(neighbour);
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
