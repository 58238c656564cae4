#include "generator/live/datagram_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

namespace railcast {
namespace {

/// A clock whose time passes only by waiting, for a queue that sends from its own thread.
class WaitedClock final : public LiveClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const override { return now_ns_; }
  void WaitUntil(std::int64_t time_ns,
                 std::condition_variable& /*changed*/,
                 std::unique_lock<std::mutex>& /*lock*/) override {
    now_ns_ = std::max(now_ns_.load(), time_ns);
  }
  [[nodiscard]] bool jumps() const override { return false; }

 private:
  std::atomic<std::int64_t> now_ns_ = 0;
};

struct Departure {
  std::int64_t left_ns;
  std::size_t num;
  std::int64_t first_due_ns, last_due_ns;
};

/// Sends one frame of datagrams that are due at equal intervals, and returns the calls.
std::vector<Departure> DeparturesOf(std::size_t num, std::int64_t interval_ns, bool is_burst) {
  WaitedClock clock;
  std::vector<Departure> departures;
  DatagramQueue queue(clock, {[&](const Datagrams&, std::span<const Datagrams::Item> items) {
                        departures.push_back({clock.NowNs(), items.size(), items.front().due_ns,
                                              items.back().due_ns});
                      }});
  OutgoingFrame frame = queue.AcquireFrame(0);
  for (std::size_t i = 1; i <= num; ++i) {
    frame.datagrams.items.push_back(
        {.offset = 0, .size = 1, .due_ns = static_cast<std::int64_t>(i) * interval_ns});
  }
  frame.is_burst = is_burst;
  queue.Put(0, std::move(frame));
  queue.Flush();
  return departures;
}

std::size_t NumSent(const std::vector<Departure>& departures) {
  std::size_t num = 0;
  for (const Departure& each : departures) num += each.num;
  return num;
}

TEST(DatagramQueue, SendsDatagramsThatAreFarApartWhenTheyAreDue) {
  constexpr std::int64_t kInterval_ns = DatagramQueue::kRest_ns;  // VLP-16's is 1.3 ms.
  const auto departures = DeparturesOf(75, kInterval_ns, false);
  ASSERT_EQ(departures.size(), 75U);
  for (const Departure& each : departures) EXPECT_EQ(each.left_ns, each.first_due_ns);
}

TEST(DatagramQueue, SendsDatagramsThatAreCloseTogetherAtMostAMillisecondLate) {
  constexpr std::int64_t kInterval_ns = 200'000;
  const auto departures = DeparturesOf(500, kInterval_ns, false);
  EXPECT_EQ(NumSent(departures), 500U);
  // The first is not waited for.
  EXPECT_EQ(departures.size(), 1U + 499U / 5U + 1U);
  for (const Departure& each : departures) {
    EXPECT_GE(each.left_ns, each.last_due_ns);
    EXPECT_LT(each.left_ns - each.first_due_ns, DatagramQueue::kRest_ns);
  }
}

TEST(DatagramQueue, NeverLetsMoreWaitThanReceiversHaveRoomFor) {
  const auto departures = DeparturesOf(10'000, 2'000, false);
  EXPECT_EQ(NumSent(departures), 10'000U);
  EXPECT_LT(departures.size(), 10'000U / 16U);
  for (const Departure& each : departures) {
    EXPECT_LE(each.num, DatagramQueue::kMostTogether);
    EXPECT_GE(each.left_ns, each.last_due_ns);
  }
}

TEST(DatagramQueue, SendsABurstAtOnce) {
  const auto departures = DeparturesOf(500, 200'000, true);
  ASSERT_EQ(departures.size(), 1U);
  EXPECT_EQ(departures.front().num, 500U);
}

}  // namespace
}  // namespace railcast
