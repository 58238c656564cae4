#include "generator/live/live_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "core/base/error.h"
#include "core/base/units.h"
#include "generator/run/stopping.h"

namespace railcast {
namespace {

constexpr std::int64_t kDay_ns = 86'400 * kNsPerS;

/// A sensor whose frames are two datagrams, due at the stamp and half a period later, that contain
/// only the number of their frame.
struct TinySensor {
  struct Sent {
    std::uint32_t frame{};
    std::int64_t due_ns{};
    std::int64_t left_ns{};
  };

  TinySensor(double rate, LiveClock& its_clock) : rate_hz(rate), clock(its_clock) {}

  [[nodiscard]] std::int64_t StampNs(std::uint32_t frame) const {
    return std::llround(1e9L * static_cast<long double>(frame) / static_cast<long double>(rate_hz));
  }
  [[nodiscard]] LiveSensor Live(const std::string& name) {
    return {.name = name,
            .period_ns = StampNs(1),
            .stamp_ns = [this](std::uint32_t frame) { return StampNs(frame); },
            .make =
                [this](std::uint32_t frame, Datagrams& datagrams) {
                  made.push_back(frame);
                  if (work) work(frame);
                  for (const std::int64_t since_ns : {std::int64_t{0}, StampNs(1) / 2}) {
                    datagrams.items.push_back({.offset = datagrams.bytes.size(),
                                               .size = sizeof frame,
                                               .due_ns = StampNs(frame) + since_ns});
                    const char* bytes = reinterpret_cast<const char*>(&frame);
                    datagrams.bytes.insert(datagrams.bytes.end(), bytes, bytes + sizeof frame);
                  }
                },
            .send =
                [this](const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
                  const std::int64_t now_ns = clock.NowNs();
                  for (const Datagrams::Item& item : items) {
                    std::uint32_t frame = 0;
                    std::memcpy(&frame, datagrams.BytesOf(item).data(), sizeof frame);
                    sent.push_back({frame, item.due_ns, now_ns});
                  }
                }};
  }

