#pragma once

#include <cstdint>
#include <memory>
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
  /// @throws InputError as MakeSimulators() and SensorStream do.
  LiveStreams(const ScenarioSpec& scenario,
              const std::vector<SensorStreamSpec>& streams,
              int num_threads,
              std::uint32_t run);

  [[nodiscard]] CommandedRun& commanded_run() { return commanded_; }

  /// Does what happens once and takes long, so that it makes no frame late: builds the scene of
  /// frame 0, and fidelity auto's choice. @pre Nothing has been made.
  void WarmUp();

  /// For RunLive(); valid as long as this.
  [[nodiscard]] std::vector<LiveSensor> Sensors();

  /// All sensors begin anew with frame 0. The commanded run must have been reset.
  void Restart();

  /// Completes capture files. @throws InputError if the system refuses.
  void Finish();
  /// By sensor. @pre Nothing is being sent.
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const;

 private:
  void MakeFrame(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams);

  std::vector<std::unique_ptr<Simulator>> simulators_;
  CommandedRun commanded_;
  std::vector<std::unique_ptr<SensorStream>> streams_;
  std::vector<Frame> frames_;
  std::uint32_t run_;
};

}  // namespace railcast
