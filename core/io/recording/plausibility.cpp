#include "core/io/recording/plausibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/scan_table.h"
#include "core/io/sensor_tables.h"

namespace railcast {
namespace {

constexpr double kMostWrong = 0.01;

using Positions = std::vector<Vector3>;

/// The positions of a cloud as stored, but for those that are not finite, or 0 for "no return".
Positions StoredPositions(const Cloud& cloud) {
  Positions positions(cloud.num_points());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const CloudField* const field = FindFieldOf(cloud, std::string_view("xyz").substr(axis, 1));
    Check(field != nullptr, "the cloud has x, y and z");
    VisitField(cloud, *field,
               [&](std::size_t i, auto value) { positions[i][axis] = static_cast<double>(value); });
  }
  std::erase_if(positions, [](const Vector3& position) {
    return !position.allFinite() || position.isZero(0.0);
  });
  return positions;
}

/// Whether most positions are within a distance of a place along each axis.
bool AreTogether(const Positions& positions, const Vector3& place_m, double distance_m) {
  const auto num_wrong = std::ranges::count_if(positions, [&](const Vector3& position_m) {
    return !((position_m - place_m).cwiseAbs().maxCoeff() < distance_m);
  });
  return static_cast<double>(num_wrong) <= kMostWrong * static_cast<double>(positions.size());
}

Vector3 MiddleOf(const Positions& positions) {
  Vector3 middle_m = Vector3::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> values_m;
    for (const Vector3& position_m : positions) values_m.push_back(position_m[axis]);
    middle_m[axis] = MedianOf(values_m);
  }
  return middle_m;
}

/// Whether the positions lie far from 0 as a whole: within 5 km, or in the numbers of a national
/// grid or of the whole earth within 100 km, as a line of railway. Of a room in millimetres they
/// are more than 5000 apart.
bool AreFarTogether(const Positions& positions) {
  constexpr double kLocal_m = 5e3;
  constexpr double kGrid_m = 1e5;
  constexpr double kEarth_m = 1e8;
  const Vector3 middle_m = MiddleOf(positions);
  const double far_m = middle_m.norm();
  if (!(far_m > kFarPosition_m && far_m < kEarth_m)) return false;
  return AreTogether(positions, middle_m, far_m > kGrid_m ? kGrid_m : kLocal_m);
}

std::vector<double> DifferentOf(std::vector<double> values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
  return values;
}

/// Whether an axis has the azimuths of a whole turn, from -180 or from 0 deg on: their widest gap
/// is no wider than a twelfth, and they end no farther than that from the ends of the turn.
/// @param values In order.
bool IsAzimuth(const std::vector<double>& values, double turn) {
  constexpr double kRounding = 1e-4;
  constexpr double kWidestGap = 1.0 / 12.0;
  const double begin = values.front() < 0.0 ? -0.5 * turn : 0.0;
  if (values.front() < begin - kRounding * turn) return false;
  if (values.back() > begin + (1.0 + kRounding) * turn) return false;
  double gap = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) gap = std::max(gap, values[i] - values[i - 1]);
  const double missing = turn - (values.back() - values.front());
  return gap <= kWidestGap * turn && missing <= (1.0 + kRounding) * gap + kRounding * turn;
}

/// Whether an axis has the elevations of rings, few values, each of several points.
/// @param values In order.
bool IsElevation(const std::vector<double>& values, std::size_t num_points, double turn) {
  constexpr std::size_t kMostRings = 256;
  constexpr std::size_t kLeastPoints = 4;  // In a ring, on average.
  return std::max(-values.front(), values.back()) <= 0.25 * turn && values.size() > 1 &&
         values.size() <= kMostRings && num_points >= kLeastPoints * values.size();
}

/// Whether one axis is never below 0 and another one as wide as most of a turn. (This is quick.)
bool MayBePolar(const Positions& positions) {
  Vector3 least = Vector3::Constant(std::numeric_limits<double>::infinity());
  Vector3 most = -least;
  for (const Vector3& position : positions) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  const auto is_turn = [](double width) {
    return (width > 300.0 && width < 361.0) || (width > 5.0 && width < 6.3);
  };
  return least.maxCoeff() >= 0.0 &&
         (is_turn(most.x() - least.x()) || is_turn(most.y() - least.y()) ||
          is_turn(most.z() - least.z()));
}

