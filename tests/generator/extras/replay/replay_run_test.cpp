#include "generator/extras/replay/replay_run.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;

/// Datagrams of a byte each that are due at given times.
class MadeFeed final : public ReplayFeed {
 public:
  MadeFeed(std::vector<std::vector<std::int64_t>> due_ms, const LiveClock& clock)
      : due_ms_(std::move(due_ms)), clock_(clock) {}

  [[nodiscard]] std::string name() const override { return "made"; }
  [[nodiscard]] std::string Description() const override { return "made"; }
  [[nodiscard]] bool Load() override {
    if (num_loaded_ == fault_at) throw InputError("made.pcap: damaged");
    if (num_loaded_ == due_ms_.size()) return false;
    ++num_loaded_;
    return true;
  }
  [[nodiscard]] std::int64_t begin_ns() const override {
    return due_ms_[num_loaded_ - 1].front() * kNsPerMs;
  }
  void Take(Datagrams& datagrams) override {
    for (const std::int64_t ms : due_ms_[num_loaded_ - 1]) {
      datagrams.items.push_back(
          {.offset = datagrams.bytes.size(), .size = 1, .due_ns = ms * kNsPerMs});
      datagrams.bytes.push_back('x');
    }
  }
  void Send(const Datagrams&, std::span<const Datagrams::Item> items) override {
    for (std::size_t i = 0; i < items.size(); ++i) sent_ms.push_back(clock_.NowNs() / kNsPerMs);
  }
  [[nodiscard]] UdpSender::Counts delivered() const override { return {sent_ms.size(), 0}; }

  std::vector<std::int64_t> sent_ms;
  std::size_t fault_at = 1'000;

 private:
  std::vector<std::vector<std::int64_t>> due_ms_;
  const LiveClock& clock_;
  std::size_t num_loaded_{};
};

constexpr std::int64_t kLead_ms = ReplayRunSpec::kLead_ns / kNsPerMs;

std::vector<std::int64_t> SinceBegin(const MadeFeed& feed) {
  std::vector<std::int64_t> times_ms;
  for (const std::int64_t ms : feed.sent_ms) times_ms.push_back(ms - kLead_ms);
  return times_ms;
}

TEST(ReplayRun, SendsEachDatagramAtItsTime) {
  JumpingClock clock;
  MadeFeed feed({{0, 30, 90}, {100, 199}, {5'000}}, clock);
  const LiveResult result = RunReplay(feed, {}, clock);
  EXPECT_EQ(result.fault, std::nullopt);
  EXPECT_EQ(SinceBegin(feed), (std::vector<std::int64_t>{0, 30, 90, 100, 199, 5'000}));
  ASSERT_EQ(result.records.size(), 1U);
  EXPECT_EQ(result.records[0].name, "made");
  EXPECT_EQ(result.records[0].frames, 3U);
  EXPECT_EQ(result.records[0].late_frames, 0U);
  EXPECT_EQ(result.records[0].sent.datagrams, 6U);
}

TEST(ReplayRun, SendsAFrameInABurstWhenItBegins) {
  JumpingClock clock;
  MadeFeed feed({{0, 30, 90}, {100, 199}}, clock);
  const LiveResult result = RunReplay(feed, {.pacing = Pacing::kBurst}, clock);
  EXPECT_EQ(SinceBegin(feed), (std::vector<std::int64_t>{0, 0, 0, 100, 100}));
  EXPECT_EQ(result.records[0].late_frames, 0U);
}

TEST(ReplayRun, SendsWhatCouldBeReadBeforeAFault) {
  JumpingClock clock;
  MadeFeed feed({{0}, {100, 150}, {200}}, clock);
  feed.fault_at = 2;
  const LiveResult result = RunReplay(feed, {}, clock);
  EXPECT_EQ(result.fault, "made.pcap: damaged");
  EXPECT_EQ(SinceBegin(feed), (std::vector<std::int64_t>{0, 100, 150}));
}

TEST(ReplayRun, EndsInAPauseWhenItIsStopped) {
  JumpingClock clock;
  MadeFeed feed({{0}, {100}, {100'000'000}}, clock);
  ReplayRunSpec spec;
  spec.is_stopped = [&] { return clock.NowNs() > 10'000 * kNsPerMs; };
  const LiveResult result = RunReplay(feed, spec, clock);
  EXPECT_EQ(result.fault, std::nullopt);
  EXPECT_EQ(SinceBegin(feed), (std::vector<std::int64_t>{0, 100}));
  EXPECT_LT(clock.NowNs(), 11'000 * kNsPerMs);
}

}  // namespace
}  // namespace railcast
