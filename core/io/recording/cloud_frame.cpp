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
#include "core/io/recording/plausibility.h"
#include "core/io/recording/ring_table.h"
#include "core/io/recording/slot_plans.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

constexpr std::array<std::string_view, 5> kTimeNames = {"t", "time", "timestamp", "time_stamp",
                                                        "gps_time"};
// The durations of scans at 50 Hz and at 1 Hz.
constexpr double kMinScan_s = 0.02;
constexpr double kMaxScan_s = 1.0;

bool IsFloating(NumberType type) {
  return type == NumberType::kFloat || type == NumberType::kDouble;
}

bool IsScanTime(double span_s) {
  return span_s >= kMinScan_s && span_s <= kMaxScan_s;
}

/// Whether a time would be one from 2000 to 2100 if it counted microseconds since 1970. As
/// nanoseconds it would be 11 to 47 days: a scan by such a clock and a drive look alike.
bool AreMicrosecondsOfCalendar(double time) {
  constexpr double kBegin_us = 946'684'800e6;
  constexpr double kEnd_us = 4'102'444'800e6;
  return time >= kBegin_us && time < kEnd_us;
}

/// The times of a cloud's points.
struct PointTimes : TimeColumn {
  std::vector<double> since_first_ns;
};

/// Returns the times of a column, if their unit is certain.
std::optional<PointTimes> LoadTimes(const Cloud& cloud, const CloudField& column) {
  std::vector<double> times(cloud.num_points());
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  VisitField(cloud, column, [&](std::size_t i, auto value) {
    times[i] = static_cast<double>(value);
    first = std::min(first, times[i]);
    last = std::max(last, times[i]);
  });
  const bool is_in_s = IsFloating(column.type) && IsScanTime(last - first);
  const double ns_per_unit = is_in_s ? kNsPerS : AreMicrosecondsOfCalendar(first) ? 1e3 : 1.0;
  if (!IsScanTime((last - first) * ns_per_unit / kNsPerS)) return std::nullopt;
  for (double& time : times) {
    if (std::isnan(time)) return std::nullopt;
    time = (time - first) * ns_per_unit;
  }
  return PointTimes{{&column, first * ns_per_unit, ns_per_unit}, std::move(times)};
}

std::optional<PointTimes> FindTimes(const Cloud& cloud) {
  for (const std::string_view name : kTimeNames) {
    const CloudField* const column = cloud.Find(name);
    if (column == nullptr) continue;
    if (auto times = LoadTimes(cloud, *column)) return times;
  }
  return std::nullopt;
}

/// Says that a column that is called a time is none of the points', for its unit is not certain.
/// Surveys have GPS times, which need not be those of a scan.
void RemarkUnknownTime(const Cloud& cloud, RecordedFrame& recorded) {
  for (const std::string_view name : kTimeNames) {
    const CloudField* const column = cloud.Find(name);
    if (column == nullptr || name == "gps_time") continue;
    AddRemark({.kind = RemarkKind::kFieldsLeftOut,
               .place = recorded.name,
               .detail = column->name + " as times of points, for its unit is not certain"},
              recorded.remarks);
  }
}

