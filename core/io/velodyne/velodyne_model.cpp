#include "core/io/velodyne/velodyne_model.h"

#include <array>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/io/sensor_tables.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

/// A model with the channels and the cycle of its sensor's file.
VelodyneModel ModelOf(std::string_view sensor, VelodyneModel model) {
  SpinningSpec table = SensorTable(sensor);
  model.cycle_us = table.cycle_us;
  model.lasers = std::move(table.channels);
  return model;
}

VelodyneModel Vlp16() {
  return ModelOf("vlp16", {.name = "VLP-16", .id = 0x22, .distance_unit_m = 0.002});
}

VelodyneModel Hdl32e() {
  return ModelOf("hdl32e", {.name = "HDL-32E", .id = 0x21, .distance_unit_m = 0.002});
}

VelodyneModel Vlp32c() {
  return ModelOf("vlp32c", {.name = "VLP-32C", .id = 0x28, .distance_unit_m = 0.004});
}

VelodyneModel Hdl64e() {
  VelodyneModel model = ModelOf("hdl64e", {.name = "HDL-64E",
                                           .has_mode_and_id = false,
                                           .has_own_angles = true,
                                           .distance_unit_m = 0.002});
  // The file's angles are those of one unit.
  for (ChannelSpec& laser : model.lasers) laser.elevation_deg = laser.azimuth_deg = 0.0;
  return model;
}

VelodyneModel Vls128() {
  return ModelOf("vls128", {.name = "VLS-128", .id = 0xA1, .distance_unit_m = 0.004});
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
  static const std::array<VelodyneFormat, 5> formats = {{{"vlp16", &vlp16, false},
                                                         {"vlp16-dual", &vlp16, true},
                                                         {"hdl32e", &hdl32e, false},
                                                         {"vlp32c", &vlp32c, false},
                                                         {"hdl64e", &hdl64e, false}}};
  std::vector<std::string> names;
  for (const VelodyneFormat& format : formats) {
    if (format.name == name) return format;
    names.emplace_back(format.name);
  }
  throw InputError("must be " + Alternatives(names) + " (got \"" + std::string(name) + "\")");
}

std::vector<const VelodyneModel*> ModelsWithoutCalibration() {
  std::vector<const VelodyneModel*> models;
  for (const std::string_view name : {"vlp16", "hdl32e", "vlp32c"}) {
    models.push_back(FindVelodyneFormat(name).model);
  }
  models.push_back(&Vls128Model());
  return models;
}

}  // namespace railcast
