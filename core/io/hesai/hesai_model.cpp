#include "core/io/hesai/hesai_model.h"

#include <algorithm>
#include <numeric>

#include "core/io/sensor_tables.h"

namespace railcast {
namespace {

// The other return modes. Dual ones name the first block of a pair, then the second.
constexpr std::uint8_t kSecond = 0x34;
constexpr std::uint8_t kFirstAndSecond = 0x3A;
constexpr std::uint8_t kFirstAndStrongest = 0x3C;
constexpr std::uint8_t kStrongestAndSecond = 0x3E;

std::vector<std::vector<std::uint8_t>> OneLoopOf(std::size_t lasers) {
  std::vector<std::uint8_t> loop(lasers);
  std::iota(loop.begin(), loop.end(), std::uint8_t{0});
  return {loop};
}

/// Lasers 32 to 127, then 0 to 31 and 64 to 127: half of them fire in both loops.
std::vector<std::vector<std::uint8_t>> LoopsOfQt128() {
  std::vector<std::vector<std::uint8_t>> loops(2);
  for (std::uint8_t laser = 0; laser < 128; ++laser) {
    if (laser >= 32) loops[0].push_back(laser);
    if (laser < 32 || laser >= 64) loops[1].push_back(laser);
  }
  return loops;
}

/// The central lasers fire in both azimuth states, of the others groups of four in turn: lasers 4
/// to 7 in state 0, lasers 0 to 3 in state 1.
std::vector<std::vector<std::uint8_t>> LoopsOf128e4x() {
  std::vector<std::vector<std::uint8_t>> loops(2);
  for (std::uint8_t laser = 0; laser < 128; ++laser) {
    const bool is_central = laser >= 24 && laser < 88;
    if (is_central || laser / 4 % 2 == 1) loops[0].push_back(laser);
    if (is_central || laser / 4 % 2 == 0) loops[1].push_back(laser);
  }
  return loops;
}

// The modes of the sensors without second returns.
HesaiModel WithPlainModes(HesaiModel model) {
  model.single_modes = {kHesaiFirst, kHesaiStrongest, kHesaiLast};
  model.dual_modes = {kHesaiLastAndStrongest, kHesaiFirstAndLast, kFirstAndStrongest};
  return model;
}

// Packets: Hesai, Pandar64 user manual, "point cloud data packet". Times: HesaiLidar_SDK,
// PandarGeneral; tier4/nebula, pandar_64.hpp. A packet is stamped with the time at which it ends,
// the last block ends 42.58 us before that, and the first laser fires 54.668 us before the end of
// its block.
HesaiModel Pandar64() {
  return WithPlainModes({.name = "Pandar64",
                         .protocol = "pandar64",
                         .layout = {.packet_size = 1198,
                                    .header = {{.size = 8,
                                                .version = std::nullopt,
                                                .lasers_place = 2,
                                                .blocks_place = 3,
                                                .unit_place = 5}},
                                    .lasers = 64,
                                    .blocks = 6,
                                    .return_size = 3,
                                    .tail = {.mode_place = 1186,
                                             .speed_place = 1180,
                                             .date_place = 1188,
                                             .time_place = 1182,
                                             .factory_place = 1187,
                                             .sequence_place = 1194}},
                         .channels = SensorTable("pandar64").channels,
                         .loops = OneLoopOf(64),
                         .loop_ns = 55'560,
                         .stated_loop_ns = -42'580 - 54'668,
                         .turned_us = std::nullopt});
}

// Packets: Hesai, Pandar40P user manual; tier4/nebula, pandar_40.hpp, where the times come from,
// too. There is no header; distances are in 4 mm. Sequence numbers are optional.
HesaiModel Pandar40p(bool has_sequence) {
  return WithPlainModes(
      {.name = "Pandar40P",
       .protocol = "pandar40p",
       .layout = {.packet_size = has_sequence ? std::size_t{1266} : std::size_t{1262},
                  .header = std::nullopt,
                  .has_block_flags = true,
                  .lasers = 40,
                  .blocks = 10,
                  .return_size = 3,
                  .tail = {.mode_place = 1254,
                           .speed_place = 1248,
                           .date_place = 1256,
                           .time_place = 1250,
                           .factory_place = 1255,
                           .sequence_place =
                               has_sequence ? std::optional<std::size_t>(1262) : std::nullopt}},
       .channels = SensorTable("pandar40p").channels,
       .loops = OneLoopOf(40),
       .loop_ns = 55'560,
       .stated_loop_ns = -28'580 - 54'670,
       .turned_us = std::nullopt,
       .year_zero = 2000});
}

struct XtSensor {
  std::string_view name;
  std::string_view protocol;
  std::size_t lasers{};
  std::size_t blocks{};
  bool has_last_first{};
};

// Packets: Hesai, PandarXT user manual, 3.1 and appendix II: a packet is stamped with the command
// to fire its last block. Times: tier4/nebula, pandar_xt32.hpp, pandar_xt16.hpp and
// pandar_xt32m.hpp; HesaiLidar_SDK_2.0, PandarXT-32_Firetime Correction File.csv: the first laser
// fires 6 us after the command.
HesaiModel Xt(const XtSensor& sensor) {
  const std::size_t end = 12 + sensor.blocks * (2 + sensor.lasers * 4);
  return WithPlainModes({.name = sensor.name,
                         .protocol = sensor.protocol,
                         .layout = {.packet_size = end + 28,
                                    .header = {{.size = 12,
                                                .version = {{6, 1}},
                                                .lasers_place = 6,
                                                .blocks_place = 7,
                                                .unit_place = 9,
                                                .flags = 0x01}},
                                    .lasers = sensor.lasers,
                                    .blocks = sensor.blocks,
                                    .return_size = 4,
                                    .tail = {.mode_place = end + 10,
                                             .speed_place = end + 11,
                                             .date_place = end + 13,
                                             .time_place = end + 19,
                                             .factory_place = end + 23,
                                             .sequence_place = end + 24}},
                         .has_last_first = sensor.has_last_first,
                         .channels = SensorTable(sensor.protocol).channels,
                         .loops = OneLoopOf(sensor.lasers),
                         .loop_ns = 50'000,
                         .stated_loop_ns = 6'000,
                         .turned_us = 6.0});
}

// Packets and times: tier4/nebula, pandar_qt64.hpp; HesaiLidar_SDK_2.0, udp_protocol_v3_1.h. A
// packet is stamped 25.71 us before its first block, whose first laser fires after another 12.31
// us. Reflectivity: Hesai, PandarQT user manual, 3.1.2: the sensor "does not support" it yet.
HesaiModel Qt64() {
  return WithPlainModes({.name = "QT64",
                         .protocol = "qt64",
                         .layout = {.packet_size = 1072,
                                    .header = {{.size = 12,
                                                .version = {{3, 1}},
                                                .lasers_place = 6,
                                                .blocks_place = 7,
                                                .unit_place = 9,
                                                .flags = 0x01}},
                                    .lasers = 64,
                                    .blocks = 4,
                                    .return_size = 4,
                                    .tail = {.mode_place = 1060,
                                             .speed_place = 1054,
                                             .date_place = 1062,
                                             .time_place = 1056,
                                             .factory_place = 1061,
                                             .sequence_place = 1068}},
                         .channels = SensorTable("qt64").channels,
                         .loops = OneLoopOf(64),
                         .loop_ns = 166'667,
                         .stated_loop_ns = 25'710 + 12'310,
                         .states_first = true,
                         .turned_us = 12.31,
                         .has_reflectivity = false});
}

HesaiModel WithAllModes(HesaiModel model) {
  model.single_modes = {kHesaiFirst, kSecond, kHesaiStrongest, kHesaiLast};
  model.dual_modes = {kHesaiLastAndStrongest, kFirstAndSecond, kHesaiFirstAndLast,
                      kFirstAndStrongest, kStrongestAndSecond};
  return model;
}

// Packets: Hesai, QT128C2X user manual, 3.1 and appendix II. Times: tier4/nebula, pandar_qt128.hpp:
// a loop begins 9 us after the time stamp, and its first laser fires 0.6 us after that.
HesaiModel Qt128() {
  return WithAllModes({.name = "QT128",
                       .protocol = "qt128",
                       .layout = {.packet_size = 1127,
                                  .header = {{.size = 12,
                                              .version = {{3, 2}},
                                              .lasers_place = 6,
                                              .blocks_place = 7,
                                              .unit_place = 9,
                                              .flags = 0x1D}},
                                  .lasers = 128,
                                  .blocks = 2,
                                  .return_size = 4,
                                  .loop_place = 1066,
                                  .tail = {.mode_place = 1073,
                                           .speed_place = 1074,
                                           .date_place = 1076,
                                           .time_place = 1082,
                                           .factory_place = 1086,
                                           .sequence_place = 1087},
                                  .checked_size = 1095},
                       .channels = SensorTable("qt128").channels,
                       .loops = LoopsOfQt128(),
                       .loop_ns = 111'111,
                       .stated_loop_ns = 9'600,
                       .turned_us = 0.6});
}

/// The lasers that a recorded cloud has nearer than 1.4 m, and all that look up steeply.
std::vector<std::uint8_t> NearLasersOf128e4x() {
  std::vector<std::uint8_t> lasers = OneLoopOf(24).front();
  for (const int laser : {31,  38,  45,  52,  59,  66,  73,  79,  88,  92,  96,
                          100, 104, 108, 112, 116, 120, 122, 124, 125, 126, 127}) {
    lasers.push_back(static_cast<std::uint8_t>(laser));
  }
  return lasers;
}

// Packets: HesaiLidar_SDK_2.0, udp_protocol_v1_4.h; tier4/nebula, pandar_128e3x.hpp and
// pandar_128e4x.hpp, which has the states, the meaning of small distances, the order of returns,
// and the time: block 2 begins 43.346 us after the stamp.
HesaiModel Pandar128e4x(HesaiModel model, std::uint8_t state) {
  model.layout = {.packet_size = 861,
                  .header = {{.size = 12,
                              .version = {{1, 4}},
                              .lasers_place = 6,
                              .blocks_place = 7,
                              .unit_place = 9,
                              .flags = 0x07}},
                  .lasers = 128,
                  .blocks = 2,
                  .return_size = 3,
                  .state_place = 814,
                  .mark = {{.what = "operational state", .place = 816, .value = state}},
                  .tail = {.mode_place = 817,
                           .speed_place = 818,
                           .date_place = 820,
                           .time_place = 826,
                           .factory_place = 830,
                           .sequence_place = 831},
                  .checked_size = 861};
  model.has_last_first = true;
  model.near_limits = {.near_m = 0.3, .far_m = 1.4, .near_lasers = NearLasersOf128e4x()};
  return WithAllModes(std::move(model));
}

HesaiModel HighResolution128e4x() {
  return Pandar128e4x({.name = "Pandar128E4X",
                       .protocol = "pandar128e4x",
                       .channels = SensorTable("pandar128e4x").channels,
                       .loops = LoopsOf128e4x(),
                       .loop_ns = 27'778,
                       .stated_loop_ns = 43'346,
                       .turned_us = 0.0},
                      0);
}

// The azimuth states alternate here, too, but the lasers do not care.
HesaiModel Standard128e4x() {
  HesaiModel model = Pandar128e4x({.name = "Pandar128E4X in standard mode",
                                   .protocol = "pandar128e4x-standard",
                                   .channels = SensorTable("pandar128e4x_standard").channels,
                                   .loops = OneLoopOf(128),
                                   .loop_ns = 55'556,
                                   .stated_loop_ns = 43'346 + 2'378,
                                   .turned_us = 2.378},
                                  1);
  model.layout.state_place.reset();
  return model;
}

}  // namespace

bool HesaiModel::IsDual(std::uint8_t mode) const {
  return std::ranges::count(dual_modes, mode) > 0;
}

const std::vector<HesaiModel>& HesaiModels() {
  static const std::vector<HesaiModel> models = {
      Pandar64(),
      Xt({"XT32", "xt32", 32, 8, true}),
      Qt128(),
      HighResolution128e4x(),
      Standard128e4x(),
      Pandar40p(true),
      Pandar40p(false),
      Qt64(),
      Xt({"XT16", "xt16", 16, 8, true}),
      Xt({"XT32M", "xt32m", 32, 6, false}),
  };
  return models;
}

const HesaiModel* FindHesaiModel(std::string_view protocol) {
  const auto found = std::ranges::find(HesaiModels(), protocol, &HesaiModel::protocol);
  return found == HesaiModels().end() ? nullptr : &*found;
}

}  // namespace railcast
