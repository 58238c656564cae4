#include "generator/run/make_frames.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/fidelity/choice_report.h"
#include "core/io/run/sensors_record.h"
#include "core/io/unfinished_file.h"
#include "core/program/stop_signals.h"
#include "generator/run/all_sensors.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_extras.h"
#include "generator/run/stopping.h"

namespace railcast {
namespace {

/// One of several sequences that are made together, one for each sensor.
struct SensorSequence {
  const SequenceSpec& spec;
  BeginFrame begin_frame;
  /// The time at which a frame of the sensor begins.
  std::function<std::int64_t(std::uint32_t index)> stamp_ns;

  /// The stamp of the sequence's i-th frame; nothing after the last.
  [[nodiscard]] std::optional<std::int64_t> StampOfFrame_ns(std::uint32_t i) const {
    if (i >= spec.num_frames) return std::nullopt;
    return stamp_ns ? stamp_ns(spec.FrameAt(i)) : 0;
  }
};

/// Which of `num` sequences begins its next frame first; `num` if none has a frame left.
/// @param next_stamp_ns The stamp of a sequence's next frame; nothing if it has none left.
template <typename Stamp>
std::size_t EarliestOf(std::size_t num, const Stamp& next_stamp_ns) {
  std::size_t earliest = num;
  std::int64_t earliest_ns = 0;
  for (std::size_t i = 0; i < num; ++i) {
    const std::optional<std::int64_t> stamp_ns = next_stamp_ns(i);
    if (!stamp_ns || (earliest < num && *stamp_ns >= earliest_ns)) continue;
    earliest = i;
    earliest_ns = *stamp_ns;
  }
  return earliest;
}

/// How many frames each sequence has among those that all of them begin first.
/// @param most Number of all of these.
/// @param most_of_each At the first that is not there, they end.
std::vector<std::uint32_t> FirstFrames(const std::vector<SensorSequence>& sensors,
                                       std::uint64_t most,
                                       const std::vector<std::uint32_t>& most_of_each) {
  std::vector<std::uint32_t> next(sensors.size());
  const auto stamp_ns = [&](std::size_t i) { return sensors[i].StampOfFrame_ns(next[i]); };
  for (std::uint64_t i = 0; i < most; ++i) {
    const std::size_t earliest = EarliestOf(sensors.size(), stamp_ns);
    if (earliest == sensors.size() || next[earliest] == most_of_each[earliest]) break;
    ++next[earliest];
  }
  return next;
}

/// A sequence, its directory, and how far it has been begun.
struct SequenceUnderWay {
  SequenceUnderWay(const SensorSequence& sequence, std::uint32_t most_done)
      : of(sequence),
        directory(std::make_unique<RunDirectory>(sequence.spec, most_done)),
        next(directory->num_done()) {
    result.num_resumed = next;
    result.was_complete = directory->is_complete();
    result.changed = directory->changed();
  }

  /// The stamp of the frame that is begun next; nothing if all are begun.
  [[nodiscard]] std::optional<std::int64_t> next_stamp_ns() const {
    return of.StampOfFrame_ns(next);
  }

