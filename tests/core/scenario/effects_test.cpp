#include "railcast/effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/detect/detector/effect_table.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::set<std::string> NamesIn(const EffectSet& effects) {
  const std::vector<std::string> names = EffectNames(effects);
  return {names.begin(), names.end()};
}

const std::set<std::string> kSurfaceEffects{
    "channel_bias",      "clutter",        "detection",   "detection_probability",
    "extinction",        "fog_echo",       "range_noise", "pointing_jitter",
    "pulse_stretch",     "sensor_dropout", "sunlight",    "surface_response",
    "surface_condition", "cover",          "halo",        "range_walk",
    "interference",      "spray",          "dead_time",   "mirror_paths",
    "saturation",        "ghost",          "texture",     "intensity_noise",
    "channel_gain"};

std::set<std::string> SurfaceAnd(const std::set<std::string>& more) {
  std::set<std::string> names = kSurfaceEffects;
  names.insert(more.begin(), more.end());
  return names;
}

TEST(EffectTable, HasARowForEachSwitch) {
  EXPECT_EQ(sizeof(EffectSet), EffectTable().size());  // EffectSet consists of bools only.
  EffectSet all;
  for (const Effect& effect : EffectTable()) {
    EXPECT_FALSE(all.*effect.is_on) << effect.name;
    all.*effect.is_on = true;
  }
  EXPECT_EQ(NamesIn(all).size(), EffectTable().size());
}

TEST(EffectsOfRung, AreNoneInGeometry) {
  EXPECT_EQ(EffectsOfRung(Fidelity::kGeometry), EffectSet{});
}

TEST(EffectsOfRung, AreThePublishedOnesInPlausibility) {
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kPlausibility)),
            (std::set<std::string>{"threshold", "rain", "snow", "noise", "sensor_dropout"}));
}

TEST(EffectsOfRung, ArePhysicalFromSurfaceOn) {
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kSurface)), kSurfaceEffects);
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kFootprint)),
            SurfaceAnd({"footprint", "thin_conductors", "edge_loss"}));
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kReference)),
            SurfaceAnd({"footprint", "dense_footprint", "sampled_waveform", "edge_loss"}));
}

TEST(EffectsOfRung, GoTogetherInEveryRung) {
  for (const Fidelity rung : kRungs) {
    EXPECT_EQ(ConflictIn(EffectsOfRung(rung)), std::nullopt) << NameOf(rung);
  }
}

TEST(EffectsOfRung, ThrowsForAuto) {
  EXPECT_EQ(MessageOf([&] { static_cast<void>(EffectsOfRung(Fidelity::kAuto)); }),
            R"(fidelity: must be "geometry", "plausibility", "surface", "footprint" or )"
            R"("reference" (got "auto"))");
}

TEST(ConflictIn, NamesAPublishedEffectBesideAPhysicalOne) {
  EXPECT_EQ(ConflictIn({.rain = true, .extinction = true}),
            "\"rain\" of the published model and \"extinction\" of physics must not both be on");
  EXPECT_EQ(ConflictIn({.noise = true, .sensor_dropout = true}), std::nullopt);
  EXPECT_EQ(ConflictIn({.sensor_dropout = true, .clutter = true}), std::nullopt);
}

TEST(ConflictIn, WantsAFootprintWithoutAnalyticWiresForTheDenseOne) {
  EXPECT_EQ(ConflictIn({.dense_footprint = true}),
            "\"dense_footprint\" must not be on without \"footprint\"");
  EXPECT_EQ(ConflictIn({.footprint = true, .thin_conductors = true, .dense_footprint = true}),
            "\"dense_footprint\" and \"thin_conductors\" must not both be on");
}

TEST(EffectsOf, FollowTheSingleSwitches) {
  ScenarioSpec spec;
  spec.fidelity = Fidelity::kPlausibility;
  spec.effects = {{"rain", false}, {"noise", false}};
  EXPECT_EQ(NamesIn(EffectsOf(spec)),
            (std::set<std::string>{"threshold", "snow", "sensor_dropout"}));
  spec.fidelity = Fidelity::kGeometry;
  spec.effects = {{"snow", true}};
  EXPECT_EQ(NamesIn(EffectsOf(spec)), std::set<std::string>{"snow"});
}

TEST(EffectsOf, ThrowsForTheSwitchesOfAnotherRung) {
  ScenarioSpec spec;
  spec.fidelity = Fidelity::kSurface;
  spec.effects = {{"snow", true}};
  EXPECT_EQ(MessageOf([&] { static_cast<void>(EffectsOf(spec)); }),
            R"(/effects: "snow" of the published model and "surface_response" of physics )"
            "must not both be on");
}

