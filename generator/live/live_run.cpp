#include "generator/live/live_run.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "core/base/error.h"
#include "generator/run/stopping.h"

namespace railcast {
namespace {

// The longest time until a waiting run notices that it was stopped.
constexpr std::int64_t kPatience_ns = 50'000'000;
// A certificate hardly ever takes longer than so many times what they take in the median.
constexpr std::int64_t kLongestCertificate = 3;
// As many are known to tell that median.
constexpr std::uint64_t kLeastCertificates = 3;

class LiveRun {
 public:
  LiveRun(const LiveRunSpec& spec,
          const std::vector<LiveSensor>& sensors,
          const LiveHooks& hooks,
          LiveClock& clock)
      : spec_(spec), sensors_(sensors), hooks_(hooks), clock_(clock), queue_(clock, SendersOf()) {
    for (const LiveSensor& sensor : sensors) {
      records_.push_back(
          {.name = sensor.name, .period_ns = sensor.period_ns, .sends = sensor.sends});
      if (sensor.certify) records_.back().uncertified_frames = 0;
    }
    Restart();
  }

  LiveResult Run() {
    LiveResult result;
    try {
      MakeAll();
    } catch (const RunStopped&) {
      // Frames made before the stop are still sent.
    } catch (const InputError& error) {
      result.fault = error.what();
    }
    queue_.Flush();
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      records_[i].sent = queue_.record(i);
      records_[i].late_frames += records_[i].sent.late_frames;
    }
    result.records = std::move(records_);
    return result;
  }

 private:
  [[nodiscard]] std::vector<DatagramQueue::Send> SendersOf() const {
    std::vector<DatagramQueue::Send> senders;
    for (const LiveSensor& sensor : sensors_) senders.push_back(sensor.send);
    return senders;
  }

  void MakeAll() {
    while (!IsOver() && (spec_.lockstep || AwaitBegin())) {
      const NextFrames next = hooks_.begin_frames(NextStampNs());
      if (next == NextFrames::kStop) return;
      if (next == NextFrames::kReset) {
        Restart();
      } else {
        MakeFrames();
      }
    }
  }

  void Restart() {
    next_.assign(sensors_.size(), 0);
    // The first frame is begun at once; it, too, has the time before its stamp.
    clock_from_stamp_ns_ = clock_.NowNs() + spec_.lead_ns - NextStampNs();
  }

  [[nodiscard]] std::int64_t NextStampNs(std::size_t sensor) const {
    return sensors_[sensor].stamp_ns(next_[sensor]);
  }

  /// Returns the earliest stamp among all sensors' next frames.
  [[nodiscard]] std::int64_t NextStampNs() const {
    std::int64_t stamp_ns = NextStampNs(0);
    for (std::size_t i = 1; i < sensors_.size(); ++i) {
      stamp_ns = std::min(stamp_ns, NextStampNs(i));
    }
    return stamp_ns;
  }

  [[nodiscard]] bool IsOver() const {
    return hooks_.is_stopped() || (spec_.duration_ns && NextStampNs() >= *spec_.duration_ns);
  }

  /// The clock's time at which the next frames begin. Not in lockstep.
  [[nodiscard]] std::int64_t BeginNs() const {
    return clock_from_stamp_ns_ + NextStampNs() - spec_.lead_ns;
  }

  [[nodiscard]] bool AwaitBegin() {
    const std::int64_t begin_ns = BeginNs();
    queue_.SendUntil(begin_ns);
    std::mutex mutex;
    std::condition_variable never;
    std::unique_lock lock(mutex);
    while (clock_.NowNs() < begin_ns) {
      if (hooks_.is_stopped()) return false;
      clock_.WaitUntil(std::min(begin_ns, clock_.NowNs() + kPatience_ns), never, lock);
    }
    return true;
  }

