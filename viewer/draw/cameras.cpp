#include "viewer/draw/cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kViewAngle_deg = 36.0;
constexpr double kDriverHeight_m = 2.2;  // Where most of our scenarios have their sensor.

CameraPlace AtOrigin(std::string_view name) {
  if (name == "driver") return {{-1.0, 0.0, 0.3}, {60.0, 0.0, -1.5}};
  if (name == "side") return {{45.0, -75.0, 18.0}, {45.0, 0.0, 0.0}};
  if (name == "top") return {{55.0, 0.0, 150.0}, {55.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  return {{-20.0, 0.0, 12.0}, {35.0, 0.0, -2.0}};
}

std::string TripleText(const std::array<double, 3>& values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ',';
    text += NumberText(std::round(1e3 * value) / 1e3);
  }
  return text;
}

/// Returns the place that presets take for the sensor's: the origin, or the middle of a cloud that
/// does not surround the origin.
std::array<double, 3> OriginOf(std::span<const float> positions_m) {
  std::array<double, 3> middle_m{};
  bool surrounds = true;
  for (std::size_t axis = 0; axis < 3 && !positions_m.empty(); ++axis) {
    float lowest = positions_m[axis];
    float highest = lowest;
    for (std::size_t i = axis; i < positions_m.size(); i += 3) {
      lowest = std::min(lowest, positions_m[i]);
      highest = std::max(highest, positions_m[i]);
    }
    middle_m[axis] = 0.5 * (static_cast<double>(lowest) + static_cast<double>(highest));
    const double size_m = static_cast<double>(highest) - static_cast<double>(lowest);
    if (std::abs(middle_m[axis]) > std::max(2.0 * size_m, 300.0)) surrounds = false;
  }
  return surrounds ? std::array<double, 3>{} : middle_m;
}

double QuantileOf(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

/// Places the camera so that it sees 95 of 100 points about the median position.
CameraPlace PlaceForAll(std::span<const float> positions_m) {
  std::array<double, 3> middle_m{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values_m;
    for (std::size_t i = axis; i < positions_m.size(); i += 3) {
      values_m.push_back(static_cast<double>(positions_m[i]));
    }
    middle_m[axis] = QuantileOf(std::move(values_m), 0.5);
  }
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < positions_m.size(); i += 3) {
    distances_m.push_back(std::hypot(static_cast<double>(positions_m[i]) - middle_m[0],
                                     static_cast<double>(positions_m[i + 1]) - middle_m[1],
                                     static_cast<double>(positions_m[i + 2]) - middle_m[2]));
  }
  const double radius_m = std::max(1.0, QuantileOf(std::move(distances_m), 0.95));
  const double away_m = radius_m / std::tan(0.5 * kViewAngle_deg * std::numbers::pi / 180.0);
  CameraPlace place{.target_m = middle_m};
  place.eye_m = {middle_m[0] - 0.8 * away_m, middle_m[1], middle_m[2] + 0.6 * away_m};
  return place;
}

// The share of the points that lies behind the place of the sensor.
double ShareBehind(std::span<const float> positions_m, const std::array<double, 3>& origin_m) {
  std::size_t num_behind = 0;
  for (std::size_t i = 0; i < positions_m.size(); i += 3) {
    if (static_cast<double>(positions_m[i]) < origin_m[0] - 1.0) ++num_behind;
  }
  return static_cast<double>(num_behind) /
         static_cast<double>(std::max<std::size_t>(positions_m.size() / 3, 1));
}

/// Looks down on the sensor from where 95 of 100 points around it are in view.
CameraPlace PlaceAbove(std::span<const float> positions_m, const std::array<double, 3>& origin_m) {
  std::vector<double> aside_m;
  for (std::size_t i = 0; i < positions_m.size(); i += 3) {
    aside_m.push_back(std::max(std::abs(static_cast<double>(positions_m[i]) - origin_m[0]),
                               std::abs(static_cast<double>(positions_m[i + 1]) - origin_m[1])));
  }
  const double radius_m = std::max(10.0, QuantileOf(std::move(aside_m), 0.95));
  CameraPlace place{.eye_m = origin_m, .target_m = origin_m, .up = {1.0, 0.0, 0.0}};
  place.eye_m[2] += radius_m / std::tan(0.5 * kViewAngle_deg * std::numbers::pi / 180.0);
  return place;
}

}  // namespace

CameraPlace UprightCamera(const std::array<double, 3>& eye_m,
                          const std::array<double, 3>& target_m) {
  CameraPlace place{.eye_m = eye_m, .target_m = target_m};
  const double level_m = std::hypot(target_m[0] - eye_m[0], target_m[1] - eye_m[1]);
  if (level_m < 1e-3 * std::abs(target_m[2] - eye_m[2])) place.up = {1.0, 0.0, 0.0};
  return place;
}

CameraPlace PresetCamera(std::string_view name,
                         std::span<const float> positions_m,
                         bool is_origin_on_rails) {
  if (name == "all" && !positions_m.empty()) return PlaceForAll(positions_m);
  const std::array<double, 3> origin_m = OriginOf(positions_m);
  constexpr double kSurroundsFrom = 0.1;
  if (name == "top" && ShareBehind(positions_m, origin_m) > kSurroundsFrom) {
    return PlaceAbove(positions_m, origin_m);
  }
  CameraPlace place = AtOrigin(name);
  if (name == "driver" && is_origin_on_rails) {
    place.eye_m[2] += kDriverHeight_m;
    place.target_m[2] += kDriverHeight_m;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.eye_m[axis] += origin_m[axis];
    place.target_m[axis] += origin_m[axis];
  }
  return place;
}

void PlaceCamera(const CameraPlace& place, vtkCamera& camera) {
  camera.SetPosition(place.eye_m.data());
  camera.SetFocalPoint(place.target_m.data());
  camera.SetViewUp(place.up.data());
  camera.SetViewAngle(kViewAngle_deg);
}

CameraPlace PlaceOf(vtkCamera& camera) {
  CameraPlace place;
  camera.GetPosition(place.eye_m.data());
  camera.GetFocalPoint(place.target_m.data());
  camera.GetViewUp(place.up.data());
  return place;
}

std::string CameraOptions(const CameraPlace& place) {
  std::string text = "--eye ";
  text += TripleText(place.eye_m);
  text += " --target ";
  text += TripleText(place.target_m);
  return text;
}

}  // namespace railcast
