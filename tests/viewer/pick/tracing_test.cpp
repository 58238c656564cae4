#include "viewer/pick/tracing.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "tests/viewer/session/held_frames.h"

namespace railcast {
namespace {

/// A recording without a scenario. Its answer is an error with the source's name, which comes at
/// once and tells the sources apart.
RecordingInfo Named(const std::string& name) {
  RecordingInfo info;
  info.source = name;
  return info;
}

std::string AnswerOf(Tracing& tracing) {
  for (;;) {
    if (auto answer = tracing.Take()) return *answer;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(Tracing, AnswersOfTheSourceThatWasAsked) {
  const auto recorded = std::make_shared<const RecordedFrame>(NumberedCloud(0));
  Tracing tracing(2);
  EXPECT_FALSE(tracing.Take());
  tracing.Ask(1, Named("b"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: b: has no scenario to trace points with");
  EXPECT_FALSE(tracing.Take()) << "once";
  tracing.Ask(0, Named("a"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: a: has no scenario to trace points with");
}

TEST(Tracing, ForgetsWhatIsOfNoInterestAnyMore) {
  const auto recorded = std::make_shared<const RecordedFrame>(NumberedCloud(0));
  Tracing tracing(2);
  tracing.Ask(0, Named("a"), recorded, 0);
  tracing.Forget();
  tracing.Ask(1, Named("b"), recorded, 0);
  EXPECT_EQ(AnswerOf(tracing), "error: b: has no scenario to trace points with");
  EXPECT_FALSE(tracing.Take());
}

}  // namespace
}  // namespace railcast
