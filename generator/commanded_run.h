#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/rail/rail_world.h"
#include "core/scenario/command_log.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// A scenario's simulation that commands change at the boundaries of frames: a command holds for
/// the frames stamped at its time or later. So a frame is a function of the scenario, its index and
/// the commands, whichever frames were made before, and a log of the commands makes it again.
class CommandedRun {
 public:
  /// @param simulators Of the scenario's sensors, on one world (MakeSimulators); they must outlive
  ///   the run and be used through At() only.
  CommandedRun(ScenarioSpec scenario, std::vector<Simulator*> simulators);

  /// Lets a command take effect. Step changes nothing; Reset is Reset().
  /// @pre time_ns >= 0, and not less than that of the command before it unless that is Reset.
  /// @throws InputError "command: /object/track: rule (got value)"; nothing has changed then.
  void Apply(const Command& command, std::int64_t time_ns);
  /// The same of a log; its lines begin with "at 1.5 s: ".
  void Apply(const std::vector<TimedCommand>& commands);
  /// Back to the scenario alone; times begin anew.
  void Reset();
  /// Forgets what holds for frames stamped before `time_ns` only, so that a run of hours does not
  /// grow. @pre Those frames are not asked for any more.
  void ForgetBefore(std::int64_t time_ns);

  /// The sensor's simulator with the world and the weather of that frame, until At() is called
  /// for that sensor again.
  /// @throws InputError if the vehicle or an object leaves its track in that frame.
  [[nodiscard]] Simulator& At(std::size_t sensor, std::uint32_t frame_index);

  /// What holds for frames stamped at `time_ns`.
  struct State {
    std::int64_t time_ns{};  ///< Since when.
    std::shared_ptr<const RailWorld> world;
    WeatherSpec weather;
  };
  [[nodiscard]] const State& StateAt(std::int64_t time_ns) const;
  /// All that is remembered, by rising time; of several at one time the last holds.
  [[nodiscard]] const std::vector<State>& states() const { return states_; }

  [[nodiscard]] const ScenarioSpec& scenario() const { return scenario_; }
  [[nodiscard]] std::size_t num_sensors() const { return simulators_.size(); }

 private:
  [[nodiscard]] State After(const State& state, const Command& command, std::int64_t time_ns) const;

  ScenarioSpec scenario_;
  std::vector<Simulator*> simulators_;
  std::vector<State> states_;  ///< The first is the scenario's own, until it is forgotten.
  State own_;
};

}  // namespace railcast
