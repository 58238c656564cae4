#include "core/certify/certified_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint32_t kGroundLabel = 4;
constexpr std::uint32_t kPersonLabel = 13;
constexpr Stratum kGroundStratum{
    .label = kGroundLabel, .range_bin = 0, .is_edge = false, .has_return = true};

CertifiedEcho Found(double error_m,
                    std::uint32_t label = kGroundLabel,
                    std::uint32_t instance = 0) {
  return {EchoVerdict::kFound, label, instance, 20.0, error_m, 1.1, false};
}

/// A frame of 10,000 firings of which 40 were drawn: 30 with an echo of the ground, of which 6 are
/// missed; and 10 on a person, all found.
FrameCertificate MadeCertificate() {
  FrameCertificate certificate;
  certificate.strata.push_back({kGroundStratum, 10'000, 0.004});
  for (std::uint32_t i = 0; i < 40; ++i) {
    DrawnFiring& drawn = certificate.drawn.emplace_back();
    drawn.cell = 100 * i;
    drawn.rungs = {{1, 0, 0}};
    if (i < 10) {
      drawn.echoes = {Found(0.001, kPersonLabel, 7)};
    } else if (i < 16) {
      drawn.echoes = {{EchoVerdict::kMissed, kGroundLabel, 0, 60.0},
                      {EchoVerdict::kFalse, kGroundLabel, 0, 66.0}};
    } else {
      drawn.echoes = {Found(0.002)};
    }
  }
  return certificate;
}

LabelTable Labels() {
  Label ground;
  ground.id = kGroundLabel;
  ground.name = "ground";
  Label person;
  person.id = kPersonLabel;
  person.name = "person";
  return LabelTable({ground, person});
}

RunCertificate OfOneFrame(const std::optional<ToleranceSpec>& tolerance = {},
                          const std::vector<std::uint32_t>& tolerance_labels = {}) {
  CertificateSums sums({0.01, {{"surface", {}, 0.125}}, {{7, "Ann"}}, tolerance, tolerance_labels});
  sums.Add(MadeCertificate());
  return sums.Result(Labels());
}

TEST(CertificateSums, GiveSharesOfMissedAndFalseEchoesOverAll) {
  const RunCertificate run = OfOneFrame();
  EXPECT_EQ(run.frames, 1U);
  EXPECT_EQ(run.firings, 10'000U);
  EXPECT_EQ(run.drawn, 40U);
  EXPECT_EQ(run.all.echoes, 40U);
  EXPECT_DOUBLE_EQ(run.all.missed->value, 6.0 / 40.0);
  EXPECT_DOUBLE_EQ(run.all.wrong->value, 6.0 / 40.0);
  EXPECT_DOUBLE_EQ(run.all.other_label->value, 0.0);
  EXPECT_DOUBLE_EQ(run.all.range_p50_m->value, 0.002);
  EXPECT_NEAR(run.all.power_p50->value, 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(run.without_drawn, 0.0);
}

TEST(CertificateSums, GiveThemByClassRangeAndObject) {
  const RunCertificate run = OfOneFrame();
  ASSERT_EQ(run.classes.size(), 2U);
  EXPECT_EQ(run.classes[0].name, "ground");
  EXPECT_DOUBLE_EQ(run.classes[0].missed->value, 6.0 / 30.0);
  EXPECT_EQ(run.classes[1].name, "person");
  EXPECT_EQ(run.classes[1].echoes, 10U);
  ASSERT_EQ(run.ranges.size(), 2U);
  EXPECT_EQ(run.ranges[0].name, "0 to 25 m");
  EXPECT_EQ(run.ranges[1].name, "50 to 100 m");
  ASSERT_EQ(run.objects.size(), 1U);
  EXPECT_EQ(run.objects[0].name, "Ann");
  EXPECT_EQ(run.objects[0].echoes, 10U);
}

TEST(CertificateSums, GiveNoFigureOfRowsOfFewerThanThirtyEchoes) {
  const auto run_of = [](std::uint32_t num) {
    FrameCertificate certificate;
    certificate.strata.push_back({kGroundStratum, 10'000, 0.004});
    certificate.drawn.resize(num);
    for (DrawnFiring& drawn : certificate.drawn) drawn.echoes = {Found(0.001, kGroundLabel, 7)};
    CertificateSums sums({.objects = {{7, "Ann"}}});
    sums.Add(certificate);
    return sums.Result(Labels());
  };
  for (const std::uint32_t num : {9U, 10U, 29U, 30U}) {
    const RunCertificate run = run_of(num);
    for (const auto* rows : {&run.classes, &run.ranges, &run.objects}) {
      ASSERT_EQ(rows->size(), 1U);
      EXPECT_EQ((*rows)[0].echoes, num);
      EXPECT_EQ((*rows)[0].missed.has_value(), num >= 30) << num;
      EXPECT_EQ((*rows)[0].range_p95_m.has_value(), num >= 30) << num;
    }
    EXPECT_EQ(run.all.missed.has_value(), num >= 10) << num;
  }
}

// As of things in a recording that no beam comes near.
TEST(CertificateSums, KnowOfFramesWithoutFirings) {
  CertificateSums sums({});
  sums.Add({});
  const RunCertificate run = sums.Result(LabelTable());
  EXPECT_EQ(run.frames, 1U);
  EXPECT_EQ(run.without_drawn, 0.0);
}

TEST(CertificateSums, TellWhatAnotherRungMissesOnTheSameFirings) {
  const RunCertificate run = OfOneFrame();
  ASSERT_EQ(run.rungs.size(), 1U);
  EXPECT_DOUBLE_EQ(run.rungs[0].missed->value, 0.0);
  EXPECT_THAT(CertificateText(run),
              HasSubstr("surface would take 0.12 times as long and miss 0.0 %"));
}

TEST(CertificateSums, CountFramesOfWhichTheToleranceIsKnownToHold) {
  ToleranceSpec wide;
  wide.missed_share = wide.false_share = 0.5;
  wide.range_m = 0.1;
  EXPECT_EQ(OfOneFrame(wide).tolerance->frames_within, 1U);
  EXPECT_TRUE(OfOneFrame(wide).tolerance->is_within);
  ToleranceSpec narrow = wide;
  narrow.missed_share = 0.01;
  EXPECT_EQ(OfOneFrame(narrow).tolerance->frames_beyond, 1U);
  ToleranceSpec between = wide;
  between.missed_share = 0.15;
  EXPECT_EQ(OfOneFrame(between).tolerance->frames_within, 0U);
  EXPECT_EQ(OfOneFrame(between).tolerance->frames_beyond, 0U);
  EXPECT_FALSE(OfOneFrame(between).tolerance->is_within);
}

TEST(CertificateSums, HoldATolerancesClassesAgainstIt) {
  ToleranceSpec narrow;
  narrow.missed_share = 0.01;
  narrow.false_share = 1.0;
  // Of the ground, 6 of 30 echoes are missed, of persons none.
  EXPECT_EQ(OfOneFrame(narrow, {kGroundLabel}).tolerance->frames_beyond, 1U);
  EXPECT_EQ(OfOneFrame(narrow, {kPersonLabel}).tolerance->frames_beyond, 0U);
}

TEST(CertificateText, SaysHowMuchIsMissedAndHowManyFiringsTellIt) {
  const std::string text = CertificateText(OfOneFrame());
  EXPECT_THAT(text, HasSubstr("certificate: 15.0 % ("));
  EXPECT_THAT(text, HasSubstr("40 of 10000 firings were made anew on rung reference"));
}

TEST(CertificateText, SaysWhatShareWouldTellMore) {
  // The interval of 6 of 40 is 0.057 to 0.298: (0.1205 / 0.05)^2 = 5.8 times as many would do.
  RunCertificate run = OfOneFrame();
  EXPECT_THAT(CertificateText(run),
              HasSubstr("  --certify 6% would tell the share of missed echoes to +-5 points\n"));
  run.firings = 200;
  EXPECT_THAT(CertificateText(run),
              HasSubstr("  only more frames would tell the share of missed echoes"));
  run.all.missed = CertifiedFigure{0.1, 0.06, 0.15};
  EXPECT_THAT(CertificateText(run), Not(HasSubstr("would tell")));
  // Nothing is known: 400 echoes would do, of which 8 were drawn.
  run = {.cost_share = 0.01, .firings = 10'000, .drawn = 20};
  run.all.echoes = 8;
  EXPECT_THAT(CertificateText(run), HasSubstr("too few echoes were drawn to tell"));
  EXPECT_THAT(CertificateText(run), HasSubstr("  --certify 50% would tell"));
}

}  // namespace
}  // namespace railcast
