#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/extras/packets/ouster/ouster_encoder.h"
#include "core/extras/packets/ouster/ouster_http.h"
#include "core/scenario/ouster_metadata.h"
#include "railcast/lidar.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/decode_packet.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

void CheckTurn(const SensorTurn& turn, const OusterMetadata& metadata) {
  Check(turn.num_columns() <= metadata.columns_per_frame, "a turn has an end");
  for (const TurnField& field : turn.fields) {
    Check(field.values.size() == turn.points.size(), "each point has each field");
  }
  for (const TurnPoint& point : turn.points) {
    Check(point.column < turn.num_columns() && point.ring < metadata.beams.size(),
          "a point is of a firing");
    Check(turn.is_dual || point.return_index == 0, "a second return is of a dual profile");
    Check(point.range_m > 0.0F && point.range_m < 1049.0F, "a range is within the format");
    Check(point.azimuth_rad >= 0.0F && point.azimuth_rad < 6.2832F, "an azimuth is of one turn");
    Check(std::isfinite(point.x + point.y + point.z), "a point is somewhere");
  }
}

// Splits the bytes into packets; the last one may be truncated.
void DecodePackets(const OusterMetadata& metadata, std::span<const char> bytes) {
  OusterDecoder decoder(metadata);
  std::vector<SensorTurn> turns;
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), decoder.layout().packet_size()));
    static_cast<void>(DecodePacket(decoder, packet, turns));
    bytes = bytes.subspan(packet.size());
  }
  turns.push_back(decoder.TakeUnfinished());
  for (const SensorTurn& turn : turns) CheckTurn(turn, metadata);
}

// What can be read makes a scan, a decoder and the metadata of a stream, which read the same.
void ReadMetadata(const std::string& text) {
  try {
    const OusterMetadata metadata = ParseOusterMetadata(text);
    const OusterDecoder decoder(metadata);
    Check(decoder.layout().packet_size() <= 65'507, "a packet is a datagram");
    const std::string streamed = MetadataOfStream(text, {0x7F000001, 7502}).dump();
    const OusterMetadata again = ParseOusterMetadata(streamed);
    Check(again.beams.size() == metadata.beams.size() && again.profile == metadata.profile &&
              again.column_window == metadata.column_window,
          "metadata are sent as they were read");
    LidarSpec lidar;
    UseOusterMetadata(text, lidar);
    Check(BuildScanPattern(lidar.scan).rows == metadata.beams.size(), "each beam has a row");
  } catch (const InputError&) {
  }
}

// The first line is the method and the target, the rest the body.
void Ask(std::string_view text) {
  static const Json metadata = MetadataOfStream(MadeOusterMetadataText(), {0x7F000001, 7502});
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::string_view method = line.substr(0, line.find(' '));
  const HttpAnswer answer = AnswerAsOuster(
      metadata, {.method = std::string(method),
                 .target = std::string(line.substr(std::min(method.size() + 1, line.size()))),
                 .body = std::string(text.substr(std::min(line.size() + 1, text.size())))});
  Check(
      answer.status == 200 || answer.status == 400 || answer.status == 404 || answer.status == 405,
      "an answer has a status");
  Check(ParseJson(answer.body).json.has_value(), "an answer is JSON");
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format of the rest: 0 to 5 for packets of
/// a profile, h for what is asked over HTTP, anything else for metadata.
RAILCAST_FUZZ_TARGET(ouster) {
  using railcast::OusterProfile;
  if (size == 0) return 0;
  const std::span bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] >= '0' && data[0] <= '5') {
    const auto profile = static_cast<OusterProfile>(data[0] - '0');
    railcast::DecodePackets(railcast::ParseOusterMetadata(railcast::MadeOusterMetadataText(
                                std::string(railcast::NameOf(profile)))),
                            bytes);
  } else if (data[0] == 'h') {
    railcast::Ask({bytes.data(), bytes.size()});
  } else {
    railcast::ReadMetadata({bytes.data(), bytes.size()});
  }
  return 0;
}
