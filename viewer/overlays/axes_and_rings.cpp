#include "viewer/overlays/overlays.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/strokes.h"

namespace railcast {
namespace {

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

}  // namespace

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

}  // namespace railcast
