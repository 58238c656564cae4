#include "generator/python/held_simulation.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_lines.h"
#include "core/scenario/command.h"
#include "railcast/fidelity.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

constexpr std::int64_t kMostThreads = 1024;

int CheckedThreads(std::int64_t num_threads) {
  if (num_threads >= 0 && num_threads <= kMostThreads) return static_cast<int>(num_threads);
  throw InputError({{"threads", "must be >= 0 and <= " + std::to_string(kMostThreads),
                     std::to_string(num_threads)}});
}

void CheckLength(const char* name, double length_m) {
  if (std::isfinite(length_m) && length_m >= 0.0) return;
  throw InputError({{name, "must be finite and >= 0", NumberText(length_m)}});
}

std::set<std::string, std::less<>> NamesOfFields(const Frame& frame) {
  std::set<std::string, std::less<>> names;
  ForEachField(frame, [&](const char* name, const auto&...) { names.emplace(name); });
  return names;
}

Command CommandOf(const std::string& line, const std::vector<ModelSpec>& models) {
  CommandLine read = ReadCommand(line, models);
  if (read.command) return std::move(*read.command);
  ErrorList faults;
  for (std::string& fault : read.faults) faults.AddLine(std::move(fault));
  faults.ThrowIfAny();
  throw InputError("command: must not be empty");
}

}  // namespace

HeldSimulation::HeldSimulation(const ScenarioSpec& scenario,
                               std::int64_t num_threads,
                               std::function<bool()> is_interrupted)
    : made_in_(::getpid()),
      is_interrupted_(std::move(is_interrupted)),
      maker_(scenario, CheckedThreads(num_threads)) {
  for (std::size_t i = 0; i < maker_.num_sensors(); ++i) pools_.push_back(FramePool::Make());
  WatchForInterruption();
  ChooseEffects();
}

void HeldSimulation::WatchForInterruption() {
  for (std::size_t i = 0; i < maker_.num_sensors(); ++i) {
    maker_.simulator(i).UseProgress([this](std::size_t, std::size_t) {
      if (std::this_thread::get_id() == waiting_.load() && is_interrupted_()) {
        was_interrupted_ = true;
      }
      if (was_interrupted_) throw Interrupted();
    });
  }
}

void HeldSimulation::ChooseEffects() {
  if (scenario().fidelity != Fidelity::kAuto) return;
  waiting_ = std::this_thread::get_id();
  const std::vector<std::string> names = SensorNames(scenario());
  for (std::size_t i = 0; i < maker_.num_sensors(); ++i) {
    UseChosenFidelity(maker_.simulator(i), PickSensor(scenario(), names[i]), [this](double) {
      if (is_interrupted_()) throw Interrupted();
    });
  }
}

bool HeldSimulation::IsOfThisProcess() const {
  return ::getpid() == made_in_;
}

// Asks before it locks: another thread may have held the lock when the process was forked.
std::unique_lock<std::mutex> HeldSimulation::LockHere() {
  if (!IsOfThisProcess()) {
    throw InputError(
        "simulator: must be used in the process that made it (got one forked from that)");
  }
  return std::unique_lock(mutex_);
}

