#include "core/certify/certifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/certify/certified_figures.h"
#include "core/fidelity/frame_comparison.h"
#include "tests/core/fidelity/line_scenario.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

using testing::ElementsAre;

ScenarioSpec LineAt(Fidelity fidelity) {
  ScenarioSpec scenario = ReadLine({.trees_per_hectare = "100"});
  scenario.fidelity = fidelity;
  return scenario;
}

/// The certificate of a frame that a simulator of the scenario makes.
FrameCertificate CertificateOf(const ScenarioSpec& scenario,
                               double cost_share,
                               std::uint32_t frame_index,
                               int num_threads = 1) {
  const auto simulator = MakeSimulator(scenario, num_threads);
  const Certifier certifier(scenario, cost_share, *simulator);
  const auto begun = simulator->Begin(frame_index);
  Frame frame;
  simulator->Scan(*begun, frame);
  return certifier.Certify(*simulator, *begun, frame);
}

// So much that every firing is drawn.
constexpr double kAll = 1e6;

TEST(Certifier, FindsTheErrorOfAFrameIfAllFiringsAreDrawn) {
  for (const Fidelity fidelity : {Fidelity::kSurface, Fidelity::kFootprint}) {
    ScenarioSpec scenario = LineAt(fidelity);
    CertificateSums sums({.cost_share = kAll});
    sums.Add(CertificateOf(scenario, kAll, 3));
    const RunCertificate run = sums.Result(LabelTable(scenario.labels));
    ASSERT_EQ(run.drawn, run.firings);

    const auto frame_of = [&](SceneDetail detail, Fidelity rung) {
      scenario.world.detail = detail;
      const auto simulator = MakeSimulator(scenario, 1);
      SimulatorSpec spec = simulator->spec();
      spec.detector.effects = WithoutRangeErrors(EffectsAt(rung, scenario));
      simulator->Use(spec);
      return FrameBy(*simulator, 3);
    };
    FrameComparison comparison(
        MakeComparisonSpec(scenario.lidar.beam, 120.0, LabelTable(scenario.labels), {}));
    comparison.Add(frame_of(SceneDetail::kFull, Fidelity::kReference),
                   frame_of(SceneDetail::kAuto, fidelity));
    const FrameDifference whole = comparison.Result();
    // Rays are aimed within packets of others, which moves them by parts of 1e-7, so that one or
    // the other firing at an edge may meet another thing.
    EXPECT_NEAR(run.all.missed->value, 1.0 - whole.reference_echoes.share(), 0.004);
    EXPECT_NEAR(run.all.wrong->value, 1.0 - whole.echoes.share(), 0.004);
    EXPECT_NEAR(run.all.range_p50_m->value, whole.range_m.median, 2e-4);
  }
}

TEST(Certifier, DrawsTheSameFiringsAtAnyNumberOfThreadsAndFromAnyFirstFrame) {
  const ScenarioSpec scenario = LineAt(Fidelity::kSurface);
  const FrameCertificate alone = CertificateOf(scenario, 10.0, 5);
  ASSERT_FALSE(alone.drawn.empty());
  EXPECT_EQ(alone, CertificateOf(scenario, 10.0, 5, 4));
  const auto simulator = MakeSimulator(scenario, 2);
  const Certifier certifier(scenario, 10.0, *simulator);
  for (std::uint32_t index = 0; index <= 5; ++index) {
    const auto begun = simulator->Begin(index);
    Frame frame;
    simulator->Scan(*begun, frame);
    const FrameCertificate certificate = certifier.Certify(*simulator, *begun, frame);
    EXPECT_EQ(certificate == alone, index == 5);
  }
}

TEST(Certifier, DrawsAboutAsManyFiringsAsItsShareOfTheTimeIsEnoughFor) {
  const ScenarioSpec scenario = LineAt(Fidelity::kFootprint);
  const auto simulator = MakeSimulator(scenario, 1);
  const Certifier certifier(scenario, 1.0, *simulator);
  const auto num = static_cast<double>(CertificateOf(scenario, 1.0, 2).drawn.size());
  EXPECT_GT(num, certifier.num_expected() / 3.0);
  EXPECT_LT(num, certifier.num_expected() * 3.0);
}

TEST(Certifier, LeavesFramesAsTheyAre) {
  const ScenarioSpec scenario = LineAt(Fidelity::kFootprint);
  const auto plain = MakeSimulator(scenario, 1);
  const auto certified = MakeSimulator(scenario, 1);
  const Certifier certifier(scenario, 1.0, *certified);
  const auto begun = certified->Begin(2);
  Frame frame;
  certified->Scan(*begun, frame);
  static_cast<void>(certifier.Certify(*certified, *begun, frame));
  const Frame expected = FrameBy(*plain, 2);
  EXPECT_EQ(frame.outcome, expected.outcome);
  EXPECT_EQ(frame.label, expected.label);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasPoint(frame.outcome[slot])) continue;
    EXPECT_EQ(frame.range_m[slot], expected.range_m[slot]);
  }
}

