#include "generator/run/frame_maker.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <deque>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/track_limits.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

/// Applies one command to the state that held before it.
struct CommandEffect {
  const ScenarioSpec& scenario;
  std::int64_t time_ns;
  FrameMaker::State& state;

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

struct FrameMaker::Surveys {
  std::deque<tbb::enumerable_thread_specific<CurrentSurvey>> of_sensors;
};

FrameMaker::FrameMaker(const ScenarioSpec& scenario, int num_threads, const std::string& isa)
    : FrameMaker(scenario, MakeSimulators(scenario, num_threads, isa)) {}

FrameMaker::FrameMaker(ScenarioSpec scenario, std::vector<std::unique_ptr<Simulator>> simulators)
    : scenario_(std::move(scenario)),
      labels_(scenario_.labels),
      simulators_(std::move(simulators)),
      surveys_(std::make_shared<Surveys>()) {
  surveys_->of_sensors.resize(simulators_.size());
  // Every simulator of a scenario has the world that MakeWorld returns and shares its ownership.
  auto world = std::dynamic_pointer_cast<const RailWorld>(simulators_.front()->shared_world());
  Check(world != nullptr, "the world of a scenario is a railway");
  own_ = {0, std::move(world), scenario_.weather};
  Reset();
  motion_sensors_ = MakeMotionSensors(scenario_, *own_.world);
  if (!scenario_.camera) return;
  const ScenarioSpec first = PickSensor(scenario_, SensorNames(scenario_).front());
  camera_ = MakeCamera(first);
  frames_per_image_ = FramesPerImage(first);
}

void FrameMaker::Reset() {
  states_ = {own_};
}

void FrameMaker::Apply(const Command& command, std::int64_t time_ns) {
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

void FrameMaker::Apply(const std::vector<TimedCommand>& commands) {
  for (const TimedCommand& timed : commands) {
    AtPlace("at " + SecondsText(timed.time_ns) + ": ",
            [&] { Apply(timed.command, timed.time_ns); });
  }
}

void FrameMaker::ForgetBefore(std::int64_t time_ns) {
  const auto holds = states_.begin() + (&StateAt(time_ns) - states_.data());
  states_.erase(states_.begin(), holds);
}

const FrameMaker::State& FrameMaker::StateAt(std::int64_t time_ns) const {
  const auto after =
      std::upper_bound(states_.begin() + 1, states_.end(), time_ns,
                       [](std::int64_t time, const State& state) { return time < state.time_ns; });
  return *(after - 1);
}

Simulator& FrameMaker::At(std::size_t sensor, std::uint32_t frame_index) {
  Simulator& simulator = *simulators_.at(sensor);
  const State& state = StateAt(simulator.pattern().StampNs(frame_index));
  railcast::CheckStaysOnTracks(scenario_, *state.world, simulator.pattern(), frame_index,
                               frame_index);
  simulator.UseWorld(state.world);
  if (simulator.spec().detector.weather != state.weather) {
    SimulatorSpec spec = simulator.spec();
    UseWeather(scenario_, state.weather, spec);
    simulator.Use(spec);
  }
  return simulator;
}

FrameJob FrameMaker::Begin(std::size_t sensor, std::uint32_t frame_index) {
  Simulator& simulator = At(sensor, frame_index);
  const bool has_image = camera_ && sensor == 0 && frame_index % frames_per_image_ == 0;
  const std::int64_t stamp_ns = simulator.pattern().StampNs(frame_index);
  const RigidMotion vehicle = StateAt(stamp_ns).world->VehicleMotion(stamp_ns);
  return [this, sensor, &simulator, begun = simulator.Begin(frame_index), has_image,
          vehicle](MadeFrame& made) {
    made.objects = ScanAndDescribe(sensor, *begun, made.frame);
    made.vehicle = vehicle;
    made.has_image = has_image;
    if (has_image) camera_->Render(simulator, *begun, made.image);
    made.motion = sensor == 0 ? SampleMotion(*begun) : MotionSamples{};
    const auto certifier = certifiers_.find(sensor);
    made.certificate.reset();
    if (certifier != certifiers_.end()) {
      made.certificate = certifier->second.Certify(simulator, *begun, made.frame);
    }
  };
}

const Certifier& FrameMaker::Certify(std::size_t sensor, double cost_share) {
  Simulator& simulator = *simulators_[sensor];
  certifiers_.erase(sensor);
  // If a scenario has several sensors, a certifier knows its own.
  const ScenarioSpec own = PickSensor(scenario_, SensorNames(scenario_).at(sensor));
  return certifiers_.emplace(sensor, Certifier(own, cost_share, simulator)).first->second;
}

std::vector<ObjectInFrame> FrameMaker::ScanAndDescribe(std::size_t sensor,
                                                       BegunFrame& begun,
                                                       Frame& frame) {
  Simulator& simulator = *simulators_[sensor];
  std::vector<ObjectView> views;
  simulator.Scan(begun, frame, views);
  return surveys_->of_sensors[sensor].local().Of(simulator, labels_).Describe(frame, views);
}

MotionSamples FrameMaker::SampleMotion(BegunFrame& begun) const {
  if (!motion_sensors_) return {};
  return motion_sensors_->Sample(*simulators_.front(), begun);
}

std::size_t FrameMaker::NumAtOnce() const {
  // A pixel of the camera's image takes about as much memory as a firing.
  constexpr std::size_t kMostInMemory = 1'000'000;
  if (states_.size() > 1) return 1;
  std::size_t num_each = 0;
  for (std::size_t i = 0; i < simulators_.size(); ++i) {
    std::size_t num = pattern(i).num_firings();
    if (camera_ && i == 0) num += std::size_t{camera_->spec().width_px} * camera_->spec().height_px;
    num_each = std::max(num_each, num);
  }
  return std::clamp<std::size_t>(kMostInMemory / num_each, 1,
                                 simulators_.front()->num_threads() + 1);
}

void FrameMaker::CheckStaysOnTracks(std::size_t sensor,
                                    std::uint32_t first_frame,
                                    std::uint32_t last_frame) const {
  // Includes the frame after the last one.
  const auto first_at = [&](std::int64_t time_ns) {
    return FirstStampedAt(pattern(sensor), time_ns, first_frame, last_frame + 1);
  };
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const std::uint32_t begin = i == 0 ? first_frame : first_at(states_[i].time_ns);
    const std::uint32_t end =
        i + 1 < states_.size() ? first_at(states_[i + 1].time_ns) : last_frame + 1;
    if (begin >= end) continue;
    railcast::CheckStaysOnTracks(scenario_, *states_[i].world, pattern(sensor), begin, end - 1);
  }
}

}  // namespace railcast
