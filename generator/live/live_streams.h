#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "generator/live/camera_stream.h"
#include "generator/live/live_run.h"
#include "generator/live/sensor_stream.h"
#include "generator/run/frame_maker.h"
#include "railcast/frame.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// All sensors of one vehicle and the destinations of their frames; they share one world and one
/// clock. If the scenario has a camera with receivers, its images accompany the frames of the first
/// sensor, unless nothing is sent.
class LiveStreams {
 public:
  /// @param streams One for each of the scenario's sensors, in its order.
  /// @param run Distinguishes this start from others in protocol railcast.
  /// @param isa As MakeSimulators() takes it.
  /// @param ends_ns If given, the simulation time until which nothing may leave its track.
  /// @throws InputError as MakeSimulators(), CheckStaysOnTracks() and SensorStream do, in this
  ///   order, so that no file is created for a run that cannot be made.
  LiveStreams(const ScenarioSpec& scenario,
              const std::vector<SensorStreamSpec>& streams,
              int num_threads,
              std::uint32_t run,
              const std::string& isa,
              std::optional<std::int64_t> ends_ns = std::nullopt);

  [[nodiscard]] FrameMaker& maker() { return maker_; }

  /// Does slow work beforehand, so that it makes no frame late: builds the scene of frame 0 and, if
  /// the scenario asks for it, makes fidelity auto's choice. From now on the building of scenes is
  /// watched as by WatchBuilding(). Returns early if stopped.
  /// @pre No frame has been made.
  void WarmUp(const std::function<bool()>& is_stopped);

  /// Returns the sensors for RunLive(), the camera after them; valid as long as this object.
  [[nodiscard]] std::vector<LiveSensor> Sensors();

  /// Restarts all sensors with frame 0.
  /// @pre The maker has been reset.
  void Restart();

  /// Completes the capture files.
  void Finish();
  /// Returns a line for each capture that ended early. Thread-safe.
  [[nodiscard]] std::vector<std::string> CaptureFaults() const;
  /// Returns the numbers of datagrams delivered, in the order of Sensors().
  /// @pre Nothing is being sent.
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const;

 private:
  void ChooseFidelity();
  void MakeFrame(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams);

  FrameMaker maker_;
  std::vector<std::unique_ptr<SensorStream>> streams_;
  std::unique_ptr<CameraStream> camera_;  ///< Null if no images are sent.
  std::vector<Frame> frames_;
  std::uint32_t run_;
};

}  // namespace railcast
