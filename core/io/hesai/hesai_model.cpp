#include "core/io/hesai/hesai_model.h"

#include <numeric>

#include "core/io/sensor_tables.h"

namespace railcast {
namespace {

// Return modes. Dual ones name the first block of a pair, then the second.
constexpr std::uint8_t kFirst = 0x33;
constexpr std::uint8_t kSecond = 0x34;
constexpr std::uint8_t kStrongest = 0x37;
constexpr std::uint8_t kLast = 0x38;
constexpr std::uint8_t kLastAndStrongest = 0x39;
constexpr std::uint8_t kFirstAndSecond = 0x3A;
constexpr std::uint8_t kFirstAndLast = 0x3B;
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

}  // namespace

// Packets: Hesai, Pandar64 user manual, "point cloud data packet". Times: HesaiLidar_SDK,
// PandarGeneral; tier4/nebula, pandar_64.hpp. A packet is stamped with the time at which it ends,
// the last block ends 42.58 us before that, and the first laser fires 54.668 us before the end of
// its block.
const HesaiModel& Pandar64Model() {
  static const HesaiModel model{
      .name = "Pandar64",
      .layout = {.packet_size = 1198,
                 .version = std::nullopt,
                 .lasers_place = 2,
                 .blocks_place = 3,
                 .unit_place = 5,
                 .header_size = 8,
                 .lasers = 64,
                 .blocks = 6,
                 .return_size = 3,
                 .mode_place = 1186,
                 .speed_place = 1180,
                 .date_place = 1188,
                 .time_place = 1182},
      .single_modes = {kFirst, kStrongest, kLast},
      .dual_modes = {kLastAndStrongest, kFirstAndLast, kFirstAndStrongest},
      .channels = SensorTable("pandar64").channels,
      .loops = OneLoopOf(64),
      .loop_ns = 55'560,
      .last_loop_ns = -42'580 - 54'668,
      .turned_us = std::nullopt};
  return model;
}

// Packets: Hesai, PandarXT user manual, 3.1 and appendix II: a packet is stamped with the command
// to fire its last block. Times: tier4/nebula, pandar_xt32.hpp; HesaiLidar_SDK_2.0,
// PandarXT-32_Firetime Correction File.csv: the first laser fires 6 us after the command.
const HesaiModel& Xt32Model() {
  static const HesaiModel model{
      .name = "XT32",
      .layout = {.packet_size = 1080,
                 .version = {{6, 1}},
                 .lasers_place = 6,
                 .blocks_place = 7,
                 .unit_place = 9,
                 .header_size = 12,
                 .lasers = 32,
                 .blocks = 8,
                 .return_size = 4,
                 .mode_place = 1062,
                 .speed_place = 1063,
                 .date_place = 1065,
                 .time_place = 1071},
      .single_modes = {kFirst, kStrongest, kLast},
      .dual_modes = {kLastAndStrongest, kFirstAndLast, kFirstAndStrongest},
      .channels = SensorTable("xt32").channels,
      .loops = OneLoopOf(32),
      .loop_ns = 50'000,
      .last_loop_ns = 6'000,
      .turned_us = 6.0};
  return model;
}

// Packets: Hesai, QT128C2X user manual, 3.1 and appendix II. Times: tier4/nebula, pandar_qt128.hpp:
// a loop begins 9 us after the time stamp, and its first laser fires 0.6 us after that.
const HesaiModel& Qt128Model() {
  static const HesaiModel model{.name = "QT128",
                                .layout = {.packet_size = 1127,
                                           .version = {{3, 2}},
                                           .lasers_place = 6,
                                           .blocks_place = 7,
                                           .unit_place = 9,
                                           .header_size = 12,
                                           .lasers = 128,
                                           .blocks = 2,
                                           .return_size = 4,
                                           .loop_place = 1066,
                                           .mode_place = 1073,
                                           .speed_place = 1074,
                                           .date_place = 1076,
                                           .time_place = 1082},
                                .single_modes = {kFirst, kSecond, kStrongest, kLast},
                                .dual_modes = {kLastAndStrongest, kFirstAndSecond, kFirstAndLast,
                                               kFirstAndStrongest, kStrongestAndSecond},
                                .channels = SensorTable("qt128").channels,
                                .loops = LoopsOfQt128(),
                                .loop_ns = 111'111,
                                .last_loop_ns = 9'600,
                                .turned_us = 0.6};
  return model;
}

std::vector<const HesaiModel*> HesaiModels() {
  return {&Pandar64Model(), &Xt32Model(), &Qt128Model()};
}

}  // namespace railcast
