#include <array>
#include <cmath>
#include <string_view>

#include "core/extras/packets/ouster/ouster_encoder.h"
#include "core/scenario/sensors.h"

namespace railcast {
namespace {

Json NumbersOf(const Transform& transform) {
  constexpr double kMillimetres = 1e3;
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      rows.push_back(transform.matrix()(row, column) * (row < 3 && column == 3 ? kMillimetres : 1));
    }
  }
  return rows;
}

/// By how many columns each row of the packets is turned against the rotor.
Json ShiftsOf(const OusterMetadata& metadata) {
  Json shifts = Json::array();
  for (std::uint32_t i = 0; i < metadata.pixels_per_column; ++i) shifts.push_back(0);
  for (const OusterBeam& beam : metadata.beams) {
    shifts[beam.pixel] = std::lround(beam.azimuth_deg / 360.0 * metadata.columns_per_frame);
  }
  return shifts;
}

void AddMissing(Json& section, std::string_view key, Json value) {
  const std::string name(key);
  if (!section.contains(name)) section[name] = std::move(value);
}

void CompleteDataFormat(const OusterMetadata& metadata, Json& format) {
  AddMissing(format, "columns_per_frame", metadata.columns_per_frame);
  AddMissing(format, "columns_per_packet", metadata.columns_per_packet);
  AddMissing(format, "pixels_per_column", metadata.pixels_per_column);
  AddMissing(format, "column_window", metadata.column_window);
  AddMissing(format, "pixel_shift_by_row", ShiftsOf(metadata));
  AddMissing(format, "udp_profile_lidar", NameOf(metadata.profile));
  AddMissing(format, "fps", metadata.rate_hz);
  format["udp_profile_imu"] = "LEGACY";
}

void CompleteConfig(const OusterMetadata& metadata,
                    const Endpoint& receiver,
                    const std::optional<std::string>& timestamp_mode,
                    Json& config) {
  const std::string host = AddressText(receiver.address);
  // The interface is one of this machine, not of the sensor.
  config["udp_dest"] = host.substr(0, host.find('%'));
  config["udp_port_lidar"] = receiver.port;
  config["udp_port_imu"] = kOusterImuPort;
  config["udp_profile_imu"] = "LEGACY";
  AddMissing(config, "udp_profile_lidar", NameOf(metadata.profile));
  AddMissing(config, "operating_mode", "NORMAL");
  AddMissing(config, "timestamp_mode", "TIME_FROM_INTERNAL_OSC");
  if (timestamp_mode) config["timestamp_mode"] = *timestamp_mode;
  // Firmware 1 has the older name of udp_dest.
  if (config.contains("udp_ip")) config["udp_ip"] = config["udp_dest"];
}

}  // namespace

Json MetadataOfStream(const std::string& text,
                      const Endpoint& receiver,
                      const std::optional<std::string>& timestamp_mode) {
  const OusterMetadata metadata = ParseOusterOfPackets(text);
  Json sections = SectionsOfOusterMetadata(text);
  for (const char* const name :
       {"sensor_info", "beam_intrinsics", "imu_intrinsics", "lidar_intrinsics", "config_params",
        "lidar_data_format", "calibration_status"}) {
    // Where firmware did not know a command, Ouster's programs noted the error message.
    if (!sections.contains(name) || !sections[name].is_object()) sections[name] = Json::object();
  }
  sections["sensor_info"]["status"] = "RUNNING";
  AddMissing(sections["sensor_info"], "prod_line", metadata.product_line);
  AddMissing(sections["beam_intrinsics"], "lidar_origin_to_beam_origin_mm",
             1e3 * metadata.beam_origin_m[0]);
  AddMissing(sections["imu_intrinsics"], "imu_to_sensor_transform",
             NumbersOf(metadata.sensor_from_imu));
  AddMissing(sections["lidar_intrinsics"], "lidar_to_sensor_transform",
             NumbersOf(metadata.sensor_from_lidar));
  CompleteDataFormat(metadata, sections["lidar_data_format"]);
  CompleteConfig(metadata, receiver, timestamp_mode, sections["config_params"]);
  sections.erase("imu_data_format");
  return sections;
}

}  // namespace railcast
