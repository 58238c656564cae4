#include <gtest/gtest.h>

#include "core/scenario/scenario.h"

namespace railcast {
namespace {

TEST(EffectsOf, AreNoneInRungGeometry) {
  ScenarioSpec spec;
  spec.fidelity = "geometry";
  EXPECT_EQ(EffectsOf(spec), EffectSet{});
}

TEST(EffectsOf, AreAllInRungPlausibility) {
  ScenarioSpec spec;
  spec.fidelity = "plausibility";
  EXPECT_EQ(EffectsOf(spec), (EffectSet{true, true, true, true, true}));
}

TEST(EffectsOf, FollowTheSingleSwitches) {
  ScenarioSpec spec;
  spec.fidelity = "plausibility";
  spec.effects = {{"rain", false}, {"noise", false}};
  EXPECT_EQ(EffectsOf(spec), (EffectSet{true, false, true, false, true}));
  spec.fidelity = "geometry";
  spec.effects = {{"snow", true}};
  EXPECT_EQ(EffectsOf(spec), (EffectSet{false, false, true, false, false}));
}

}  // namespace
}  // namespace railcast