  double rate_hz;
  LiveClock& clock;
  std::function<void(std::uint32_t)> work;
  std::vector<std::uint32_t> made;
  std::vector<Sent> sent;
};

std::vector<LiveRecord> RecordsOf(const LiveRunSpec& spec,
                                  const std::vector<LiveSensor>& sensors,
                                  const LiveHooks& hooks,
                                  LiveClock& clock) {
  LiveResult result = RunLive(spec, sensors, hooks, clock);
  EXPECT_EQ(result.fault, std::nullopt);
  return std::move(result.records);
}

LiveRunSpec Lasting(std::int64_t duration_ns) {
  return {.duration_ns = duration_ns};
}

TEST(LiveRun, KeepsItsStampsForADay) {
  // The period at 30 Hz is not a whole number of nanoseconds.
  for (const double rate_hz : {10.0, 30.0}) {
    JumpingClock clock;
    TinySensor sensor(rate_hz, clock);
    const auto records = RecordsOf(Lasting(kDay_ns), {sensor.Live("a")}, {}, clock);
    const auto num_frames = static_cast<std::uint64_t>(86'400.0 * rate_hz);
    EXPECT_EQ(records.front().frames, num_frames);
    EXPECT_EQ(records.front().late_frames, 0U);
    ASSERT_EQ(sensor.sent.size(), 2 * num_frames);
    // An assertion for each of seven million datagrams would take longer than the run.
    std::size_t num_wrong = 0;
    double most_off_ns = 0.0;
    for (std::size_t i = 0; i < sensor.sent.size(); ++i) {
      const TinySensor::Sent& sent = sensor.sent[i];
      const double exact_ns = static_cast<double>(sent.frame) * 1e9 / rate_hz;
      const std::int64_t half_ns = i % 2 == 0 ? 0 : sensor.StampNs(1) / 2;
      most_off_ns =
          std::max(most_off_ns, std::abs(static_cast<double>(sent.due_ns - half_ns) - exact_ns));
      if (sent.frame != i / 2 || sent.left_ns != sent.due_ns + sensor.StampNs(1)) ++num_wrong;
    }
    EXPECT_EQ(num_wrong, 0U);
    // A double resolves a day to 2^-53, 0.01 ns; stamps are rounded to whole nanoseconds.
    EXPECT_LT(most_off_ns, 0.52);
  }
}

TEST(LiveRun, SpreadsDatagramsOnePeriodAfterTheirFirings) {
  MonotonicClock clock;
  TinySensor sensor(50.0, clock);
  const std::int64_t begin_ns = clock.NowNs();
  const auto records = RecordsOf(Lasting(kNsPerS / 5), {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().frames, 10U);
  EXPECT_EQ(records.front().sent.datagrams, 20U);
  EXPECT_EQ(records.front().sent.bytes, 80U);
  ASSERT_EQ(sensor.sent.size(), 20U);
  for (const TinySensor::Sent& sent : sensor.sent) {
    EXPECT_GE(sent.left_ns - begin_ns, sent.due_ns + sensor.StampNs(1));
  }
}

TEST(LiveRun, DoesNotWaitForAPeriodWhereTheLatencyIsLess) {
  JumpingClock clock;
  TinySensor images(2.0, clock);
  LiveSensor live = images.Live("camera");
  live.latency_ns = kNsPerS / 10;
  static_cast<void>(RecordsOf(Lasting(2 * kNsPerS), {live}, {}, clock));
  ASSERT_EQ(images.sent.size(), 8U);
  for (const TinySensor::Sent& sent : images.sent) {
    EXPECT_EQ(sent.left_ns, sent.due_ns + kNsPerS / 10);
  }
}

TEST(LiveRun, SendsABurstAsSoonAsItIsMade) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  LiveRunSpec spec = Lasting(kNsPerS);
  spec.pacing = Pacing::kBurst;
  const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().late_frames, 0U);
  ASSERT_EQ(sensor.sent.size(), 20U);
  for (const TinySensor::Sent& sent : sensor.sent) {
    EXPECT_EQ(sent.left_ns, sensor.StampNs(sent.frame));
  }
}

TEST(LiveRun, MakesTheNextFrameWhileOneIsSent) {
  MonotonicClock clock;
  TinySensor sensor(20.0, clock);
  LiveSensor live = sensor.Live("a");
  std::atomic<bool> is_second_made = false;
  bool did_overlap = false;
  sensor.work = [&](std::uint32_t frame) {
    if (frame == 1) is_second_made = true;
  };
  const auto send = live.send;
  live.send = [&](const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
    // Keep sending frame 0 until frame 1 is being made.
    for (int i = 0; i < 1000 && !is_second_made; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    did_overlap = did_overlap || is_second_made;
    send(datagrams, items);
  };
  static_cast<void>(RunLive(Lasting(3 * kNsPerS / 20), {live}, {}, clock));
  EXPECT_TRUE(did_overlap);
}

TEST(LiveRun, CountsLateFramesAndSendsThemWhole) {
  JumpingClock clock;
  for (const Pacing pacing : {Pacing::kSpread, Pacing::kBurst}) {
    TinySensor sensor(10.0, clock);
    sensor.work = [&](std::uint32_t) { clock.JumpTo(clock.NowNs() + sensor.StampNs(1) * 3 / 2); };
    LiveRunSpec spec = Lasting(kNsPerS);
    spec.pacing = pacing;
    const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
    EXPECT_EQ(records.front().frames, 10U);
    EXPECT_EQ(records.front().late_frames, 10U);
    ASSERT_EQ(sensor.sent.size(), 20U);
    for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(sensor.sent[i].frame, i / 2);
  }
}

TEST(LiveRun, CatchesUpAfterAStall) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  sensor.work = [&](std::uint32_t frame) {
    if (frame == 5) clock.JumpTo(clock.NowNs() + 3 * sensor.StampNs(1));
  };
  const auto records = RecordsOf(Lasting(3 * kNsPerS), {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().frames, 30U);
  // Frame 5 is done when frame 8 begins, so frames 5 and 6 are late and frame 7 is just in time.
  EXPECT_EQ(records.front().late_frames, 2U);
  EXPECT_EQ(sensor.sent.back().left_ns, sensor.sent.back().due_ns + sensor.StampNs(1));
}

TEST(LiveRun, MakesUpForLongFramesWithTheTimeThatOthersLeft) {
  for (const bool has_lead : {false, true}) {
    JumpingClock clock;
    TinySensor sensor(10.0, clock);
    const std::int64_t period_ns = sensor.StampNs(1);
    // Every third frame takes 1.6 periods, the others half of one.
    sensor.work = [&](std::uint32_t frame) {
      clock.JumpTo(clock.NowNs() + (frame % 3 == 2 ? 16 : 5) * period_ns / 10);
    };
    LiveRunSpec spec = Lasting(3 * kNsPerS);
    if (has_lead) spec.lead_ns = period_ns;
    const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
    EXPECT_EQ(records.front().frames, 30U);
    // The long ones, and all after them but the last.
    EXPECT_EQ(records.front().late_frames, has_lead ? 0U : 19U);
    ASSERT_EQ(sensor.sent.size(), 60U);
    for (const TinySensor::Sent& sent : sensor.sent) {
      EXPECT_GE(sent.left_ns, sent.due_ns + period_ns);
    }
  }
}

TEST(LiveRun, SendsNoBurstBeforeItsFrameBegins) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  LiveRunSpec spec = Lasting(kNsPerS);
  spec.pacing = Pacing::kBurst;
  spec.lead_ns = sensor.StampNs(1);
  const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().late_frames, 0U);
  ASSERT_EQ(sensor.sent.size(), 20U);
  for (const TinySensor::Sent& sent : sensor.sent) {
    EXPECT_EQ(sent.left_ns, spec.lead_ns + sensor.StampNs(sent.frame));
  }
}

TEST(LiveRun, GivesTheFirstFrameTheTimeBeforeItsStamp) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  const std::int64_t period_ns = sensor.StampNs(1);
  sensor.work = [&](std::uint32_t frame) {
    clock.JumpTo(clock.NowNs() + (frame == 0 ? 19 : 8) * period_ns / 10);
  };
  LiveRunSpec spec = Lasting(kNsPerS);
  spec.lead_ns = period_ns;
  const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().frames, 10U);
  EXPECT_EQ(records.front().late_frames, 0U);
}

