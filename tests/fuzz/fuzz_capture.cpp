#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/packet_recording.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/decode_packet.h"

namespace railcast {
namespace {

void CheckTurn(const SensorTurn& turn, std::size_t num_rings) {
  Check(turn.num_columns() <= (std::size_t{1} << 14U) + 6, "a turn has an end");
  for (const TurnPoint& point : turn.points) {
    Check(point.column < turn.num_columns() && point.ring < num_rings && point.return_index < 2,
          "a point is of a firing");
    Check(turn.is_dual || point.return_index == 0, "a second return is of dual mode");
    Check(point.range_m > 0.0F && point.range_m < 16'712.0F, "a range is within the format");
    Check(std::isfinite(point.x + point.y + point.z), "a point is somewhere");
  }
}

// Splits the bytes into packets; the last one may be truncated.
void DecodeAll(const SpinningModel& model, std::span<const char> bytes) {
  SpinningDecoder decoder(model);
  std::vector<SensorTurn> turns;
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(bytes.size(), model.packet_size));
    (void)DecodePacket(decoder, packet, turns);
    bytes = bytes.subspan(packet.size());
  }
  turns.push_back(decoder.TakeUnfinished());
  for (const SensorTurn& turn : turns) CheckTurn(turn, model.channels.size());
}

// With the right checksums of all packets, which an input does not have by chance.
std::vector<char> WithChecksums(const SpinningModel& model, std::span<const char> bytes) {
  std::vector<char> packets(bytes.begin(), bytes.end());
  const std::size_t size = model.packet_size;
  for (std::size_t end = size; end <= packets.size(); end += size) {
    StoreChecksums(model, std::span(packets).first(end).last(size));
  }
  return packets;
}

// A correction file whose fields start at 20, 140 and 260 deg; its angles are 0 but for what the
// input begins with.
std::string CorrectionFile(std::span<const char> start) {
  std::string file(47'176, '\0');
  const std::string head = {'\xEE', '\xFF', 1, 5, '\x80', 3, 3};
  file.replace(0, head.size(), head);
  file[15] = 1;
  for (std::size_t field = 0; field < 3; ++field) {
    const auto steps = static_cast<std::uint32_t>((20 + 120 * field) * 25'600);
    std::memcpy(file.data() + 16 + 4 * field, &steps, sizeof steps);
  }
  std::copy_n(start.begin(), std::min(start.size(), file.size()), file.begin());
  return file;
}

void UseCorrection(std::span<const char> bytes) {
  try {
    const At128Correction correction(CorrectionFile(bytes));
    for (double block_deg = 0.0; block_deg < 360.0; block_deg += 7.3) {
      const auto direction = correction.At(block_deg, correction.FieldAt(block_deg), 127);
      Check(direction.azimuth_deg >= 0.0 && direction.azimuth_deg <= 360.0,
            "an azimuth is of one turn");
      Check(std::isfinite(direction.elevation_deg), "an elevation is a number");
    }
  } catch (const InputError&) {
  }
}

void CheckCapturedFrame(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  Check(recorded.is_grid && frame.columns > 0, "a turn is a grid");
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    Check(frame.ring[i] == i / frame.width(), "a slot knows its place");
    Check(std::isnan(frame.x[i]) == std::isnan(frame.intensity[i]), "a point has an intensity");
    Check(frame.return_count[i] <= frame.returns, "returns are counted");
  }
}

void ReadFrames(const std::function<std::FILE*()>& open) {
  const auto recording = OpenCapture(open, "fuzz");
  while (const auto read = recording->Next()) CheckCapturedFrame((*read)());
}

void ReadPackets(const std::function<std::FILE*()>& open) {
  PacketRecording recording(PlaceOfCapture(open, "fuzz"));
  std::size_t num = 1;
  while (num > 0) {
    const auto turn = recording.NextTurn();
    num = turn.size();
    for (const RecordedDatagram& datagram : turn) {
      Check(!datagram.bytes.empty() && datagram.port != 0, "a datagram can be sent");
    }
  }
}

void ReadCapture(std::span<const char> bytes) {
  const auto open = [&] {
    std::FILE* const stream =
        // Mode "r" does not write.
        ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb");
    if (stream == nullptr) throw InputError("fuzz: empty");
    return stream;
  };
  for (const auto read : {&ReadFrames, &ReadPackets}) {
    try {
      read(open);
    } catch (const InputError& error) {
      Check(std::string(error.what()).starts_with("fuzz: "), "a fault names its file");
    }
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects the format of the rest: h for packets of a
/// Pandar64, x of an XT32, q of a QT128, 0 to 9 of any spinning sensor of Hesai's, a of an AT128, c
/// for the start of its correction file, anything else for a capture.
RAILCAST_FUZZ_TARGET(capture) {
  if (size == 0) return 0;
  const std::span bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string_view letters = "hxq";
  const std::size_t letter = letters.find(static_cast<char>(data[0]));
  const std::size_t number = data[0] - std::size_t{'0'};
  const std::size_t model = letter < letters.size() ? letter : number;
  // Hesai's stand side by side.
  const auto first =
      std::ranges::find(railcast::SpinningModels(), "Pandar64", &railcast::SpinningModel::name);
  if (model < 10) {
    const railcast::SpinningModel& hesai = *(first + static_cast<std::ptrdiff_t>(model));
    railcast::DecodeAll(hesai, railcast::WithChecksums(hesai, bytes));
  } else if (data[0] == 'a') {
    const auto correction =
        std::make_shared<const railcast::At128Correction>(railcast::CorrectionFile({}));
    const railcast::SpinningModel at128 = railcast::At128Model(correction);
    railcast::DecodeAll(at128, railcast::WithChecksums(at128, bytes));
  } else if (data[0] == 'c') {
    railcast::UseCorrection(bytes);
  } else {
    railcast::ReadCapture(bytes);
  }
  return 0;
}
