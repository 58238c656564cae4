#include "core/fidelity/sample_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace railcast {
namespace {

using testing::ElementsAre;

ScanPattern PatternAt(double rate_hz) {
  ScanPattern pattern;
  pattern.rate_hz = rate_hz;
  return pattern;
}

TEST(SampleFrames, AreASecondApart) {
  EXPECT_THAT(SampleFrames(PatternAt(10.0), 3), ElementsAre(0, 10, 20));
  EXPECT_THAT(SampleFrames(PatternAt(10.0), 3, 0.5), ElementsAre(5, 15, 25));
}

TEST(SampleFrames, AreNeverTheSameFrameTwice) {
  EXPECT_THAT(SampleFrames(PatternAt(0.5), 3), ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace railcast
