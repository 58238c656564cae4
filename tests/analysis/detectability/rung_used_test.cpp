#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/detectability/detect_report.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

RecordingInfo RunOf(Fidelity fidelity) {
  RecordingInfo run;
  run.scenario.emplace().fidelity = fidelity;
  run.origin.emplace();
  return run;
}

TEST(RungUsed, WarnsOfOneRayPerBeam) {
  for (const Fidelity rung : {Fidelity::kGeometry, Fidelity::kPlausibility, Fidelity::kSurface}) {
    const RungUsed used = RungOf({RunOf(rung)});
    EXPECT_EQ(used.InWords(), std::string(NameOf(rung)) + ": one ray per beam");
    EXPECT_THAT(used.Warning(), HasSubstr("sends one ray into each beam"));
    EXPECT_THAT(used.Warning(), HasSubstr("0.62 of the reference's points at 100 m"));
  }
  for (const Fidelity rung : {Fidelity::kFootprint, Fidelity::kReference}) {
    const RungUsed used = RungOf({RunOf(rung)});
    EXPECT_EQ(used.InWords(), std::string(NameOf(rung)) + ": beams with a width");
    EXPECT_THAT(used.Warning(), IsEmpty());
  }
}

TEST(RungUsed, GoesByTheEffectsThatAreOn) {
  RecordingInfo narrowed = RunOf(Fidelity::kFootprint);
  narrowed.scenario->effects["footprint"] = false;
  EXPECT_EQ(RungOf({narrowed}).InWords(), "footprint: one ray per beam");
  RecordingInfo widened = RunOf(Fidelity::kSurface);
  widened.scenario->effects["footprint"] = true;
  EXPECT_EQ(RungOf({widened}).InWords(), "surface: beams with a width");
}

TEST(RungUsed, GoesByWhatAutoChoseInEveryRun) {
  RecordingInfo wide = RunOf(Fidelity::kAuto);
  wide.origin->chosen_effects = {"surface_response", "footprint"};
  RecordingInfo narrow = RunOf(Fidelity::kAuto);
  narrow.origin->chosen_effects = {"surface_response"};
  EXPECT_EQ(RungOf({wide, wide}).InWords(), "auto: beams with a width");
  EXPECT_EQ(RungOf({wide, narrow, wide}).InWords(), "auto: one ray per beam");
  const RungUsed unknown = RungOf({wide, RunOf(Fidelity::kAuto)});
  EXPECT_EQ(unknown.InWords(),
            "auto: not known what was chosen, as a run is unfinished or its clouds are merged");
  EXPECT_THAT(unknown.Warning(), HasSubstr("If the rung that was chosen"));
  RecordingInfo merged = RunOf(Fidelity::kAuto);
  merged.origin.reset();
  EXPECT_EQ(RungOf({merged}).InWords(), unknown.InWords());
}

TEST(RungUsed, StandsWithItsWarningBeforeTheVerdicts) {
  const auto report_of = [](Fidelity rung) {
    return MakeDetectReport({DetectInRun("run", 1, {}, {})}, {}, "railcast-analyze detect", {},
                            RungOf({RunOf(rung)}));
  };
  const Report surface = report_of(Fidelity::kSurface);
  EXPECT_EQ(surface.facts.back().second, "surface: one ray per beam");
  EXPECT_THAT(surface.sections.front().paragraphs.back(), HasSubstr("Use footprint"));
  const Report footprint = report_of(Fidelity::kFootprint);
  for (const std::string& text : footprint.sections.front().paragraphs) {
    EXPECT_THAT(text, testing::Not(HasSubstr("Use footprint")));
  }
}

}  // namespace
}  // namespace railcast
