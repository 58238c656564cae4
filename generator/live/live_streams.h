#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/frame.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"
#include "generator/commanded_run.h"
#include "generator/live/live_run.h"
#include "generator/live/sensor_stream.h"

namespace railcast {

/// All sensors of one vehicle and where their frames go: one world, one clock.
class LiveStreams {
 public:
  /// @param streams Of the scenario's sensors, in its order.
  /// @param run Tells this start from others in protocol railcast.
  /// @param isa As MakeSimulators() takes it.
  /// @param ends_ns Where given, the simulation time until which nothing may leave its track.
  /// @throws InputError as MakeSimulators(), CheckStaysOnTracks() and SensorStream do, in this
  ///   order: no file is begun for a run that cannot be made.
  LiveStreams(const ScenarioSpec& scenario,
              const std::vector<SensorStreamSpec>& streams,
              int num_threads,
              std::uint32_t run,
              const std::string& isa,
              std::optional<std::int64_t> ends_ns = std::nullopt);

  [[nodiscard]] CommandedRun& commanded_run() { return commanded_; }

  /// Does beforehand what takes long, so that it makes no frame late: builds the scene of frame 0
  /// and, if the scenario asks for it, makes fidelity auto's choice. Watches from now on as
  /// WatchBuilding() does. It may end early. @pre Nothing has been made.
  void WarmUp(const std::function<bool()>& is_stopped);

  /// For RunLive(); valid as long as this.
  [[nodiscard]] std::vector<LiveSensor> Sensors();

  /// All sensors begin anew with frame 0. The commanded run must have been reset.
  void Restart();

  /// Completes capture files.
  void Finish();
  /// A line for each capture that ended early. Thread-safe.
  [[nodiscard]] std::vector<std::string> CaptureFaults() const;
  /// By sensor. @pre Nothing is being sent.
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const;

 private:
  void ChooseFidelity();
  void MakeFrame(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams);

  std::vector<std::unique_ptr<Simulator>> simulators_;
  CommandedRun commanded_;
  std::vector<std::unique_ptr<SensorStream>> streams_;
  std::vector<Frame> frames_;
  std::uint32_t run_;
};

}  // namespace railcast