std::size_t HeldSimulation::IndexOf(const Sensor& sensor) const {
  const std::vector<std::string> names = SensorNames(scenario());
  if (const auto* const name = std::get_if<std::string>(&sensor)) {
    const auto found = std::find(names.begin(), names.end(), *name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    // Throws the line that names the sensors.
    static_cast<void>(PickSensor(scenario(), *name));
  }
  const std::int64_t index = std::get<std::int64_t>(sensor);
  if (index >= 0 && std::cmp_less(index, names.size())) return static_cast<std::size_t>(index);
  throw InputError(
      {{"sensor", "must be >= 0 and < " + std::to_string(names.size()), std::to_string(index)}});
}

std::uint32_t HeldSimulation::FrameOf(std::int64_t frame, std::size_t sensor) const {
  const std::uint32_t last = maker_.pattern(sensor).LastFrame();
  if (frame >= 0 && std::cmp_less_equal(frame, last)) return static_cast<std::uint32_t>(frame);
  throw InputError(
      {{"frame", "must be >= 0 and <= " + std::to_string(last), std::to_string(frame)}});
}

template <typename Work>
void HeldSimulation::DoInterruptibly(const Work& work) {
  waiting_ = std::this_thread::get_id();
  for (;;) {
    was_interrupted_ = false;
    try {
      return work();
    } catch (const Interrupted&) {
      // A window that is built ahead may have been ended by the interruption of an earlier frame.
      if (was_interrupted_) throw;
    }
  }
}

std::shared_ptr<RecordedFrame> HeldSimulation::Scan(std::int64_t frame,
                                                    const Sensor& sensor,
                                                    bool has_objects) {
  const std::unique_lock lock = LockHere();
  const std::size_t index = IndexOf(sensor);
  const std::uint32_t number = FrameOf(frame, index);
  std::shared_ptr<RecordedFrame> made = pools_[index]->Take();
  DoInterruptibly([&] { Make(number, index, has_objects, *made); });
  return made;
}

MotionSamples HeldSimulation::Motion(std::int64_t frame) {
  const std::unique_lock lock = LockHere();
  const std::uint32_t number = FrameOf(frame, 0);
  MotionSamples samples;
  DoInterruptibly([&] {
    const auto begun = maker_.At(0, number).Begin(number);
    samples = maker_.SampleMotion(*begun);
  });
  return samples;
}

void HeldSimulation::Make(std::uint32_t frame,
                          std::size_t sensor,
                          bool has_objects,
                          RecordedFrame& made) {
  Simulator& simulator = maker_.At(sensor, frame);
  const auto begun = simulator.Begin(frame);
  made.objects.clear();
  if (has_objects) {
    const auto objects = maker_.ScanAndDescribe(sensor, *begun, made.frame);
    const Transform sensor_from_world = made.frame.world_from_sensor.inverse();
    for (const ObjectInFrame& object : objects) {
      made.objects.push_back(RecordedOf(object, sensor_from_world));
    }
  } else {
    simulator.Scan(*begun, made.frame);
  }
  if (!made.fields.empty()) return;
  made.fields = NamesOfFields(made.frame);
  const OutputSpec& output = simulator.spec().output;
  const bool is_in_sensor_axes =
      output.frame == OutputFrame::kSensor && output.handedness == Handedness::kRight;
  made.axes = is_in_sensor_axes ? PointAxes::kSensorAtFiring : PointAxes::kOther;
  made.is_grid = true;
  made.has_pose = true;
}

std::vector<RailLines> HeldSimulation::Rails(std::int64_t frame,
                                             const Sensor& sensor,
                                             const RailReach& reach) {
  const std::unique_lock lock = LockHere();
  CheckLength("behind_m", reach.behind_m);
  CheckLength("ahead_m", reach.ahead_m);
  const std::size_t index = IndexOf(sensor);
  const std::uint32_t number = FrameOf(frame, index);
  const Simulator& simulator = maker_.At(index, number);
  const std::int64_t stamp_ns = simulator.pattern().StampNs(number);
  return RailLinesAbout(*maker_.StateAt(stamp_ns).world, scenario().world.alignment, stamp_ns,
                        reach, simulator.WorldFromSensor(stamp_ns).inverse());
}

void HeldSimulation::Apply(const std::string& line, std::int64_t frame, const Sensor& sensor) {
  const std::unique_lock lock = LockHere();
  const Command command = CommandOf(line, scenario().models);
  const std::size_t index = IndexOf(sensor);
  const std::int64_t time_ns = maker_.pattern(index).StampNs(FrameOf(frame, index));
  const std::int64_t last_ns = maker_.states().back().time_ns;
  if (time_ns < last_ns && !std::holds_alternative<Reset>(command)) {
    throw InputError(
        {{"frame", "must not be stamped before the last command, at " + SecondsText(last_ns),
          SecondsText(time_ns)}});
  }
  maker_.Apply(command, time_ns);
}

}  // namespace railcast