  const SensorSequence& of;
  std::unique_ptr<RunDirectory> directory;
  SequenceResult result;  ///< As far as it is known before frames are made.
  std::uint32_t next;     ///< Which of its frames is begun next.
};

/// The memory of a frame from its beginning until it is written.
struct FrameSlot {
  std::size_t sequence{};
  FrameJob job;
  MadeFrame made;
  EncodedFrame encoded;
};

/// Begins, makes and writes the frames that sequences lack, until there is none left or the run is
/// stopped: of all of them, the frame that begins first is begun first.
/// @param bag Of all frames; null = none.
void MakeMissing(std::vector<SequenceUnderWay>& sequences,
                 RunOutput* bag,
                 const SequenceHooks& hooks,
                 const FramesAtOnce& at_once) {
  std::uint32_t num_frames = 0;
  std::uint32_t num_done = 0;
  for (const SequenceUnderWay& sequence : sequences) {
    num_done += sequence.result.num_resumed;
    num_frames += sequence.of.spec.num_frames;
  }
  FramePipe pipe;
  pipe.num_at_once = at_once.num;
  pipe.num_waiting = at_once.num;
  pipe.execute = at_once.execute;
  std::vector<FrameSlot> slots(pipe.num_slots());
  pipe.begin = [&](std::size_t i) {
    const std::size_t earliest = EarliestOf(
        sequences.size(), [&](std::size_t each) { return sequences[each].next_stamp_ns(); });
    if (earliest == sequences.size() || hooks.is_stopped()) return false;
    SequenceUnderWay& sequence = sequences[earliest];
    slots[i].sequence = earliest;
    slots[i].job = sequence.of.begin_frame(sequence.of.spec.FrameAt(sequence.next++));
    return true;
  };
  const auto within_memory = [&](std::size_t i, const auto& work) {
    const Frame& frame = slots[i].made.frame;
    const auto doing = [&] {
      return "writing frame " + std::to_string(frame.index) + " (" +
             std::to_string(frame.num_slots()) + " slots)";
    };
    WithinMemory(doing, [&] { work(slots[i], *sequences[slots[i].sequence].directory); });
  };
  pipe.stages = {{false, [&](std::size_t i) {
                    std::exchange(slots[i].job, {})(slots[i].made);
                    within_memory(i, [&](FrameSlot& slot, const RunDirectory& directory) {
                      directory.Encode(slot.made, slot.encoded);
                      if (bag != nullptr) bag->Encode(slot.sequence, slot.made, slot.encoded);
                    });
                    // With thousands of objects, they would take megabytes in every waiting frame.
                    slots[i].made.objects = {};
                  }}};
  pipe.write = [&](std::size_t i) {
    within_memory(i, [&](FrameSlot& slot, RunDirectory& directory) {
      // A frame counts as done once the directory has it; hence the bag must have it before.
      if (bag != nullptr) bag->Write(slot.encoded);
      directory.Write(slot.encoded);
    });
  };
  pipe.on_written = [&] { hooks.on_progress(++num_done, num_frames); };
  hooks.on_progress(num_done, num_frames);
  RunPipe(pipe);
}

/// Opens the sequences and, if they have one, their bag after the frames that both it and they
/// hold.
std::vector<SequenceUnderWay> OpenSequences(const std::vector<SensorSequence>& sensors,
                                            RunOutput* bag) {
  std::vector most_done(sensors.size(), std::numeric_limits<std::uint32_t>::max());
  std::vector<std::vector<std::string>> changed(sensors.size());
  for (bool is_first = true;; is_first = false) {
    if (bag != nullptr) most_done = FirstFrames(sensors, bag->num_frames(), most_done);
    std::vector<SequenceUnderWay> sequences;
    std::vector<std::uint32_t> num_of_each;
    std::uint64_t num_done = 0;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      SequenceResult& result = sequences.emplace_back(sensors[i], most_done[i]).result;
      num_of_each.push_back(result.num_resumed);
      num_done += result.num_resumed;
      // Later, it is opened with fewer frames than it has.
      if (is_first) changed[i] = result.changed;
      result.changed = changed[i];
    }
    if (bag == nullptr) return sequences;
    if (bag->is_complete()) {
      const bool has_all = num_done == bag->num_frames();
      if (has_all && bag->IsUnchanged()) return sequences;
      if (has_all) changed.front().push_back(ShownPath(bag->path()) + " was changed");
      // The end of a complete bag is not gone on with.
      bag->Discard();
    } else if (FirstFrames(sensors, num_done, num_of_each) == num_of_each &&
               bag->Open(num_done) == num_done) {
      return sequences;
    }
    // What one of them lacks, all make anew.
    most_done = num_of_each;
  }
}

/// Makes the missing frames of several sequences, in the order in which they begin.
/// @return The results in the order of the sequences.
/// @param bag Of all frames; null = none.
/// @param on_open Called once the folders are known to be this run's.
std::vector<SequenceResult> RunSequences(
    const std::vector<SensorSequence>& sensors,
    RunOutput* bag,
    const SequenceHooks& hooks,
    const FramesAtOnce& at_once,
    const std::function<void()>& on_open = [] {}) {
  std::vector<SequenceUnderWay> sequences = OpenSequences(sensors, bag);
  on_open();
  const auto begin = std::chrono::steady_clock::now();
  if (!std::ranges::all_of(sequences, [](const auto& each) { return each.result.was_complete; })) {
    MakeMissing(sequences, bag, hooks, at_once);
  }
  std::vector<SequenceResult> results;
  for (const auto& [of, directory, result, next] : sequences) {
    if (!directory->is_complete() && directory->num_done() == of.spec.num_frames) {
      directory->Finish();
    }
    SequenceResult& made = results.emplace_back(result);
    made.num_done = directory->num_done();
    made.is_complete = directory->is_complete();
    made.counts = directory->counts();
    made.certificate = directory->certificate();
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  for (SequenceResult& result : results) result.elapsed_s = elapsed.count();
  return results;
}

/// Completes a run's bag with the vehicle's pose at the last firing of all frames.
void FinishBag(const FrameMaker& maker, const RunPlan& plan, RunOutput& bag) {
  std::int64_t stamp_ns = 0;
  std::int64_t end_ns = 0;
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    const SequenceSpec& spec = plan.sensors[i].spec;
    const ScanPattern& pattern = maker.pattern(i);
    const std::int64_t begin_ns = pattern.StampNs(spec.FrameAt(spec.num_frames - 1));
    if (begin_ns + pattern.time_ns.back() < end_ns) continue;
    stamp_ns = begin_ns;
    end_ns = begin_ns + pattern.time_ns.back();
  }
  // A command takes effect with the next frame.
  const RailWorld& world = *maker.StateAt(stamp_ns).world;
  bag.Finish(plan, end_ns, world.VehicleMotion(end_ns).world_from_body);
}

/// A thread other than the one that waits for a window may be the first to see that the run is
/// stopped; then the deadline is still set, which would cut off frames that are being finished.
struct NoDeadlineAfterwards {
  NoDeadlineAfterwards() = default;
  ~NoDeadlineAfterwards() { UseStopDeadline(false); }
  NoDeadlineAfterwards(const NoDeadlineAfterwards&) = delete;
  NoDeadlineAfterwards& operator=(const NoDeadlineAfterwards&) = delete;
};

/// Lets the building of scenes end once the run is stopped.
void Watch(Simulator& simulator, const SequenceHooks& hooks) {
  if (hooks.is_alone) return WatchBuilding(simulator, hooks.is_stopped, true);
  StopBuilding(simulator, hooks.is_stopped);
}

FidelityChoice ChooseFor(const SensorPlan& sensor,
                         Simulator& simulator,
                         const SequenceHooks& hooks) {
  if (hooks.is_alone) return UseChosenFidelity(simulator, sensor.scenario);
  return UseChosenFidelity(simulator, sensor.scenario, [&](double /*done*/) {
    if (hooks.is_stopped()) throw RunStopped();
  });
}

}  // namespace

