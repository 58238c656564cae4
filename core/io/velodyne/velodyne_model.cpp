#include "core/io/velodyne/velodyne_model.h"

#include <array>
#include <string>

#include "core/base/error.h"

namespace railcast {
namespace {

// Sources. Angles: ros-drivers/velodyne, params/VLP16db.yaml, 32db.yaml and VeloView-VLP-32C.yaml.
// Times: user manuals 63-9243, 63-9113 and 63-9325. Laser numbers are positions in the packet.

VelodyneModel Vlp16() {
  VelodyneModel model{.name = "VLP-16",
                      .id = 0x22,
                      .has_mode_and_id = true,
                      .has_own_angles = false,
                      .distance_unit_m = 0.002,
                      .cycle_us = 55.296,
                      .lasers = {}};
  for (int laser = 0; laser < 16; ++laser) {
    model.lasers.push_back({.elevation_deg = laser % 2 == 0 ? laser - 15.0 : laser,
                            .azimuth_deg = 0.0,
                            .time_us = 2.304 * laser});
  }
  return model;
}

VelodyneModel Hdl32e() {
  constexpr std::array<double, 32> kElevations_deg = {
      -30.67, -9.33,  -29.33, -8.0,   -28.0,  -6.67, -26.67, -5.33,  -25.33, -4.0,   -24.0,
      -2.67,  -22.67, -1.33,  -21.33, 0.0,    -20.0, 1.33,   -18.67, 2.67,   -17.33, 4.0,
      -16.0,  5.33,   -14.67, 6.67,   -13.33, 8.0,   -12.0,  9.33,   -10.67, 10.67};
  VelodyneModel model{.name = "HDL-32E",
                      .id = 0x21,
                      .has_mode_and_id = true,
                      .has_own_angles = false,
                      .distance_unit_m = 0.002,
                      .cycle_us = 46.08,
                      .lasers = {}};
  for (std::size_t laser = 0; laser < kElevations_deg.size(); ++laser) {
    model.lasers.push_back({.elevation_deg = kElevations_deg[laser],
                            .azimuth_deg = 0.0,
                            .time_us = 1.152 * static_cast<double>(laser)});
  }
  return model;
}

VelodyneModel Vlp32c() {
  constexpr std::array<double, 32> kElevations_deg = {
      -25.0,  -1.0,   -1.667, -15.639, -11.31, 0.0,    -0.667, -8.843, -7.254, 0.333,  -0.333,
      -6.148, -5.333, 1.333,  0.667,   -4.0,   -4.667, 1.667,  1.0,    -3.667, -3.333, 3.333,
      2.333,  -2.667, -3.0,   7.0,     4.667,  -2.333, -2.0,   15.0,   10.333, -1.333};
  constexpr std::array<double, 32> kAzimuths_deg = {
      1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
      1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4};
  VelodyneModel model{.name = "VLP-32C",
                      .id = 0x28,
                      .has_mode_and_id = true,
                      .has_own_angles = false,
                      .distance_unit_m = 0.004,
                      .cycle_us = 55.296,
                      .lasers = {}};
  for (std::size_t laser = 0; laser < kElevations_deg.size(); ++laser) {
    const std::size_t pair = laser / 2;
    model.lasers.push_back({.elevation_deg = kElevations_deg[laser],
                            .azimuth_deg = kAzimuths_deg[laser],
                            .time_us = 2.304 * static_cast<double>(pair)});
  }
  return model;
}

VelodyneModel Hdl64e() {
  // S2 model: the upper and the lower half fire at once, in groups of four.
  constexpr std::array<double, 4> kInGroup_us = {0.0, 1.26, 2.46, 3.66};
  VelodyneModel model{.name = "HDL-64E",
                      .id = 0,
                      .has_mode_and_id = false,
                      .has_own_angles = true,
                      .distance_unit_m = 0.002,
                      .cycle_us = 48.0,
                      .lasers = {}};
  for (std::size_t laser = 0; laser < 64; ++laser) {
    const std::size_t in_block = laser % kLasersPerBlock;
    const std::size_t group = in_block / 4;
    model.lasers.push_back(
        {.elevation_deg = 0.0,
         .azimuth_deg = 0.0,
         .time_us = 6.0 * static_cast<double>(group) + kInGroup_us[in_block % 4]});
  }
  return model;
}

}  // namespace

VelodyneFormat FindVelodyneFormat(std::string_view name) {
  static const VelodyneModel vlp16 = Vlp16();
  static const VelodyneModel hdl32e = Hdl32e();
  static const VelodyneModel vlp32c = Vlp32c();
  static const VelodyneModel hdl64e = Hdl64e();
  for (const VelodyneFormat& format :
       {VelodyneFormat{"vlp16", &vlp16, false}, VelodyneFormat{"vlp16-dual", &vlp16, true},
        VelodyneFormat{"hdl32e", &hdl32e, false}, VelodyneFormat{"vlp32c", &vlp32c, false},
        VelodyneFormat{"hdl64e", &hdl64e, false}}) {
    if (format.name == name) return format;
  }
  throw InputError("must be vlp16, vlp16-dual, hdl32e, vlp32c or hdl64e (got \"" +
                   std::string(name) + "\")");
}

}  // namespace railcast
