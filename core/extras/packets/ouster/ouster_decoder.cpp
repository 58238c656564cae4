#include "core/extras/packets/ouster/ouster_decoder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
/// Later times, some 146 years, are no times of a sensor; sums and differences of others fit.
constexpr std::uint64_t kMostTime_ns = std::uint64_t{1} << 62U;

std::optional<std::string> RefuseNumber(const char* name, std::uint64_t got, std::uint64_t wanted) {
  if (got == wanted) return std::nullopt;
  return std::string(name) + " must be " + NumberText(wanted) + Got(got);
}

}  // namespace

std::vector<ChannelSpec> ChannelsOf(const OusterMetadata& metadata) {
  std::vector<ChannelSpec> channels;
  for (const OusterBeam& beam : metadata.beams) {
    channels.push_back({beam.altitude_deg, beam.azimuth_deg, 0.0});
  }
  return channels;
}

OusterDecoder::OusterDecoder(const OusterMetadata& metadata)
    : metadata_(metadata), layout_(metadata), is_seen_(metadata.columns_per_frame) {
  const std::vector<std::uint16_t> rows = RowsByElevation(ChannelsOf(metadata));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const OusterBeam& beam = metadata.beams[i];
    const double altitude_rad = RadFromDeg(beam.altitude_deg);
    beams_.push_back({beam.pixel, rows[i], std::sin(altitude_rad), std::cos(altitude_rad),
                      RadFromDeg(beam.azimuth_deg)});
  }
  const auto [first, last] = metadata.column_window;
  const auto is_measured = [first = first, last = last](std::uint32_t column) {
    return first <= last ? column >= first && column <= last : column >= first || column <= last;
  };
  std::int64_t num_packets = 0;
  for (std::uint32_t column = 0; column < metadata.columns_per_frame; ++column) {
    packets_before_.push_back(num_packets);
    if ((column + 1) % metadata.columns_per_packet != 0) continue;
    bool has_measured = false;
    for (std::uint32_t i = 0; i < metadata.columns_per_packet; ++i) {
      has_measured = has_measured || is_measured(column - i);
    }
    num_packets += has_measured ? 1 : 0;
  }
  packets_before_.push_back(num_packets);
}

PacketMark OusterDecoder::MarkOf(std::span<const char> payload) const {
  // Columns that were not measured need not state their place.
  const OusterColumn begin = layout_.ColumnOf(payload, 0);
  std::uint32_t column = begin.measurement_id;
  std::uint64_t time_ns = 0;
  bool is_measured = false;
  bool has_places = column < metadata_.columns_per_frame;
  for (std::uint32_t i = 0; i < layout_.num_columns() && !is_measured; ++i) {
    const OusterColumn stated = layout_.ColumnOf(payload, i);
    is_measured = stated.is_valid;
    has_places = has_places && stated.measurement_id == begin.measurement_id + i;
    if (!is_measured) continue;
    column = stated.measurement_id - std::min<std::uint32_t>(i, stated.measurement_id);
    time_ns = stated.time_ns;
  }
  if (!is_measured && !has_places) return {.has_number = false, .is_counted = true};
  const std::int64_t in_turn = packets_before_.back();
  const std::int64_t turn = layout_.HeaderOf(payload).frame_id;
  return {.number = turn * in_turn + packets_before_[column],
          .is_counted = true,
          .period = (std::int64_t{layout_.last_frame_id()} + 1) * in_turn,
          .time_ns = static_cast<std::int64_t>(time_ns)};
}

std::optional<std::string> OusterDecoder::Refuse(std::span<const char> payload) const {
  if (payload.size() != layout_.packet_size()) {
    return "must be " + NumberText(layout_.packet_size()) + " bytes" + Got(payload.size());
  }
  if (auto refusal = RefuseColumns(payload)) return refusal;
  if (layout_.is_legacy()) return std::nullopt;
  const OusterHeader header = layout_.HeaderOf(payload);
  if (auto refusal = RefuseNumber("packet type", header.packet_type, 1)) return refusal;
  if (metadata_.serial_number) {
    auto refusal = RefuseNumber("serial number", header.serial_number, *metadata_.serial_number);
    if (refusal) return refusal;
  }
  if (metadata_.initialization_id) {
    auto refusal =
        RefuseNumber("initialization id", header.initialization_id, *metadata_.initialization_id);
    if (refusal) return refusal;
  }
  if (layout_.may_have_checksum() && !HasRightChecksum(payload)) {
    return std::string(kWrongChecksum);
  }
  return std::nullopt;
}