TEST(LiveRun, SaysHowFarBehindItIs) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  const std::int64_t period_ns = sensor.StampNs(1);
  sensor.work = [&](std::uint32_t) { clock.JumpTo(clock.NowNs() + 3 * period_ns / 2); };
  std::vector<std::int64_t> behind_ns;
  LiveHooks hooks;
  hooks.end_frames = [&](const RunState& state) { behind_ns.push_back(state.behind_ns); };
  static_cast<void>(RecordsOf(Lasting(4 * period_ns), {sensor.Live("a")}, hooks, clock));
  EXPECT_EQ(behind_ns, (std::vector<std::int64_t>{period_ns / 2, 2 * period_ns / 2,
                                                  3 * period_ns / 2, 4 * period_ns / 2}));
}

TEST(LiveRun, DropsWholeFramesThatCannotBeInTime) {
  for (const Pacing pacing : {Pacing::kSpread, Pacing::kBurst}) {
    JumpingClock clock;
    TinySensor sensor(10.0, clock);
    const std::int64_t period_ns = sensor.StampNs(1);
    sensor.work = [&](std::uint32_t) { clock.JumpTo(clock.NowNs() + 5 * period_ns / 2); };
    std::int64_t worst_ns = 0;
    LiveHooks hooks;
    hooks.end_frames = [&](const RunState& state) {
      worst_ns = std::max(worst_ns, state.behind_ns);
    };
    LiveRunSpec spec = Lasting(kNsPerS);
    spec.pacing = pacing;
    spec.drops_late = true;
    const auto records = RecordsOf(spec, {sensor.Live("a")}, hooks, clock);
    // Frames are begun at 0, 2.5, 5 and 7.5 periods; each is the first whose period has not ended.
    EXPECT_EQ(sensor.made, (std::vector<std::uint32_t>{0, 2, 5, 7}));
    EXPECT_EQ(records.front().frames, 4U);
    EXPECT_EQ(records.front().late_frames, 4U);
    EXPECT_EQ(records.front().dropped_frames, 6U);
    ASSERT_EQ(sensor.sent.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
      const std::uint32_t frame = sensor.made[i / 2];
      EXPECT_EQ(sensor.sent[i].frame, frame);
      EXPECT_EQ(sensor.sent[i].due_ns, sensor.StampNs(frame) + (i % 2 == 0 ? 0 : period_ns / 2));
    }
    // A frame is begun before its period ends, when the next one should begin.
    EXPECT_LT(worst_ns, 5 * period_ns / 2) << "what a frame takes";
  }
}

TEST(LiveRun, DropsNothingWhereAllIsInTime) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  LiveRunSpec spec = Lasting(kNsPerS);
  spec.drops_late = true;
  const auto records = RecordsOf(spec, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().frames, 10U);
  EXPECT_EQ(records.front().dropped_frames, 0U);
}

