#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/scenario/ouster_metadata.h"

namespace railcast {
namespace {

/// What is known of a product line, or of a generation of it.
struct ProductLine {
  std::string_view prefix;
  bool is_first_generation_only{};
  double range_min_m{};
  double range_max_m{};
  double range_at_10_percent_m{};
  double divergence_deg{};  ///< Full width at half maximum.
  double range_noise_floor_m{};
};

// Least ranges and ranges at 10 % are those of the data sheets of OS0 and OS1, revision 6 (version
// 2.4, as NVIDIA's Isaac Sim quotes them), and of OS2's: where half of the pulses are detected at
// 100 klx, as our threshold means it. The greatest ranges are those of real captures, rounded up to
// 10 m: sensors also report what lies beyond the sheets' ranges at 80 %, 50, 120 and 240 m. The
// divergences of OS1 are in its sheet of 2019. The floors of the noise are the least second
// differences that captures show (docs/ouster.md); the sheets' are 15 mm and more.
constexpr std::array<ProductLine, 5> kProductLines = {
    {{"OS-0-", false, 0.3, 230.0, 20.0, 0.35, 0.005},
     {"OS-1-16", true, 0.3, 250.0, 55.0, 0.13, 0.002},
     {"OS-1-64", true, 0.3, 250.0, 55.0, 0.13, 0.002},
     {"OS-1-", false, 0.3, 250.0, 55.0, 0.18, 0.005},
     {"OS-2-", false, 1.0, 340.0, 100.0, 0.09, 0.015}}};

/// Whether beams leave as far from the axis as those of OS1's first generation.
bool IsOfFirstGeneration(const OusterMetadata& metadata) {
  return std::abs(metadata.beam_origin_m[0] - 0.012163) < 1e-5;
}

void UseProductLine(const ProductLine& line, LidarSpec& lidar) {
  lidar.range_min_m = line.range_min_m;
  lidar.range_max_m = line.range_max_m;
  lidar.receiver.range_at_10_percent_m = line.range_at_10_percent_m;
  lidar.plausibility.reference_range_m = line.range_at_10_percent_m;
  // A Gaussian is 1.699 = sqrt(2 / ln 2) times as wide between its 1/e^2 points as at half maximum.
  const double width_mrad = 1e3 * std::sqrt(2.0 / std::log(2.0)) * RadFromDeg(line.divergence_deg);
  lidar.beam.divergence_mrad = {width_mrad, width_mrad};
  lidar.receiver.range_noise_floor_m = line.range_noise_floor_m;
}

/// The firings of a window, in railcast's axes.
/// @throws InputError if the lidar does not stand upright in the sensor.
SpinningSpec FiringsOf(const OusterMetadata& metadata) {
  const Transform& lidar = metadata.sensor_from_lidar;
  constexpr double kRounding = 1e-3;
  const Vector3 shift_m = lidar.translation();
  if (lidar.linear()(2, 2) < 1.0 - kRounding || std::hypot(shift_m.x(), shift_m.y()) > 1e-6) {
    throw InputError(
        "lidar_to_sensor_transform: must turn about the z axis and shift along it for a scan");
  }
  const double columns = metadata.columns_per_frame;
  const double begin_deg = -DegFromRad(std::atan2(lidar.linear()(1, 0), lidar.linear()(0, 0)));
  SpinningSpec spinning{
      .channels = {},
      .cycle_us = 1e6 / (metadata.rate_hz * columns),
      .columns = metadata.num_window_columns(),
      .rotation = Rotation::kClockwise,
      .start_azimuth_deg =
          std::remainder(begin_deg + 360.0 * metadata.column_window[0] / columns, 360.0),
      .beam_origin_m = {{metadata.beam_origin_m[0], metadata.beam_origin_m[1] + shift_m.z()}}};
  for (const OusterBeam& beam : metadata.beams) {
    spinning.channels.push_back({beam.altitude_deg, beam.azimuth_deg, 0.0});
  }
  return spinning;
}

}  // namespace

void UseOusterMetadata(const std::string& text, LidarSpec& lidar) {
  const OusterMetadata metadata = ParseOusterMetadata(text);
  lidar.scan.pattern = FiringsOf(metadata);
  lidar.scan.rate_hz = metadata.rate_hz;
  if (lidar.name.empty()) {
    lidar.name = metadata.product_line.empty() ? "Ouster" : metadata.product_line;
  }
  if (IsDualProfile(metadata.profile)) lidar.receiver.return_mode = ReturnMode::kDual;
  const auto line = std::ranges::find_if(kProductLines, [&](const ProductLine& known) {
    return metadata.product_line.starts_with(known.prefix) &&
           (!known.is_first_generation_only || IsOfFirstGeneration(metadata));
  });
  if (line != kProductLines.end()) UseProductLine(*line, lidar);
}

}  // namespace railcast
