#include "core/io/recording/found_sensor.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/elevation_rings.h"
#include "core/io/recording/scan_table.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"

namespace railcast {
namespace {

constexpr double kWholeTurn_deg = 360.0;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double Rounded(double value, double unit) {
  return std::round(value / unit) * unit + 0.0;
}

/// A point of a turn in its grid.
struct CellPoint {
  std::size_t slot{};
  std::uint32_t row{}, column{};
};

std::vector<CellPoint> PointsOfGrid(const Frame& frame) {
  std::vector<CellPoint> points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const std::size_t cell = slot / frame.returns;
    points.push_back({slot, static_cast<std::uint32_t>(cell / frame.columns),
                      static_cast<std::uint32_t>(cell % frame.columns)});
  }
  return points;
}

std::array<double, 2> OriginOf(const Frame& frame, const std::vector<CellPoint>& points) {
  std::vector<LevelPoint> level;
  std::vector<std::uint32_t> rings;
  for (const CellPoint& point : points) {
    const Vector3 point_m = SpinPoint_m(frame, point.slot);
    level.push_back({std::hypot(point_m.x(), point_m.y()), point_m.z()});
    rings.push_back(point.row);
  }
  return OriginOfRings(level, rings);
}

/// The step between columns, signed as their azimuths are.
double StepOfColumns(const ScanTable& table) {
  double turned_rad = 0.0;
  double num_steps = 0.0;
  for (std::size_t i = 1; i < table.columns; ++i) {
    const double one_rad = table.column_azimuth_rad[i] - table.column_azimuth_rad[i - 1];
    const double num = std::round(std::abs(one_rad) / table.column_step_rad);
    constexpr double kMost = 4.0;
    if (!(num >= 1.0 && num <= kMost)) continue;
    turned_rad += one_rad;
    num_steps += num;
  }
  const double step_rad = turned_rad / num_steps;
  constexpr double kLeast_rad = 1e-5;
  if (!(std::abs(step_rad) >= kLeast_rad)) throw InputError("its columns have no common step");
  return step_rad;
}

/// Finds how far aside of the rotor's azimuth the beams of each row look, where they leave
/// `origin_m[0]` outwards of the axis: near points are seen at another azimuth than far ones.
std::vector<double> AsideOfRows(const Frame& frame,
                                const std::vector<CellPoint>& points,
                                const std::array<double, 2>& origin_m,
                                const ScanTable& table,
                                double step_rad) {
  // Columns that follow near points would hide what their lasers have in common: the rotor is even.
  std::complex<double> phases;
  for (const double column_rad : table.column_azimuth_rad) {
    if (std::isnan(column_rad)) continue;
    phases += std::polar(1.0, 2.0 * std::numbers::pi * column_rad / step_rad);
  }
  const double first_rad = std::arg(phases) / (2.0 * std::numbers::pi) * step_rad;
  const auto even_rad = [&](double column_rad) {
    return first_rad + std::round((column_rad - first_rad) / step_rad) * step_rad;
  };
  struct Line {
    double num{}, x{}, y{}, xx{}, xy{};
  };
  std::vector<Line> lines(table.rows);
  for (const CellPoint& point : points) {
    const Vector3 point_m = SpinPoint_m(frame, point.slot);
    const double azimuth_rad = std::atan2(point_m.y(), point_m.x());
    const double y =
        WrappedAngle_rad(azimuth_rad - even_rad(table.column_azimuth_rad[point.column]) -
                         table.row_azimuth_rad[point.row]);
    const double x = 1.0 / std::hypot(point_m.x(), point_m.y());
    Line& line = lines[point.row];
    line.num += 1.0;
    line.x += x;
    line.y += y;
    line.xx += x * x;
    line.xy += x * y;
  }
  std::vector<double> aside_rad;
  for (const Line& line : lines) {
    // A row that sees everything equally far away shows nothing: its slope becomes 0.
    constexpr double kLeastSpread_per_m = 0.001;
    const double num = std::max(line.num, 1.0);
    const double spread = line.xx / num - line.x * line.x / (num * num);
    const double slope_m = (line.xy / num - line.x * line.y / (num * num)) /
                           (spread + kLeastSpread_per_m * kLeastSpread_per_m);
    constexpr double kMostAside = 0.35;  // The sine of 20 deg.
    aside_rad.push_back(std::asin(std::clamp(-slope_m / origin_m[0], -kMostAside, kMostAside)));
  }
  return aside_rad;
}

/// How the times of a turn's points follow its azimuths.
struct TurnTimes {
  double left_rad_per_us{};     ///< Speed of the rotor; 0 = unknown.
  std::vector<double> late_us;  ///< For each row, from when its column fires.
};

TurnTimes TimesOfTurn(const RecordedFrame& recorded,
                      const std::vector<CellPoint>& points,
                      const ScanTable& table) {
  TurnTimes times{0.0, std::vector(table.rows, 0.0)};
  if (!recorded.Has("time_ns")) return times;
  std::vector<double> column_us(table.columns, kNoValue);
  const auto time_us = [&](const CellPoint& point) {
    return 1e-3 * recorded.frame.time_ns[point.slot];
  };
  constexpr int kPasses = 3;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<std::vector<double>> of_columns(table.columns), of_rows(table.rows);
    for (const CellPoint& point : points) {
      of_columns[point.column].push_back(time_us(point) - times.late_us[point.row]);
    }
    for (std::size_t i = 0; i < column_us.size(); ++i) column_us[i] = MedianOf(of_columns[i]);
    for (const CellPoint& point : points) {
      of_rows[point.row].push_back(time_us(point) - column_us[point.column]);
    }
    for (std::size_t i = 0; i < times.late_us.size(); ++i) {
      if (!of_rows[i].empty()) times.late_us[i] = MedianOf(of_rows[i]);
    }
  }
  // Over an eighth of the turn, so that rounded times matter little.
  const std::size_t way = std::max<std::size_t>(1, table.columns / 8);
  std::vector<double> speeds;
  for (std::size_t i = way; i < table.columns; ++i) {
    const double turned_rad = table.column_azimuth_rad[i] - table.column_azimuth_rad[i - way];
    const double speed = turned_rad / (column_us[i] - column_us[i - way]);
    if (std::isfinite(speed)) speeds.push_back(speed);
  }
  const double speed = MedianOf(speeds);
  if (std::isfinite(speed)) times.left_rad_per_us = speed;
  return times;
}

