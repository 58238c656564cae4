#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/certify/certifier.h"
#include "core/io/run/object_survey.h"
#include "core/scenario/command_log.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/motion_sensors.h"
#include "railcast/rail_world.h"
#include "railcast/rigid_motion.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// What is written of one frame. Its memory is reused.
struct MadeFrame {
  Frame frame;
  std::vector<ObjectInFrame> objects;  ///< The records of the world's objects.
  CameraImage image;
  bool has_image = false;  ///< Whether the camera has an image of this frame.
  RigidMotion vehicle;     ///< At the stamp.
  MotionSamples motion;    ///< Samples in the time of this frame; only with the first sensor.
  std::optional<FrameCertificate> certificate;  ///< If the sensor's frames are certified.
};

/// Makes one frame. Called once, by any thread, while other frames may be made.
using FrameJob = std::function<void(MadeFrame& made)>;

/// Makes the frames of a scenario's sensors, whose simulators it owns. Commands change the
/// simulation at the boundaries of frames: a command holds for the frames stamped at its time or
/// later. So a frame is a function of the scenario, its index and the commands, whichever frames
/// were made before, and a log of the commands reproduces it.
class FrameMaker {
 public:
  /// @param num_threads,isa As MakeSimulators() takes them.
  /// @throws InputError as MakeSimulators() does.
  FrameMaker(const ScenarioSpec& scenario, int num_threads, const std::string& isa = {});
  /// @param simulators Of the scenario, as MakeSimulators() makes them.
  FrameMaker(ScenarioSpec scenario, std::vector<std::unique_ptr<Simulator>> simulators);

  /// Applies a command. Step changes nothing; Reset is the same as Reset().
  /// @pre time_ns >= 0, and not less than that of the command before it unless that is Reset.
  /// @throws InputError "command: /object/track: rule (got value)"; nothing has changed then.
  void Apply(const Command& command, std::int64_t time_ns);
  /// Applies the commands of a log; error lines begin with "at 1.5 s: ".
  void Apply(const std::vector<TimedCommand>& commands);
  /// Returns to the scenario without commands; times begin anew.
  void Reset();

  /// Drops states that hold only for frames stamped before `time_ns`, so that memory does not grow
  /// over hours.
  /// @pre Those frames are not requested any more.
  void ForgetBefore(std::int64_t time_ns);

  /// Returns the sensor's simulator with the world and the weather of that frame, valid until At()
  /// is called for that sensor again.
  /// @throws InputError if the vehicle or an object leaves its track in that frame.
  [[nodiscard]] Simulator& At(std::size_t sensor, std::uint32_t frame_index);

  /// Begins a frame with the records of its objects and, of the first sensor, the camera's image
  /// and the motion sensors' samples. Frames are begun in order, by one thread at a time.
  /// @return What makes it.
  /// @throws InputError as At() does.
  [[nodiscard]] FrameJob Begin(std::size_t sensor, std::uint32_t frame_index);

  /// Has the sensor's frames certified from now on, with the effects that its simulator has now.
  /// @throws InputError as Certifier does.
  const Certifier& Certify(std::size_t sensor, double cost_share);

  /// Scans a frame, and finds what it shows of the world's objects. Thread-safe.
  /// @param begun The frame as the sensor's simulator began it.
  [[nodiscard]] std::vector<ObjectInFrame> ScanAndDescribe(std::size_t sensor,
                                                           BegunFrame& begun,
                                                           Frame& frame);

  /// The samples of the scenario's motion sensors in the time of a begun frame; none if it has no
  /// motion sensors. Thread-safe.
  /// @param begun The frame as the first sensor's simulator began it.
  [[nodiscard]] MotionSamples SampleMotion(BegunFrame& begun) const;

  /// How many frames are made at once where none depends on another: one for each thread, and one
  /// that waits for its turn to be written. Frames of a million firings, or with images of millions
  /// of pixels, keep all threads busy by themselves and take much memory: they are made one after
  /// another. So are frames that commands change.
  [[nodiscard]] std::size_t NumAtOnce() const;

  /// Checks that nothing leaves its track in a sensor's frames, whatever commands made of the world
  /// by then.
  /// @throws InputError as CheckStaysOnTracks() of a scenario's world.
  void CheckStaysOnTracks(std::size_t sensor,
                          std::uint32_t first_frame,
                          std::uint32_t last_frame) const;

  /// The state that holds for frames stamped at `time_ns` or later.
  struct State {
    std::int64_t time_ns{};  ///< The time from which it holds.
    std::shared_ptr<const RailWorld> world;
    WeatherSpec weather;
  };
  [[nodiscard]] const State& StateAt(std::int64_t time_ns) const;
  /// All states in memory, by rising time; of several at one time only the last is kept.
  [[nodiscard]] const std::vector<State>& states() const { return states_; }

  [[nodiscard]] const ScenarioSpec& scenario() const { return scenario_; }
  [[nodiscard]] const LabelTable& labels() const { return labels_; }
  [[nodiscard]] std::size_t num_sensors() const { return simulators_.size(); }
  /// In the state of the frame that At() was asked for last.
  [[nodiscard]] Simulator& simulator(std::size_t sensor) const { return *simulators_.at(sensor); }
  [[nodiscard]] const ScanPattern& pattern(std::size_t sensor) const {
    return simulators_.at(sensor)->pattern();
  }

 private:
  ScenarioSpec scenario_;
  LabelTable labels_;
  std::vector<std::unique_ptr<Simulator>> simulators_;
  std::vector<State> states_;  ///< The first is the scenario's own state until it is dropped.
  State own_;
  std::optional<Camera> camera_;
  std::uint32_t frames_per_image_ = 1;
  std::optional<MotionSensors> motion_sensors_;
  /// By sensor. Each survey remembers what it measured, so that each thread has its own.
  struct Surveys;
  std::shared_ptr<Surveys> surveys_;
  std::map<std::size_t, Certifier> certifiers_;  ///< By sensor.
};

}  // namespace railcast
