#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/io/recording/recorded_motion.h"
#include "railcast/scenario.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

constexpr Rgb kWhite{255, 255, 255};
// Large enough to be seen on a person, small enough not to look like a coupling on a wagon.
constexpr double kMostNose_m = 1.0;

// The bits of a corner: 1 = front, 2 = left, 4 = top.
Vector3 Corner(const RecordedObject& object, unsigned corner) {
  const Vector3 half_m = 0.5 * object.size_m;
  return object.sensor_from_box * Vector3((corner & 1U) != 0 ? half_m.x() : -half_m.x(),
                                          (corner & 2U) != 0 ? half_m.y() : -half_m.y(),
                                          (corner & 4U) != 0 ? half_m.z() : -half_m.z());
}

void AddEdges(const RecordedObject& object, Rgb rgb, Overlay& drawing) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((corner & axis) != 0) continue;
      AddSegment(Corner(object, corner), Corner(object, corner | axis), rgb, drawing);
    }
  }
}

void AddNose(const RecordedObject& object, Rgb rgb, Overlay& drawing) {
  const double front_m = 0.5 * object.size_m.x();
  const double nose_m = std::min(0.5 * object.size_m.y(), kMostNose_m);
  const Vector3 tip = object.sensor_from_box * Vector3(front_m + nose_m, 0.0, 0.0);
  for (const double side_m : {0.5 * object.size_m.y(), -0.5 * object.size_m.y()}) {
    AddSegment(object.sensor_from_box * Vector3(front_m, side_m, 0.0), tip, rgb, drawing);
  }
}

constexpr double kAxis_m = 2.0;
constexpr std::array<Rgb, 3> kAxisRgb = {kVermillion, kBluishGreen, kBlue};
constexpr std::array<const char*, 3> kAxisLetters = {"x", "y", "z"};

constexpr std::array<int, 7> kRings_m = {10, 25, 50, 100, 150, 200, 300};
constexpr Rgb kRingRgb{150, 150, 150};
constexpr double kChordError_m = 0.01;

// A chord over the angle a deviates from its circle by r (1 - cos(a / 2)).
int NumChords(double radius_m) {
  return static_cast<int>(std::ceil(std::numbers::pi / std::acos(1.0 - kChordError_m / radius_m)));
}

void AddRing(const Transform& sensor_from_plane, double radius_m, Overlay& drawing) {
  const int num_chords = NumChords(radius_m);
  std::vector<Vector3> circle;
  for (int i = 0; i <= num_chords; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * (i % num_chords) / num_chords;
    circle.emplace_back(sensor_from_plane * Vector3(radius_m * std::cos(angle_rad),
                                                    radius_m * std::sin(angle_rad), 0.0));
  }
  AddPolyline(circle, kRingRgb, drawing);
}

// The origin of the plane is below the sensor, at top of rail.
Transform SensorFromPlane(const std::optional<MountSpec>& mount) {
  if (!mount) return Transform::Identity();
  return VehicleFromSensor(*mount).inverse() *
         Eigen::Translation3d(mount->position_m[0], mount->position_m[1], 0.0);
}

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

Overlay DrawObjectBoxes(const RecordedFrame& recorded, const LabelTable& labels) {
  Overlay drawing;
  const RecordedMotion motion(recorded, Compensation::kAll);
  for (RecordedObject object : recorded.objects) {
    object.sensor_from_box = motion.BoxOf(object);
    if (object.sensor_from_box.translation().norm() > kMostBoxRange_m) continue;
    const Label* label = labels.Find(object.label);
    const Rgb rgb = label != nullptr ? label->rgb : kWhite;
    AddEdges(object, rgb, drawing);
    AddNose(object, rgb, drawing);
    AddWord(object.sensor_from_box * Vector3(0.0, 0.0, 0.5 * object.size_m.z()), object.name, rgb,
            drawing);
  }
  return drawing;
}

Overlay DrawAxes() {
  Overlay drawing;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const Vector3 end_m = kAxis_m * Vector3::Unit(axis);
    AddSegment(Vector3::Zero(), end_m, kAxisRgb[i], drawing);
    AddWord(end_m, kAxisLetters[i], kAxisRgb[i], drawing);
  }
  return drawing;
}

Overlay DrawRangeRings(double limit_m, const std::optional<MountSpec>& mount) {
  Overlay drawing;
  const Transform sensor_from_plane = SensorFromPlane(mount);
  for (const int radius_m : kRings_m) {
    if (radius_m > limit_m) break;
    AddRing(sensor_from_plane, radius_m, drawing);
    std::string text = std::to_string(radius_m);
    text += " m";
    for (const double x_m : {1.0 * radius_m, -1.0 * radius_m}) {
      AddWord(sensor_from_plane * Vector3(x_m, 0.0, 0.0), text, kRingRgb, drawing);
    }
  }
  return drawing;
}

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