/// The most firings of any row, from its first point to its last: rows of a part of a turn begin
/// and end at other columns where they have azimuths of their own.
double FiringsOfFullestRow(const std::vector<CellPoint>& points,
                           const ScanTable& table,
                           double step_rad) {
  std::vector<double> first_rad(table.rows, kNoValue), last_rad(table.rows, kNoValue);
  for (const CellPoint& point : points) {
    const double turned_rad = table.column_azimuth_rad[point.column] * (step_rad < 0.0 ? -1 : 1);
    first_rad[point.row] = std::fmin(first_rad[point.row], turned_rad);
    last_rad[point.row] = std::fmax(last_rad[point.row], turned_rad);
  }
  double most = 0.0;
  for (std::size_t row = 0; row < table.rows; ++row) {
    most = std::fmax(most, std::round((last_rad[row] - first_rad[row]) / std::abs(step_rad)) + 1.0);
  }
  return most;
}

/// Measures how far points lie beside the beams of the table.
void MeasureErrors(const Frame& frame,
                   const std::vector<CellPoint>& points,
                   const ScanTable& table,
                   const std::vector<double>& aside_rad,
                   FoundSensor& found) {
  double elevations = 0.0;
  double azimuths = 0.0;
  const std::array<double, 2> origin_m = found.pattern.beam_origin_m.value_or(std::array{0.0, 0.0});
  double first_off_rad = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CellPoint& point = points[i];
    const double beam_rad = aside_rad.empty() ? 0.0 : aside_rad[point.row];
    const AimedPoint seen = SeenFromBeam(origin_m, beam_rad, frame, point.slot);
    const double up_rad = seen.elevation_rad - table.elevation_rad[point.row];
    const double off_rad =
        WrappedAngle_rad(seen.azimuth_rad - table.column_azimuth_rad[point.column] -
                         table.row_azimuth_rad[point.row]);
    elevations += up_rad * up_rad;
    azimuths += off_rad * off_rad;
    const bool is_first =
        i == 0 || points[i - 1].row != point.row || points[i - 1].column != point.column;
    if (is_first) first_off_rad = off_rad;
    constexpr double kSameBeam = 0.1;  // As a share of a step.
    if (std::abs(off_rad - first_off_rad) > kSameBeam * table.column_step_rad) ++found.num_lost;
  }
  found.num_points = points.size();
  const auto num = static_cast<double>(points.size());
  found.elevation_error_deg = DegFromRad(std::sqrt(elevations / num));
  found.azimuth_error_deg = DegFromRad(std::sqrt(azimuths / num));
}

