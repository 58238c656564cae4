#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace railcast {

/// Metadata of a made-up Ouster sensor with four beams, in the layout of later firmware.
[[nodiscard]] inline nlohmann::ordered_json MadeOusterMetadata(
    const std::string& profile = "RNG19_RFL8_SIG16_NIR16", int first = 0, int last = 511) {
  return {{"sensor_info",
           {{"prod_line", "OS-1-4"},
            {"prod_sn", "122201000998"},
            {"initialization_id", 7109750},
            {"image_rev", "ousteros-image-prod-bootes-v3.1.0+20240425131508"},
            {"status", "RUNNING"}}},
          {"beam_intrinsics",
           {{"beam_altitude_angles", {12.5, 4.25, -3.75, -11.0}},
            {"beam_azimuth_angles", {3.5, -3.5, 1.25, -1.25}},
            {"lidar_origin_to_beam_origin_mm", 15.806}}},
          {"imu_intrinsics",
           {{"imu_to_sensor_transform",
             {1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1}}}},
          {"lidar_intrinsics",
           {{"lidar_to_sensor_transform", {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1}}}},
          {"config_params",
           {{"lidar_mode", "512x10"}, {"udp_dest", "169.254.29.215"}, {"udp_port_lidar", 7502}}},
          {"lidar_data_format",
           {{"columns_per_frame", 512},
            {"columns_per_packet", 16},
            {"pixels_per_column", 4},
            {"column_window", {first, last}},
            {"pixel_shift_by_row", {5, -5, 2, -2}},
            {"udp_profile_lidar", profile},
            {"udp_profile_imu", "LEGACY"}}},
          {"calibration_status", nlohmann::ordered_json::object()}};
}

[[nodiscard]] inline std::string MadeOusterMetadataText(
    const std::string& profile = "RNG19_RFL8_SIG16_NIR16", int first = 0, int last = 511) {
  return MadeOusterMetadata(profile, first, last).dump(2);
}

}  // namespace railcast
