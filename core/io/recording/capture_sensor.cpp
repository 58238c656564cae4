#include "core/io/recording/capture_sensor.h"

#include <algorithm>
#include <array>

#include "core/base/text.h"
#include "core/io/hesai/hesai_model.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

struct OtherModel {
  std::uint8_t id{};
  std::string_view name;
};
constexpr std::array<OtherModel, 4> kOtherModels = {
    {{0x23, "VLP-32A or VLP-32B"},
     {0x24, "Puck Hi-Res"},
     {0x31, "Velarray"},
     {0xA1, "VLS-128, of which only single returns are read"}}};

/// Returns the first packet of that size from a payload that may hold several.
std::span<const char> FirstPacket(std::span<const char> payload, std::size_t size) {
  return payload.first(std::min(payload.size(), size));
}

/// A sensor of each kind that can be decoded, without any packet so far.
std::vector<CaptureSensor> ReadableSensors() {
  std::vector<CaptureSensor> sensors;
  for (const VelodyneModel* model : ModelsWithoutCalibration()) {
    sensors.push_back({.name = model->name,
                       .packet_size = kVelodynePacketSize,
                       .shape = ShapeOfTurns(model->lasers, IntensityBytes::kVelodyne),
                       .decoder = VelodyneDecoder(*model)});
  }
  for (const HesaiModel* model : HesaiModels()) {
    sensors.push_back({.name = model->name,
                       .packet_size = model->layout.packet_size,
                       .shape = ShapeOfTurns(model->channels, IntensityBytes::kPercent),
                       .decoder = HesaiDecoder(*model)});
  }
  return sensors;
}

/// Whether this begins with a packet of Hesai's Pandar40P: 10 blocks of 124 bytes, each with the
/// flag of Velodyne's blocks, and a tail of 22 bytes (Hesai, Pandar40P user manual, "point cloud
/// data packet").
bool IsPandar40P(std::span<const char> payload) {
  constexpr std::size_t kBlocks = 10;
  constexpr std::size_t kBlockBytes = 124;
  constexpr std::size_t kTailBytes = 22;
  if (payload.size() < kBlocks * kBlockBytes + kTailBytes) return false;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    if (LoadAt<std::uint16_t>(payload.data() + i * kBlockBytes) != kLowerBlockFlag) return false;
  }
  return true;
}

/// Describes packets of a sensor that is recognised but cannot be decoded; empty if the payload is
/// not one of those.
std::string NameOfStranger(std::span<const char> payload) {
  constexpr std::size_t kLeastHesaiHeader = 8;
  if (payload.size() >= kLeastHesaiHeader && LoadAt<std::uint16_t>(payload.data()) == kHesaiFlag) {
    return "packets of " + NumberText(payload.size()) + " bytes of a Hesai sensor";
  }
  constexpr std::string_view kOurs = "RCST";
  if (payload.size() >= kOurs.size() && std::equal(kOurs.begin(), kOurs.end(), payload.begin())) {
    return "datagrams of protocol railcast, which railcast-analyze receive records";
  }
  if (payload.size() < kVelodynePacketSize ||
      LoadAt<std::uint16_t>(payload.data()) != kLowerBlockFlag) {
    return {};
  }
  if (IsPandar40P(payload)) return "packets of Hesai's Pandar40P, which are not read";
  const auto id = LoadAt<std::uint8_t>(payload.data() + kModelPlace);
  for (const OtherModel& model : kOtherModels) {
    if (model.id == id) return std::string(model.name);
  }
  if (LoadAt<std::uint16_t>(payload.data() + kBlockSize) == kUpperBlockFlag) {
    return "HDL-64E, whose packets lack its calibration";
  }
  return "Velodyne packets of model byte " + NumberText(id);
}

}  // namespace

std::string ReadableSensorsText() {
  std::vector<std::string> names;
  for (const CaptureSensor& sensor : ReadableSensors()) names.emplace_back(sensor.name);
  return Alternatives(names);
}

SensorFinder::SensorFinder() : probes_(ReadableSensors()) {}

std::optional<CaptureSensor> SensorFinder::Look(std::span<const char> payload) {
  if (num_datagrams_++ == 0) first_size_ = payload.size();
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    const std::span<const char> packet = FirstPacket(payload, probes_[i].packet_size);
    std::vector<SensorTurn> turns;
    const auto decode = [&](auto& decoder) { return decoder.Decode(packet, turns); };
    // The probe has used the packet, which the caller will decode.
    if (!std::visit(decode, probes_[i].decoder)) return ReadableSensors()[i];
  }
  if (stranger_.empty()) stranger_ = NameOfStranger(payload);
  return std::nullopt;
}

std::string SensorFinder::Findings(std::size_t num_torn) const {
  std::string found = "got " + stranger_;
  if (stranger_.empty()) {
    found = num_torn > 0 ? "got no whole UDP datagram" : "got no UDP datagram";
  }
  if (stranger_.empty() && num_datagrams_ > 0) {
    found = "got " + NumberText(num_datagrams_) + " UDP datagrams, the first of " +
            NumberText(first_size_) + " bytes";
  }
  if (num_torn == 0) return found;
  return found + ", and " + NumberText(num_torn) + " that lack IP fragments";
}

}  // namespace railcast
