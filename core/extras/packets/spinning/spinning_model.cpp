#include "core/extras/packets/spinning/spinning_model.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/io/sensor_tables.h"
#include "core/scan/at128.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {

NLOHMANN_JSON_SERIALIZE_ENUM(IntensityBytes,
                             {{IntensityBytes::kVelodyne, "velodyne"},
                              {IntensityBytes::kPercent, "percent"},
                              {IntensityBytes::kUnknown, "unknown"}})
// What is left out here, the program finds out. One name a line would be as long as the struct.
// clang-format off
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(
    SpinningModel, name, protocol, sensor, is_read, has_own_angles, sends, packet_size, header_size,
    version, lasers_place, blocks_place, unit_place, unit_mm, header_flags, header_rule,
    block_flags, has_fine_azimuth, lasers, blocks, return_size, loop_place, state_place, mark_place,
    mark_value, mark_rule, mode_place, speed_place, date_place, time_place, factory_place,
    sequence_place, safety_place, checked, single_modes, dual_modes, has_last_first, intensity,
    year_zero, counts_seconds, loop_ns, stated_loop_ns, states_first, turned_us, turns_azimuths,
    near_m, far_m, near_lasers)
// clang-format on

namespace {

/// From first to end.
using LaserRanges = std::vector<std::pair<int, int>>;

std::vector<std::uint8_t> LasersIn(const LaserRanges& ranges) {
  std::vector<std::uint8_t> lasers;
  for (const auto& [first, end] : ranges) {
    for (int laser = first; laser < end; ++laser) {
      lasers.push_back(static_cast<std::uint8_t>(laser));
    }
  }
  return lasers;
}

void ReadFirings(const nlohmann::json& entry, SpinningModel& model) {
  if (model.sensor.empty()) {
    model.cycle_us = kAt128Block_us;
    for (const std::uint16_t time_ns : kAt128Firing_ns) {
      model.channels.push_back({.time_us = 1e-3 * time_ns});
    }
  } else {
    SpinningSpec table = SensorTable(model.sensor);
    model.cycle_us = table.cycle_us;
    model.channels = std::move(table.channels);
  }
  for (ChannelSpec& channel : model.channels) {
    // The file's angles are those of one unit.
    if (model.has_own_angles) channel.elevation_deg = channel.azimuth_deg = 0.0;
  }
  for (const nlohmann::json& ranges : entry.value("loops", nlohmann::json::array())) {
    model.loops.push_back(LasersIn(ranges.get<LaserRanges>()));
  }
  if (model.loops.empty()) {
    model.loops.push_back(LasersIn({{0, static_cast<int>(model.channels.size())}}));
  }
  if (model.loop_ns == 0) {
    model.loop_ns = std::llround(1e3 * model.cycle_us);
  } else {
    model.cycle_us =
        1e-3 * static_cast<double>(model.loop_ns) * static_cast<double>(model.loops.size());
  }
}

/// An entry may name another before it, which it is like but for its own keys.
std::vector<SpinningModel> ReadModels() {
  nlohmann::json entries = nlohmann::json::parse(PacketTable(), nullptr, true, true);
  nlohmann::json known = SpinningModel();
  known.update({{"like", ""}, {"loops", {}}});
  std::vector<SpinningModel> models;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (const auto& [key, value] : entries[i].items()) {
      Check(known.contains(key), "packets.json has the members of SpinningModel");
    }
    const auto like = std::ranges::find(models, entries[i].value("like", ""), &SpinningModel::name);
    if (like != models.end()) {
      nlohmann::json whole = entries[static_cast<std::size_t>(like - models.begin())];
      whole.update(entries[i]);
      entries[i] = std::move(whole);
    }
    models.push_back(entries[i].get<SpinningModel>());
    ReadFirings(entries[i], models.back());
  }
  return models;
}

}  // namespace

bool SpinningModel::IsDual(std::uint8_t mode) const {
  return std::ranges::count(dual_modes, mode) > 0;
}

std::vector<PacketFiring> FiringsOf(const SpinningModel& model,
                                    const std::vector<ChannelSpec>& channels) {
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  std::vector<PacketFiring> firings;
  for (std::size_t loop = 0; loop < model.loops.size(); ++loop) {
    const double loop_us = 1e-3 * static_cast<double>(model.loop_ns) * static_cast<double>(loop);
    for (const std::uint8_t laser : model.loops[loop]) {
      const double time_us = channels[firings.size()].time_us;
      firings.push_back(
          {.loop = loop,
           .laser = laser,
           .row = rows[firings.size()],
           .turned_us = model.turns_azimuths ? 0.0 : model.turned_us + time_us - loop_us,
           .of_cycle_us = loop_us});
    }
  }
  return firings;
}

const std::vector<SpinningModel>& SpinningModels() {
  static const std::vector<SpinningModel> models = ReadModels();
  return models;
}

const SpinningModel* FindSpinningModel(std::string_view protocol) {
  const auto found = std::ranges::find(SpinningModels(), protocol, &SpinningModel::protocol);
  return found == SpinningModels().end() ? nullptr : &*found;
}

const SpinningModel& ModelNamed(std::string_view name) {
  return *std::ranges::find(SpinningModels(), name, &SpinningModel::name);
}

SpinningModel At128Model(const std::shared_ptr<const At128Correction>& correction) {
  SpinningModel model = ModelNamed(kAt128Name);
  model.channels = At128Channels(*correction);
  model.correction = correction;
  return model;
}

}  // namespace railcast