TEST(LiveRun, TakesSeveralSensorsInTheOrderOfTheirStamps) {
  JumpingClock clock;
  TinySensor slow(10.0, clock);
  TinySensor fast(20.0, clock);
  std::vector<std::int64_t> stamps_ns;
  LiveHooks hooks;
  hooks.begin_frames = [&](std::int64_t stamp_ns) {
    stamps_ns.push_back(stamp_ns);
    return NextFrames::kMake;
  };
  const auto records =
      RecordsOf(Lasting(kNsPerS / 5), {slow.Live("slow"), fast.Live("fast")}, hooks, clock);
  EXPECT_EQ(records[0].frames, 2U);
  EXPECT_EQ(records[1].frames, 4U);
  EXPECT_EQ(stamps_ns, (std::vector<std::int64_t>{0, 50'000'000, 100'000'000, 150'000'000}));
}

TEST(LiveRun, SendsEachFrameBeforeTheNextStepInLockstep) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  int num_steps = 0;
  std::vector<std::size_t> num_sent_after_step;
  LiveHooks hooks;
  hooks.begin_frames = [&](std::int64_t) {
    return num_steps++ < 4 ? NextFrames::kMake : NextFrames::kStop;
  };
  hooks.end_frames = [&](const RunState& state) {
    EXPECT_EQ(state.behind_ns, 0);
    num_sent_after_step.push_back(sensor.sent.size());
  };
  LiveRunSpec spec;
  spec.lockstep = true;
  const auto records = RecordsOf(spec, {sensor.Live("a")}, hooks, clock);
  EXPECT_EQ(records.front().frames, 4U);
  EXPECT_EQ(records.front().late_frames, 0U);
  EXPECT_EQ(num_sent_after_step, (std::vector<std::size_t>{2, 4, 6, 8}));
}

TEST(LiveRun, BeginsAnewOnReset) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  bool was_reset = false;
  LiveHooks hooks;
  hooks.begin_frames = [&](std::int64_t stamp_ns) {
    const bool reset = !was_reset && stamp_ns == 300'000'000;
    was_reset = was_reset || reset;
    return reset ? NextFrames::kReset : NextFrames::kMake;
  };
  const auto records = RecordsOf(Lasting(kNsPerS / 2), {sensor.Live("a")}, hooks, clock);
  EXPECT_EQ(sensor.made, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 3, 4}));
  EXPECT_EQ(records.front().late_frames, 0U);
}

TEST(LiveRun, StopsAfterTheFrameInTheMakingAndSendsWhatWasMade) {
  MonotonicClock clock;
  TinySensor sensor(100.0, clock);
  LiveHooks hooks;
  hooks.is_stopped = [&] { return sensor.made.size() == 3; };
  const auto records = RecordsOf({}, {sensor.Live("a")}, hooks, clock);
  EXPECT_EQ(records.front().frames, 3U);
  EXPECT_EQ(sensor.sent.size(), 6U);
}

TEST(LiveRun, SendsWhatWasMadeBeforeAFrameThatCannotBe) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  sensor.work = [](std::uint32_t frame) {
    if (frame == 3) throw InputError("the track ends");
  };
  const LiveResult result = RunLive({}, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(result.fault, "the track ends");
  EXPECT_EQ(result.records.front().frames, 3U);
  EXPECT_EQ(sensor.sent.size(), 6U);
}

TEST(LiveRun, EndsWithoutAFrameThatItWasStoppedIn) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  sensor.work = [](std::uint32_t frame) {
    if (frame == 3) throw RunStopped();
  };
  const auto records = RecordsOf({}, {sensor.Live("a")}, {}, clock);
  EXPECT_EQ(records.front().frames, 3U);
  EXPECT_EQ(sensor.sent.size(), 6U);
}

TEST(LiveRun, EndsWithWhatSendingThrew) {
  JumpingClock clock;
  TinySensor sensor(10.0, clock);
  LiveSensor live = sensor.Live("a");
  live.send = [](const Datagrams&, std::span<const Datagrams::Item>) {
    throw std::runtime_error("disk full");
  };
  EXPECT_THROW(static_cast<void>(RunLive(Lasting(kNsPerS), {live}, {}, clock)), std::runtime_error);
}

}  // namespace
}  // namespace railcast
