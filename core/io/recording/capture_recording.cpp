#include "core/io/recording/recording_kinds.h"

#include <algorithm>
#include <cerrno>
#include <deque>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/io/pcap/pcap_reader.h"
#include "core/io/recording/capture_sensor.h"
#include "core/io/recording/turn_reader.h"
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
        shape_(std::make_shared<const TurnShape>(sensor.shape)),
        reader_(std::move(sensor), ShownPath(source)) {
    info_.source = source;
    info_.kind = "capture of " + reader_.sensor().name;
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
    const auto datagram = datagrams_->Next();
    if (datagram) {
      reader_.Take(*datagram, turns_);
      return;
    }
    reader_.End(turns_);
    is_at_end_ = true;
    AddRemarks();
  }

  void AddRemarks() {
    const auto add = [&](RemarkKind kind, std::size_t num) {
      info_.remarks->Add({.kind = kind, .place = ShownPath(info_.source), .number = num});
    };
    add(RemarkKind::kPacketsDamaged, reader_.num_damaged());
    add(RemarkKind::kFragmentsMissing, datagrams_->num_torn());
  }

  RecordingInfo info_;
  std::unique_ptr<DatagramSource> datagrams_;
  std::shared_ptr<const TurnShape> shape_;
  TurnReader reader_;
  std::deque<SensorTurn> turns_;
  std::uint32_t num_frames_{};
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
  auto place = PlaceOfCapture([file] { return OpenStream(file); }, ShownPath(source), beside);
  place.file = file;
  return place;
}

DatagramPlace PlaceOfFile(const std::filesystem::path& file) {
  CaptureMetadata beside = FindOusterMetadata(file);
  beside.load_correction = [file] { return CorrectionBeside(file); };
  return PlaceOfFile(file, file, beside);
}

bool IsCaptureName(const std::filesystem::path& file) {
  const std::string extension = LowerCase(file.extension().string());
  return extension == ".pcap" || extension == ".pcapng";
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
