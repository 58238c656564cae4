#include "generator/live/live_streams.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/stream/stream_encoder.h"
#include "core/program/stop_signals.h"
#include "core/scenario/sensors.h"
#include "core/scenario/track_limits.h"
#include "generator/live/live_extras.h"
#include "generator/run/stopping.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Whether a capture of what is sent there holds packets of IPv6.
bool GoesByIpv6(const std::vector<Endpoint>& to) {
  return !to.empty() &&
         std::ranges::none_of(to, [](const Endpoint& each) { return each.address.is_ipv4(); });
}

}  // namespace

std::vector<Endpoint> ImageReceivers(const ScenarioSpec& scenario) {
  std::vector<Endpoint> receivers;
  if (!scenario.camera) return receivers;
  for (const std::string& to : scenario.camera->udp) {
    receivers.push_back(AtPlace("/camera/udp: ", [&] { return ParseEndpoint(to, 0); }));
  }
  return receivers;
}

bool HasReaders(const SensorStreamSpec& stream) {
  return stream.protocol == Protocol::kRos2 || !stream.to.empty();
}

CameraStream::CameraStream(const ScenarioSpec& scenario,
                           const SendOptions& sending,
                           std::uint32_t run)
    : camera_(*MakeCamera(scenario)),
      num_frames_(FramesPerImage(scenario)),
      run_(run),
      sender_(ImageReceivers(scenario), kVelodynePositionPort, sending) {}

void CameraStream::Make(Simulator& simulator, std::uint32_t image, Datagrams& datagrams) {
  const std::uint32_t frame = FrameOf(image);
  camera_.Render(simulator, frame, image_);
  // Spread over a period of the sensor, as its own datagrams are.
  const std::int64_t period_ns = simulator.pattern().PeriodNs();
  EncodeImageDatagrams(
      image_, camera_.spec(),
      {.run = run_, .frame = frame, .spread_ns = period_ns, .clock_ahead_ns = clock_ahead_ns_},
      datagrams);
}

SensorStream::SensorStream(SensorStreamSpec spec,
                           const ScenarioSpec& scenario,
                           const ScanPattern& pattern,
                           std::uint32_t run)
    : spec_(std::move(spec)),
      lidar_(scenario.lidar),
      output_(scenario.output),
      pattern_(pattern),
      encoder_(MakeEncoder(run)) {
  if (!spec_.to.empty()) {
    sender_ = AtPlace("receivers of " + spec_.name + ": ", [&] {
      return std::make_unique<UdpSender>(spec_.to, PositionPort(spec_.protocol).value_or(0),
                                         spec_.sending);
    });
  }
  if (spec_.pcap) {
    capture_ = LiveExtras::Get().packets.value().open_capture(*spec_.pcap, spec_.protocol,
                                                              GoesByIpv6(spec_.to));
  }
}

std::unique_ptr<FrameEncoder> SensorStream::MakeEncoder(std::uint32_t run) const {
  if (spec_.protocol != Protocol::kRailcast) {
    return LiveExtras::Get().packets.value().make_encoder(spec_.protocol, lidar_);
  }
  return std::make_unique<StreamEncoder>(pattern_, StreamSpec{.fields = spec_.fields,
                                                              .has_all_slots = spec_.has_all_slots,
                                                              .output = output_,
                                                              .sensor = spec_.sensor,
                                                              .run = run});
}

void SensorStream::Restart(std::uint32_t run) {
  encoder_ = MakeEncoder(run);
}

void SensorStream::SetUtcAhead(std::int64_t ahead_ns) {
  if (spec_.clock == StampClock::kSimulated) return;
  const bool is_ours = spec_.protocol == Protocol::kRailcast;  // Whose stamps begin in 1970.
  encoder_->SetClockAhead(ahead_ns + (spec_.clock == StampClock::kTai ? kTaiAhead_ns : 0) +
                          (is_ours ? kSimulationEpoch_s * kNsPerS : 0));
  // Later, another thread may be writing.
  if (!has_capture_clock_)
    UseCapture([&](DatagramFile& capture) { capture.SetClockAhead(ahead_ns); });
  has_capture_clock_ = true;
}

