#include "generator/extras/insert/recorded_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/detect/base/beam_optics.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

// The first slot of the cell so many rows and columns beside that of a firing.
std::optional<std::size_t> SlotBeside(const RecordedFirings& firings,
                                      std::size_t firing,
                                      int rows,
                                      int columns) {
  const ScanPattern& pattern = firings.pattern;
  const std::int64_t row = std::int64_t{pattern.row[firing]} + rows;
  const std::int64_t column = std::int64_t{pattern.column[firing]} + columns;
  const bool is_inside = row >= 0 && column >= 0 && row < pattern.rows && column < pattern.columns;
  if (!is_inside) return std::nullopt;
  const auto cell = static_cast<std::size_t>(row * pattern.columns + column);
  if (firings.firing_of_cell[cell] == kNoFiring) return std::nullopt;
  return firings.SlotOfCell(cell);
}

Vector3 PointIn(const Frame& frame, std::size_t slot) {
  return {static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
          static_cast<double>(frame.z[slot])};
}

}  // namespace

float BeamShareAt(const RecordedFirings& firings, std::size_t firing, std::size_t slot) {
  constexpr float kSameSurface_m = 0.5F;
  constexpr float kWhole = 0.75F;
  const Frame& frame = firings.recorded.frame;
  if (firings.are_points_alone) return 1.0F;
  float brightest = 0.0F;
  bool is_at_edge = false;
  for (int rows = -1; rows <= 1; ++rows) {
    for (int columns = -1; columns <= 1; ++columns) {
      const auto beside = SlotBeside(firings, firing, rows, columns);
      if (!beside) continue;
      if (std::fabs(frame.range_m[*beside] - frame.range_m[slot]) < kSameSurface_m) {
        brightest = std::max(brightest, frame.intensity[*beside]);
      } else {
        is_at_edge = true;  // Nothing was returned there, or from elsewhere.
      }
    }
  }
  if (!is_at_edge || !(brightest > 0.0F)) return 1.0F;
  const float share = frame.intensity[slot] / brightest;
  return share < kWhole ? share : 1.0F;
}

float PeakKeptAt(const RecordedFirings& firings,
                 const BeamSpec& beam,
                 std::size_t firing,
                 std::size_t slot) {
  constexpr float kSameSurface = 0.3F;  // Neighbours are at most this share of the range apart.
  const Frame& frame = firings.recorded.frame;
  if (firings.are_points_alone) return 1.0F;
  const Vector3 point_m = PointIn(frame, slot);
  const Vector3 direction = point_m.normalized();
  const Vector3 axis =
      frame.sensor_from_spin ? Vector3(frame.sensor_from_spin->col(2)) : Vector3::UnitZ();
  const Vector3 horizontal = axis.cross(direction).normalized();
  const Vector3 vertical = direction.cross(horizontal);
  const auto to_neighbour_m = [&](int rows, int columns) -> std::optional<Vector3> {
    const auto beside = SlotBeside(firings, firing, rows, columns);
    if (!beside) return std::nullopt;
    const float apart_m = std::fabs(frame.range_m[*beside] - frame.range_m[slot]);
    if (!(apart_m < kSameSurface * frame.range_m[slot])) return std::nullopt;
    return PointIn(frame, *beside) - point_m;
  };
  double least_spread_rad = std::numeric_limits<double>::infinity();
  for (const int columns : {-1, 1}) {
    for (const int rows : {-1, 1}) {
      const auto across_m = to_neighbour_m(0, columns);
      const auto along_m = to_neighbour_m(rows, 0);
      if (!across_m || !along_m) continue;
      const Vector3 normal = across_m->cross(*along_m);
      const double spread_rad = std::hypot(HorizontalSigma_rad(beam) * normal.dot(horizontal),
                                           VerticalSigma_rad(beam) * normal.dot(vertical)) /
                                std::max(std::abs(normal.dot(direction)), 1e-12);
      least_spread_rad = std::min(least_spread_rad, spread_rad);
    }
  }
  if (!std::isfinite(least_spread_rad)) return 1.0F;
  const double spread_m = static_cast<double>(frame.range_m[slot]) * least_spread_rad;
  return static_cast<float>(PulseSigma_m(beam) / std::hypot(PulseSigma_m(beam), spread_m));
}

}  // namespace railcast