TEST(EffectsOf, ThrowsForASwitchOfNoEffect) {
  ScenarioSpec spec;
  spec.effects = {{"rian", true}};
  EXPECT_EQ(MessageOf([&] { static_cast<void>(EffectsOf(spec)); }),
            R"(/effects: unknown effect "rian", the nearest is "rain")");
}

template <class Change>
std::string DetectorFaultsOf(const Change& change) {
  DetectorSpec spec;
  change(spec);
  return MessageOf([&] { CheckDetectorSpec(spec); });
}

TEST(CheckDetectorSpec, TakesTheDefaults) {
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec&) {}), "no error");
}

TEST(CheckDetectorSpec, RefusesAWavelengthAtWhichNoMaterialIsKnown) {
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec& s) { s.beam.wavelength_nm = 1064; }),
            "/beam/wavelength_nm: must be 905 or 1550 (got 1064)");
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec& s) { s.beam.wavelength_nm = 1550; }), "no error");
}

TEST(CheckDetectorSpec, NamesEveryNumberThatBreaksItsRule) {
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec& s) {
              s.range_min_m = -1.0;
              s.range_max_m = std::nan("");
              s.beam.divergence_mrad = {-1.0, 1.0};
              s.beam.pulse_length_ns = 0.0;
              s.beam.reference_rays = 0;
              s.beam.footprint_rays = 32;
              s.receiver.range_at_10_percent_m = 0.0;
              s.receiver.snr_at_threshold = -5.0;
            }),
            "/range_min_m: must be >= 0 and <= 10000 (got -1)\n"
            "/range_max_m: must be > 0 and <= 10000 (got nan)\n"
            "/beam/divergence_mrad/0: must be >= 0 and <= 17.5 (got -1)\n"
            "/beam/pulse_length_ns: must be >= 0.1 and <= 100 (got 0)\n"
            "/beam/reference_rays: must be >= 1 and <= 4096 (got 0)\n"
            "/beam/footprint_rays: must be 16 or 64 (got 32)\n"
            "/receiver/range_at_10_percent_m: must be > 0 and <= 10000 (got 0)\n"
            "/receiver/snr_at_threshold: must be > 0 and <= 100 (got -5)");
}

TEST(CheckDetectorSpec, NamesTheWeatherThatCannotBe) {
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec& s) {
              s.weather.fog_density_per_m = -0.1;
              s.weather.visibility_m = 0.0;
              s.weather.rain_rate_mmph = -1.0;
              s.weather.snow_rate_mmph = INFINITY;
              s.weather.wetness = 1.5;
              s.weather.snow_cover = -0.5;
            }),
            "/weather/fog_density_per_m: must be >= 0 and <= 10 (got -0.1)\n"
            "/weather/visibility_m: must be >= 0.3 and <= 1000000000 (got 0)\n"
            "/weather/rain_rate_mmph: must be >= 0 and <= 5000 (got -1)\n"
            "/weather/snow_rate_mmph: must be >= 0 and <= 5000 (got inf)\n"
            "/weather/wetness: must be >= 0 and <= 1 (got 1.5)\n"
            "/weather/snow_cover: must be >= 0 and <= 1 (got -0.5)");
}

// Without a rule of its own, such a number would make points that are nowhere.
TEST(CheckDetectorSpec, RefusesEveryNumberThatIsNone) {
  const double none = std::nan("");
  EXPECT_EQ(DetectorFaultsOf([&](DetectorSpec& s) {
              s.plausibility.noise_sigma0_m = none;
              s.receiver.range_noise_floor_m = none;
              s.receiver.saturation_power_ratio = none;
              s.weather.fog_variation = none;
              s.weather.sun.azimuth_deg = none;
            }),
            "/plausibility/noise_sigma0_m: must be >= 0 and <= 10 (got nan)\n"
            "/receiver/range_noise_floor_m: must be >= 0 and <= 10 (got nan)\n"
            "/receiver/saturation_power_ratio: must be >= 2 and <= 1000000000 (got nan)\n"
            "/weather/fog_variation: must be >= 0 and <= 1 (got nan)\n"
            "/weather/sun/azimuth_deg: must be >= -360 and <= 360 (got nan)");
}

TEST(CheckDetectorSpec, HoldsWhatDependsOnTwoNumbersAsFilesDo) {
  EXPECT_EQ(DetectorFaultsOf([](DetectorSpec& s) { s.range_min_m = s.range_max_m; }),
            "/range_min_m: must be < range_max_m (got 300)");
  EXPECT_EQ(
      DetectorFaultsOf([](DetectorSpec& s) {
        s.weather.visibility_m = 100.0;
        s.weather.fog_density_per_m = 0.01;
      }),
      "/weather/visibility_m: must not be given together with \"fog_density_per_m\" (got 100)");
}

}  // namespace
}  // namespace railcast
