#include "core/rail/line/piecewise_linear.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

constexpr double kSumRounding = 1e-12;

// 1 up to chainage 10, a jump to 3, falling to 1 at 30, and constant to 40.
PiecewiseLinear Example() {
  return {{{0.0, 1.0, 1.0}, {10.0, 3.0, 1.0}, {30.0, 1.0, 1.0}}, 40.0};
}

PiecewiseLinear Steps(const std::vector<std::pair<double, double>>& steps, double end_s_m) {
  std::vector<LinearPiece> pieces;
  for (const auto& [s_m, value] : steps) pieces.push_back({s_m, value, value});
  return {std::move(pieces), end_s_m};
}

TEST(PiecewiseLinear, IsLinearOnPiecesAndAJumpBelongsToThePieceAfterIt) {
  const PiecewiseLinear function = Example();
  EXPECT_DOUBLE_EQ(function.Value(9.999), 1.0);
  EXPECT_DOUBLE_EQ(function.Value(10.0), 3.0);
  EXPECT_DOUBLE_EQ(function.Value(20.0), 2.0);
}

TEST(PiecewiseLinear, StaysAsItIsBeyondTheEnds) {
  const PiecewiseLinear function = Steps({{0.0, 5.0}, {10.0, 7.0}}, 20.0);
  EXPECT_DOUBLE_EQ(function.Value(-3.0), 5.0);
  EXPECT_DOUBLE_EQ(function.Value(23.0), 7.0);
  EXPECT_DOUBLE_EQ(function.Integral(-3.0), -15.0);
  EXPECT_DOUBLE_EQ(function.Integral(23.0), 50.0 + 91.0);
}

TEST(PiecewiseLinear, IntegratesExactly) {
  const PiecewiseLinear function = Example();
  EXPECT_DOUBLE_EQ(function.Integral(10.0), 10.0);
  EXPECT_DOUBLE_EQ(function.Integral(20.0), 10.0 + 25.0);
  EXPECT_DOUBLE_EQ(function.Integral(40.0), 10.0 + 40.0 + 10.0);
}

TEST(SmoothJumps, CentresALinearChangeOnTheJump) {
  const SmoothedFunction smooth = SmoothJumps(Steps({{0.0, 1.0}, {100.0, 3.0}}, 200.0), 20.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(90.0), 1.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(100.0), 2.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(110.0), 3.0);
  ASSERT_EQ(smooth.jumps.size(), 1U);
  EXPECT_EQ(smooth.jumps[0].s_m, 100.0);
  EXPECT_EQ(smooth.jumps[0].before, 1.0);
  EXPECT_EQ(smooth.jumps[0].after, 3.0);
  EXPECT_EQ(smooth.jumps[0].length_m, 20.0);
}

TEST(SmoothJumps, KeepsTheIntegralBetweenConstantPieces) {
  const PiecewiseLinear steps = Steps({{0.0, 1.0}, {30.0, -2.0}, {37.0, 5.0}, {80.0, 4.0}}, 100.0);
  const SmoothedFunction smooth = SmoothJumps(steps, 40.0);
  EXPECT_NEAR(smooth.function.Integral(100.0), steps.Integral(100.0), 100.0 * kSumRounding);
}

TEST(SmoothJumps, SharesAShortPieceBetweenTwoChanges) {
  const SmoothedFunction smooth =
      SmoothJumps(Steps({{0.0, 0.0}, {100.0, 1.0}, {106.0, 0.0}}, 200.0), 20.0);
  ASSERT_EQ(smooth.jumps.size(), 2U);
  EXPECT_DOUBLE_EQ(smooth.jumps[0].length_m, 6.0);
  EXPECT_DOUBLE_EQ(smooth.jumps[1].length_m, 6.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(103.0), 1.0);
}

TEST(SmoothJumps, TakesAtMostThePieceAtAnEnd) {
  const SmoothedFunction smooth = SmoothJumps(Steps({{0.0, 0.0}, {4.0, 1.0}}, 100.0), 20.0);
  ASSERT_EQ(smooth.jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(smooth.jumps[0].length_m, 8.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(0.0), 0.0);
  EXPECT_DOUBLE_EQ(smooth.function.Value(8.0), 1.0);
}

TEST(SmoothJumps, LeavesNoJumpBesideSlopes) {
  const PiecewiseLinear saw({{0.0, 0.0, 5.0}, {7.0, 1.0, 3.0}, {9.0, -1.0, -1.0}}, 30.0);
  const SmoothedFunction smooth = SmoothJumps(saw, 10.0);
  EXPECT_EQ(smooth.jumps.size(), 2U);
  const std::vector<LinearPiece>& pieces = smooth.function.pieces();
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    EXPECT_NEAR(pieces[i].end_value, pieces[i + 1].begin_value, kSumRounding) << "at piece " << i;
  }
}

TEST(SmoothJumps, LeavesAContinuousFunctionAlone) {
  const PiecewiseLinear ramp({{0.0, 1.0, 1.0}, {10.0, 1.0, 4.0}, {20.0, 4.0, 4.0}}, 30.0);
  const SmoothedFunction smooth = SmoothJumps(ramp, 10.0);
  EXPECT_TRUE(smooth.jumps.empty());
  ASSERT_EQ(smooth.function.pieces().size(), 3U);
  EXPECT_EQ(smooth.function.Value(15.0), ramp.Value(15.0));
}

}  // namespace
}  // namespace railcast