std::optional<std::string> OusterDecoder::RefuseColumns(std::span<const char> payload) const {
  for (std::size_t i = 0; i < layout_.num_columns(); ++i) {
    const OusterColumn column = layout_.ColumnOf(payload, i);
    if (!column.is_valid) continue;
    if (column.measurement_id >= metadata_.columns_per_frame) {
      return "column " + NumberText(i) + ": measurement id must be < " +
             NumberText(metadata_.columns_per_frame) + Got(column.measurement_id);
    }
    // Where a few counts are a small part, but in the first packet of a turn.
    constexpr std::uint16_t kFirstClear = 8;
    if (layout_.is_legacy() && column.measurement_id >= kFirstClear) {
      // Whether it is from another mode of the sensor, which has twice or half as many columns, or
      // four times.
      const double ticks = layout_.EncoderTicksOf(payload, i);
      const double expected =
          double{kOusterTicks} * column.measurement_id / metadata_.columns_per_frame;
      const auto is_of_mode = [&](double factor) {
        constexpr double kMostOff = 0.1;
        return std::abs(ticks / expected / factor - 1.0) < kMostOff;
      };
      if (is_of_mode(0.25) || is_of_mode(0.5) || is_of_mode(2.0) || is_of_mode(4.0)) {
        return "column " + NumberText(i) + ": encoder count must be near " +
               NumberText(std::round(expected)) +
               " by its measurement id and the metadata's lidar mode" + Got(ticks);
      }
    }
    if (column.time_ns > kMostTime_ns) {
      return "column " + NumberText(i) + ": time must be <= " + NumberText(kMostTime_ns) + " ns" +
             Got(column.time_ns);
    }
  }
  return std::nullopt;
}

void OusterDecoder::TakePacket(std::span<const char> payload, std::vector<SensorTurn>& turns) {
  ++num_packets_;
  const std::uint32_t frame_id = layout_.HeaderOf(payload).frame_id;
  if (frame_id_ && frame_id != *frame_id_) {
    const bool is_late = frame_id == ((*frame_id_ - 1) & layout_.last_frame_id());
    if (is_late) return;
    turns.push_back(TakeUnfinished());
  }
  frame_id_ = frame_id;
  for (std::size_t i = 0; i < layout_.num_columns(); ++i) AddColumn(payload, i);
}

void OusterDecoder::AddColumn(std::span<const char> payload, std::size_t place) {
  const OusterColumn column = layout_.ColumnOf(payload, place);
  if (!column.is_valid || is_seen_[column.measurement_id]) return;
  is_seen_[column.measurement_id] = true;
  const double turned = static_cast<double>(column.measurement_id) / metadata_.columns_per_frame;
  columns_.push_back({.measurement_id = column.measurement_id,
                      .time_ns = static_cast<std::int64_t>(column.time_ns),
                      .first_point = points_.size(),
                      .first_place = places_.size()});
  places_.resize(places_.size() + beams_.size());
  for (const Beam& beam : beams_) {
    const std::size_t in_packet = layout_.PlaceOfPixel(place, beam.pixel);
    const OusterPixel pixel = layout_.PixelAt(payload, in_packet);
    places_[columns_.back().first_place + beam.ring] = {
        .packet = num_packets_ - 1, .first = static_cast<std::uint32_t>(in_packet)};
    TurnPoint point{};
    point.ring = beam.ring;
    point.laser = static_cast<std::uint8_t>(beam.pixel);
    for (std::size_t i = 0; i < layout_.num_returns(); ++i) {
      point.return_index = static_cast<std::uint8_t>(i);
      const std::size_t num_points = points_.size();
      AddPoint(pixel.returns[i], beam, kTurn_rad * turned, point);
      if (points_.size() == num_points) continue;
      signals_.push_back(pixel.returns[i].signal);
      near_irs_.push_back(pixel.near_ir);
    }
  }
  columns_.back().num_points = points_.size() - columns_.back().first_point;
}

