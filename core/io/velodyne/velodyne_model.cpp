#include "core/io/velodyne/velodyne_model.h"

#include <array>
#include <string>

#include "core/base/error.h"

namespace railcast {
namespace {

// Sources. Angles: ros-drivers/velodyne, params/VLP16db.yaml, 32db.yaml, VeloView-VLP-32C.yaml and
// VLS128.yaml. Times: user manuals 63-9243, 63-9113, 63-9325 and that of VLS-128. Laser numbers are
// positions in the packet.

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

VelodyneModel Vls128() {
  constexpr std::array<double, 128> kElevations_deg = {
      -11.742, -1.99,   3.4,   -5.29,   -0.78, 4.61,  -4.08,   1.31,   -6.5,  -1.11,   4.28,  -4.41,
      0.1,     6.48,    -3.2,  2.19,    -3.86, 1.53,  -9.244,  -1.77,  2.74,  -5.95,   -0.56, 4.83,
      -2.98,   2.41,    -6.28, -0.89,   3.62,  -5.07, 0.32,    7.58,   -0.34, 5.18,    -3.64, 1.75,
      -25.0,   -2.43,   2.96,  -5.73,   0.54,  9.7,   -2.76,   2.63,   -7.65, -1.55,   3.84,  -4.85,
      3.18,    -5.51,   -0.12, 5.73,    -4.3,  1.09,  -16.042, -2.21,  4.06,  -4.63,   0.76,  15.0,
      -3.42,   1.97,    -6.85, -1.33,   -5.62, -0.23, 5.43,    -3.53,  0.98,  -19.582, -2.32, 3.07,
      -4.74,   0.65,    11.75, -2.65,   1.86,  -7.15, -1.44,   3.95,   -2.1,  3.29,    -5.4,  -0.01,
      4.5,     -4.19,   1.2,   -13.565, -1.22, 4.17,  -4.52,   0.87,   6.08,  -3.31,   2.08,  -6.65,
      1.42,    -10.346, -1.88, 3.51,    -6.06, -0.67, 4.72,    -3.97,  2.3,   -6.39,   -1.0,  4.39,
      -5.18,   0.21,    6.98,  -3.09,   4.98,  -3.75, 1.64,    -8.352, -2.54, 2.85,    -5.84, -0.45,
      8.43,    -2.87,   2.52,  -6.17,   -1.66, 3.73,  -4.96,   0.43};
  constexpr std::array<double, 8> kAzimuths_deg = {6.354,  4.548,  2.732,  0.911,
                                                   -0.911, -2.732, -4.548, -6.354};
  VelodyneModel model{.name = "VLS-128",
                      .id = 0xA1,
                      .has_mode_and_id = true,
                      .has_own_angles = false,
                      .distance_unit_m = 0.004,
                      .cycle_us = 55.277,
                      .lasers = {}};
  // Groups of eight fire together; one slot of maintenance follows the eighth group and three
  // follow the sixteenth. The manual's cycle is 53.3 us; a real sensor's packets, of three cycles
  // each, are 165.83 us apart.
  for (std::size_t laser = 0; laser < kElevations_deg.size(); ++laser) {
    model.lasers.push_back({.elevation_deg = kElevations_deg[laser],
                            .azimuth_deg = kAzimuths_deg[laser % kAzimuths_deg.size()],
                            .time_us = 2.665 * static_cast<double>(laser / 8 + laser / 64)});
  }
  return model;
}

}  // namespace

const VelodyneModel& Vls128Model() {
  static const VelodyneModel model = Vls128();
  return model;
}

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
