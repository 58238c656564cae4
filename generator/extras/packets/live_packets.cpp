// What live runs send as sensors do: their packets, captures of these, and what drivers ask for.
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/inputs.h"
#include "core/base/text.h"
#include "core/extras/packets/ouster/ouster_encoder.h"
#include "core/extras/packets/ouster/ouster_http.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/packets/recording/capture_metadata.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"
#include "core/scenario/sensors.h"
#include "generator/live/live_extras.h"
#include "generator/live/live_options.h"
#include "generator/live/live_streams.h"

namespace railcast {
namespace {

void AddPacketOptions(ProgramOptions& stream, StreamOptions& options) {
  stream
      .AddOption("--pcap", options.pcap,
                 "Capture file to write; without --to, nothing is sent and the file is written as "
                 "fast as the machine can compute it")
      .Check(NonEmpty());
  stream
      .AddOption("--calibration", options.calibration,
                 "With protocol hdl64e: file to write the calibration to, which receivers need")
      .Check(NonEmpty());
  stream
      .AddOption("--http", options.http,
                 "With protocol ouster: HOST:PORT of this machine at which to answer drivers' "
                 "HTTP requests as the sensor does; default: none; 127.0.0.1:8080 is for this "
                 "machine only")
      .Check(NonEmpty());
}

std::unique_ptr<FrameEncoder> MakePacketEncoder(Protocol protocol, const LidarSpec& lidar) {
  if (protocol == Protocol::kOuster) return MakeOusterEncoder(lidar);
  const SpinningModel* const model = FindSpinningModel(NameOf(protocol));
  Check(model != nullptr, "the packets of the protocol are known");
  return MakeSpinningEncoder(*model, lidar.scan, lidar.receiver.return_mode);
}

std::unique_ptr<DatagramFile> OpenCapture(const std::filesystem::path& file,
                                          Protocol protocol,
                                          bool is_ipv6) {
  return std::make_unique<PcapWriter>(file, DefaultPort(protocol),
                                      PositionPort(protocol).value_or(0), is_ipv6);
}

/// Checks that an option for one sensor of a protocol is given for one.
void CheckIsFor(const std::string& option,
                Protocol protocol,
                const std::vector<SensorStreamSpec>& streams) {
  if (streams.size() == 1 && streams.front().protocol == protocol) return;
  throw InputError(option + ": is for one sensor of protocol " + std::string(NameOf(protocol)) +
                   " (got " +
                   (streams.size() == 1 ? std::string(NameOf(streams.front().protocol))
                                        : std::to_string(streams.size()) + " sensors") +
                   ")");
}

/// Writes the correction file of an AT128 beside its capture, which cannot be read without.
void WriteCorrectionBeside(const SensorStreamSpec& stream, const LidarSpec& lidar) {
  if (!stream.pcap || stream.protocol != Protocol::kAt128) return;
  std::filesystem::path file = *stream.pcap;
  file.replace_extension(".dat");
  // When the stream was made, it was checked that the scan is one of these.
  const InputBytes bytes = ReadInput(std::get<FiringTableSpec>(lidar.scan.pattern).file);
  if (std::filesystem::exists(file) && ReadFileWhole(file) != *bytes) {
    throw InputError(ShownPath(file) +
                     ": must be absent or the scan's correction file, which is written "
                     "beside the capture");
  }
  WriteFileWhole(file, *bytes);
}

/// What a sensor calls the source of such time. UTC comes as a sentence of NMEA with a pulse.
std::optional<std::string> TimestampMode(StampClock clock) {
  if (clock == StampClock::kSimulated) return std::nullopt;
  return clock == StampClock::kUtc ? "TIME_FROM_SYNC_PULSE_IN" : "TIME_FROM_PTP_1588";
}

/// The metadata as of a sensor that sends to the first receiver of a stream, or as captures have
/// it.
Json MetadataOf(const SensorStreamSpec& stream, const LidarSpec& lidar) {
  constexpr std::uint32_t kBroadcast = 0xFFFFFFFF;
  const Endpoint to =
      stream.to.empty() ? Endpoint{kBroadcast, kOusterLidarPort} : stream.to.front();
  return MetadataOfStream(*ReadInput(lidar.ouster_metadata.value()), to,
                          TimestampMode(stream.clock));
}

/// Writes the metadata of an Ouster sensor that is captured beside its capture, as Ouster's
/// programs name them: drive_0.json for drive.pcap.
void WriteMetadataBeside(const SensorStreamSpec& stream, const LidarSpec& lidar) {
  if (!stream.pcap || stream.protocol != Protocol::kOuster) return;
  const std::filesystem::path file =
      stream.pcap->parent_path() / (stream.pcap->stem().string() + "_0.json");
  if (std::filesystem::exists(file)) {
    try {
      static_cast<void>(ReadOusterMetadata(file));
    } catch (const InputError&) {
      throw InputError(ShownPath(file) +
                       ": must be absent or the metadata of an Ouster sensor, which are "
                       "written beside the capture");
    }
  }
  WriteFileWhole(file, MetadataOf(stream, lidar).dump(2) + '\n');
}

/// Answers the drivers of an Ouster sensor at HOST:PORT of this machine.
std::unique_ptr<HttpServer> ServeOuster(const std::string& at, Json metadata) {
  auto answer = [metadata = std::move(metadata)](const HttpRequest& request) {
    return AnswerAsOuster(metadata, request);
  };
  constexpr std::uint16_t kHttpPort = 80;
  auto server = AtPlace("--http: ", [&] {
    return std::make_unique<HttpServer>(ParseEndpoint(at, kHttpPort), std::move(answer));
  });
  std::cout << "HTTP at " << EndpointText(server->at()) << "\n";
  return server;
}

std::unique_ptr<HttpServer> AccompanyPackets(const StreamOptions& options,
                                             const ScenarioSpec& scenario,
                                             const std::vector<SensorStreamSpec>& streams) {
  const auto lidar_of = [&](const SensorStreamSpec& stream) {
    return PickSensor(scenario, stream.name).lidar;
  };
  if (options.calibration) {
    CheckIsFor("--calibration", Protocol::kHdl64e, streams);
    // The protocol fits only spinning scans, which was checked when its stream was made.
    const LidarSpec lidar = lidar_of(streams.front());
    WriteNamedFile(*options.calibration,
                   CalibrationXml(std::get<SpinningSpec>(lidar.scan.pattern)));
  }
  for (const SensorStreamSpec& stream : streams) {
    const LidarSpec lidar = lidar_of(stream);
    WriteMetadataBeside(stream, lidar);
    WriteCorrectionBeside(stream, lidar);
  }
  if (!options.http) return nullptr;
  CheckIsFor("--http", Protocol::kOuster, streams);
  return ServeOuster(*options.http, MetadataOf(streams.front(), lidar_of(streams.front())));
}

}  // namespace

void AddPackets(LiveExtras& extras) {
  extras.packets = {.add_options = AddPacketOptions,
                    .make_encoder = MakePacketEncoder,
                    .open_capture = OpenCapture,
                    .accompany = AccompanyPackets};
}

}  // namespace railcast
