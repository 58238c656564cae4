#include "core/extras/packets/recording/capture_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/recording/plausibility.h"
#include "core/scan/spinning_pattern.h"
#include "core/scenario/json_rules.h"

namespace railcast {
namespace {

constexpr float kNoPoint = std::numeric_limits<float>::quiet_NaN();

/// The foreign field that has intensities of no known scale; empty if frames have intensities.
std::string_view UnknownField(IntensityBytes bytes) {
  if (bytes == IntensityBytes::kUnknownWide) return "intensity_16_bit";
  return bytes == IntensityBytes::kUnknown ? "intensity_byte" : "";
}

float IntensityOf(const TurnPoint& point, IntensityBytes bytes) {
  const auto value = static_cast<float>(point.intensity);
  if (!UnknownField(bytes).empty()) return value;
  // Bytes up to 100 are percent in either case.
  if (bytes == IntensityBytes::kVelodyne || point.intensity <= 100) {
    return IntensityOfByte(static_cast<std::uint8_t>(point.intensity));
  }
  return value / 100.0F;
}

void FillSlots(const SensorTurn& turn, const TurnShape& shape, Frame& frame) {
  std::size_t slot = 0;
  for (std::uint32_t row = 0; row < frame.rows; ++row) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      const std::int64_t time_ns = turn.column_time_ns[column] + shape.row_time_ns[row];
      for (std::uint32_t r = 0; r < frame.returns; ++r, ++slot) {
        frame.time_ns[slot] = static_cast<std::uint32_t>(time_ns);
        frame.ring[slot] = static_cast<std::uint16_t>(row);
        frame.column[slot] = column;
        frame.return_index[slot] = static_cast<std::uint8_t>(r);
      }
    }
  }
}

void FillPoints(const SensorTurn& turn, const TurnShape& shape, Frame& frame) {
  for (const TurnPoint& point : turn.points) {
    const std::size_t first =
        (std::size_t{point.ring} * frame.columns + point.column) * std::size_t{frame.returns};
    const std::size_t slot = first + point.return_index;
    frame.x[slot] = point.x;
    frame.y[slot] = point.y;
    frame.z[slot] = point.z;
    frame.range_m[slot] = point.range_m;
    frame.intensity[slot] = IntensityOf(point, shape.intensity);
    for (std::size_t r = 0; r < frame.returns; ++r) ++frame.return_count[first + r];
  }
}

std::vector<ForeignField> FieldsOf(const SensorTurn& turn, const Frame& frame) {
  std::vector<ForeignField> fields;
  for (const TurnField& field : turn.fields) {
    std::vector<float> values(frame.num_slots(), kNoPoint);
    for (std::size_t i = 0; i < turn.points.size(); ++i) {
      const TurnPoint& point = turn.points[i];
      const std::size_t firing = std::size_t{point.ring} * frame.columns + point.column;
      values[firing * frame.returns + point.return_index] = field.values[i];
    }
    fields.push_back({field.name, std::move(values)});
  }
  return fields;
}

bool AreTimesKnown(const SensorTurn& turn, const TurnShape& shape) {
  const auto [first, last] = std::ranges::minmax(turn.column_time_ns);
  const std::int64_t longest_ns = *std::ranges::max_element(shape.row_time_ns);
  return first >= 0 && last + longest_ns <= std::numeric_limits<std::uint32_t>::max();
}

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

CaptureSensor OusterSensor(const OusterMetadata& metadata) {
  return {.name = metadata.product_line.empty() ? "an Ouster sensor" : metadata.product_line,
          .packet_size = OusterPacketSize(metadata),
          .shape = ShapeOfTurns(ChannelsOf(metadata),
                                metadata.has_wide_reflectivity ? IntensityBytes::kUnknownWide
                                                               : IntensityBytes::kVelodyne,
                                BeamsOfOuster(metadata)),
          .decoder = OusterDecoder(metadata)};
}

