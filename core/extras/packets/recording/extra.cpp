#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/turn_reader.h"
#include "core/io/recording/recording_extras.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The metadata are copied beside the capture.
std::string BehindCopyOfCapture(const fs::path& folder, const std::string& behind) {
  const auto [metadata, sensor] = SplitCaptureSuffix(behind);
  std::string text;
  if (!metadata.empty()) text += ":" + (folder / fs::path(metadata).filename()).string();
  return sensor.empty() ? text : text + ":" + sensor;
}

std::vector<SensorPackets> CountPacketsOf(const fs::path& source) {
  std::vector<SensorPackets> sensors;
  const auto capture = FindCapture(source);
  if (!capture) return sensors;
  for (const TurnReader& reader : CountPackets(*capture)) {
    const PacketOrder& order = reader.order();
    sensors.push_back({capture->file, reader.sensor().name, reader.sensor().address,
                       PortsText(reader.sensor()), reader.num_taken(), reader.lost().number,
                       order.doubled().number, order.reordered().number, order.late().number,
                       reader.damaged().number, reader.refused().number});
  }
  return sensors;
}

}  // namespace

void AddPackets(RecordingExtras& extras) {
  extras.kinds.push_back(
      {.help = [] { return ".pcap capture of " + ReadableSensorsText(); },
       .option = "--sensor",
       .extensions = {".pcap", ".pcapng"},
       .is_of = [](const fs::path& source) { return FindCapture(source).has_value(); },
       .open = OpenCapture,
       .open_more = OpenCaptureWithMetadata,
       .behind_copy = BehindCopyOfCapture});
  extras.count_packets = CountPacketsOf;
}

}  // namespace railcast