/// The names of the axes that hold a range, an azimuth and an elevation; empty if they are those of
/// a place.
std::string PolarAxes(const Positions& positions) {
  constexpr std::size_t kSurePoints = 100;
  if (positions.size() < kSurePoints || !MayBePolar(positions)) return {};
  std::array<std::vector<double>, 3> axes;
  for (const Vector3& position : positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes.at(axis).push_back(position[static_cast<Eigen::Index>(axis)]);
    }
  }
  for (std::vector<double>& axis : axes) axis = DifferentOf(std::move(axis));
  for (const double turn : {360.0, 2.0 * std::numbers::pi}) {
    std::array<std::size_t, 3> order = {0, 1, 2};
    do {
      const std::vector<double>& range = axes.at(order[0]);
      const std::vector<double>& azimuth = axes.at(order[1]);
      const std::vector<double>& elevation = axes.at(order[2]);
      if (range.front() < 0.0 || !IsAzimuth(azimuth, turn)) continue;
      if (!IsElevation(elevation, positions.size(), turn)) continue;
      if (elevation.size() >= std::min(range.size(), azimuth.size())) continue;
      const auto name = [](std::size_t axis) { return std::string(1, "xyz"[axis]); };
      return name(order[0]) + " is like a range, " + name(order[1]) + " like an azimuth and " +
             name(order[2]) + " like an elevation in " + (turn == 360.0 ? "degrees" : "radians");
    } while (std::ranges::next_permutation(order).found);
  }
  return {};
}

/// A spinning sensor whose channels the program holds.
struct KnownSensor {
  std::vector<double> elevations_deg;
  double range_max_m{};
};

const std::vector<KnownSensor>& KnownSensors() {
  static const std::vector<KnownSensor> sensors = [] {
    std::vector<KnownSensor> all;
    for (const SensorTableName& name : SensorTableNames()) {
      KnownSensor sensor;
      for (const ChannelSpec& channel : SensorTable(name.file).channels) {
        sensor.elevations_deg.push_back(channel.elevation_deg);
      }
      std::ranges::sort(sensor.elevations_deg);
      const auto file = nlohmann::json::parse(*SensorFileOf(name.product));
      sensor.range_max_m = file.value("range_max_m", LidarSpec{}.range_max_m);
      all.push_back(std::move(sensor));
    }
    return all;
  }();
  return sensors;
}

/// The mean elevations of the rows of a grid, of points that are not so near that it matters where
/// their beams leave, by height.
std::vector<double> ElevationsOfRows_deg(const Frame& frame) {
  constexpr double kNear_m = 3.0;
  std::vector<double> rows_deg;
  const std::size_t num_slots = std::size_t{frame.columns} * frame.returns;
  for (std::size_t row = 0; row < frame.rows; ++row) {
    double sum_rad = 0.0;
    std::size_t num = 0;
    for (std::size_t i = row * num_slots; i < (row + 1) * num_slots; ++i) {
      const Vector3 point_m = SpinPoint_m(frame, i);
      const double level_m = std::hypot(point_m.x(), point_m.y());
      if (!(level_m > kNear_m)) continue;
      sum_rad += std::atan2(point_m.z(), level_m);
      ++num;
    }
    if (num > 0) rows_deg.push_back(DegFromRad(sum_rad / static_cast<double>(num)));
  }
  std::ranges::sort(rows_deg);
  return rows_deg;
}

/// Whether the rows are channels of a sensor, and at least four in five of these.
bool IsOf(const KnownSensor& sensor, const std::vector<double>& rows_deg) {
  constexpr double kSure_deg = 0.1;
  constexpr double kFewest = 0.8;
  const auto& channels_deg = sensor.elevations_deg;
  if (rows_deg.size() > channels_deg.size() ||
      static_cast<double>(rows_deg.size()) < kFewest * static_cast<double>(channels_deg.size())) {
    return false;
  }
  double squares_deg2 = 0.0;
  for (const double row_deg : rows_deg) {
    double off_deg = std::numeric_limits<double>::infinity();
    for (const double channel_deg : channels_deg) {
      off_deg = std::min(off_deg, std::abs(row_deg - channel_deg));
    }
    squares_deg2 += off_deg * off_deg;
  }
  return squares_deg2 <= kSure_deg * kSure_deg * static_cast<double>(rows_deg.size());
}