/// Whether a datagram has the size of a lidar packet of one of Ouster's sensors with 16 columns,
/// and begins like one.
bool LooksLikeOuster(std::span<const char> payload) {
  constexpr std::size_t kColumns = 16;
  for (const std::size_t num_pixels : {16U, 32U, 64U, 128U}) {
    if (payload.size() == kColumns * (20 + 12 * num_pixels)) return true;
    for (const std::size_t pixel_size : {4U, 8U, 12U, 16U}) {
      if (payload.size() != 64 + kColumns * (12 + pixel_size * num_pixels)) continue;
      return payload[0] == 1;
    }
  }
  return false;
}

CaptureSensor SensorOf(const SpinningModel& model) {
  return {.name = model.name,
          .packet_size = model.packet_size,
          .shape = ShapeOfTurns(model.channels, model.intensity, BeamsOfSpinning(model)),
          .decoder = SpinningDecoder(model)};
}

/// A sensor of each kind that can be decoded, without any packet so far.
std::vector<CaptureSensor> ReadableSensors(
    const std::optional<OusterMetadata>& metadata = std::nullopt) {
  std::vector<CaptureSensor> sensors;
  for (const SpinningModel& model : SpinningModels()) {
    if (model.is_read) sensors.push_back(SensorOf(model));
  }
  if (metadata) sensors.push_back(OusterSensor(*metadata));
  return sensors;
}

// What Velodyne's packets look like.
constexpr std::size_t kVelodynePacketSize = 1206;
constexpr std::size_t kVelodyneBlockSize = 100;
constexpr std::uint16_t kLowerBlockFlag = 0xEEFF;  ///< Lasers 0 to 31.
constexpr std::uint16_t kUpperBlockFlag = 0xDDFF;  ///< Lasers 32 to 63.

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
  if (HasHeaderOf(ModelNamed(kAt128Name), payload)) {
    return "packets of an AT128, whose correction file must be beside the capture, with its name "
           "and .dat";
  }
  if (payload.size() >= kLeastHesaiHeader && LoadAt<std::uint16_t>(payload.data()) == kHesaiFlag) {
    return "packets of " + NumberText(payload.size()) + " bytes of a Hesai sensor";
  }
  if (LooksLikeOuster(payload)) {
    return "packets of " + NumberText(payload.size()) +
           " bytes of an Ouster sensor, whose metadata must stand beside the capture";
  }
  constexpr std::string_view kOurs = "RCST";
  if (payload.size() >= kOurs.size() && std::equal(kOurs.begin(), kOurs.end(), payload.begin())) {
    return "datagrams of protocol railcast, which railcast-analyze receive records";
  }
  if (payload.size() < kVelodynePacketSize ||
      LoadAt<std::uint16_t>(payload.data()) != kLowerBlockFlag) {
    return {};
  }
  if (IsPandar40P(payload)) return "damaged packets of Hesai's Pandar40P";
  const auto id = LoadAt<std::uint8_t>(payload.data() + kVelodynePacketSize - 1);
  for (const OtherModel& model : kOtherModels) {
    if (model.id == id) return std::string(model.name);
  }
  if (LoadAt<std::uint16_t>(payload.data() + kVelodyneBlockSize) == kUpperBlockFlag) {
    return "HDL-64E, whose packets lack its calibration";
  }
  return "Velodyne packets of model byte " + NumberText(id);
}

}  // namespace

std::optional<std::uint8_t> ByteOfIntensity(float intensity, IntensityBytes bytes) {
  if (!UnknownField(bytes).empty()) return std::nullopt;
  return bytes == IntensityBytes::kVelodyne ? ReflectivityByte(intensity) : PercentByte(intensity);
}

TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels,
                       IntensityBytes intensity,
                       BeamOfAims beam_of) {
  TurnShape shape{.row_time_ns = std::vector<std::int64_t>(channels.size()),
                  .intensity = intensity,
                  .beam_of = std::move(beam_of)};
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    shape.row_time_ns[rows[i]] = std::llround(channels[i].time_us * 1e3);
  }
  return shape;
}

RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                            const TurnShape& shape,
                            const std::string& name) {
  RecordedFrame recorded;
  recorded.name = name;
  recorded.is_grid = true;
  recorded.fields = {"x", "y", "z", "range_m", "ring", "column", "return_index", "return_count"};
  Frame& frame = recorded.frame;
  frame.Resize(static_cast<std::uint32_t>(shape.row_time_ns.size()),
               static_cast<std::uint32_t>(turn.num_columns()), turn.is_dual ? 2 : 1);
  ForEachField(frame, [](std::string_view, std::string_view, auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    if constexpr (std::is_same_v<Value, float>) std::ranges::fill(values, kNoPoint);
  });
  frame.stamp_ns = turn.stamp_ns;
  FillSlots(turn, shape, frame);
  FillPoints(turn, shape, frame);
  recorded.foreign = FieldsOf(turn, frame);
  if (const std::string_view field = UnknownField(shape.intensity); !field.empty()) {
    recorded.foreign.push_back({std::string(field), frame.intensity});
    std::ranges::fill(frame.intensity, kNoPoint);
  } else {
    recorded.fields.emplace("intensity");
  }
  recorded.beam_of = BeamsOfTurn(turn, shape.beam_of);
  if (AreTimesKnown(turn, shape)) {
    recorded.fields.emplace("time_ns");
    frame.duration_ns = *std::ranges::max_element(frame.time_ns);
  } else {
    std::ranges::fill(frame.time_ns, 0U);
  }
  LeaveOutUnlikelyTimes(recorded);
  return recorded;
}

std::string ReadableSensorsText() {
  std::vector<std::string> names;
  for (const CaptureSensor& sensor : ReadableSensors()) {
    if (names.empty() || names.back() != sensor.name) names.emplace_back(sensor.name);
  }
  names.emplace_back(kAt128Name);
  return Alternatives(names);
}

SensorFinder::SensorFinder(const CaptureMetadata& beside)
    : metadata_(beside.metadata),
      load_correction_(beside.load_correction),
      probes_(ReadableSensors(metadata_)) {}

std::optional<CaptureSensor> SensorFinder::Look(std::span<const char> payload) {
  if (num_datagrams_++ == 0) first_size_ = payload.size();
  if (load_correction_ && HasHeaderOf(ModelNamed(kAt128Name), payload)) {
    if (const auto correction = load_correction_()) return SensorOf(At128Model(correction));
  }
  for (const CaptureSensor& probe : probes_) {
    const std::span<const char> packet = FirstPacket(payload, probe.packet_size);
    const auto refusal =
        std::visit([&](const auto& decoder) { return decoder.Refuse(packet); }, probe.decoder);
    if (!refusal) return probe;
    const bool is_ouster = std::holds_alternative<OusterDecoder>(probe.decoder);
    if (!is_ouster || !LooksLikeOuster(payload) || !ouster_refusal_.empty()) continue;
    const bool has_size = payload.size() % probe.packet_size == 0;
    ouster_refusal_ =
        has_size ? *refusal
                 : "must be " + NumberText(probe.packet_size) + " bytes" + Got(payload.size());
  }
  has_seen_ouster_ = has_seen_ouster_ || LooksLikeOuster(payload);
  if (stranger_.empty()) stranger_ = NameOfStranger(payload);
  return std::nullopt;
}

std::string SensorFinder::Findings(const std::vector<Remark>& left_out) const {
  const auto torn = std::ranges::find(left_out, RemarkKind::kFragmentsMissing, &Remark::kind);
  const std::size_t num_torn = torn == left_out.end() ? 0 : torn->number;
  std::string found = "got " + stranger_;
  if (stranger_.empty()) {
    found = num_torn > 0 ? "got no whole UDP datagram" : "got no UDP datagram";
  }
  if (stranger_.empty() && num_datagrams_ > 0) {
    found = "got " + NumberText(num_datagrams_) + " UDP datagrams, the first of " +
            NumberText(first_size_) + " bytes";
  }
  if (num_torn > 0) found += ", and " + NumberText(num_torn) + " that lack IP fragments";
  for (const Remark& remark : left_out) {
    if (remark.kind != RemarkKind::kFragmentsMissing) found += ", and " + remark.Text();
  }
  return found;
}

}  // namespace railcast
