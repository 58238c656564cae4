#include "core/io/recording/near_origin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace railcast {
namespace {

constexpr double kFar_m = 10e3;
constexpr double kStep_m = 1e3;

/// Calls `visit(slot, stored value)` for every point of the frame.
template <typename Visitor>
void VisitPoints(const PointTable& table,
                 const PointColumn& column,
                 const SlotPlan& plan,
                 const Frame& frame,
                 Visitor&& visit) {
  VisitColumn(table, column, [&](std::size_t i, auto value) {
    const std::uint32_t slot = plan.slots.empty() ? static_cast<std::uint32_t>(i) : plan.slots[i];
    if (slot != kNoSlot && !std::isnan(frame.range_m[slot])) {
      visit(slot, static_cast<double>(value));
    }
  });
}

/// Returns the median, which stray points do not move as they would a mean.
/// @pre Not empty.
double Median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

void TakeFromNearOrigin(const PointTable& table, const SlotPlan& plan, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  const std::array<const PointColumn*, 3> columns = {
      FindFieldOf(table, "x"), FindFieldOf(table, "y"), FindFieldOf(table, "z")};
  const bool is_double = std::ranges::all_of(
      columns, [](const PointColumn* column) { return column->type == NumberType::kDouble; });
  if (!is_double) return;
  Vector3 middle_m = Vector3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values_m;
    VisitPoints(table, *columns.at(static_cast<std::size_t>(axis)), plan, frame,
                [&](std::uint32_t, double value_m) { values_m.push_back(value_m); });
    if (values_m.empty()) return;
    middle_m[axis] = Median(values_m);
  }
  if (!(middle_m.norm() > kFar_m)) return;
  recorded.origin_m = kStep_m * (middle_m / kStep_m).array().round().matrix();
  const std::array<std::vector<float>*, 3> positions_m = {&frame.x, &frame.y, &frame.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin_m = recorded.origin_m[static_cast<Eigen::Index>(axis)];
    VisitPoints(table, *columns.at(axis), plan, frame, [&](std::uint32_t slot, double value_m) {
      (*positions_m.at(axis))[slot] = static_cast<float>(value_m - origin_m);
    });
  }
}

}  // namespace railcast