/// Compares ranges with that of a sensor with such rings. Other makers' sensors with the same rings
/// have a range of their own, and some returns there; in another unit, many are.
void HoldAgainst(double range_max_m, const std::vector<double>& ranges_m, RecordedFrame& recorded) {
  constexpr double kMostFar = 0.1;
  const auto num_far =
      std::ranges::count_if(ranges_m, [&](double range_m) { return range_m > range_max_m; });
  const double share = static_cast<double>(num_far) / static_cast<double>(ranges_m.size());
  const std::string limit = ShortText(range_max_m) + " m, the range of a sensor with such rings";
  const std::string got = ShortText(100.0 * share) + " %";
  if (share > kMostFar) {
    throw InputError(recorded.name + ": range_m: at most 10 % of the returns may be beyond " +
                     limit + " (got " + got + ", the farthest " +
                     NumberText(std::round(std::ranges::max(ranges_m))) + " m): another unit?");
  }
  AddRemark({.kind = RemarkKind::kFarReturns,
             .place = recorded.name,
             .number = static_cast<std::uint64_t>(num_far),
             .detail = got + " beyond " + limit},
            recorded.remarks);
}

}  // namespace

std::vector<Remark> CheckPositions(const Cloud& cloud, const std::string& name) {
  const Positions positions = StoredPositions(cloud);
  std::vector<Remark> remarks;
  if (positions.empty()) return remarks;
  for (const char* axis : {"x", "y", "z"}) {
    const NumberType type = FindFieldOf(cloud, axis)->type;
    if (type == NumberType::kFloat || type == NumberType::kDouble) continue;
    throw InputError(name + ": " + axis +
                     ": must be floating point, for whole numbers do not state their unit (got " +
                     NumberText(8 * SizeOf(type)) + " bits)");
  }
  const std::string polar = PolarAxes(positions);
  if (!polar.empty()) throw InputError(name + ": x, y, z: must be places (got " + polar + ")");
  // No sensor has all of its returns so near, but a file of kilometres has, or one of a small
  // thing.
  constexpr double kNearest_m = 0.1;
  constexpr std::size_t kSurePoints = 100;
  if (positions.size() >= kSurePoints && AreTogether(positions, Vector3::Zero(), kNearest_m)) {
    remarks.push_back({.kind = RemarkKind::kUnitsAssumed,
                       .place = name,
                       .detail = "99 % of the points are less than 0.1 m from 0"});
  }
  const auto num_likely = std::ranges::count_if(positions, [](const Vector3& position) {
    return std::ranges::all_of(position, &IsLikelyPosition);
  });
  const double share = static_cast<double>(num_likely) / static_cast<double>(positions.size());
  if (share >= 1.0 - kMostWrong) {
    AddRemark({.kind = RemarkKind::kFarReturns,
               .place = name,
               .number = positions.size() - static_cast<std::size_t>(num_likely),
               .detail = "no coordinates in metres within 10 km"},
              remarks);
    return remarks;
  }
  if (AreFarTogether(positions)) return remarks;
  throw InputError(name +
                   ": x, y, z: 99 % of the points must be less than 10 km from 0, or all in one "
                   "place of a grid (got " +
                   ShortText(100.0 * share) + " %): other columns, another byte order or unit?");
}

void LeaveOutUnlikelyTimes(RecordedFrame& recorded) {
  constexpr std::uint32_t kShortestTurn_ns = 2'000'000;
  Frame& frame = recorded.frame;
  if (!recorded.Has("time_ns")) return;
  std::array<std::size_t, 4> num_in_quadrant{};
  std::size_t num = 0;
  auto first_ns = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last_ns = 0;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    ++num;
    ++num_in_quadrant.at((frame.x[i] < 0.0F ? 2U : 0U) + (frame.y[i] < 0.0F ? 1U : 0U));
    first_ns = std::min(first_ns, frame.time_ns[i]);
    last_ns = std::max(last_ns, frame.time_ns[i]);
  }
  constexpr std::size_t kSurePoints = 100;
  constexpr std::size_t kLeastShare = 20;
  const bool is_around = std::ranges::all_of(
      num_in_quadrant, [&](std::size_t part) { return kLeastShare * part >= num; });
  if (num < kSurePoints || !is_around || last_ns - first_ns >= kShortestTurn_ns) return;
  recorded.fields.erase("time_ns");
  std::ranges::fill(frame.time_ns, 0U);
  frame.duration_ns = 0;
  AddRemark({.kind = RemarkKind::kFieldsLeftOut,
             .place = recorded.name,
             .detail = "times of points, for no turn is as short as theirs, " +
                       ShortText(1e-6 * (last_ns - first_ns)) + " ms"},
            recorded.remarks);
}

