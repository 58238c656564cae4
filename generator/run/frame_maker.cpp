#include "generator/run/frame_maker.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/run/track_limits.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// Applies one command to the state that held before it.
struct CommandEffect {
  const ScenarioSpec& scenario;
  std::int64_t time_ns;
  CommandedRun::State& state;

  void operator()(const SetSpeed& command) {
    ChangeSpeed(command.speed_mps, command.acceleration_mps2);
  }
  void operator()(const Brake& command) { ChangeSpeed(0.0, command.deceleration_mps2); }
  void operator()(const Stop&) { ChangeSpeed(0.0, kEmergencyDeceleration_mps2); }
  void operator()(const PlaceObject& command) {
    state.world = state.world->WithObject(command.object, time_ns);
  }
  void operator()(const RemoveObject& command) {
    state.world = state.world->WithoutObject(command.name);
  }
  void operator()(const SetWeather& command) {
    SimulatorSpec trial;
    UseWeather(scenario, command.weather, trial);
    state.weather = command.weather;
  }
  void operator()(const Step&) {}
  void operator()(const railcast::Reset&) {}

 private:
  void ChangeSpeed(double speed_mps, double acceleration_mps2) {
    state.world = state.world->WithVehicleSpeed(time_ns, speed_mps, acceleration_mps2);
  }
};

}  // namespace

CommandedRun::CommandedRun(ScenarioSpec scenario, std::vector<Simulator*> simulators)
    : scenario_(std::move(scenario)), simulators_(std::move(simulators)) {
  // Every simulator of a scenario has the world that MakeWorld returns and shares its ownership.
  auto world = std::dynamic_pointer_cast<const RailWorld>(simulators_.front()->shared_world());
  Check(world != nullptr, "the world of a scenario is a railway");
  own_ = {0, std::move(world), scenario_.weather};
  Reset();
}

void CommandedRun::Reset() {
  states_ = {own_};
}

void CommandedRun::Apply(const Command& command, std::int64_t time_ns) {
  if (std::holds_alternative<railcast::Reset>(command)) return Reset();
  Check(time_ns >= states_.back().time_ns, "commands come by rising time");
  if (std::holds_alternative<Step>(command)) return;
  State changed = states_.back();
  changed.time_ns = time_ns;
  AtPlace("command: ", [&] { std::visit(CommandEffect{scenario_, time_ns, changed}, command); });
  // If several commands come at one time, only the last state holds: no frame sees those before it.
  if (states_.back().time_ns == time_ns) states_.pop_back();
  states_.push_back(std::move(changed));
}

void CommandedRun::Apply(const std::vector<TimedCommand>& commands) {
  for (const TimedCommand& timed : commands) {
    AtPlace("at " + SecondsText(timed.time_ns) + ": ",
            [&] { Apply(timed.command, timed.time_ns); });
  }
}

void CommandedRun::ForgetBefore(std::int64_t time_ns) {
  const auto holds = states_.begin() + (&StateAt(time_ns) - states_.data());
  states_.erase(states_.begin(), holds);
}

const CommandedRun::State& CommandedRun::StateAt(std::int64_t time_ns) const {
  const auto after =
      std::upper_bound(states_.begin() + 1, states_.end(), time_ns,
                       [](std::int64_t time, const State& state) { return time < state.time_ns; });
  return *(after - 1);
}

Simulator& CommandedRun::At(std::size_t sensor, std::uint32_t frame_index) {
  Simulator& simulator = *simulators_.at(sensor);
  const State& state = StateAt(simulator.pattern().StampNs(frame_index));
  CheckStaysOnTracks(scenario_, *state.world, simulator.pattern(), frame_index, frame_index);
  simulator.UseWorld(state.world);
  if (simulator.spec().detector.weather != state.weather) {
    SimulatorSpec spec = simulator.spec();
    UseWeather(scenario_, state.weather, spec);
    simulator.Use(spec);
  }
  return simulator;
}

}  // namespace railcast