void AddChannels(const ScanTable& table,
                 const TurnTimes& times,
                 const std::vector<std::size_t>& num_points,
                 double left,
                 FoundSensor& found) {
  SpinningSpec& pattern = found.pattern;
  double earliest_us = std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < table.rows; ++row) {
    if (num_points[row] == 0) continue;
    const double turned_rad = times.left_rad_per_us * times.late_us[row];
    const double azimuth_rad = left * WrappedAngle_rad(table.row_azimuth_rad[row] - turned_rad);
    pattern.channels.push_back({Rounded(DegFromRad(table.elevation_rad[row]), 1e-5),
                                Rounded(DegFromRad(azimuth_rad), 1e-5), times.late_us[row]});
    earliest_us = std::min(earliest_us, times.late_us[row]);
  }
  for (ChannelSpec& channel : pattern.channels) {
    const double cycles = (channel.time_us - earliest_us) / pattern.cycle_us;
    channel.time_us = Rounded((cycles - std::floor(cycles)) * pattern.cycle_us, 1e-3);
  }
}

void SetTurn(const ScanTable& table, double step_rad, double left, FoundSensor& found) {
  SpinningSpec& pattern = found.pattern;
  found.step_deg = DegFromRad(std::abs(step_rad));
  pattern.columns = static_cast<std::uint32_t>(std::llround(kWholeTurn_deg / found.step_deg));
  pattern.rotation = left > 0.0 ? Rotation::kCounterclockwise : Rotation::kClockwise;
  constexpr double kUnit_us = 1e-5;
  pattern.cycle_us = std::floor(1e6 / (found.rate_hz * pattern.columns) / kUnit_us) * kUnit_us;
  std::vector<double> known_rad = table.column_azimuth_rad;
  std::erase_if(known_rad, [](double azimuth_rad) { return std::isnan(azimuth_rad); });
  const double begin_deg = left * DegFromRad(known_rad.front());
  const double end_deg = left * DegFromRad(known_rad.back());
  const double first_deg = std::min(begin_deg, end_deg) - 0.5 * found.step_deg;
  const double last_deg = std::max(begin_deg, end_deg) + 0.5 * found.step_deg;
  const auto in_turn_deg = [](double deg) {
    return Rounded(deg - kWholeTurn_deg * std::floor(deg / kWholeTurn_deg), 1e-4);
  };
  pattern.start_azimuth_deg = in_turn_deg(begin_deg);
  if (!table.is_full_turn) {
    pattern.azimuth_window_deg = {in_turn_deg(first_deg), in_turn_deg(last_deg)};
  }
}

}  // namespace

std::string FoundSensor::Text() const {
  std::string text = NumberText(pattern.channels.size()) + " rings from " +
                     ShortText(pattern.channels.front().elevation_deg) + " to " +
                     ShortText(pattern.channels.back().elevation_deg) + " deg, step " +
                     ShortText(step_deg) + " deg, rms of elevations " +
                     ShortText(elevation_error_deg) + " deg, of azimuths " +
                     ShortText(azimuth_error_deg) + " deg, " +
                     ShortText(100.0 * share_without_return) + " % of firings without a return";
  if (pattern.beam_origin_m) {
    text += ", beams leave " + ShortText(1e3 * (*pattern.beam_origin_m)[0]) + " mm outwards and " +
            ShortText(1e3 * (*pattern.beam_origin_m)[1]) + " mm up";
  }
  if (num_lost > 0) text += ", " + NumberText(num_lost) + " points share a firing with another";
  return text + (has_times ? ", " + ShortText(rate_hz) + " turns per s"
                           : ", order of firing and rate not known");
}

std::string FoundSensor::AxisText() const {
  if (!sensor_from_spin) return "";
  const auto decimal = [&](int i) {
    return NumberText(std::round(1e3 * (*sensor_from_spin)(i, 2)) / 1e3 + 0.0);
  };
  return "[" + decimal(0) + ", " + decimal(1) + ", " + decimal(2) + "]";
}

std::string FoundSensor::FileText() const {
  LidarSpec lidar;
  lidar.name = "found";
  lidar.scan = {.rate_hz = rate_hz, .pattern = pattern};
  // Says what scenarios would refuse.
  (void)BuildScanPattern(lidar.scan);
  Json json = {{"version", 1}};
  json.update(JsonWriter::WriteShort(lidar));
  return json.dump(2) + '\n';
}

std::array<double, 2> NearOriginOf(const Frame& frame, const std::vector<CellPoint>& points) {
  constexpr double kFarthest_m = 1.0;
  const std::array<double, 2> origin_m = OriginOf(frame, points);
  if (!(std::max(std::abs(origin_m[0]), std::abs(origin_m[1])) <= kFarthest_m)) {
    throw InputError("its beams must leave within 1 m of its origin (got " +
                     ShortText(origin_m[0]) + " m outwards, " + ShortText(origin_m[1]) + " m up)");
  }
  return origin_m;
}

