#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scenario/command_log.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// A scenario's simulation that commands change at the boundaries of frames: a command holds for
/// the frames stamped at its time or later. So a frame is a function of the scenario, its index and
/// the commands, whichever frames were made before, and a log of the commands reproduces it.
class CommandedRun {
 public:
  /// @param simulators Those of the scenario's sensors, on one world (MakeSimulators). They must
  ///   outlive the run and be used through At() only.
  CommandedRun(ScenarioSpec scenario, std::vector<Simulator*> simulators);

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
  [[nodiscard]] std::size_t num_sensors() const { return simulators_.size(); }

 private:
  [[nodiscard]] State After(const State& state, const Command& command, std::int64_t time_ns) const;

  ScenarioSpec scenario_;
  std::vector<Simulator*> simulators_;
  std::vector<State> states_;  ///< The first is the scenario's own state until it is dropped.
  State own_;
};

}  // namespace railcast