  void MakeFrames() {
    const std::int64_t stamp_ns = NextStampNs();
    std::vector<std::size_t> made;
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
      if (NextStampNs(i) != stamp_ns) continue;
      if (spec_.drops_late && next_[i] > 0 && clock_.NowNs() >= DeadlineNs(i, stamp_ns)) {
        ++next_[i];
        ++records_[i].dropped_frames;
      } else {
        MakeFrame(i, stamp_ns);
        made.push_back(i);
      }
    }
    if (spec_.lockstep) queue_.Flush();
    const std::int64_t now_ns = clock_.NowNs();
    const std::int64_t behind_ns = now_ns - clock_from_stamp_ns_ - NextStampNs();
    hooks_.end_frames(
        {stamp_ns, now_ns, spec_.lockstep ? 0 : std::max<std::int64_t>(0, behind_ns), records_});
    for (const std::size_t sensor : made) Certify(sensor);
  }

  /// Certifies the frame that a sensor has made, if there is time before the next frames begin.
  void Certify(std::size_t sensor) {
    if (!sensors_[sensor].certify) return;
    LiveRecord& record = records_[sensor];
    const std::int64_t usual_ns = record.certify.count() < kLeastCertificates
                                      ? sensors_[sensor].certify_ns
                                      : record.certify.QuantileNs(0.5);
    const std::int64_t now_ns = clock_.NowNs();
    const bool has_bound = !spec_.lockstep && !clock_.jumps();
    if (has_bound && now_ns + kLongestCertificate * usual_ns > BeginNs()) {
      ++*record.uncertified_frames;
      return;
    }
    sensors_[sensor].certify();
    record.certify.Add(clock_.NowNs() - now_ns);
  }

  /// Returns the time by which the frame must have been made: the end of its period, of an image
  /// that of the sensor's frame with the same stamp.
  [[nodiscard]] std::int64_t DeadlineNs(std::size_t sensor, std::int64_t stamp_ns) const {
    return clock_from_stamp_ns_ + stamp_ns + sensors_[sensor].latency_ns;
  }

  void MakeFrame(std::size_t sensor, std::int64_t stamp_ns) {
    LiveRecord& record = records_[sensor];
    OutgoingFrame outgoing = queue_.AcquireFrame(sensor);
    const std::int64_t begin_ns = clock_.NowNs();
    sensors_[sensor].make(next_[sensor]++, outgoing.datagrams);
    const std::int64_t end_ns = clock_.NowNs();
    record.compute.Add(end_ns - begin_ns);
    ++record.frames;
    SetPace(sensor, stamp_ns, end_ns, outgoing);
    queue_.Put(sensor, std::move(outgoing));
  }

  void SetPace(std::size_t sensor,
               std::int64_t stamp_ns,
               std::int64_t made_ns,
               OutgoingFrame& outgoing) {
    LiveRecord& record = records_[sensor];
    const std::int64_t deadline_ns = DeadlineNs(sensor, stamp_ns);
    outgoing.is_burst = spec_.pacing == Pacing::kBurst;
    outgoing.deadline_ns.reset();
    if (outgoing.is_burst) {
      outgoing.clock_from_due_ns = made_ns;
      if (!spec_.lockstep) {
        outgoing.clock_from_due_ns = std::max(made_ns, clock_from_stamp_ns_ + stamp_ns);
        outgoing.deadline_ns = deadline_ns;
      }
    } else if (spec_.lockstep) {
      outgoing.clock_from_due_ns = made_ns - stamp_ns;
    } else {
      outgoing.clock_from_due_ns = clock_from_stamp_ns_ + sensors_[sensor].latency_ns;
      if (made_ns > deadline_ns) ++record.late_frames;
    }
  }

  const LiveRunSpec& spec_;
  const std::vector<LiveSensor>& sensors_;
  const LiveHooks& hooks_;
  LiveClock& clock_;
  DatagramQueue queue_;
  std::vector<LiveRecord> records_;
  std::vector<std::uint32_t> next_;  ///< Next frame of each sensor.
  std::int64_t clock_from_stamp_ns_{};
};

}  // namespace

LiveResult RunLive(const LiveRunSpec& spec,
                   const std::vector<LiveSensor>& sensors,
                   const LiveHooks& hooks,
                   LiveClock& clock) {
  return LiveRun(spec, sensors, hooks, clock).Run();
}

}  // namespace railcast