bool ChooseFidelities(
    const FrameMaker& maker,
    const std::function<void(const SensorPlan& sensor, const FidelityChoice& choice)>& on_choice,
    const SequenceHooks& hooks,
    RunPlan& plan) {
  for (std::size_t i = 0; i < maker.num_sensors(); ++i) {
    Watch(maker.simulator(i), hooks);
  }
  if (plan.scenario.fidelity != Fidelity::kAuto) return true;
  try {
    for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
      SensorPlan& sensor = plan.sensors[i];
      const FidelityChoice choice = ChooseFor(sensor, maker.simulator(i), hooks);
      sensor.spec.fidelity_choice_json = ChoiceJson(choice);
      on_choice(sensor, choice);
    }
  } catch (const RunStopped&) {
    return false;
  }
  return true;
}

CertifySpec CertifySpecOf(const ScenarioSpec& scenario,
                          const World& world,
                          const Certifier& certifier,
                          double cost_share) {
  CertifySpec spec{.cost_share = cost_share, .rungs = certifier.rungs()};
  for (const SceneObject& object : world.objects()) {
    spec.objects.emplace(object.instance, object.name);
  }
  if (scenario.fidelity == Fidelity::kAuto) {
    spec.tolerance = scenario.tolerance;
    spec.tolerance_labels = LabelTable(scenario.labels).Ids(scenario.tolerance.of, "/tolerance/of");
  }
  return spec;
}

