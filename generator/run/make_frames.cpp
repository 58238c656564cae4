#include "generator/run/make_frames.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/fidelity/choice_report.h"
#include "core/program/stop_signals.h"
#include "generator/run/run_bag.h"
#include "generator/run/run_directory.h"
#include "generator/run/run_topics.h"
#include "generator/run/stopping.h"

namespace railcast {
namespace {

/// One of several sequences that are made together, one for each sensor.
struct SensorSequence {
  const SequenceSpec& spec;
  BeginFrame begin_frame;
  /// The time at which a frame of the sensor begins.
  std::function<std::int64_t(std::uint32_t index)> stamp_ns;

  /// That of the sequence's i-th frame; nothing after the last.
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

/// The memory of a frame from its beginning until it is written.
struct FrameSlot {
  RunDirectory* directory = nullptr;
  std::size_t sensor{};
  FrameJob job;
  std::exception_ptr fault;  ///< Why there is no frame.
  MadeFrame made;
  EncodedFrame encoded;
};

std::string Writing(const Frame& frame) {
  return "writing frame " + std::to_string(frame.index) + " (" + std::to_string(frame.num_slots()) +
         " slots)";
}

/// Writes frames on a thread of its own, in the order in which they come.
class WritingQueue {
 public:
  /// @param most Number of frames that may wait or be written at a time.
  /// @param bag Of all frames; null = none.
  WritingQueue(std::size_t most, RunBag* bag) : most_(most), bag_(bag) {
    thread_ = StartThread("writing frames", [this] { Run(); });
  }
  ~WritingQueue() {
    {
      const std::lock_guard lock(mutex_);
      is_ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  WritingQueue(const WritingQueue&) = delete;
  WritingQueue& operator=(const WritingQueue&) = delete;

  /// Waits until no more than `most` frames wait or are being written.
  /// @return How many have been written so far.
  /// @throws What writing a frame has thrown. Nothing is written after that.
  std::uint32_t Await(std::size_t most) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return fault_ || waiting_.size() <= most; });
    if (fault_) std::rethrow_exception(fault_);
    return num_written_;
  }
  /// Has a frame written, whose memory must stay as it is until then. Waits for room.
  std::uint32_t Put(const FrameSlot& slot) {
    const std::uint32_t num_written = Await(most_ - 1);
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(&slot);
    }
    changed_.notify_all();
    return num_written;
  }

 private:
  void Run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return is_ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      const FrameSlot& slot = *waiting_.front();
      lock.unlock();
      std::exception_ptr fault;
      try {
        WithinMemory([&] { return Writing(slot.made.frame); }, [&] { Write(slot); });
      } catch (...) {
        fault = std::current_exception();
      }
      lock.lock();
      fault_ = fault;
      changed_.notify_all();
      if (fault) return;
      waiting_.pop_front();
      ++num_written_;
    }
  }

  // A frame counts as done once the directory has it; hence the bag must have it before.
  void Write(const FrameSlot& slot) const {
    if (bag_ != nullptr) bag_->Write(slot.encoded);
    slot.directory->Write(slot.encoded);
  }

  std::size_t most_;
  RunBag* bag_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<const FrameSlot*> waiting_;  ///< The first is being written.
  std::uint32_t num_written_ = 0;
  std::exception_ptr fault_;
  bool is_ending_ = false;
  std::thread thread_;
};

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

class MissingFrames {
 public:
  MissingFrames(std::vector<SequenceUnderWay>& sequences,
                RunBag* bag,
                const SequenceHooks& hooks,
                const FramesAtOnce& at_once)
      : sequences_(sequences),
        bag_(bag),
        hooks_(hooks),
        at_once_(at_once),
        // The pipeline holds as many frames as are made at once, and as many are being written.
        slots_(2 * at_once.num),
        writing_(at_once.num, bag) {
    for (const SequenceUnderWay& sequence : sequences) {
      num_resumed_ += sequence.result.num_resumed;
      num_frames_ += sequence.of.spec.num_frames;
    }
    num_shown_ = num_resumed_;
    hooks_.on_progress(num_shown_, num_frames_);
  }

  /// Makes and writes frames until there is none left, or the run is stopped.
  void Make() {
    try {
      at_once_.execute([this] { RunPipeline(); });
    } catch (const RunStopped&) {
      // The frames before it are there.
    }
    AwaitWriting();
  }

 private:
  void AwaitWriting() { ShowProgress(writing_.Await(0)); }

  void RunPipeline() {
    tbb::parallel_pipeline(
        at_once_.num,
        tbb::make_filter<void, FrameSlot*>(tbb::filter_mode::serial_in_order,
                                           [this](tbb::flow_control& flow) {
                                             FrameSlot* const slot = Begin();
                                             if (slot == nullptr) flow.stop();
                                             return slot;
                                           }) &
            tbb::make_filter<FrameSlot*, FrameSlot*>(tbb::filter_mode::parallel,
                                                     [this](FrameSlot* slot) {
                                                       Finish(*slot);
                                                       return slot;
                                                     }) &
            tbb::make_filter<FrameSlot*, void>(tbb::filter_mode::serial_in_order,
                                               [this](FrameSlot* slot) { Write(*slot); }));
  }