void SensorStream::Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  if (sender_) sender_->Send(datagrams, items);
  UseCapture([&](DatagramFile& capture) {
    capture.Write(datagrams, items);
    num_captured_ += items.size();
  });
}

void SensorStream::Finish() {
  UseCapture([](DatagramFile& capture) { capture.Finish(); });
}

template <typename Work>
void SensorStream::UseCapture(const Work& work) {
  if (!capture_) return;
  try {
    work(*capture_);
  } catch (const InputError& error) {
    const std::lock_guard lock(mutex_);
    capture_fault_ = std::string(error.what()) + "; the capture ends after " +
                     std::to_string(num_captured_) + " datagrams, in " +
                     ShownPath(capture_->unfinished());
    capture_.reset();
  }
}

std::optional<std::string> SensorStream::capture_fault() const {
  const std::lock_guard lock(mutex_);
  return capture_fault_;
}

UdpSender::Counts SensorStream::delivered() const {
  return sender_ ? sender_->counts() : UdpSender::Counts{};
}

// NOLINTNEXTLINE(readability-function-size): makes one member after the other
LiveStreams::LiveStreams(const ScenarioSpec& scenario,
                         const std::vector<SensorStreamSpec>& streams,
                         int num_threads,
                         std::uint32_t run,
                         const std::string& isa,
                         std::optional<std::int64_t> ends_ns)
    : maker_(scenario, num_threads, isa), frames_(streams.size()), run_(run) {
  for (std::size_t i = 0; ends_ns && i < maker_.num_sensors(); ++i) {
    maker_.CheckStaysOnTracks(i, 0, LastFrameBefore(maker_.pattern(i), *ends_ns));
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].protocol == Protocol::kRos2) continue;
    const ScenarioSpec alone = PickSensor(scenario, streams[i].name);
    streams_.push_back(std::make_unique<SensorStream>(streams[i], alone, maker_.pattern(i), run));
  }
  const SensorStreamSpec& first = streams.front();
  if (!HasReaders(first) || ImageReceivers(scenario).empty()) return;
  camera_ = std::make_unique<CameraStream>(PickSensor(scenario, first.name), first.sending, run);
}

void LiveStreams::ChooseFidelity() {
  if (maker_.scenario().fidelity != Fidelity::kAuto) return;
  const std::vector<std::string> names = SensorNames(maker_.scenario());
  for (std::size_t i = 0; i < maker_.num_sensors(); ++i) {
    const ScenarioSpec alone = PickSensor(maker_.scenario(), names[i]);
    static_cast<void>(UseChosenFidelity(maker_.simulator(i), alone));
  }
}

void LiveStreams::WarmUp(const std::function<bool()>& is_stopped) {
  const auto watch = [&](bool has_deadline) {
    for (std::size_t i = 0; i < maker_.num_sensors(); ++i) {
      WatchBuilding(maker_.simulator(i), is_stopped, has_deadline);
    }
  };
  watch(true);
  try {
    ChooseFidelity();
    const std::vector<std::string> names = SensorNames(maker_.scenario());
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (certified_share_) {
        const ScenarioSpec alone = PickSensor(maker_.scenario(), names[i]);
        certificates_.try_emplace(names[i], maker_, i, alone, *certified_share_);
      }
      maker_.At(i, 0).Scan(0, frames_[i]);
      if (certified_share_) certificates_.at(names[i]).Try(frames_[i]);
    }
  } catch (const RunStopped&) {
    // The run has been stopped and ends without a frame.
  }
  // From here on a stop must still finish captures and send datagrams.
  UseStopDeadline(false);
  watch(false);
}

void LiveStreams::Publish(LiveTopics* topics) {
  topics_ = topics;
}

void LiveStreams::MakeFrame(SensorStream& stream, std::uint32_t frame, Datagrams& datagrams) {
  const std::size_t sensor = stream.spec().sensor;
  Simulator& simulator = maker_.At(sensor, frame);
  simulator.Scan(frame, frames_[sensor]);
  // On the threads that scan.
  simulator.Execute([&] { stream.Encode(frames_[sensor], datagrams); });
}

