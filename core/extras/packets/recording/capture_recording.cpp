#include "core/extras/packets/recording/capture_recording.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/recording/turn_reader.h"
#include "core/io/recording/source_choice.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

class PcapSource : public DatagramSource {
 public:
  PcapSource(std::FILE* stream, const std::string& name) : reader_(stream, name) {}

  [[nodiscard]] std::optional<CapturedDatagram> Next() override { return reader_.Next(); }
  [[nodiscard]] std::vector<Remark> remarks() const override { return reader_.remarks(); }

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

  ~CaptureRecording() override {
    // If not all was read, the remarks are about what was.
    if (!is_at_end_) AddRemarks();
  }
  CaptureRecording(const CaptureRecording&) = delete;
  CaptureRecording& operator=(const CaptureRecording&) = delete;

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
    if (const auto datagram = datagrams_->Next()) {
      reader_.Take(*datagram, &turns_);
    } else {
      reader_.End(&turns_);
      is_at_end_ = true;
    }
    if (is_at_end_) AddRemarks();
  }

  // What seems lost may only be late, so that nothing is said before the end.
  void AddRemarks() {
    for (const Remark& remark : reader_.remarks()) info_.remarks->Add(remark);
    for (const Remark& remark : datagrams_->remarks()) info_.remarks->Add(remark);
  }

  RecordingInfo info_;
  std::unique_ptr<DatagramSource> datagrams_;
  std::shared_ptr<const TurnShape> shape_;
  TurnReader reader_;
  std::deque<SensorTurn> turns_;
  std::uint32_t num_frames_{};
  bool is_at_end_ = false;
};

/// Reads the correction file of an AT128 that has the capture's name.
std::shared_ptr<const At128Correction> CorrectionBeside(std::filesystem::path file) {
  file.replace_extension(".dat");
  if (!std::filesystem::exists(file)) return nullptr;
  return std::make_shared<const At128Correction>(ReadAt128Correction(file));
}

DatagramPlace PlaceOfFile(const std::filesystem::path& file,
                          const std::filesystem::path& source,
                          const CaptureMetadata& beside) {
  auto place = PlaceOfCapture([file] { return OpenStream(file); }, ShownPath(source), beside);
  place.file = file;
  return place;
}

CaptureMetadata MetadataBeside(const std::filesystem::path& file) {
  CaptureMetadata beside = FindOusterMetadata(file);
  beside.load_correction = [file] { return CorrectionBeside(file); };
  return beside;
}

/// Bags of ROS 2, which are folders, may have such a name, too.
bool IsCaptureName(const std::filesystem::path& file) {
  const std::string extension = LowerCase(file.extension().string());
  std::error_code error;
  return (extension == ".pcap" || extension == ".pcapng") &&
         !std::filesystem::is_directory(file, error);
}

/// Finds a capture with metadata, a sensor or both behind it: "drive.pcap:os.json:192.168.1.201".
std::optional<DatagramPlace> FindCaptureWithMore(const std::filesystem::path& source) {
  const std::string& text = source.native();
  for (std::size_t mark = text.find(':'); mark != std::string::npos;
       mark = text.find(':', mark + 1)) {
    const std::filesystem::path file = text.substr(0, mark);
    std::error_code error;
    if (!IsCaptureName(file) || !std::filesystem::exists(file, error)) continue;
    const auto [metadata, sensor] = SplitCaptureSuffix(std::string_view(text).substr(mark + 1));
    CaptureMetadata beside = MetadataBeside(file);
    if (!metadata.empty()) {
      beside = {.file = metadata, .metadata = ReadOusterMetadata(metadata), .is_named = true};
    }
    DatagramPlace place = PlaceOfFile(file, source, beside);
    place.sensor = ParseSender(sensor);
    return place;
  }
  return std::nullopt;
}

}  // namespace

CaptureSuffix SplitCaptureSuffix(std::string_view suffix) {
  if (ParseSender(suffix)) return {.sensor = std::string(suffix)};
  for (std::size_t mark = suffix.find(':'); mark != std::string_view::npos;
       mark = suffix.find(':', mark + 1)) {
    const std::string_view rest = suffix.substr(mark + 1);
    if (ParseSender(rest)) return {std::string(suffix.substr(0, mark)), std::string(rest)};
  }
  return {.metadata = std::string(suffix)};
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
  if (!IsCaptureName(file)) return nullptr;
  return OpenDatagrams(PlaceOfFile(file, file, MetadataBeside(file)));
}

std::unique_ptr<Recording> OpenCaptureWithMetadata(const std::filesystem::path& source) {
  const auto place = FindCaptureWithMore(source);
  return place ? OpenDatagrams(*place) : nullptr;
}

std::optional<DatagramPlace> FindCapture(const std::filesystem::path& source) {
  if (auto place = FindCaptureWithMore(source)) return place;
  if (!IsCaptureName(source)) return std::nullopt;
  return PlaceOfFile(source, source, MetadataBeside(source));
}

}  // namespace railcast
