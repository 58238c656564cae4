#include "core/fidelity/frame_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/echo_frame.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr std::uint32_t kGround = 4;
constexpr std::uint32_t kContactWire = 7;
constexpr std::uint32_t kDropper = 9;
constexpr std::uint32_t kPerson = 13;
constexpr std::uint32_t kPole = 14;
constexpr std::uint32_t kRain = 23;

using Firings = std::vector<std::vector<MadeEcho>>;

FrameDifference Compare(const Firings& reference,
                        const Firings& other,
                        std::uint32_t num_other_returns = 3) {
  FrameComparison comparison({0.375F, 100.0F, {kContactWire, kDropper}});
  comparison.Add(MakeEchoFrame(reference), MakeEchoFrame(other, num_other_returns));
  return comparison.Result();
}

TEST(MatchEchoes, TakesTheNearestPairFirst) {
  // Matching in the order of the lists would pair 10.0 with 10.25, which is nearer to 10.3.
  EXPECT_THAT(MatchEchoes({10.0F, 10.3F}, {10.25F, 9.9F}, 0.375F),
              ElementsAre(Pair(1, 0), Pair(0, 1)));
}

TEST(MatchEchoes, TakesEveryEchoOnce) {
  EXPECT_THAT(MatchEchoes({10.0F}, {10.2F, 10.1F}, 0.375F), ElementsAre(Pair(0, 1)));
  EXPECT_THAT(MatchEchoes({10.2F, 10.1F}, {10.0F}, 0.375F), ElementsAre(Pair(1, 0)));
}