void LiveStreams::AddCertificates(std::vector<LiveRecord>& records) const {
  for (LiveRecord& record : records) {
    if (record.uncertified_frames) record.certificate = certificates_.at(record.name).Result();
  }
}

std::vector<LiveSensor> LiveStreams::Sensors() {
  std::vector<LiveSensor> sensors;
  for (const auto& each : streams_) {
    SensorStream& stream = *each;
    const ScanPattern& pattern = maker_.pattern(stream.spec().sensor);
    sensors.push_back(
        {.name = stream.spec().name,
         .period_ns = pattern.PeriodNs(),
         .stamp_ns = [&pattern](std::uint32_t frame) { return pattern.StampNs(frame); },
         .make = [this, &stream](std::uint32_t frame,
                                 Datagrams& datagrams) { MakeFrame(stream, frame, datagrams); },
         .send = [&stream](
                     const Datagrams& datagrams,
                     std::span<const Datagrams::Item> items) { stream.Send(datagrams, items); },
         .frame = &frames_[stream.spec().sensor]});
  }
  if (topics_ != nullptr) std::ranges::move(topics_->Sensors(), std::back_inserter(sensors));
  for (LiveSensor& sensor : sensors) {
    const auto at = certificates_.find(sensor.name);
    if (at == certificates_.end()) continue;
    sensor.certify = [&to = at->second, frame = sensor.frame] { to.Add(*frame); };
    sensor.certify_ns = at->second.tried_ns();
  }
  if (!camera_) return sensors;
  const ScanPattern& pattern = maker_.pattern(0);
  CameraStream& camera = *camera_;
  sensors.push_back(
      {.name = camera.name(),
       .period_ns = pattern.StampNs(camera.FrameOf(1)) - pattern.StampNs(0),
       .latency_ns = pattern.PeriodNs(),  // As the frame of the same stamp.
       .stamp_ns = [&](std::uint32_t image) { return pattern.StampNs(camera.FrameOf(image)); },
       .make =
           [this](std::uint32_t image, Datagrams& datagrams) {
             camera_->Make(maker_.At(0, camera_->FrameOf(image)), image, datagrams);
           },
       .send = [&camera](
                   const Datagrams& datagrams,
                   std::span<const Datagrams::Item> items) { camera.Send(datagrams, items); }});
  return sensors;
}

void LiveStreams::Restart() {
  ++run_;
  if (camera_) camera_->Restart(run_);
  for (const auto& stream : streams_) stream->Restart(run_);
  for (auto& [name, certificate] : certificates_) certificate.Restart();
}

void LiveStreams::SetClocks(std::int64_t now_ns, std::int64_t lead_ns) {
  std::int64_t first_ns = maker_.pattern(0).StampNs(0);
  for (std::size_t i = 1; i < maker_.num_sensors(); ++i) {
    first_ns = std::min(first_ns, maker_.pattern(i).StampNs(0));
  }
  // Packets count microseconds.
  const std::int64_t time_0_ns = (now_ns + lead_ns - first_ns) / kNsPerUs * kNsPerUs;
  for (const auto& stream : streams_) stream->SetUtcAhead(time_0_ns - kSimulationEpoch_s * kNsPerS);
  if (camera_) camera_->SetClockAhead(time_0_ns);
  if (topics_ != nullptr) topics_->SetClockAhead(time_0_ns);
}

void LiveStreams::Finish() {
  for (const auto& stream : streams_) stream->Finish();
  if (topics_ != nullptr) topics_->Finish();
}

std::vector<std::string> LiveStreams::CaptureFaults() const {
  std::vector<std::string> faults;
  for (const auto& stream : streams_) {
    if (auto fault = stream->capture_fault()) faults.push_back(std::move(*fault));
  }
  return faults;
}

std::vector<UdpSender::Counts> LiveStreams::Delivered() const {
  std::vector<UdpSender::Counts> delivered;
  for (const auto& stream : streams_) delivered.push_back(stream->delivered());
  if (topics_ != nullptr) std::ranges::move(topics_->Delivered(), std::back_inserter(delivered));
  if (camera_) delivered.push_back(camera_->delivered());
  return delivered;
}

}  // namespace railcast