std::string FaultOfIntensities(const Cloud& cloud) {
  const CloudField* const field = FindFieldOf(cloud, "intensity");
  if (field == nullptr) return {};
  constexpr double kMost = 1e7;
  constexpr double kLeast = 1e-20;
  std::size_t num_wrong = 0;
  VisitField(cloud, *field, [&](std::size_t, auto value) {
    const double size = std::abs(static_cast<double>(value));
    num_wrong += std::isfinite(size) && size != 0.0 && (size < kLeast || size > kMost) ? 1 : 0;
  });
  const double share = static_cast<double>(num_wrong) / static_cast<double>(cloud.num_points());
  if (num_wrong == 0 || share <= kMostWrong) return {};
  return field->name + ": 99 % must be 0 or from 1e-20 to 1e7 (got " +
         ShortText(100.0 * (1.0 - share)) + " %): another type or byte order?";
}

void RemarkOtherRanges(RecordedFrame& recorded) {
  constexpr float kMost_m = 1.0F;  // Beams leave nearer to the origin.
  if (!recorded.why_no_ranges.empty()) return;
  const Frame& frame = recorded.frame;
  Remark remark{.kind = RemarkKind::kRangesDiffer, .place = recorded.name, .number = 0};
  std::size_t num = 0;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    ++num;
    const float distance_m = std::hypot(frame.x[i], frame.y[i], frame.z[i]);
    if (std::abs(frame.range_m[i] - distance_m) <= kMost_m) continue;
    if (remark.number == 0) {
      remark.detail =
          ShortText(double{frame.range_m[i]}) + " m at " + ShortText(double{distance_m}) + " m";
    }
    ++remark.number;
  }
  if (static_cast<double>(remark.number) <= kMostWrong * static_cast<double>(num)) return;
  AddRemark(remark, recorded.remarks);
}

void NeedRanges(const RecordedFrame& recorded) {
  if (recorded.why_no_ranges.empty()) return;
  throw InputError(recorded.name +
                   ": must be in the axes of its sensor: " + recorded.why_no_ranges);
}

std::optional<Remark> CheckRanges(const RecordedFrame& recorded,
                                  const RecordingInfo& info,
                                  double range_max_m) {
  if (info.origin || !recorded.why_no_ranges.empty()) return std::nullopt;
  std::size_t num = 0;
  std::size_t num_far = 0;
  float farthest_m = 0.0F;
  for (const float range_m : recorded.frame.range_m) {
    if (!std::isfinite(range_m)) continue;
    ++num;
    if (double{range_m} <= range_max_m) continue;
    ++num_far;
    farthest_m = std::max(farthest_m, range_m);
  }
  if (num_far == 0) return std::nullopt;
  const double share = static_cast<double>(num_far) / static_cast<double>(num);
  const std::string got =
      ShortText(100.0 * share) + " %, the farthest " + NumberText(std::round(farthest_m)) + " m";
  if (share > kMostWrong && !recorded.beam_of) {
    throw InputError(recorded.name +
                     ": range_m: at most 1 % of the returns may be beyond the sensor's "
                     "range_max_m of " +
                     ShortText(range_max_m) + " (got " + got + "): another unit?");
  }
  return Remark{
      .kind = RemarkKind::kFarReturns, .place = recorded.name, .number = num_far, .detail = got};
}

void CheckUnit(RecordedFrame& recorded) {
  constexpr double kMostLikely_m = 300.0;
  constexpr double kLeastRange_m = 50.0;  // Least range of all known sensors.
  constexpr std::size_t kSurePoints = 100;
  if (!recorded.why_no_ranges.empty()) return;
  std::vector<double> ranges_m;
  for (const float range_m : recorded.frame.range_m) {
    if (std::isfinite(range_m)) ranges_m.push_back(double{range_m});
  }
  const double median_m = MedianOf(ranges_m);
  const bool is_near =
      std::ranges::none_of(ranges_m, [](double range_m) { return range_m > kLeastRange_m; });
  if (ranges_m.size() < kSurePoints || is_near || median_m > kFarPosition_m) return;
  const auto rows_deg =
      recorded.is_grid ? ElevationsOfRows_deg(recorded.frame) : std::vector<double>();
  double range_max_m = 0.0;
  for (const KnownSensor& sensor : KnownSensors()) {
    if (!rows_deg.empty() && IsOf(sensor, rows_deg)) {
      range_max_m = std::max(range_max_m, sensor.range_max_m);
    }
  }
  if (range_max_m > 0.0) {
    HoldAgainst(range_max_m, ranges_m, recorded);
  } else if (median_m > kMostLikely_m) {
    AddRemark({.kind = RemarkKind::kUnitsAssumed,
               .place = recorded.name,
               .detail = "half of its ranges are beyond " + ShortText(median_m) + " m"},
              recorded.remarks);
  }
}

}  // namespace railcast
