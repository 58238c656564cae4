#include "viewer/overlays/overlays.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "viewer/color/palette.h"
#include "viewer/overlays/strokes.h"
#include "viewer/overlays/track_stretch.h"

namespace railcast {
namespace {

constexpr Rgb kTrackAxisRgb = kYellow;
constexpr double kTickStep_m = 10.0;
constexpr int kTicksPerWord = 5;
// Half the lengths of the ticks: inside the rails, and as wide as the sleepers.
constexpr double kTick_m = 0.5;
constexpr double kLongTick_m = 1.3;

std::string ChainageText(double s_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "km %.3f", s_m * 1e-3);
  return text.data();
}

}  // namespace

Overlay DrawTrackAxis(const Surroundings& surroundings, const RecordedFrame& recorded) {
  Overlay drawing;
  const std::optional<TrackStretch> stretch =
      StretchAbout(*surroundings.world, recorded, kAxisBehind_m, kAxisAhead_m);
  if (!stretch) return drawing;
  std::vector<Vector3> axis;
  for (const double s_m : stretch->LineChainages_m()) {
    axis.emplace_back(stretch->SensorFromTrack(s_m).translation());
  }
  AddPolyline(axis, kTrackAxisRgb, drawing);
  for (const double s_m : stretch->WholeChainages_m(kTickStep_m)) {
    const bool is_long = std::llround(s_m / kTickStep_m) % kTicksPerWord == 0;
    const Transform sensor_from_track = stretch->SensorFromTrack(s_m);
    const double half_m = is_long ? kLongTick_m : kTick_m;
    const Vector3 left = sensor_from_track * Vector3(0.0, half_m, 0.0);
    AddSegment(left, sensor_from_track * Vector3(0.0, -half_m, 0.0), kTrackAxisRgb, drawing);
    if (is_long) AddWord(left, ChainageText(s_m), kTrackAxisRgb, drawing);
  }
  return drawing;
}

}  // namespace railcast
