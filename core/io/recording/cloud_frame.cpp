#include "core/io/recording/cloud_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/ring_table.h"
#include "core/io/recording/slot_plans.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

constexpr std::array<std::string_view, 4> kTimeNames = {"t", "time", "timestamp", "time_stamp"};
// The durations of scans at 50 Hz and at 1 Hz.
constexpr double kMinScan_s = 0.02;
constexpr double kMaxScan_s = 1.0;

bool IsFloating(NumberType type) {
  return type == NumberType::kFloat || type == NumberType::kDouble;
}

bool IsScanTime(double span_s) {
  return span_s >= kMinScan_s && span_s <= kMaxScan_s;
}

/// The times of a cloud's points.
struct PointTimes {
  const PointColumn* column{};
  double first_ns{};
  double ns_per_unit{};
  std::vector<double> since_first_ns;
};

/// Returns the times of a column, if their unit is certain.
std::optional<PointTimes> LoadTimes(const PointTable& table, const PointColumn& column) {
  std::vector<double> times(table.num_points());
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  VisitColumn(table, column, [&](std::size_t i, auto value) {
    times[i] = static_cast<double>(value);
    first = std::min(first, times[i]);
    last = std::max(last, times[i]);
  });
  const bool is_in_s = IsFloating(column.type) && IsScanTime(last - first);
  const double ns_per_unit = is_in_s ? kNsPerS : 1.0;
  if (!IsScanTime((last - first) * ns_per_unit / kNsPerS)) return std::nullopt;
  for (double& time : times) {
    if (std::isnan(time)) return std::nullopt;
    time = (time - first) * ns_per_unit;
  }
  return PointTimes{&column, first * ns_per_unit, ns_per_unit, std::move(times)};
}

std::optional<PointTimes> FindTimes(const PointTable& table) {
  for (const std::string_view name : kTimeNames) {
    const PointColumn* const column = table.Find(name);
    if (column == nullptr) continue;
    if (auto times = LoadTimes(table, *column)) return times;
  }
  return std::nullopt;
}

// Takes the time from a foreign column, for files that have no time_ns.
void FillForeignTime(const PointTable& table, const SlotPlan& plan, RecordedFrame& recorded) {
  const auto times = FindTimes(table);
  if (!times) return;
  for (std::size_t i = 0; i < times->since_first_ns.size(); ++i) {
    const auto slot = plan.slots.empty() ? static_cast<std::uint32_t>(i) : plan.slots[i];
    if (slot == kNoSlot) continue;
    recorded.frame.time_ns[slot] =
        static_cast<std::uint32_t>(std::llround(times->since_first_ns[i]));
  }
  recorded.fields.emplace("time_ns");
  std::erase_if(recorded.foreign, [&](const ForeignField& field) {
    return field.name == times->column->plain_name();
  });
}

/// Returns the number of slots per firing in an organised file that railcast wrote.
std::uint32_t ReturnsOf(const PointTable& table, const std::string& name) {
  const PointColumn* const return_index = table.Find("return_index");
  if (return_index == nullptr) return 1;
  const auto indices = LoadIndices(table, *return_index, 2, name);
  const std::uint32_t returns = *std::ranges::max_element(indices) + 1;
  if (table.width % returns == 0) return returns;
  throw InputError(name + ": return_index: WIDTH must be a multiple of its returns (got " +
                   NumberText(table.width) + " of " + NumberText(returns) + ")");
}

std::vector<std::uint32_t> LoadRings(const PointTable& table, const std::string& name) {
  const PointColumn* const ring = FindFieldOf(table, "ring");
  if (ring == nullptr) return {};
  return LoadIndices(table, *ring, std::numeric_limits<std::uint16_t>::max(), name);
}

SlotPlan PlanOfTable(const PointTable& table, const std::string& name) {
  const bool is_ours = table.Find("ring") != nullptr && table.Find("column") != nullptr;
  if (table.height > 1) {
    return is_ours ? OrganisedPlan(table, ReturnsOf(table, name))
                   : SortedRowsPlan(table, FindFieldOf(table, "ring"));
  }
  // Points of several sensors share no grid.
  if (FindFieldOf(table, kSensorIndexField) != nullptr) {
    return LoosePlan(table, "its points are those of several sensors");
  }
  if (is_ours) return PlacedPlan(table, name, std::nullopt);
  const PointPositions positions{.x = LoadFloats(table, *table.Find("x")),
                                 .y = LoadFloats(table, *table.Find("y")),
                                 .z = LoadFloats(table, *table.Find("z"))};
  const std::vector<std::uint32_t> rings = LoadRings(table, name);
  std::string why_not;
  if (auto plan = MakeRingTable(positions, rings, &why_not)) return std::move(*plan);
  return LoosePlan(table, why_not);
}

/// Fills in the times of the scan pattern, since slots without a point have no time of their own.
void FillScanTimes(const ScanPattern& pattern, Frame& frame) {
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t first = (std::size_t{pattern.row[i]} * frame.columns + pattern.column[i]) *
                              std::size_t{frame.returns};
    std::fill_n(frame.time_ns.begin() + static_cast<std::ptrdiff_t>(first), frame.returns,
                pattern.time_ns[i]);
  }
}

}  // namespace

std::optional<TimeColumn> FindTimeColumn(const PointTable& table) {
  if (FindFieldOf(table, "time_ns") != nullptr) return std::nullopt;
  const auto times = FindTimes(table);
  if (!times) return std::nullopt;
  return TimeColumn{times->column, times->first_ns, times->ns_per_unit};
}

std::optional<double> FirstTimeIn_ns(const PointTable& table) {
  const auto times = FindTimeColumn(table);
  return times ? std::optional(times->first_ns) : std::nullopt;
}

RecordedFrame MakeCloudFrame(const PointTable& table, const std::string& name) {
  RecordedFrame recorded;
  recorded.name = name;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(table, axis, name);
  const SlotPlan plan = PlanOfTable(table, name);
  FillFrame(table, plan, recorded);
  if (!recorded.Has("time_ns")) FillForeignTime(table, plan, recorded);
  const std::vector<std::uint32_t>& times_ns = recorded.frame.time_ns;
  if (!times_ns.empty()) recorded.frame.duration_ns = *std::ranges::max_element(times_ns);
  return recorded;
}

RecordedFrame MakeScanFrame(const PointTable& table,
                            const std::string& name,
                            const ScanPattern& pattern,
                            bool is_organised) {
  RecordedFrame recorded;
  recorded.name = name;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(table, axis, name);
  if (is_organised) {
    if (table.height != pattern.rows || table.width % pattern.columns != 0 ||
        table.width / pattern.columns > 3 || table.width == 0) {
      throw InputError(name + ": WIDTH x HEIGHT: must be " + NumberText(pattern.columns) +
                       " per return x " + NumberText(pattern.rows) +
                       ", as the scenario says (got " + NumberText(table.width) + " x " +
                       NumberText(table.height) + ")");
    }
    FillFrame(table, OrganisedPlan(table, table.width / pattern.columns), recorded);
  } else if (table.Find("ring") != nullptr && table.Find("column") != nullptr) {
    FillFrame(table, PlacedPlan(table, name, ScanShape{pattern.rows, pattern.columns}), recorded);
    if (recorded.Has("time_ns")) FillScanTimes(pattern, recorded.frame);
  } else {
    FillFrame(table, LoosePlan(table, "it has no fields ring and column"), recorded);
  }
  return recorded;
}

}  // namespace railcast
