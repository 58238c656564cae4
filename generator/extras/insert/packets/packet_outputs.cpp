#include "generator/extras/insert/packets/packet_outputs.h"

#include <algorithm>
#include <deque>
#include <vector>

#include "core/base/text.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/io/unfinished_file.h"
#include "generator/extras/insert/packets/turn_editor.h"

namespace railcast {
namespace {

constexpr std::int64_t kMostChecksum = 0xFFFF;

/// What a capture's sensor cannot be decoded without.
std::vector<std::filesystem::path> FilesBeside(const DatagramPlace& capture,
                                               const CaptureSensor& sensor) {
  const auto* const spinning = std::get_if<SpinningDecoder>(&sensor.decoder);
  if (spinning == nullptr) return {capture.beside.file};
  if (!spinning->model().correction) return {};
  std::filesystem::path correction = capture.file;
  return {correction.replace_extension(".dat")};
}

class CaptureOutput : public InsertedOutput {
 public:
  CaptureOutput(const DatagramPlace& capture, const std::filesystem::path& folder)
      : sensor_(FindSensor(capture)),
        editor_(sensor_, ShownPath(capture.source)),
        reader_(capture.file),
        out_(folder / capture.file.filename(), 0) {
    reader_.FindPlaces();
    out_.AppendFile(capture.file);
    for (const std::filesystem::path& file : FilesBeside(capture, sensor_)) {
      const UnfinishedFile copy(folder / file.filename(), 0);
      copy.AppendFile(file);
      copy.Finish();
    }
  }

  std::optional<std::vector<std::uint32_t>> Write(const RecordedFirings&,
                                                  const InsertedFrame& inserted) override {
    if (inserted.edits.empty()) return std::nullopt;
    const std::uint32_t turn = inserted.recorded.frame.index;
    while (!editor_.Has(turn)) TakeDatagram(turn);
    for (const EditedPacket& packet : editor_.Edit(inserted)) Overwrite(packet);
    while (first_held_ < editor_.first_open_datagram()) {
      held_.pop_front();
      ++first_held_;
    }
    return std::nullopt;
  }

  void Finish() override { out_.Finish(); }

 private:
  using Pieces = std::vector<CapturedPiece>;

  void TakeDatagram(std::uint32_t turn) {
    const auto datagram = reader_.Next();
    if (!datagram) return editor_.End();
    held_.emplace_back(datagram->pieces.begin(), datagram->pieces.end());
    editor_.Take(*datagram);
    editor_.Skip(turn);
  }

  void Overwrite(const EditedPacket& packet) {
    const Pieces& pieces = held_.at(packet.datagram - first_held_);
    const std::size_t begin = kUdpHeaderSize + packet.offset;
    std::size_t piece_begin = 0;
    for (const CapturedPiece& piece : pieces) {
      const std::size_t from = std::max(begin, piece_begin);
      const std::size_t to = std::min(begin + packet.after.size(), piece_begin + piece.size);
      if (from < to) {
        out_.Overwrite(piece.place + from - piece_begin,
                       std::span(packet.after).subspan(from - begin, to - from));
      }
      piece_begin += piece.size;
    }
    const std::uint64_t place = pieces.front().place + kUdpChecksumPlace;
    const std::string stored = out_.Read(place, 2);
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(stored[i]); };
    const auto checksum = static_cast<std::uint16_t>(byte(0) << 8U | byte(1));
    const std::uint16_t changed = ChangedChecksum(checksum, begin, packet.before, packet.after);
    out_.Overwrite(
        place, std::array{static_cast<char>(changed >> 8U), static_cast<char>(changed & 0xFFU)});
  }

  CaptureSensor sensor_;
  TurnEditor editor_;
  PcapReader reader_;
  UnfinishedFile out_;
  std::deque<Pieces> held_;     ///< For each datagram that may still be edited.
  std::uint64_t first_held_{};  ///< Number of their first.
};

}  // namespace

std::uint16_t ChangedChecksum(std::uint16_t checksum,
                              std::size_t place,
                              std::span<const char> before,
                              std::span<const char> after) {
  if (checksum == 0) return 0;
  std::int64_t sum = kMostChecksum - checksum;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::int64_t change =
        static_cast<unsigned char>(after[i]) - int{static_cast<unsigned char>(before[i])};
    sum += (place + i) % 2 == 0 ? 256 * change : change;
  }
  sum = (sum % kMostChecksum + kMostChecksum) % kMostChecksum;
  return static_cast<std::uint16_t>(kMostChecksum - sum);
}

std::unique_ptr<InsertedOutput> MakeCopyOutput(const std::filesystem::path& source,
                                               const std::filesystem::path& folder) {
  if (const auto capture = FindCapture(source)) {
    return std::make_unique<CaptureOutput>(*capture, folder);
  }
  if (const auto bag = FindBag(source)) return MakeBagOutput(*bag, folder);
  return nullptr;
}

}  // namespace railcast
