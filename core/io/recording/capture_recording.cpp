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

class PcapSource : public DatagramSource {
 public:
  PcapSource(std::FILE* stream, const std::string& name) : reader_(stream, name) {}

  [[nodiscard]] std::optional<CapturedDatagram> Next() override { return reader_.Next(); }
  [[nodiscard]] std::size_t num_torn() const override { return reader_.num_torn(); }

 private:
  PcapReader reader_;
};

class CaptureRecording : public Recording {
 public:
  CaptureRecording(std::unique_ptr<DatagramSource> datagrams,
                   const std::filesystem::path& source,
                   CaptureSensor sensor)
      : datagrams_(std::move(datagrams)),
        name_(std::move(sensor.name)),
        packet_size_(sensor.packet_size),
        shape_(std::make_shared<const TurnShape>(std::move(sensor.shape))),
        decoder_(std::move(sensor.decoder)) {
    info_.source = source;
    info_.kind = "capture of " + name_;
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
    const auto datagram = datagrams_->Next();
    std::visit(
        [&](auto& decoder) {
          if (datagram) TakePackets(*datagram, decoder, turns);
          if (!datagram) turns.push_back(decoder.TakeUnfinished());
        },
        decoder_);
    is_at_end_ = !datagram;
    if (is_at_end_) info_.left_out = LeftOut();
    for (SensorTurn& turn : turns) {
      if (turn.num_columns() > 0) turns_.push_back(std::move(turn));
    }
  }

  [[nodiscard]] std::string LeftOut() const {
    std::string text;
    const auto add = [&text](std::size_t num, const char* one, const char* several) {
      if (num == 0) return;
      text += (text.empty() ? "" : ", ") + NumberText(num) + (num == 1 ? one : several);
    };
    add(num_damaged_, " packet with a wrong checksum", " packets with a wrong checksum");
    add(datagrams_->num_torn(), " datagram that lacks IP fragments",
        " datagrams that lack IP fragments");
    return text;
  }

  // The payload holds one packet, or several that were captured as one datagram. A packet that the
  // decoder refuses leaves it unchanged.
  template <typename Decoder>
  void TakePackets(const CapturedDatagram& datagram,
                   Decoder& decoder,
                   std::vector<SensorTurn>& turns) {
    std::span<const char> rest = datagram.payload;
    while (!rest.empty()) {
      const std::size_t size = std::min(rest.size(), packet_size_);
      const auto refusal = decoder.Decode(rest.first(size), turns);
      const bool is_damaged = refusal == kWrongChecksum;
      num_damaged_ += is_damaged ? 1 : 0;
      const bool is_first = rest.size() == datagram.payload.size();
      if (refusal && is_first && !is_damaged) return;
      if (size < packet_size_) {
        throw InputError(ShownPath(info_.source) + ": packet " + NumberText(datagram.packet) +
                         ": must hold whole packets of " + name_ + ", of " +
                         NumberText(packet_size_) + " bytes each (got " +
                         NumberText(datagram.payload.size()) + " bytes)");
      }
      rest = rest.subspan(size);
    }
  }

  RecordingInfo info_;
  std::unique_ptr<DatagramSource> datagrams_;
  std::string name_;
  std::size_t packet_size_;
  std::shared_ptr<const TurnShape> shape_;
  std::variant<VelodyneDecoder, HesaiDecoder, At128Decoder, OusterDecoder> decoder_;
  std::deque<SensorTurn> turns_;
  std::uint32_t num_frames_{};
  std::size_t num_damaged_{};  ///< Packets whose checksum is wrong.
  bool is_at_end_ = false;
};

std::FILE* OpenStream(const std::filesystem::path& file) {
  CheckIsReadable(file);
  std::FILE* const stream = std::fopen(file.c_str(), "rbe");
  if (stream == nullptr) throw FileError(file, errno);
  return stream;
}