FoundSensor FindSensor(const RecordedFrame& recorded) {
  if (!recorded.is_grid) throw InputError(recorded.why_no_grid);
  const Frame& frame = recorded.frame;
  const std::vector<CellPoint> points = PointsOfGrid(frame);
  if (points.empty()) throw InputError("it has no points");
  FoundSensor found;
  found.sensor_from_spin = frame.sensor_from_spin;
  const std::array<double, 2> origin_m = NearOriginOf(frame, points);
  if (origin_m != std::array{0.0, 0.0}) found.pattern.beam_origin_m = origin_m;
  auto table = MakeScanTable(frame, origin_m);
  std::vector<double> aside_rad;
  constexpr int kPasses = 4;
  // Less than this does not show where beams look.
  constexpr double kLeastOutwards_m = 0.003;
  for (int pass = 0; table && origin_m[0] > kLeastOutwards_m && pass < kPasses; ++pass) {
    aside_rad = AsideOfRows(frame, points, origin_m, *table, StepOfColumns(*table));
    table = MakeScanTable(frame, origin_m, aside_rad);
  }
  if (!table) throw InputError("its points are too few, or its rings are not level");
  const TurnTimes times = TimesOfTurn(recorded, points, *table);
  found.has_times = times.left_rad_per_us != 0.0;
  if (found.has_times) {
    found.rate_hz = Rounded(1e6 * std::abs(times.left_rad_per_us) / (2.0 * std::numbers::pi), 1e-4);
    if (!(found.rate_hz >= 0.1 && found.rate_hz <= 1000.0)) {
      throw InputError("the times of its points must be those of 0.1 to 1000 turns per s" +
                       Got(found.rate_hz));
    }
  }
  const double step_rad = StepOfColumns(*table);
  const double left = (found.has_times ? times.left_rad_per_us : step_rad) < 0.0 ? -1.0 : 1.0;
  SetTurn(*table, step_rad, left, found);
  std::vector<std::size_t> num_points(table->rows);
  std::size_t num_firings_hit = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ++num_points[points[i].row];
    const bool is_first =
        i == 0 || points[i].slot / frame.returns != points[i - 1].slot / frame.returns;
    num_firings_hit += is_first ? 1 : 0;
  }
  MeasureErrors(frame, points, *table, aside_rad, found);
  found.beams = *table;
  // Azimuths of rows are those of columns but for whole steps.
  for (std::size_t row = 0; row < aside_rad.size(); ++row) {
    double& azimuth_rad = table->row_azimuth_rad[row];
    const double steps = (aside_rad[row] - azimuth_rad) / step_rad;
    if (!found.has_times) azimuth_rad += std::round(steps) * step_rad;
  }
  AddChannels(*table, times, num_points, left, found);
  const double num_firings =
      static_cast<double>(found.pattern.channels.size()) *
      (table->is_full_turn ? found.pattern.columns : FiringsOfFullestRow(points, *table, step_rad));
  found.share_without_return = 1.0 - static_cast<double>(num_firings_hit) / num_firings;
  // As a share of a step; points at random azimuths are off by 0.29.
  constexpr double kMostOff = 0.25;
  if (!(found.azimuth_error_deg <= kMostOff * found.step_deg)) {
    throw InputError("its points are off the beams of a spinning sensor by " +
                     ShortText(found.azimuth_error_deg) + " deg in azimuth, of steps of " +
                     ShortText(found.step_deg) + " deg");
  }
  return found;
}

void SensorSearch::Add(const RecordedFrame& recorded) {
  if (!goes_on()) return;
  SensorSearch one;
  one.num_frames_ = 1;
  try {
    one.found = FindSensor(recorded);
  } catch (const InputError& error) {
    one.why_not = error.what();
  }
  Add(std::move(one));
}

void SensorSearch::Add(SensorSearch other) {
  if (!goes_on()) return;
  const auto size_of = [](const FoundSensor& sensor) {
    return std::pair(sensor.pattern.channels.size(), sensor.num_points);
  };
  num_frames_ += other.num_frames_;
  if (!other.found) {
    why_not = std::move(other.why_not);
  } else if (!found || size_of(*other.found) > size_of(*found)) {
    found = std::move(other.found);
  }
}

FoundSensor FindSensor(Recording& recording) {
  SensorSearch search;
  while (search.goes_on()) {
    const auto read = recording.Next();
    if (!read) break;
    search.Add((*read)());
  }
  if (!search.found) throw InputError("no spinning sensor is found: " + search.why_not);
  return *std::move(search.found);
}

}  // namespace railcast
