#include "railcast/effects.h"

#include <gtest/gtest.h>

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

const std::set<std::string> surface_effects{
    "channel_bias",      "clutter",        "detection",   "detection_probability",
    "extinction",        "fog_echo",       "range_noise", "pointing_jitter",
    "pulse_stretch",     "sensor_dropout", "sunlight",    "surface_response",
    "surface_condition", "cover",          "halo",        "range_walk",
    "interference",      "spray",          "dead_time",   "mirror_paths",
    "saturation",        "ghost"};

std::set<std::string> SurfaceAnd(const std::set<std::string>& more) {
  std::set<std::string> names = surface_effects;
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
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kSurface)), surface_effects);
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kFootprint)),
            SurfaceAnd({"footprint", "thin_conductors"}));
  EXPECT_EQ(NamesIn(EffectsOfRung(Fidelity::kReference)),
            SurfaceAnd({"footprint", "dense_footprint", "sampled_waveform"}));
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

}  // namespace
}  // namespace railcast