/// Reads the correction file of an AT128 that has the capture's name.
std::shared_ptr<const At128Correction> CorrectionBeside(std::filesystem::path file) {
  file.replace_extension(".dat");
  if (!std::filesystem::exists(file)) return nullptr;
  const std::string bytes = ReadFileWhole(file);
  return AtPlace(ShownPath(file) + ": ",
                 [&] { return std::make_shared<const At128Correction>(bytes); });
}

DatagramPlace PlaceOfFile(const std::filesystem::path& file,
                          const std::filesystem::path& source,
                          const CaptureMetadata& beside) {
  return PlaceOfCapture([file] { return OpenStream(file); }, ShownPath(source), beside);
}

DatagramPlace PlaceOfFile(const std::filesystem::path& file) {
  CaptureMetadata beside = FindOusterMetadata(file);
  beside.load_correction = [file] { return CorrectionBeside(file); };
  return PlaceOfFile(file, file, beside);
}

bool IsCaptureName(const std::filesystem::path& file) {
  return file.extension() == ".pcap" || file.extension() == ".pcapng";
}

std::optional<DatagramPlace> FindCaptureWithMetadata(const std::filesystem::path& source) {
  const std::string& text = source.native();
  for (std::size_t mark = text.find(':'); mark != std::string::npos;
       mark = text.find(':', mark + 1)) {
    const std::filesystem::path file = text.substr(0, mark);
    std::error_code error;
    if (!IsCaptureName(file) || !std::filesystem::exists(file, error)) continue;
    const std::filesystem::path metadata = text.substr(mark + 1);
    return PlaceOfFile(file, source, {.file = metadata, .metadata = ReadOusterMetadata(metadata)});
  }
  return std::nullopt;
}

}  // namespace

CaptureSensor FindSensor(const DatagramPlace& place) {
  const auto datagrams = place.open();
  const std::string name = ShownPath(place.source);
  const CaptureMetadata& beside = place.beside;
  SensorFinder finder(beside);
  while (const auto datagram = datagrams->Next()) {
    if (auto sensor = finder.Look(datagram->payload)) return std::move(*sensor);
  }
  if (finder.has_seen_ouster() && !beside.fault.empty()) throw InputError(beside.fault);
  if (!finder.ouster_refusal().empty()) {
    throw InputError(name + ": packets are not of the sensor of " + ShownPath(beside.file) + ": " +
                     finder.ouster_refusal());
  }
  throw InputError(name + ": must be a capture of " + ReadableSensorsText() + " (" +
                   finder.Findings(datagrams->num_torn()) + ")");
}

std::unique_ptr<Recording> OpenDatagrams(const DatagramPlace& place) {
  CaptureSensor sensor = FindSensor(place);
  return std::make_unique<CaptureRecording>(place.open(), place.source, std::move(sensor));
}

std::unique_ptr<Recording> OpenCapture(const std::function<std::FILE*()>& open,
                                       const std::string& name,
                                       const CaptureMetadata& beside) {
  return OpenDatagrams(PlaceOfCapture(open, name, beside));
}

DatagramPlace PlaceOfCapture(const std::function<std::FILE*()>& open,
                             const std::string& name,
                             const CaptureMetadata& beside) {
  return {.open = [open, name] { return std::make_unique<PcapSource>(open(), name); },
          .source = name,
          .beside = beside};
}

std::unique_ptr<Recording> OpenCapture(const std::filesystem::path& file) {
  return OpenDatagrams(PlaceOfFile(file));
}

std::unique_ptr<Recording> OpenCaptureWithMetadata(const std::filesystem::path& source) {
  const auto place = FindCaptureWithMetadata(source);
  return place ? OpenDatagrams(*place) : nullptr;
}

std::optional<DatagramPlace> FindCapture(const std::filesystem::path& source) {
  if (auto place = FindCaptureWithMetadata(source)) return place;
  if (!IsCaptureName(source)) return std::nullopt;
  return PlaceOfFile(source);
}

}  // namespace railcast
