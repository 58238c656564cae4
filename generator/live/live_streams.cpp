#include "generator/live/live_streams.h"

#include <utility>

#include "generator/run/stop_signal.h"
#include "generator/run/stopping.h"
#include "generator/run/track_limits.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

std::vector<Simulator*> Pointers(const std::vector<std::unique_ptr<Simulator>>& simulators) {
  std::vector<Simulator*> pointers;
  for (const auto& simulator : simulators) pointers.push_back(simulator.get());
  return pointers;
}

}  // namespace

LiveStreams::LiveStreams(const ScenarioSpec& scenario,
                         const std::vector<SensorStreamSpec>& streams,
                         int num_threads,
                         std::uint32_t run,
                         const std::string& isa,
                         std::optional<std::int64_t> ends_ns)
    : simulators_(MakeSimulators(scenario, num_threads, isa)),
      commanded_(scenario, Pointers(simulators_)),
      frames_(streams.size()),
      run_(run) {
  for (const auto& simulator : simulators_) {
    if (!ends_ns) break;
    CheckStaysOnTracks(commanded_, simulator->pattern(), 0,
                       LastFrameBefore(simulator->pattern(), *ends_ns));
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const ScenarioSpec alone = PickSensor(scenario, streams[i].name);
    streams_.push_back(
        std::make_unique<SensorStream>(streams[i], alone, simulators_[i]->pattern(), run));
  }
  const SensorStreamSpec& first = streams.front();
  if (first.to.empty() || ImageReceivers(scenario).empty()) return;
  camera_ =
      std::make_unique<CameraStream>(PickSensor(scenario, first.name), first.has_offload, run);
}

void LiveStreams::ChooseFidelity() {
  if (commanded_.scenario().fidelity != Fidelity::kAuto) return;
  for (std::size_t i = 0; i < simulators_.size(); ++i) {
    const ScenarioSpec alone = PickSensor(commanded_.scenario(), streams_[i]->spec().name);
    static_cast<void>(UseChosenFidelity(*simulators_[i], alone));
  }
}

void LiveStreams::WarmUp(const std::function<bool()>& is_stopped) {
  const auto watch = [&](bool has_deadline) {
    for (const auto& simulator : simulators_) WatchBuilding(*simulator, is_stopped, has_deadline);
  };
  watch(true);
  try {
    ChooseFidelity();
    for (std::size_t i = 0; i < frames_.size(); ++i) commanded_.At(i, 0).Scan(0, frames_[i]);
  } catch (const RunStopped&) {
    // The run has been stopped and ends without a frame.
  }
  // From here on a stop must still finish captures and send datagrams.
  UseStopDeadline(false);
  watch(false);
}

void LiveStreams::MakeFrame(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams) {
  Simulator& simulator = commanded_.At(sensor, frame);
  simulator.Scan(frame, frames_[sensor]);
  // On the threads that scan.
  simulator.Execute([&] { streams_[sensor]->Encode(frames_[sensor], datagrams); });
}

std::vector<LiveSensor> LiveStreams::Sensors() {
  std::vector<LiveSensor> sensors;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const ScanPattern& pattern = simulators_[i]->pattern();
    SensorStream& stream = *streams_[i];
    sensors.push_back(
        {.name = stream.spec().name,
         .period_ns = pattern.PeriodNs(),
         .stamp_ns = [&pattern](std::uint32_t frame) { return pattern.StampNs(frame); },
         .make = [this, i](std::uint32_t frame,
                           Datagrams& datagrams) { MakeFrame(i, frame, datagrams); },
         .send = [&stream](
                     const Datagrams& datagrams,
                     std::span<const Datagrams::Item> items) { stream.Send(datagrams, items); }});
  }
  if (!camera_) return sensors;
  const ScanPattern& pattern = simulators_.front()->pattern();
  CameraStream& camera = *camera_;
  sensors.push_back(
      {.name = camera.name(),
       .period_ns = pattern.StampNs(camera.FrameOf(1)) - pattern.StampNs(0),
       .latency_ns = pattern.PeriodNs(),  // As the frame of the same stamp.
       .stamp_ns = [&](std::uint32_t image) { return pattern.StampNs(camera.FrameOf(image)); },
       .make =
           [this](std::uint32_t image, Datagrams& datagrams) {
             camera_->Make(commanded_.At(0, camera_->FrameOf(image)), image, datagrams);
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
}

void LiveStreams::Finish() {
  for (const auto& stream : streams_) stream->Finish();
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
  if (camera_) delivered.push_back(camera_->delivered());
  return delivered;
}

}  // namespace railcast