TEST(MatchEchoes, LeavesAloneWhatIsAsFarAsTheLimit) {
  EXPECT_THAT(MatchEchoes({10.0F}, {10.5F}, 0.5F), IsEmpty());
  EXPECT_THAT(MatchEchoes({10.0F}, {10.25F}, 0.5F), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(MatchEchoes({}, {10.0F}, 0.5F), IsEmpty());
}

TEST(ComparisonSpec, MatchesWithinAQuarterOfThePulsesLength) {
  Label wire;
  wire.id = 7;
  wire.name = "contact_wire";
  Label ground;
  ground.id = 4;
  ground.name = "ground";
  const LabelTable labels({wire, ground});
  const ComparisonSpec spec = MakeComparisonSpec({.pulse_length_ns = 5.0}, 120.0, labels, {});
  EXPECT_NEAR(static_cast<double>(spec.match_distance_m), 0.25 * 0.299792458 * 5.0, 1e-7);
  EXPECT_EQ(spec.range_max_m, 120.0F);
  EXPECT_THAT(spec.thin_labels, ElementsAre(7));
}

TEST(FrameComparison, FindsNothingBetweenEqualFrames) {
  const Firings firings = {{{10.0F}, {12.0F}}, {}, {{30.0F, kContactWire}}};
  const FrameDifference d = Compare(firings, firings);
  EXPECT_EQ(d.reference_echoes, (Matched{3, 3}));
  EXPECT_EQ(d.echoes, (Matched{3, 3}));
  EXPECT_EQ(d.thin, (Matched{1, 1}));
  EXPECT_EQ(d.further, (Matched{1, 1}));
  EXPECT_EQ(d.second, (Matched{0, 0}));
  EXPECT_EQ(d.range_m.p95, 0.0);
  EXPECT_EQ(d.intensity.p95, 0.0);
  EXPECT_EQ(d.dropout_error, 0.0);
}

TEST(FrameComparison, CountsWhatIsMissedAndWhatIsFalseByLabel) {
  const FrameDifference d = Compare({{{10.0F, kGround}}, {{20.0F, kGround}}, {{30.0F}}},
                                    {{{10.1F, kContactWire}}, {}, {{40.0F}, {50.0F}}});
  EXPECT_EQ(d.reference_echoes, (Matched{3, 1}));
  EXPECT_EQ(d.echoes, (Matched{3, 1}));
  EXPECT_EQ(d.reference_echoes_per_label.at(kGround), (Matched{2, 1}));
  EXPECT_EQ(d.echoes_per_label.at(kContactWire), (Matched{1, 1}));
  EXPECT_EQ(d.echoes_per_label.at(3), (Matched{2, 0}));
}

TEST(FrameComparison, ComparesEchoesOfSomeClassesOnly) {
  ComparisonSpec spec{0.375F, 100.0F, {kContactWire}};
  spec.labels = {kPerson};
  FrameComparison comparison(spec);
  // Of the persons, one is found as what stands behind, one is missed, and one is false.
  comparison.Add(MakeEchoFrame({{{10.0F, kPerson}}, {{20.0F, kPerson}}, {{30.0F, kGround}}}),
                 MakeEchoFrame({{{10.1F, kGround}}, {{40.0F, kPerson}}, {{30.2F, kGround}}}, 3));
  const FrameDifference d = comparison.Result();
  EXPECT_EQ(d.reference_echoes, (Matched{2, 1}));
  EXPECT_EQ(d.echoes, (Matched{1, 0}));
  EXPECT_NEAR(d.range_m.p95, 0.1, 1e-6);
}

TEST(FrameComparison, TakesQuantilesOfMatchedEchoes) {
  Firings reference;
  Firings other;
  // Errors of 1, 2 ... 100 thousandths, both in range and in intensity.
  for (int i = 1; i <= 100; ++i) {
    const float error = 1e-3F * static_cast<float>(i);
    reference.push_back({{8.0F, 3, 1.0F}});
    other.push_back({{8.0F + error, 3, 1.0F - error}});
  }
  const FrameDifference d = Compare(reference, other);
  const double round_off = 1e-6;  // The rounding of float32 at 8 m is 4.8e-7.
  EXPECT_NEAR(d.range_m.median, 0.050, round_off);
  EXPECT_NEAR(d.range_m.p95, 0.095, round_off);
  EXPECT_NEAR(d.range_m.p99, 0.099, round_off);
  EXPECT_NEAR(d.intensity.median, 0.050, round_off);
  EXPECT_NEAR(d.intensity.p95, 0.095, round_off);
}

TEST(FrameComparison, HasNoIntensityErrorWhereThereIsNoIntensity) {
  const FrameDifference d =
      Compare({{{10.0F}}}, {{{10.0F, 3, std::numeric_limits<float>::quiet_NaN()}}}, 1);
  EXPECT_TRUE(std::isnan(d.intensity.median));
  EXPECT_EQ(d.range_m.median, 0.0);
}

TEST(FrameComparison, AveragesTheDropoutErrorOverRangeBins) {
  // Bins of 10 m. In the first bin both firings return in the reference and one of two in the other
  // frame; in the third bin none and then one.
  Firings reference = {{{5.0F}}, {{6.0F}}, {{25.0F, 3, 0.2F, 0.5F, Outcome::kBelowThreshold}}};
  Firings other = {{{5.0F}}, {}, {{25.0F}}};
  const FrameDifference d = Compare(reference, other);
  EXPECT_EQ(d.range_bins[0].num_firings, 2U);
  EXPECT_EQ(d.range_bins[0].num_reference_returned, 2U);
  EXPECT_EQ(d.range_bins[0].num_returned, 1U);
  EXPECT_EQ(d.range_bins[2].num_firings, 1U);
  EXPECT_NEAR(d.dropout_error, (0.5 + 1.0) / 2.0, 1e-12);
}

TEST(FrameComparison, FindsAWireByAnEchoOfAnyWire) {
  const float tiny = 0.019F;
  const FrameDifference d = Compare({{{10.0F, kContactWire}},
                                     {{10.0F, kContactWire}},
                                     {{10.0F, kContactWire}},
                                     {{10.0F, kContactWire, 0.2F, tiny}}},
                                    {{{10.0F, kDropper}}, {{10.0F, kGround}}, {}, {}});
  EXPECT_EQ(d.thin, (Matched{3, 1}));
}

TEST(FrameComparison, CountsFurtherEchoesWithATwentiethOfTheBeam) {
  const FrameDifference d =
      Compare({{{10.0F}, {12.0F, 3, 0.2F, 0.06F}, {14.0F, 3, 0.2F, 0.04F}}, {{10.0F}, {12.0F}}},
              {{{12.0F}}, {{10.0F}}}, 1);
  EXPECT_EQ(d.further, (Matched{2, 1}));
  EXPECT_EQ(d.reference_echoes, (Matched{5, 2}));
}

TEST(FrameComparison, CountsSecondSurfacesByWhatLiesBesideTheMainOne) {
  Frame reference = MakeEchoFrame({{{10.0F}}, {{10.0F}}, {{10.0F}}, {}}, 3);
  Frame other = MakeEchoFrame({{{10.0F}}, {{10.0F}}, {{10.0F}}, {}}, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float shares[][2] = {{0.05F, 0.01F}, {0.3F, 0.0F}, {0.04F, 0.5F}, {0.5F, nan}};
  for (std::size_t firing = 0; firing < 4; ++firing) {
    for (std::size_t r = 0; r < 3; ++r) reference.mixed_share[3 * firing + r] = shares[firing][0];
    other.mixed_share[firing] = shares[firing][1];
  }
  FrameComparison comparison({0.375F, 100.0F, {}});
  comparison.Add(reference, other);
  EXPECT_EQ(comparison.Result().second, (Matched{3, 1}));
}

TEST(FrameComparison, TakesErrorsOfTheStrongestEchoesOnly) {
  const FrameDifference d = Compare({{{10.0F}, {12.0F}}}, {{{10.1F}, {12.2F}}});
  EXPECT_NEAR(d.range_m.p95, 0.1, 1e-6);
}

TEST(FrameComparison, LeavesClutterToTheLabels) {
  const MadeEcho drop{9.0F, kRain, 0.02F, std::numeric_limits<float>::quiet_NaN(),
                      Outcome::kClutter};
  const FrameDifference d = Compare({{drop}, {drop, {20.0F}}}, {{drop}, {{20.0F}}});
  EXPECT_EQ(d.reference_echoes, (Matched{1, 1}));
  EXPECT_EQ(d.echoes, (Matched{1, 1}));
  EXPECT_EQ(d.reference_echoes_per_label.at(kRain), (Matched{2, 1}));
}

TEST(ComparisonSpec, KnowsPersonsAndPolesByTheirLabels) {
  std::vector<Label> labels;
  for (const char* name : {"person", "pole", "mast", "signal", "ground"}) {
    Label label;
    label.id = static_cast<std::uint32_t>(labels.size());
    label.name = name;
    labels.push_back(label);
  }
  const ComparisonSpec spec = MakeComparisonSpec({}, 120.0, LabelTable(labels), {});
  EXPECT_THAT(spec.person_labels, ElementsAre(0));
  EXPECT_THAT(spec.pole_labels, ElementsAre(1, 2, 3));
}

TEST(FrameComparison, CountsPointsOnPersonsAndPolesByRange) {
  FrameComparison comparison({.match_distance_m = 0.375F,
                              .range_max_m = 400.0F,
                              .thin_labels = {},
                              .person_labels = {kPerson},
                              .pole_labels = {kPole}});
  const Frame reference = MakeEchoFrame({{{49.0F, kPerson}, {51.0F, kPole}},
                                         {{50.0F, kPerson}},
                                         {{390.0F, kPole}},
                                         {{20.0F, kPerson, 0.2F, 0.5F, Outcome::kBelowThreshold}}});
  const Frame other = MakeEchoFrame({{{49.0F, kPerson}}, {{49.0F, kPerson}}, {}, {{51.0F, kPole}}});
  comparison.Add(reference, other);
  const FrameDifference d = comparison.Result();
  EXPECT_EQ(d.persons.bins[0].num_reference, 1U);
  EXPECT_EQ(d.persons.bins[0].num, 2U);
  EXPECT_EQ(d.persons.bins[1].num_reference, 1U);
  EXPECT_EQ(d.persons.bins[1].num, 0U);
  EXPECT_EQ(d.poles.bins[1].num_reference, 1U);
  EXPECT_EQ(d.poles.bins[1].num, 1U);
  EXPECT_EQ(d.poles.bins.back().num_reference, 1U);
  EXPECT_TRUE(std::isnan(d.poles.Error())) << "too few points";
}

TEST(TargetPoints, AverageTheirErrorOverTheBinsWithEnoughPoints) {
  TargetPoints points;
  points.bins[0] = {20, 15};
  points.bins[2] = {100, 105};
  points.bins[3] = {19, 0};
  points.bins[4] = {0, 7};
  EXPECT_NEAR(points.Error(), (0.25 + 0.05) / 2.0, 1e-12);
}

constexpr float kNoStep = std::numeric_limits<float>::quiet_NaN();

TEST(FrameComparison, CountsStepsThatBothBeamsHaveAndTheirRangeErrors) {
  FrameComparison comparison({0.375F, 100.0F, {}});
  const Frame reference = MakeEchoFrame({{{10.0F}}, {{10.0F}}, {{10.0F}}, {{10.0F}}});
  const Frame other = MakeEchoFrame({{{10.1F}}, {{10.5F}}, {}, {{19.0F}}}, 1);
  comparison.AddEdges(reference, {0.1F, 0.5F, 0.2F, kNoStep}, other,
                      {0.1F, kNoStep, kNoStep, 0.3F});
  const FrameDifference d = comparison.Result();
  EXPECT_EQ(d.steps, (Matched{3, 1}));
  EXPECT_NEAR(d.step_range_m.median, 0.1, 1e-6);
  EXPECT_NEAR(d.step_range_m.p95, 0.5, 1e-6) << "beyond the distance of a match";
}

TEST(FrameComparison, ComparesTheLightOfRetroreflectorsAtEdges) {
  FrameComparison comparison({0.375F, 100.0F, {}});
  const auto bright = [](float intensity) { return MadeEcho{10.0F, 3, intensity}; };
  // At a step, at a second surface, at neither, and a diffuse surface at a step; one not found.
  Frame reference = MakeEchoFrame(
      {{bright(100.0F)}, {bright(100.0F)}, {bright(100.0F)}, {bright(0.5F)}, {bright(2.0F)}});
  reference.mixed_share[3] = 0.3F;
  const Frame other =
      MakeEchoFrame({{bright(90.0F)}, {bright(70.0F)}, {bright(0.1F)}, {bright(0.1F)}, {}}, 1);
  const std::vector<float> steps_m = {0.1F, kNoStep, kNoStep, 0.1F, 0.2F};
  comparison.AddEdges(reference, steps_m, other, steps_m);
  const FrameDifference d = comparison.Result();
  EXPECT_NEAR(d.bright_edges.median, 0.3, 1e-6);
  EXPECT_NEAR(d.bright_edges.p95, 1.0, 1e-6);
}

TEST(FrameComparison, SumsUpFrames) {
  FrameComparison comparison({0.375F, 100.0F, {}});
  const Frame frame = MakeEchoFrame({{{10.0F}}});
  comparison.Add(frame, frame);
  comparison.Add(frame, MakeEchoFrame({{}}));
  EXPECT_EQ(comparison.Result().reference_echoes, (Matched{2, 1}));
}

}  // namespace
}  // namespace railcast
