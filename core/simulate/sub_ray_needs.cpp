#include "core/simulate/sub_ray_needs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace railcast {
namespace {

float Env(const char* name, float otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? static_cast<float>(std::atof(text)) : otherwise;
}

// Whether ray b does not hit the plane that ray a has hit.
bool Differs(const RayTile& a, std::size_t i, const RayTile& b, std::size_t j) {
  static const float kStep = Env("RC_STEP", 0.05F);
  static const float kSlope = Env("RC_SLOPE", 0.001F);
  static const float kRange = Env("RC_RANGE", 1e9F);
  if ((a.surface[i] == 0) != (b.surface[j] == 0)) return true;
  if (a.surface[i] == 0) return false;
  const float x = b.range_m[j] * b.direction_x[j] - a.range_m[i] * a.direction_x[i];
  const float y = b.range_m[j] * b.direction_y[j] - a.range_m[i] * a.direction_y[i];
  const float z = b.range_m[j] * b.direction_z[j] - a.range_m[i] * a.direction_z[i];
  const float nx = a.normal_x[i];
  const float ny = a.normal_y[i];
  const float nz = a.normal_z[i];
  const float off = std::fabs(nx * x + ny * y + nz * z) / std::sqrt(nx * nx + ny * ny + nz * nz);
  const float along =
      std::fabs(nx * b.direction_x[j] + ny * b.direction_y[j] + nz * b.direction_z[j]) /
      std::sqrt(nx * nx + ny * ny + nz * nz);
  return off > kStep + kSlope * a.range_m[i] || off > kRange * along;
}

}  // namespace

SubRayNeeds::SubRayNeeds(const ScanPattern& pattern, const BeamSpec& beam, bool everywhere)
    : everywhere_(everywhere) {
  static_cast<void>(beam);
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