TEST(Certifier, CertifiesWhatWeatherThatChangesMakesOfFrames) {
  ScenarioSpec rainy = LineAt(Fidelity::kSurface);
  const auto changed = MakeSimulator(rainy, 1);
  const Certifier certifier(rainy, 1.0, *changed);
  rainy.weather.rain_rate_mmph = 30.0;
  SimulatorSpec spec = changed->spec();
  UseWeather(rainy, rainy.weather, spec);
  changed->Use(spec);
  const auto begun = changed->Begin(2);
  Frame frame;
  changed->Scan(*begun, frame);
  const FrameCertificate certificate = certifier.Certify(*changed, *begun, frame);
  ASSERT_FALSE(certificate.drawn.empty());
  EXPECT_EQ(certificate, CertificateOf(rainy, 1.0, 2));
  EXPECT_NE(certificate, CertificateOf(LineAt(Fidelity::kSurface), 1.0, 2));
}

TEST(Certifier, RefusesTheReferenceItself) {
  const ScenarioSpec scenario = LineAt(Fidelity::kReference);
  const auto simulator = MakeSimulator(scenario, 1);
  EXPECT_THROW(Certifier(scenario, 0.01, *simulator), InputError);
}

TEST(RungsBeside, AreTheNextCheaperAndTheNextDearerOne) {
  const auto names_at = [](Fidelity fidelity) {
    const ScenarioSpec scenario = LineAt(fidelity);
    std::vector<std::string> names;
    for (const RungBeside& rung :
         RungsBeside(scenario, DetectorSpecOf(scenario, scenario.lidar, EffectsOf(scenario)))) {
      names.push_back(rung.name);
      EXPECT_EQ(rung.cost < 1.0, names.size() == 1 && fidelity != Fidelity::kPlausibility);
    }
    return names;
  };
  EXPECT_THAT(names_at(Fidelity::kPlausibility), ElementsAre("surface"));
  EXPECT_THAT(names_at(Fidelity::kSurface), ElementsAre("plausibility", "footprint"));
  EXPECT_THAT(names_at(Fidelity::kFootprint), ElementsAre("surface"));
}

TEST(Certifier, DrawsTheFiringsOfARegionThatItDrawsOfAll) {
  const ScenarioSpec scenario = LineAt(Fidelity::kSurface);
  const auto simulator = MakeSimulator(scenario, 1);
  // Those of trees and grass have probability 1, others less.
  const Certifier certifier(scenario, 40.0, *simulator);
  const auto begun = simulator->Begin(3);
  Frame frame;
  simulator->Scan(*begun, frame);
  CertifiedRegion region;
  for (std::uint32_t cell = 0; cell < frame.rows * frame.columns; cell += 1 + cell % 11) {
    region.cells.push_back(cell);
  }
  const FrameCertificate all = certifier.Certify(*simulator, *begun, frame);
  const FrameCertificate some = certifier.Certify(*simulator, *begun, frame, &region);
  const auto [least, most] = std::ranges::minmax(some.strata, {}, &StratumCount::probability);
  ASSERT_LT(least.probability, most.probability);
  ASSERT_EQ(most.probability, 1.0);
  std::vector<std::uint32_t> expected, drawn;
  for (const DrawnFiring& firing : all.drawn) {
    if (std::ranges::binary_search(region.cells, firing.cell)) expected.push_back(firing.cell);
  }
  for (const DrawnFiring& firing : some.drawn) drawn.push_back(firing.cell);
  EXPECT_LT(drawn.size(), region.cells.size());
  EXPECT_EQ(drawn, expected);
}

// As fidelity `auto` chooses it for a tolerance of persons.
TEST(RungsBeside, HaveTheFootprintOfAllBeamsBesideThatOfSome) {
  const ScenarioSpec scenario = LineAt(Fidelity::kFootprint);
  DetectorSpec own = DetectorSpecOf(scenario, scenario.lidar, EffectsOf(scenario));
  own.beam.footprint_of = {"person"};
  const std::vector<RungBeside> rungs = RungsBeside(scenario, own);
  ASSERT_EQ(rungs.size(), 2U);
  EXPECT_EQ(rungs[0].name, "surface");
  EXPECT_EQ(rungs[1].name, "footprint");
  EXPECT_FALSE(rungs[1].variant.has_footprint_of);
  EXPECT_GT(rungs[1].cost, 2.0);
}

TEST(RungsBeside, KeepTheScenariosSwitchesWhereTheyCan) {
  ScenarioSpec scenario = LineAt(Fidelity::kSurface);
  scenario.effects["clutter"] = false;
  EXPECT_FALSE(EffectsAt(Fidelity::kReference, scenario).clutter);
  scenario.effects["thin_conductors"] = true;
  EXPECT_TRUE(EffectsAt(Fidelity::kSurface, scenario).thin_conductors);
  // The reference samples the wires' triangles: they would count twice.
  EXPECT_FALSE(EffectsAt(Fidelity::kReference, scenario).thin_conductors);
}

}  // namespace
}  // namespace railcast
