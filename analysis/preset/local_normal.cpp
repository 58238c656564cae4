#include "analysis/preset/local_normal.h"

#include <cmath>

namespace railcast {
namespace {

/// A firing with a point.
struct MetAt {
  std::size_t row{};
  std::size_t column{};
  Vector3 position_m = Vector3::Zero();
};

// From the point to that of another firing; nothing if it is so near that noise decides the
// direction.
std::optional<Vector3> Baseline_m(const Frame& frame,
                                  const MetAt& met,
                                  std::size_t row,
                                  std::size_t column) {
  constexpr double kLeast_m = 0.08;
  constexpr double kOfRange = 0.01;
  const auto other_m = FirstPointAt(frame, row, column);
  if (!other_m) return std::nullopt;
  const Vector3 baseline_m = *other_m - met.position_m;
  const bool is_far = baseline_m.norm() >= kLeast_m + kOfRange * met.position_m.norm();
  return is_far ? std::optional(baseline_m) : std::nullopt;
}

// From one neighbour to the other if the point is about in line with them, else nothing.
std::optional<Vector3> ThroughPoint_m(const std::optional<Vector3>& one_m,
                                      const std::optional<Vector3>& other_m) {
  constexpr double kMostCosine = -0.9;
  if (!one_m || !other_m) return std::nullopt;
  if (one_m->dot(*other_m) > kMostCosine * one_m->norm() * other_m->norm()) return std::nullopt;
  return Vector3(*other_m - *one_m);
}

std::optional<Vector3> AlongRing_m(const Frame& frame, const MetAt& met) {
  constexpr std::size_t kMostColumns = 60;
  std::optional<Vector3> before_m, after_m;
  for (std::size_t step = 1; step <= kMostColumns && !(before_m && after_m); ++step) {
    if (!before_m && step <= met.column) {
      before_m = Baseline_m(frame, met, met.row, met.column - step);
    }
    if (!after_m) after_m = Baseline_m(frame, met, met.row, met.column + step);
  }
  return ThroughPoint_m(before_m, after_m);
}

std::optional<Vector3> AcrossRings_m(const Frame& frame, const ScanTable& scan, const MetAt& met) {
  constexpr std::size_t kShareOfRows = 3;
  const std::size_t most_rows = std::max<std::size_t>(2, frame.rows / kShareOfRows);
  const auto from = [&](std::size_t row) -> std::optional<Vector3> {
    const auto column = scan.ColumnBeside(met.row, met.column, row);
    return column ? Baseline_m(frame, met, row, *column) : std::nullopt;
  };
  std::optional<Vector3> below_m, above_m;
  for (std::size_t step = 1; step <= most_rows && !(below_m && above_m); ++step) {
    if (!below_m && step <= met.row) below_m = from(met.row - step);
    if (!above_m && met.row + step < frame.rows) above_m = from(met.row + step);
  }
  return ThroughPoint_m(below_m, above_m);
}

}  // namespace

std::optional<Vector3> FirstPointAt(const Frame& frame, std::size_t row, std::size_t column) {
  if (row >= frame.rows || column >= frame.columns) return std::nullopt;
  const std::size_t slot = row * frame.width() + column * frame.returns;
  if (!std::isfinite(frame.range_m[slot])) return std::nullopt;
  return Vector3(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                 static_cast<double>(frame.z[slot]));
}

Vector3 LocalNormal(const Frame& frame,
                    const ScanTable& scan,
                    std::size_t row,
                    std::size_t column) {
  const MetAt met{row, column, FirstPointAt(frame, row, column).value_or(Vector3::Zero())};
  const auto along_m = AlongRing_m(frame, met);
  const auto across_m = AcrossRings_m(frame, scan, met);
  if (!along_m || !across_m) return Vector3::Zero();
  const Vector3 normal = along_m->cross(*across_m);
  return normal.norm() > 0.0 ? Vector3(normal.normalized()) : Vector3::Zero();
}

}  // namespace railcast
