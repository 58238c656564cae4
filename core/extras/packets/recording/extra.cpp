#include <filesystem>
#include <string>

#include "core/extras/packets/recording/capture_recording.h"
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

}  // namespace

void AddPackets(RecordingExtras& extras) {
  extras.kinds.push_back(
      {.option = "--sensor",
       .extensions = {".pcap", ".pcapng"},
       .is_of = [](const fs::path& source) { return FindCapture(source).has_value(); },
       .open = OpenCapture,
       .open_more = OpenCaptureWithMetadata,
       .behind_copy = BehindCopyOfCapture});
}

}  // namespace railcast