void UseCertificates(FrameMaker& maker, RunPlan& plan) {
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    SensorPlan& sensor = plan.sensors[i];
    if (!sensor.spec.certify) continue;
    const double cost_share = sensor.spec.certify->cost_share;
    const Certifier& certifier = maker.Certify(i, cost_share);
    sensor.spec.certify =
        CertifySpecOf(sensor.scenario, maker.simulator(i).world(), certifier, cost_share);
  }
}

RunFolders::RunFolders(const RunPlan& plan) {
  if (plan.is_in_folders()) {
    locks_.emplace_back(plan.directory);
    RefuseOtherFiles(plan);
  }
  for (const SensorPlan& sensor : plan.sensors) locks_.emplace_back(sensor.spec.directory);
}

PlanResult MakeFrames(FrameMaker& maker,
                      const RunPlan& plan,
                      const RunFolders& /*folders*/,
                      const SequenceHooks& hooks) {
  std::vector<SensorSequence> sequences;
  for (std::size_t i = 0; i < plan.sensors.size(); ++i) {
    const SequenceSpec& spec = plan.sensors[i].spec;
    Simulator& simulator = maker.simulator(i);
    simulator.UseLastStamp(maker.pattern(i).StampNs(spec.FrameAt(spec.num_frames - 1)));
    // Frames are begun by whichever thread is free: from then on the terminal shows what this one
    // waits for.
    const auto begin = [&maker, &simulator, &hooks, i](std::uint32_t index) {
      if (!hooks.is_alone) return maker.Begin(i, index);
      const NoDeadlineAfterwards guard;
      WatchBuilding(simulator, StopRequested, true);
      return maker.Begin(i, index);
    };
    sequences.push_back({spec, begin, [&maker, i](std::uint32_t index) {
                           return maker.pattern(i).StampNs(index);
                         }});
  }
  const FramesAtOnce at_once = {maker.NumAtOnce(), [&](const std::function<void()>& work) {
                                  maker.simulator(0).Execute(work);
                                }};
  const bool has_bag = !plan.sensors.front().spec.bag.empty();
  const auto bag = has_bag ? RunExtras::Get().find_bag(maker, plan) : nullptr;
  PlanResult result;
  const auto begin_list = [&] {
    const std::filesystem::path file = plan.directory / kSensorsFile;
    if (plan.is_in_folders() && !exists(file)) UnfinishedFile(file, 0).Sync();
  };
  result.sequences = RunSequences(sequences, bag.get(), hooks, at_once, begin_list);
  if (const auto fault = FaultOfList(plan)) {
    result.sequences.front().changed.push_back(*fault);
  }
  hooks.on_frames(result.sequences);
  if (!std::ranges::all_of(result.sequences, &SequenceResult::is_complete)) return result;
  if (bag && !bag->is_complete()) FinishBag(maker, plan, *bag);
  result.is_complete = FinishRun(maker, plan, hooks.on_merged, hooks.is_stopped);
  return result;
}

SequenceResult RunSequence(const SequenceSpec& spec,
                           const BeginFrame& begin_frame,
                           const SequenceHooks& hooks,
                           const FramesAtOnce& at_once) {
  const FolderLock lock(spec.directory);
  return RunSequences({{spec, begin_frame, {}}}, nullptr, hooks, at_once).front();
}

}  // namespace railcast
