// The table of docs/packets.md says for each preset how its packets are sent and read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;
using testing::IsEmpty;

/// A row of the table.
struct SensorRow {
  std::string sensor;
  Names presets;
  Names protocols;
  std::string read;
};

// What a cell names as `code`, but for JSON.
Names CodeIn(const std::string& cell) {
  Names names;
  for (std::size_t at = cell.find('`'); at != std::string::npos;) {
    const std::size_t end = cell.find('`', at + 1);
    const std::string code = cell.substr(at + 1, end - at - 1);
    if (code.find('{') == std::string::npos) names.insert(code);
    at = cell.find('`', end + 1);
  }
  return names;
}

std::vector<SensorRow> RowsOfPage() {
  std::istringstream page(ReadFileWhole(RAILCAST_SOURCE_DIR "/docs/packets.md"));
  std::vector<SensorRow> rows;
  std::string line;
  while (std::getline(page, line) && !line.starts_with("| sensor | preset")) {
  }
  std::getline(page, line);  // The rule below the heading.
  while (std::getline(page, line) && line.starts_with("|")) {
    std::istringstream cells(line.substr(2));
    std::string sensor, preset, protocol, read;
    std::getline(cells, sensor, '|');
    std::getline(cells, preset, '|');
    std::getline(cells, protocol, '|');
    std::getline(cells, read, '|');
    const std::string word = sensor.substr(0, sensor.find_first_of(" ,"));
    rows.push_back({word, CodeIn(preset), CodeIn(protocol), read});
  }
  return rows;
}

// Whether the packets of a protocol can hold the preset's scan in some return mode.
bool CanSend(const std::string& protocol, const std::string& preset) {
  const fs::path file = fs::path(RAILCAST_SOURCE_DIR "/scenarios/sensors") / (preset + ".json");
  const auto json = nlohmann::json::parse(ReadFileWhole(file));
  if (json["scan"]["pattern"]["type"] == "raster" || protocol == "ouster") return false;
  const ScanSpec scan = ReadSensor(preset);
  const SpinningModel& model = *FindSpinningModel(protocol);
  return std::ranges::any_of(
      std::vector{ReturnMode::kStrongest, ReturnMode::kDual}, [&](ReturnMode mode) {
        return MessageOf([&] { (void)MakeSpinningEncoder(model, scan, mode); }) == "no error";
      });
}

TEST(SensorsPage, HasARowForEachPreset) {
  Names presets;
  for (const auto& entry : fs::directory_iterator(RAILCAST_SOURCE_DIR "/scenarios/sensors")) {
    if (entry.path().extension() == ".json") presets.insert(entry.path().stem());
  }
  Names named;
  for (const SensorRow& row : RowsOfPage()) {
    for (const std::string& preset : row.presets) {
      EXPECT_TRUE(named.insert(preset).second) << preset << " stands in two rows";
    }
  }
  EXPECT_EQ(named, presets);
}

TEST(SensorsPage, SaysAsWhichPacketsAPresetCanBeSent) {
  Names protocols;
  for (const std::string& name : railcast::NamesOf<Protocol>()) protocols.insert(name);
  // These send any scan.
  for (const char* name : {"railcast", "ros2"}) EXPECT_EQ(protocols.erase(name), 1U);
  Names named;
  for (const SensorRow& row : RowsOfPage()) {
    named.insert(row.protocols.begin(), row.protocols.end());
    for (const std::string& preset : row.presets) {
      Names sent;
      for (const std::string& protocol : protocols) {
        if (CanSend(protocol, preset)) sent.insert(protocol);
      }
      // Packets of HDL-64E hold any 64 channels.
      if (!row.protocols.contains("hdl64e")) sent.erase("hdl64e");
      for (const std::string& protocol : sent) {
        EXPECT_TRUE(row.protocols.contains(protocol)) << preset << " as " << protocol;
      }
      EXPECT_EQ(sent.empty(), row.protocols.empty()) << preset;
    }
  }
  EXPECT_EQ(named, protocols);
}

TEST(SensorsPage, SaysWhoseCapturesAreRead) {
  Names readable;
  std::string names = ReadableSensorsText();
  for (std::size_t at = names.find(" or "); at != std::string::npos; at = names.find(" or ")) {
    names.replace(at, 4, ", ");
  }
  std::istringstream list(names);
  for (std::string name; std::getline(list >> std::ws, name, ',');) {
    if (name.find(' ') == std::string::npos) readable.insert(name);
  }
  for (const SensorRow& row : RowsOfPage()) {
    const bool is_read = readable.erase(row.sensor) > 0;
    const bool needs_more = row.read.find("with its") != std::string::npos;
    EXPECT_EQ(row.read == " – ", !is_read && !needs_more) << row.sensor;
  }
  EXPECT_THAT(readable, IsEmpty());
}

}  // namespace
}  // namespace railcast
