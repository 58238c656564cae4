#include "viewer/overlays/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "viewer/color/palette.h"
#include "viewer/overlays/strokes.h"

namespace railcast {
namespace {

constexpr Rgb kFrustumRgb = kSkyBlue;
constexpr std::size_t kRaysOfTurn = 8;

/// The end points of beams along a row or a column; beams of unknown direction are left out.
class Border {
 public:
  Border(const ScanTable& table, double range_m) : table_(table), range_m_(range_m) {}

  [[nodiscard]] std::vector<Vector3> Row(std::size_t row) const {
    std::vector<Vector3> places;
    for (std::size_t column = 0; column < table_.columns; ++column) Add(row, column, places);
    return places;
  }
  [[nodiscard]] std::vector<Vector3> Column(std::size_t column) const {
    std::vector<Vector3> places;
    for (std::size_t row = 0; row < table_.rows; ++row) Add(row, column, places);
    return places;
  }

 private:
  void Add(std::size_t row, std::size_t column, std::vector<Vector3>& places) const {
    const std::array<double, 3> direction = table_.Direction(row, column);
    const Vector3 place = range_m_ * Vector3(direction[0], direction[1], direction[2]);
    if (place.allFinite()) places.push_back(place);
  }

  const ScanTable& table_;
  double range_m_;
};

// Returns the first and the last known angle. A ScanTable has at least two, because its steps are >
// 0.
std::pair<std::size_t, std::size_t> KnownSpan(const std::vector<double>& angles_rad) {
  const auto is_known = [](double angle_rad) { return !std::isnan(angle_rad); };
  const auto first = std::ranges::find_if(angles_rad, is_known);
  const auto after_last = std::find_if(angles_rad.rbegin(), angles_rad.rend(), is_known).base();
  return {first - angles_rad.begin(), after_last - angles_rad.begin() - 1};
}

void AddRay(const Vector3& end_m, Overlay& drawing) {
  AddSegment(Vector3::Zero(), end_m, kFrustumRgb, drawing);
}

void AddCone(std::vector<Vector3> circle, Overlay& drawing) {
  for (std::size_t ray = 0; ray < kRaysOfTurn; ++ray) {
    AddRay(circle[ray * circle.size() / kRaysOfTurn], drawing);
  }
  circle.push_back(circle.front());
  AddPolyline(circle, kFrustumRgb, drawing);
}

}  // namespace

Overlay DrawSensorFrustum(const ScanTable& table, double range_m) {
  Overlay drawing;
  const Border border(table, std::min(range_m, kMostFrustumRange_m));
  const auto [low, high] = KnownSpan(table.elevation_rad);
  const auto [first, last] = KnownSpan(table.column_azimuth_rad);
  const std::array<std::vector<Vector3>, 2> rows = {border.Row(low), border.Row(high)};
  if (table.is_full_turn) {
    for (const std::vector<Vector3>& circle : rows) AddCone(circle, drawing);
    return drawing;
  }
  for (const std::vector<Vector3>& row : rows) {
    AddRay(row.front(), drawing);
    AddRay(row.back(), drawing);
    AddPolyline(row, kFrustumRgb, drawing);
  }
  for (const std::size_t column : {first, last}) {
    AddPolyline(border.Column(column), kFrustumRgb, drawing);
  }
  return drawing;
}

}  // namespace railcast