// Ouster, firmware user manual, "lidar range to XYZ": the beam leaves from the end of an arm that
// turns with the rotor, and the stated range counts from the arm's length before that.
void OusterDecoder::AddPoint(const OusterReturn& measured,
                             const Beam& beam,
                             double rotor_rad,
                             TurnPoint point) {
  const double range_m = 1e-3 * measured.range_mm - metadata_.range_offset_m();
  if (measured.range_mm == 0 || range_m <= 0.0) return;
  const auto [out_m, up_m] = metadata_.beam_origin_m;
  // The rotor turns clockwise.
  const double beam_rad = -(rotor_rad + beam.azimuth_rad);
  const double horizontal_m = range_m * beam.cosine;
  const Vector3 in_lidar(out_m * std::cos(rotor_rad) + horizontal_m * std::cos(beam_rad),
                         -out_m * std::sin(rotor_rad) + horizontal_m * std::sin(beam_rad),
                         up_m + range_m * beam.sine);
  const Vector3 place = metadata_.sensor_from_lidar * in_lidar;
  const double azimuth_rad = -std::atan2(place.y(), place.x());
  point.x = static_cast<float>(place.x());
  point.y = static_cast<float>(place.y());
  point.z = static_cast<float>(place.z());
  point.range_m = static_cast<float>(range_m);
  point.azimuth_rad = static_cast<float>(azimuth_rad < 0.0 ? azimuth_rad + kTurn_rad : azimuth_rad);
  point.intensity = measured.reflectivity;
  points_.push_back(point);
}

std::optional<std::string> OusterDecoder::Store(const EditedReturns& returns,
                                                const FiringPlace& place,
                                                std::span<char> packet) const {
  const OusterPixel recorded = layout_.PixelAt(packet, place.first);
  OusterPixel pixel{.near_ir = recorded.near_ir};
  for (std::size_t i = 0; i < returns.size(); ++i) {
    if (!returns[i]) continue;
    if (auto refusal = StoreReturn(*returns[i], recorded, pixel.returns[i])) return refusal;
  }
  layout_.StorePixel(pixel, place.first, packet);
  return std::nullopt;
}

std::optional<std::string> OusterDecoder::StoreReturn(const EditedReturn& edited,
                                                      const OusterPixel& recorded,
                                                      OusterReturn& stored) const {
  if (edited.from) {
    stored = recorded.returns[*edited.from];
  } else {
    const double unit_m = 1e-3 * layout_.range_unit_mm();
    const double stated_m = static_cast<double>(edited.range_m) + metadata_.range_offset_m();
    const double num_units = std::round(stated_m / unit_m);
    const std::uint32_t most = layout_.most_range_mm() / layout_.range_unit_mm();
    // Written so that NaN is refused, too.
    if (!(num_units >= 1.0 && num_units <= most)) {
      return RefuseRange(static_cast<double>(edited.range_m), unit_m,
                         1e-3 * layout_.most_range_mm());
    }
    stored.range_mm = static_cast<std::uint32_t>(num_units) * layout_.range_unit_mm();
  }
  if (!edited.intensity) return std::nullopt;
  const float before = IntensityOfByte(static_cast<std::uint8_t>(stored.reflectivity));
  stored.reflectivity = *edited.intensity;
  const float in_ratio =
      before > 0.0F ? IntensityOfByte(*edited.intensity) / before * stored.signal : 0.0F;
  const float signal = edited.signal.value_or(in_ratio);
  stored.signal = static_cast<std::uint16_t>(std::lround(std::clamp(signal, 0.0F, 65535.0F)));
  return std::nullopt;
}

void OusterDecoder::Seal(std::span<char> packet) const {
  if (layout_.may_have_checksum() && StatesChecksum(packet)) StoreChecksum(packet);
}

SensorTurn OusterDecoder::TakeUnfinished() {
  SensorTurn turn;
  turn.is_dual = layout_.is_dual();
  // Packets may have come in another order.
  std::ranges::stable_sort(columns_, {}, &Column::measurement_id);
  if (!columns_.empty()) turn.stamp_ns = columns_.front().time_ns;
  turn.fields = {{"signal", {}}, {"near_ir", {}}};
  for (const Column& column : columns_) {
    const std::int64_t since_stamp_ns = column.time_ns - turn.stamp_ns;
    for (std::size_t i = column.first_point; i < column.first_point + column.num_points; ++i) {
      TurnPoint point = points_[i];
      point.column = static_cast<std::uint32_t>(turn.num_columns());
      point.time_ns = since_stamp_ns;
      turn.points.push_back(point);
      turn.fields[0].values.push_back(signals_[i]);
      turn.fields[1].values.push_back(near_irs_[i]);
    }
    turn.column_time_ns.push_back(since_stamp_ns);
    turn.aims.push_back(
        {.azimuth_deg = 360.0 * column.measurement_id / metadata_.columns_per_frame});
    const auto places = std::span(places_).subspan(column.first_place, beams_.size());
    turn.places.insert(turn.places.end(), places.begin(), places.end());
  }
  if (!layout_.has_signal()) turn.fields.erase(turn.fields.begin());
  frame_id_.reset();
  columns_.clear();
  points_.clear();
  places_.clear();
  signals_.clear();
  near_irs_.clear();
  is_seen_.assign(is_seen_.size(), false);
  return turn;
}

}  // namespace railcast
