#include "core/io/recording/recording_kinds.h"

#include <algorithm>
#include <cerrno>
#include <deque>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/pcap/pcap_reader.h"
#include "core/io/recording/capture_sensor.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

class CaptureRecording : public Recording {
 public:
  CaptureRecording(std::FILE* stream, const std::string& name, CaptureSensor sensor)
      : reader_(stream, name),
        name_(sensor.name),
        packet_size_(sensor.packet_size),
        shape_(std::make_shared<const TurnShape>(std::move(sensor.shape))),
        decoder_(std::move(sensor.decoder)) {
    info_.source = name;
    info_.kind = "capture of " + std::string(sensor.name);
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    while (turns_.empty() && !is_at_end_) TakeDatagram();
    if (turns_.empty()) return std::nullopt;
    auto turn = std::make_shared<const SensorTurn>(std::move(turns_.front()));
    turns_.pop_front();
    const std::uint32_t index = num_frames_++;
    return [shape = shape_, turn = std::move(turn), index,
            name = ShownPath(info_.source) + ": turn " + NumberText(index)] {
      RecordedFrame recorded = MakeTurnFrame(*turn, *shape, name);
      recorded.frame.index = index;
      return recorded;
    };
  }

 private:
  void TakeDatagram() {
    std::vector<SensorTurn> turns;
    const auto datagram = reader_.Next();
    std::visit(
        [&](auto& decoder) {
          if (datagram) TakePackets(*datagram, decoder, turns);
          if (!datagram) turns.push_back(decoder.TakeUnfinished());
        },
        decoder_);
    is_at_end_ = !datagram;
    for (SensorTurn& turn : turns) {
      if (turn.num_columns() > 0) turns_.push_back(std::move(turn));
    }
  }

  // The payload holds one packet, or several that were captured as one datagram. A packet that the
  // decoder refuses leaves it unchanged.
  template <typename Decoder>
  void TakePackets(const CapturedDatagram& datagram,
                   Decoder& decoder,
                   std::vector<SensorTurn>& turns) const {
    std::span<const char> rest = datagram.payload;
    while (!rest.empty()) {
      const std::size_t size = std::min(rest.size(), packet_size_);
      const auto refusal = decoder.Decode(rest.first(size), turns);
      const bool is_first = rest.size() == datagram.payload.size();
      if (refusal && is_first) return;
      if (size < packet_size_) {
        throw InputError(ShownPath(info_.source) + ": packet " + NumberText(datagram.packet) +
                         ": must hold whole packets of " + std::string(name_) + ", of " +
                         NumberText(packet_size_) + " bytes each (got " +
                         NumberText(datagram.payload.size()) + " bytes)");
      }
      rest = rest.subspan(size);
    }
  }

  RecordingInfo info_;
  PcapReader reader_;
  std::string_view name_;
  std::size_t packet_size_;
  std::shared_ptr<const TurnShape> shape_;
  std::variant<VelodyneDecoder, HesaiDecoder, At128Decoder> decoder_;
  std::deque<SensorTurn> turns_;
  std::uint32_t num_frames_{};
  bool is_at_end_ = false;
};

CaptureSensor FindSensor(std::FILE* stream,
                         const std::string& name,
                         const LoadAt128Correction& load_correction) {
  PcapReader reader(stream, name);
  SensorFinder finder(load_correction);
  while (const auto datagram = reader.Next()) {
    if (auto sensor = finder.Look(datagram->payload)) return std::move(*sensor);
  }
  throw InputError(name + ": must be a capture of " + ReadableSensorsText() + " (" +
                   finder.Findings(reader.num_torn()) + ")");
}

/// Reads the correction file of an AT128 that has the capture's name.
std::shared_ptr<const At128Correction> CorrectionBeside(std::filesystem::path file) {
  file.replace_extension(".dat");
  if (!std::filesystem::exists(file)) return nullptr;
  const std::string bytes = ReadFileWhole(file);
  return AtPlace(ShownPath(file) + ": ",
                 [&] { return std::make_shared<const At128Correction>(bytes); });
}

}  // namespace

std::unique_ptr<Recording> OpenCapture(const std::function<std::FILE*()>& open,
                                       const std::string& name,
                                       const LoadAt128Correction& load_correction) {
  CaptureSensor sensor = FindSensor(open(), name, load_correction);
  return std::make_unique<CaptureRecording>(open(), name, std::move(sensor));
}

std::unique_ptr<Recording> OpenCapture(const std::filesystem::path& file) {
  return OpenCapture(
      [&file] {
        CheckIsReadable(file);
        std::FILE* const stream = std::fopen(file.c_str(), "rbe");
        if (stream == nullptr) throw FileError(file, errno);
        return stream;
      },
      ShownPath(file), [&file] { return CorrectionBeside(file); });
}

}  // namespace railcast
