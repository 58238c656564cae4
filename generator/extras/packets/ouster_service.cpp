#include "generator/extras/packets/ouster_service.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/packets/ouster/ouster_encoder.h"
#include "core/extras/packets/ouster/ouster_http.h"
#include "core/io/recording/capture_metadata.h"
#include "core/io/write_file.h"
#include "core/scenario/sensors.h"

namespace railcast {
namespace {

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
  return MetadataOfStream(ReadFileWhole(lidar.ouster_metadata.value()), to,
                          TimestampMode(stream.clock));
}

}  // namespace

void WriteMetadataBeside(const SensorStreamSpec& stream, const LidarSpec& lidar) {
  if (!stream.pcap || stream.protocol != Protocol::kOuster) return;
  const std::filesystem::path file =
      stream.pcap->parent_path() / (stream.pcap->stem().string() + "_0.json");
  if (std::filesystem::exists(file)) {
    try {
      static_cast<void>(ReadOusterMetadata(file));
    } catch (const InputError&) {
      throw InputError(ShownPath(file) +
                       ": must not be there, or be the metadata of an Ouster sensor, which are "
                       "written beside the capture");
    }
  }
  WriteFileWhole(file, MetadataOf(stream, lidar).dump(2) + '\n');
}

std::unique_ptr<HttpServer> ServeOuster(const std::string& at,
                                        const std::vector<SensorStreamSpec>& streams,
                                        const ScenarioSpec& scenario) {
  if (streams.size() != 1 || streams.front().protocol != Protocol::kOuster) {
    throw InputError("--http: is for one sensor of protocol ouster (got " +
                     (streams.size() == 1 ? std::string(NameOf(streams.front().protocol))
                                          : std::to_string(streams.size()) + " sensors") +
                     ")");
  }
  const LidarSpec lidar = PickSensor(scenario, streams.front().name).lidar;
  auto answer = [metadata = MetadataOf(streams.front(), lidar)](const HttpRequest& request) {
    return AnswerAsOuster(metadata, request);
  };
  constexpr std::uint16_t kHttpPort = 80;
  return AtPlace("--http: ", [&] {
    return std::make_unique<HttpServer>(ParseEndpoint(at, kHttpPort), std::move(answer));
  });
}

}  // namespace railcast