  // Returns null if no frame is left.
  FrameSlot* Begin() {
    SequenceUnderWay* const sequence = Earliest();
    if (is_over_ || sequence == nullptr || hooks_.is_stopped()) return nullptr;
    FrameSlot& slot = slots_[num_begun_++ % slots_.size()];
    slot.directory = sequence->directory.get();
    slot.sensor = static_cast<std::size_t>(sequence - sequences_.data());
    slot.fault = nullptr;
    try {
      slot.job = sequence->of.begin_frame(sequence->of.spec.FrameAt(sequence->next));
    } catch (...) {
      // Passed on in its turn, after the frames before it.
      slot.fault = std::current_exception();
      is_over_ = true;
    }
    ++sequence->next;
    return &slot;
  }

  // The sequence whose next frame begins first; null if none has a frame left.
  SequenceUnderWay* Earliest() const {
    const std::size_t earliest = EarliestOf(
        sequences_.size(), [this](std::size_t i) { return sequences_[i].next_stamp_ns(); });
    return earliest < sequences_.size() ? &sequences_[earliest] : nullptr;
  }

  void Finish(FrameSlot& slot) const {
    if (slot.fault) return;
    try {
      MadeFrame& made = slot.made;
      std::exchange(slot.job, {})(made);
      const auto doing = [&made] { return Writing(made.frame); };
      WithinMemory(doing, [&] {
        slot.directory->Encode(made, slot.encoded);
        if (bag_ != nullptr) bag_->Encode(slot.sensor, made, slot.encoded);
      });
      // Of thousands of objects, they would take megabytes in every frame that waits to be written.
      made.objects = {};
    } catch (...) {
      slot.fault = std::current_exception();
    }
  }

  void Write(const FrameSlot& slot) {
    if (slot.fault) {
      AwaitWriting();
      std::rethrow_exception(slot.fault);
    }
    ShowProgress(writing_.Put(slot));
  }

  void ShowProgress(std::uint32_t num_written) {
    while (num_shown_ < num_resumed_ + num_written) {
      hooks_.on_progress(++num_shown_, num_frames_);
    }
  }

  std::vector<SequenceUnderWay>& sequences_;
  RunBag* bag_;
  const SequenceHooks& hooks_;
  const FramesAtOnce& at_once_;
  std::uint32_t num_frames_ = 0;   ///< Of all sequences.
  std::uint32_t num_resumed_ = 0;  ///< Of these, those that were there.
  std::uint32_t num_shown_ = 0;    ///< As on_progress() was told last.
  std::size_t num_begun_ = 0;
  bool is_over_ = false;
  std::vector<FrameSlot> slots_;
  WritingQueue writing_;  // Last, so that it ends before the memory that it writes.
};

/// Opens the sequences and, if they have one, their bag after the frames that both it and they
/// hold.
std::vector<SequenceUnderWay> OpenSequences(const std::vector<SensorSequence>& sensors,
                                            RunBag* bag) {
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
std::vector<SequenceResult> RunSequences(const std::vector<SensorSequence>& sensors,
                                         RunBag* bag,
                                         const SequenceHooks& hooks,
                                         const FramesAtOnce& at_once) {
  std::vector<SequenceUnderWay> sequences = OpenSequences(sensors, bag);
  const auto begin = std::chrono::steady_clock::now();
  if (!std::ranges::all_of(sequences, [](const auto& each) { return each.result.was_complete; })) {
    MissingFrames(sequences, bag, hooks, at_once).Make();
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
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  for (SequenceResult& result : results) result.elapsed_s = elapsed.count();
  return results;
}

/// The bag of a run; nothing if its format is none.
std::optional<RunBag> BagOf(const FrameMaker& maker, const RunPlan& plan) {
  const SequenceSpec& first = plan.sensors.front().spec;
  if (first.bag.empty()) return std::nullopt;
  const std::int64_t begin_ns = maker.pattern(0).StampNs(first.start_frame);
  // Those of the sensor with most fields; frames leave out what they lack.
  const auto num_fields = [](const SensorPlan& sensor) {
    return sensor.spec.clouds.fields.names().size();
  };
  const SensorPlan& richest = *std::ranges::max_element(plan.sensors, {}, num_fields);
  return std::make_optional<RunBag>(plan,
                                    TopicsSpecOf(plan.scenario, *maker.StateAt(begin_ns).world,
                                                 richest.spec.clouds, ros::ImageEncoding::kPng),
                                    begin_ns);
}

/// Completes a run's bag with the vehicle's pose at the last firing of all frames.
void FinishBag(const FrameMaker& maker, const RunPlan& plan, RunBag& bag) {
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

std::vector<SequenceResult> MakeFrames(FrameMaker& maker,
                                       const RunPlan& plan,
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
  std::optional<RunBag> bag = BagOf(maker, plan);
  std::vector<SequenceResult> results =
      RunSequences(sequences, bag ? &*bag : nullptr, hooks, at_once);
  const bool is_complete = std::ranges::all_of(results, &SequenceResult::is_complete);
  if (bag && is_complete && !bag->is_complete()) FinishBag(maker, plan, *bag);
  return results;
}

SequenceResult RunSequence(const SequenceSpec& spec,
                           const BeginFrame& begin_frame,
                           const SequenceHooks& hooks,
                           const FramesAtOnce& at_once) {
  return RunSequences({{spec, begin_frame, {}}}, nullptr, hooks, at_once).front();
}

}  // namespace railcast
