#include "core/scenario/effects.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "core/scenario/effect_names.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

std::set<std::string> NamesIn(const EffectSet& effects) {
  std::set<std::string> names;
  for (const auto& [name, effect] : kEffects) {
    if (effects.*effect) names.insert(name);
  }
  return names;
}

const std::set<std::string> surface_effects{
    "channel_bias",     "clutter",        "detection",   "detection_probability",
    "extinction",       "fog_echo",       "range_noise", "pointing_jitter",
    "pulse_stretch",    "sensor_dropout", "sunlight",    "surface_response",
    "surface_condition"};

std::set<std::string> SurfaceAnd(const std::set<std::string>& more) {
  std::set<std::string> names = surface_effects;
  names.insert(more.begin(), more.end());
  return names;
}

TEST(EffectNames, NameEachSwitchOnce) {
  EXPECT_EQ(sizeof(EffectSet), std::size(kEffects));  // It is nothing but flags.
  EffectSet all;
  for (const auto& [name, effect] : kEffects) {
    EXPECT_FALSE(all.*effect) << name;
    all.*effect = true;
  }
  EXPECT_EQ(NamesIn(all).size(), std::size(kEffects));
}

TEST(EffectsOfRung, AreNoneInGeometry) {
  EXPECT_EQ(EffectsOfRung("geometry"), EffectSet{});
}

TEST(EffectsOfRung, AreThePublishedOnesInPlausibility) {
  EXPECT_EQ(NamesIn(EffectsOfRung("plausibility")),
            (std::set<std::string>{"threshold", "rain", "snow", "noise", "sensor_dropout"}));
}

TEST(EffectsOfRung, ArePhysicalFromSurfaceOn) {
  EXPECT_EQ(NamesIn(EffectsOfRung("surface")), surface_effects);
  EXPECT_EQ(NamesIn(EffectsOfRung("footprint")), SurfaceAnd({"footprint", "thin_conductors"}));
  EXPECT_EQ(NamesIn(EffectsOfRung("reference")),
            SurfaceAnd({"footprint", "dense_footprint", "sampled_waveform"}));
}

TEST(EffectsOfRung, GoTogetherInEveryRung) {
  for (const std::string& rung : RungNames()) {
    EXPECT_EQ(ConflictIn(EffectsOfRung(rung)), std::nullopt) << rung;
  }
}

TEST(EffectsOfRung, ThrowsForAnotherName) {
  try {
    static_cast<void>(EffectsOfRung("best"));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 R"(fidelity: must be "geometry", "plausibility", "surface", "footprint" or )"
                 R"("reference" (got "best"))");
  }
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
  spec.fidelity = "plausibility";
  spec.effects = {{"rain", false}, {"noise", false}};
  EXPECT_EQ(NamesIn(EffectsOf(spec)),
            (std::set<std::string>{"threshold", "snow", "sensor_dropout"}));
  spec.fidelity = "geometry";
  spec.effects = {{"snow", true}};
  EXPECT_EQ(NamesIn(EffectsOf(spec)), std::set<std::string>{"snow"});
}

TEST(EffectsOf, ThrowsForTheSwitchesOfAnotherRung) {
  ScenarioSpec spec;
  spec.fidelity = "surface";
  spec.effects = {{"snow", true}};
  try {
    static_cast<void>(EffectsOf(spec));
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 R"(/effects: "snow" of the published model and "surface_response" of physics )"
                 "must not both be on");
  }
}

}  // namespace
}  // namespace railcast
