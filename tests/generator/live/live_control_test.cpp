#include "generator/live/live_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/program/version.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;

/// A run of two sensors, and a clock that is set by hand.
class LiveHealthTest : public testing::Test {
 protected:
  std::string Health() {
    return health_.Answer({.method = "GET", .target = "/health", .body = {}}).body;
  }
  unsigned Status() {
    return health_.Answer({.method = "GET", .target = "/health", .body = {}}).status;
  }
  void Update() {
    records_[0].compute.Add(20'000'000);
    records_[0].compute.Add(40'000'000);
    health_.Update(
        {.stamp_ns = 500'000'000, .now_ns = 0, .behind_ns = 250'000'000, .records = records_});
  }

  std::int64_t now_ns_ = 0;
  LiveHealth health_{[this] { return now_ns_; }};
  std::vector<LiveRecord> records_{
      {.name = "front", .period_ns = 100'000'000, .frames = 2, .late_frames = 1},
      {.name = R"(a "\ b)", .period_ns = 100'000'000, .frames = 3, .dropped_frames = 4}};
};

TEST_F(LiveHealthTest, SaysWhenFramesAreMade) {
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"starting")"));
  health_.Begin();
  Update();
  EXPECT_EQ(Status(), 200U);
  EXPECT_EQ(Health(),
            "{\"status\":\"running\",\"frames\":5,\"late_frames\":1,\"dropped_frames\":4,\"behind_"
            "s\":0.25}\n");
  health_.End();
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"ending")"));
}

TEST_F(LiveHealthTest, NoticesThatARunHasStalled) {
  health_.Begin();
  now_ns_ = LiveHealth::kStalled_ns;
  EXPECT_EQ(Status(), 200U);
  ++now_ns_;
  EXPECT_EQ(Status(), 503U);
  EXPECT_THAT(Health(), HasSubstr(R"("status":"stalled")"));
  health_.Beat();  // As a run that waits for commands.
  EXPECT_EQ(Status(), 200U);
}

TEST_F(LiveHealthTest, CountsInTheFormatOfPrometheus) {
  health_.Begin();
  Update();
  const HttpAnswer answer = health_.Answer({.method = "GET", .target = "/metrics?now", .body = {}});
  EXPECT_EQ(answer.status, 200U);
  EXPECT_THAT(answer.content_type, HasSubstr("text/plain; version=0.0.4"));
  EXPECT_EQ(answer.body,
            "# HELP railcast_info The program's version.\n# TYPE railcast_info gauge\n"
            "railcast_info{version=\"" +
                ProgramVersion() + R"("} 1
# HELP railcast_running 1 while frames are made.
# TYPE railcast_running gauge
railcast_running 1
# HELP railcast_simulated_seconds Simulation time of the last frame.
# TYPE railcast_simulated_seconds gauge
railcast_simulated_seconds 0.5
# HELP railcast_behind_seconds Delay with which frames begin.
# TYPE railcast_behind_seconds gauge
railcast_behind_seconds 0.25
# HELP railcast_frames_total Frames that were made.
# TYPE railcast_frames_total counter
railcast_frames_total{sensor="front"} 2
railcast_frames_total{sensor="a \"\\ b"} 3
# HELP railcast_late_frames_total Frames that were not made in time.
# TYPE railcast_late_frames_total counter
railcast_late_frames_total{sensor="front"} 1
railcast_late_frames_total{sensor="a \"\\ b"} 0
# HELP railcast_dropped_frames_total Frames that were left out because they were late.
# TYPE railcast_dropped_frames_total counter
railcast_dropped_frames_total{sensor="front"} 0
railcast_dropped_frames_total{sensor="a \"\\ b"} 4
# HELP railcast_compute_seconds_total Time in which frames were made.
# TYPE railcast_compute_seconds_total counter
railcast_compute_seconds_total{sensor="front"} 0.06
railcast_compute_seconds_total{sensor="a \"\\ b"} 0.0
# HELP railcast_compute_seconds_max Longest time in which a frame was made.
# TYPE railcast_compute_seconds_max gauge
railcast_compute_seconds_max{sensor="front"} 0.04
railcast_compute_seconds_max{sensor="a \"\\ b"} 0.0
)");
}

TEST_F(LiveHealthTest, AnswersNothingElse) {
  EXPECT_EQ(health_.Answer({.method = "GET", .target = "/", .body = {}}).status, 404U);
  EXPECT_EQ(health_.Answer({.method = "POST", .target = "/health", .body = {}}).status, 405U);
  EXPECT_EQ(health_.Answer({.method = "HEAD", .target = "/metrics", .body = {}}).status, 200U);
}

}  // namespace
}  // namespace railcast
