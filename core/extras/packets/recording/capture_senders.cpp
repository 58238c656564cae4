#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/capture_sensor.h"

namespace railcast {
namespace {

/// Datagrams from one port to another, some of which hold packets of a sensor.
struct FoundStream {
  SenderStream stream;
  std::shared_ptr<const CaptureSensor> sensor{};
  std::size_t num_packets{};
  std::size_t num_wrong{};   ///< Which do not agree with their checksums.
  std::size_t num_shared{};  ///< Which its address had sent elsewhere shortly before.
  std::size_t first{};       ///< Index among the captured of the first packet.
  std::size_t last{};
  std::size_t num_runs{};  ///< Runs of packets between which its address sent none elsewhere.

  /// Whether what the address sends elsewhere comes before or after long runs.
  [[nodiscard]] bool HasLongRuns() const {
    constexpr std::size_t kLong = 32;
    return kLong * num_runs <= num_packets;
  }
  [[nodiscard]] bool IsOfSensorOf(const FoundStream& other) const {
    const bool is_like =
        stream.from.address == other.stream.from.address && sensor->name == other.sensor->name;
    const bool is_apart =
        first > other.last || last < other.first || (HasLongRuns() && other.HasLongRuns());
    const bool is_shared =
        2 * (num_shared + other.num_shared) >= std::min(num_packets, other.num_packets);
    return is_like && (is_apart || is_shared);
  }
};

/// Tells which streams of a capture are whose.
class StreamTable {
 public:
  explicit StreamTable(SensorFinder& finder) : finder_(finder) {}

  void Add(const CapturedDatagram& datagram) {
    FoundStream& found = Find(StreamOf(datagram));
    if (!found.sensor) found.sensor = LookAt(datagram.payload);
    if (!found.sensor || datagram.payload.size() < found.sensor->packet_size) return;
    if (found.num_packets++ == 0) found.first = datagram.packet;
    found.last = datagram.packet;
    found.num_wrong += datagram.has_wrong_checksum;
    const Sent sent{
        &found, std::hash<std::string_view>{}({datagram.payload.data(), datagram.payload.size()})};
    found.num_shared += std::ranges::any_of(recent_, [&](const Sent& other) {
      return other.hash == sent.hash && other.stream != &found &&
             other.stream->stream.from.address == found.stream.from.address;
    });
    const auto before = std::find_if(recent_.rbegin(), recent_.rend(), [&](const Sent& other) {
      return other.stream->stream.from.address == found.stream.from.address;
    });
    found.num_runs += before == recent_.rend() || before->stream != &found;
    recent_.push_back(sent);
    constexpr std::size_t kMostRecent = 64;
    if (recent_.size() > kMostRecent) recent_.pop_front();
  }

  [[nodiscard]] std::vector<CaptureSensor> Sensors() const {
    std::vector<const FoundStream*> whole;  // The first stream of each sensor.
    std::vector<CaptureSensor> sensors;
    for (const FoundStream& found : streams_) {
      if (!found.sensor) continue;
      const auto same = std::ranges::find_if(
          whole, [&](const FoundStream* other) { return found.IsOfSensorOf(*other); });
      const auto place = static_cast<std::size_t>(same - whole.begin());
      if (same == whole.end()) {
        whole.push_back(&found);
        sensors.push_back(*found.sensor);
      }
      sensors[place].streams.push_back(found.stream);
      if (2 * found.num_wrong > found.num_packets) sensors[place].ignores_checksums = true;
    }
    return sensors;
  }

 private:
  struct Sent {
    const FoundStream* stream{};
    std::size_t hash{};
  };

  /// Streams of one kind of sensor share it, for there may be very many.
  std::shared_ptr<const CaptureSensor> LookAt(std::span<const char> payload) {
    auto sensor = finder_.Look(payload);
    if (!sensor) return nullptr;
    const auto known =
        std::ranges::find(models_, sensor->name, [](const auto& model) { return model->name; });
    if (known != models_.end()) return *known;
    return models_.emplace_back(std::make_shared<const CaptureSensor>(std::move(*sensor)));
  }

  FoundStream& Find(const SenderStream& stream) {
    const auto& [from, to] = stream;
    const auto [known, is_new] = places_.try_emplace(
        {from.address.bytes, from.port, to.address.bytes, to.port}, streams_.size());
    return is_new ? streams_.emplace_back(FoundStream{stream}) : streams_[known->second];
  }