// Takes the time from a foreign column, for files that have no time_ns.
void FillForeignTime(const Cloud& cloud, const SlotPlan& plan, RecordedFrame& recorded) {
  const auto times = FindTimes(cloud);
  if (!times) return RemarkUnknownTime(cloud, recorded);
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
std::uint32_t ReturnsOf(const Cloud& cloud, const std::string& name) {
  const CloudField* const return_index = cloud.Find("return_index");
  if (return_index == nullptr) return 1;
  const auto indices = LoadIndices(cloud, *return_index, 2, name);
  const std::uint32_t returns = *std::ranges::max_element(indices) + 1;
  if (cloud.width % returns == 0) return returns;
  throw InputError(name + ": return_index: WIDTH must be a multiple of its returns (got " +
                   NumberText(cloud.width) + " of " + NumberText(returns) + ")");
}

/// @param fault Says why there are none in a column that has the name.
std::vector<std::uint32_t> LoadRings(const Cloud& cloud,
                                     const std::string& name,
                                     std::string& fault) {
  const CloudField* const ring = FindFieldOf(cloud, "ring");
  if (ring == nullptr) return {};
  try {
    return LoadIndices(cloud, *ring, std::numeric_limits<std::uint16_t>::max(), name);
  } catch (const InputError& error) {
    fault = std::string(error.what()).substr(name.size() + 2);
    return {};
  }
}

SlotPlan PlanOfCloud(const Cloud& cloud, const std::string& name, std::vector<Remark>& remarks) {
  // A message may claim any number of rows without a point.
  if (cloud.height > 1 && cloud.width == 0) return LoosePlan(cloud, "it has no point");
  const bool is_ours = cloud.Find("ring") != nullptr && cloud.Find("column") != nullptr;
  if (cloud.height > 1 && is_ours) return OrganisedPlan(cloud, ReturnsOf(cloud, name));
  // Some programs give a cloud without a grid one column instead of one row.
  if (cloud.height > 1 && cloud.width > 1) {
    return SortedRowsPlan(cloud, FindFieldOf(cloud, "ring"));
  }
  // Points of several sensors share no grid.
  if (FindFieldOf(cloud, kSensorIndexField) != nullptr) {
    return LoosePlan(cloud, "its points are those of several sensors");
  }
  if (is_ours) return PlacedPlan(cloud, name, std::nullopt);
  std::string fault;
  const std::vector<std::uint32_t> rings = LoadRings(cloud, name, fault);
  std::string why_not;
  auto plan = MakeRingTable(LoadPositions(cloud), rings, &why_not);
  if (!plan) return LoosePlan(cloud, why_not);  // FillFrame() tells the fault.
  if (!fault.empty()) {
    AddRemark({.kind = RemarkKind::kFieldsLeftOut, .place = name, .detail = fault}, remarks);
  }
  return std::move(*plan);
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

std::optional<TimeColumn> FindTimeColumn(const Cloud& cloud) {
  if (FindFieldOf(cloud, "time_ns") != nullptr) return std::nullopt;
  return FindTimes(cloud);
}

std::optional<double> FirstTimeIn_ns(const Cloud& cloud) {
  const auto times = FindTimeColumn(cloud);
  return times ? std::optional(times->first_ns) : std::nullopt;
}

RecordedFrame MakeCloudFrame(const Cloud& cloud,
                             const std::string& name,
                             const std::string& why_no_ranges) {
  RecordedFrame recorded;
  recorded.name = name;
  recorded.why_no_ranges = why_no_ranges;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(cloud, axis, name);
  recorded.remarks = CheckPositions(cloud, name);
  const std::string fault = FaultOfIntensities(cloud);
  if (!fault.empty()) throw InputError(name + ": " + fault);
  const SlotPlan plan = why_no_ranges.empty() ? PlanOfCloud(cloud, name, recorded.remarks)
                                              : LoosePlan(cloud, why_no_ranges);
  FillFrame(cloud, plan, recorded);
  if (why_no_ranges.empty() && !recorded.origin_m.isZero()) {
    recorded.why_no_ranges =
        "its positions are map coordinates, and where the sensor was is not known";
  }
  if (!recorded.Has("time_ns")) FillForeignTime(cloud, plan, recorded);
  RemarkRoundedValues(cloud, plan, recorded);
  const std::vector<std::uint32_t>& times_ns = recorded.frame.time_ns;
  if (!times_ns.empty()) recorded.frame.duration_ns = *std::ranges::max_element(times_ns);
  if (!recorded.Has("column")) LeaveOutUnlikelyTimes(recorded);  // Ours may begin all at once.
  if (cloud.Find("column") == nullptr) CheckUnit(recorded);      // Ours is in metres.
  return recorded;
}

RecordedFrame MakeScanFrame(const Cloud& cloud,
                            const std::string& name,
                            const ScanPattern& pattern,
                            bool is_organised) {
  RecordedFrame recorded;
  recorded.name = name;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(cloud, axis, name);
  if (is_organised) {
    if (cloud.height != pattern.rows || cloud.width % pattern.columns != 0 ||
        cloud.width / pattern.columns > 3 || cloud.width == 0) {
      throw InputError(name + ": WIDTH x HEIGHT: must be " + NumberText(pattern.columns) +
                       " per return x " + NumberText(pattern.rows) +
                       ", as the scenario says (got " + NumberText(cloud.width) + " x " +
                       NumberText(cloud.height) + ")");
    }
    FillFrame(cloud, OrganisedPlan(cloud, cloud.width / pattern.columns), recorded);
  } else if (cloud.Find("ring") != nullptr && cloud.Find("column") != nullptr) {
    FillFrame(cloud, PlacedPlan(cloud, name, ScanShape{pattern.rows, pattern.columns}), recorded);
    if (recorded.Has("time_ns")) FillScanTimes(pattern, recorded.frame);
  } else {
    FillFrame(cloud, LoosePlan(cloud, "it has no fields ring and column"), recorded);
  }
  return recorded;
}

}  // namespace railcast
