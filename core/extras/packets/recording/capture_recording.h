#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/capture_metadata.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The sensors whose captures can be opened: "VLP-16, HDL-32E or QT128".
[[nodiscard]] std::string ReadableSensorsText();

/// Opens a .pcap or .pcapng capture of one of these sensors. Each turn is a frame; the first and
/// the last turn are usually cut short. That of an AT128 needs the sensor's correction file beside
/// it, with the capture's name and the extension .dat. Other and damaged datagrams are skipped and
/// counted. Packets that segmentation offload merged into one datagram are cut apart.
/// Returns null if the file has another extension.
/// @throws InputError with one line that says what was found if that is no sensor, or names them if
///   there are several; reading throws it, too, where a merged datagram ends within a packet.
[[nodiscard]] std::unique_ptr<Recording> OpenCapture(const std::filesystem::path& file);

/// Opens a capture with the metadata that `source` names behind it, "drive.pcap:os.json", instead
/// of those beside it, or with the sensor that it names there: "drive.pcap:192.168.1.201",
/// "drive.pcap:os.json:192.168.1.201:7502". Returns null if `source` does not name a capture so.
/// @throws InputError as above, and if the metadata cannot be read.
[[nodiscard]] std::unique_ptr<Recording> OpenCaptureWithMetadata(
    const std::filesystem::path& source);

/// What stands behind a capture's name and a colon.
struct CaptureSuffix {
  std::string metadata{};  ///< A file; empty if there is none.
  std::string sensor{};    ///< As ParseSender() takes it; empty if there is none.
};

[[nodiscard]] CaptureSuffix SplitCaptureSuffix(std::string_view suffix);

/// The overload for a capture that `open` opens. `open` is called twice: once to find the sensor,
/// and once to read.
/// @param name Names the capture in error messages.
/// @param beside What stands beside it about its sensor; only an Ouster sensor and an AT128 need
///   it.
[[nodiscard]] std::unique_ptr<Recording> OpenCapture(const std::function<std::FILE*()>& open,
                                                     const std::string& name,
                                                     const CaptureMetadata& beside = {});

/// Datagrams of one or several sensors in the order of their times.
class DatagramSource {
 public:
  virtual ~DatagramSource() = default;

  /// Returns the next datagram, or nothing at the end.
  /// @throws InputError with one line where the source is damaged.
  [[nodiscard]] virtual std::optional<CapturedDatagram> Next() = 0;
  /// What was left out so far that is no whole datagram.
  [[nodiscard]] virtual std::vector<Remark> remarks() const { return {}; }
};

/// Datagrams that can be read from their beginning any number of times.
struct DatagramPlace {
  std::function<std::unique_ptr<DatagramSource>()> open;
  std::filesystem::path source;      ///< As messages and RecordingInfo name it.
  CaptureMetadata beside;            ///< What is known of the sensor.
  std::filesystem::path file{};      ///< The capture; empty for other places.
  std::optional<Endpoint> sensor{};  ///< Which of its sensors is read; port 0: any port.
};

/// The place of a capture that `open` opens, as OpenCapture() takes it.
[[nodiscard]] DatagramPlace PlaceOfCapture(const std::function<std::FILE*()>& open,
                                           const std::string& name,
                                           const CaptureMetadata& beside = {});

/// As OpenCapture(), for datagrams of any place, which is opened twice, too.
[[nodiscard]] std::unique_ptr<Recording> OpenDatagrams(const DatagramPlace& place);

/// Finds the capture that `source` names, with or without metadata behind it. Returns nothing if it
/// names none.
/// @throws InputError if the metadata that it names cannot be read.
[[nodiscard]] std::optional<DatagramPlace> FindCapture(const std::filesystem::path& source);

}  // namespace railcast