  SensorFinder& finder_;
  using Octets = std::array<std::uint8_t, 16>;
  std::vector<std::shared_ptr<const CaptureSensor>> models_;
  std::deque<FoundStream> streams_;
  std::map<std::tuple<Octets, std::uint16_t, Octets, std::uint16_t>, std::size_t> places_;
  std::deque<Sent> recent_;
};

/// Says as much of where a sensor sends from and to as tells it from the others.
std::string AddressIn(const std::vector<CaptureSensor>& sensors, const CaptureSensor& sensor) {
  const SenderStream& own = sensor.streams.front();
  const auto is_only = [&](auto key) {
    return std::ranges::count_if(sensors, [&](const CaptureSensor& other) {
             return key(other.streams.front()) == key(own);
           }) == 1;
  };
  if (is_only([](const SenderStream& stream) { return stream.from.address.bytes; })) {
    return AddressText(own.from.address);
  }
  const bool has_own_port = is_only([](const SenderStream& stream) {
    return std::pair(stream.from.address.bytes, stream.from.port);
  });
  return EndpointText(has_own_port ? own.from : Endpoint{own.from.address, own.to.port});
}

/// The sensors of that name; if there is none, those that send from there, else to that port.
std::vector<CaptureSensor> Chosen(const std::vector<CaptureSensor>& sensors,
                                  const Endpoint& chosen) {
  std::vector<CaptureSensor> found;
  const auto take = [&](auto is_chosen) {
    if (found.empty()) std::ranges::copy_if(sensors, std::back_inserter(found), is_chosen);
  };
  const auto take_streams = [&](auto is_chosen) {
    take([&](const CaptureSensor& sensor) {
      return std::ranges::any_of(sensor.streams, is_chosen);
    });
  };
  take([&](const CaptureSensor& sensor) { return sensor.address == EndpointText(chosen); });
  take_streams([&](const SenderStream& stream) { return chosen.Covers(stream.from); });
  take_streams([&](const SenderStream& stream) {
    return chosen.Covers({stream.from.address, stream.to.port});
  });
  return found;
}

/// Whether the sensor is an Ouster's whose packets do not state its serial number.
bool IsLegacyOuster(const CaptureSensor& sensor) {
  const auto* const decoder = std::get_if<OusterDecoder>(&sensor.decoder);
  return decoder != nullptr && decoder->layout().is_legacy();
}

std::string SendersText(const std::vector<CaptureSensor>& sensors) {
  std::string names;
  for (const CaptureSensor& sensor : sensors) {
    names += (names.empty() ? "" : ", ") + sensor.name + " at " + sensor.address;
  }
  return NumberText(sensors.size()) + (sensors.size() == 1 ? " sensor: " : " sensors: ") + names;
}

}  // namespace

SenderStream StreamOf(const CapturedDatagram& datagram) {
  return {{datagram.source_address, datagram.source_port},
          {datagram.destination_address, datagram.destination_port}};
}

std::vector<CaptureSensor> FindSensors(const DatagramPlace& place) {
  const auto datagrams = place.open();
  const CaptureMetadata& beside = place.beside;
  SensorFinder finder(beside);
  StreamTable table(finder);
  try {
    while (const auto datagram = datagrams->Next()) table.Add(*datagram);
  } catch (const InputError&) {
    // What comes before is read, and whoever reads on hears of it.
    if (table.Sensors().empty()) throw;
  }
  std::vector<CaptureSensor> sensors = table.Sensors();
  for (CaptureSensor& sensor : sensors) sensor.address = AddressIn(sensors, sensor);
  if (!sensors.empty()) return sensors;
  const std::string name = ShownPath(place.source);
  if (finder.has_seen_ouster() && !beside.fault.empty()) throw InputError(beside.fault);
  if (!finder.ouster_refusal().empty()) {
    throw InputError(name + ": packets are not of the sensor of " + ShownPath(beside.file) + ": " +
                     finder.ouster_refusal());
  }
  throw InputError(name + ": must be a capture of " + ReadableSensorsText() + " (" +
                   finder.Findings(datagrams->remarks()) + ")");
}

CaptureSensor FindSensor(const DatagramPlace& place) {
  std::vector<CaptureSensor> sensors = FindSensors(place);
  std::vector<CaptureSensor> chosen = place.sensor ? Chosen(sensors, *place.sensor) : sensors;
  const std::string holds = ShownPath(place.source) + ": holds " + SendersText(sensors);
  if (chosen.size() == 1 && IsLegacyOuster(chosen.front()) && !place.beside.is_named &&
      std::ranges::count_if(sensors, &IsLegacyOuster) > 1) {
    throw InputError(holds + "; their packets do not say whose metadata " +
                     ShownPath(place.beside.file) + " has: CAPTURE:METADATA:ADDRESS does");
  }
  if (chosen.size() == 1) return std::move(chosen.front());
  if (!place.sensor || chosen.size() > 1) throw InputError(holds + "; --sensor picks one");
  throw InputError(
      holds + "; must be one of them (got " +
      (place.sensor->port == 0 ? AddressText(place.sensor->address) : EndpointText(*place.sensor)) +
      ")");
}

}  // namespace railcast
