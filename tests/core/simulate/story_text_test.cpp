#include "core/simulate/story_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();

LabelTable Labels() {
  Label wagon;
  wagon.id = 12;
  wagon.name = "wagon";
  return LabelTable({wagon});
}

FiringStory HitOnAWagon() {
  FiringStory story;
  story.firing = 4711;
  story.time_ns = 250;
  story.slot = 17;
  story.direction_sensor = Vector3(1.0, 0.0, 0.0);
  story.origin_world = Vector3(100.0, -2.5, 3.0);
  story.label = 12;
  story.instance = 3;
  story.material = 2;
  story.reflectivity = 0.5F;
  story.steps = {
      {"hit", Outcome::kReturned, 20.0F, 0.5F, kNotKnown, kNotKnown, kNotKnown},
      {"noise", Outcome::kReturned, 20.0F, 0.5F, 0.25F, 8.0F, 20.125F},
  };
  return story;
}

std::string TextOf(const FiringStory& story) {
  return StoryText(9, story, Labels(), TestMaterials());
}

TEST(StoryText, TellsWhatAFiringHitAndWhatEachEffectMadeOfIt) {
  EXPECT_EQ(
      TextOf(HitOnAWagon()),
      "frame 9 firing 4711 at 250 ns, slot 17\n"
      "from world 100.000  -2.500   3.000 along sensor 1.000000 0.000000 0.000000\n"
      "hits wagon, instance 3, material grey (reflectivity 0.5)\n"
      "after             outcome            true_range_m  cos_incidence   intensity  power_ratio"
      "    range_m\n"
      "hit               returned                     20            0.5           -            -"
      "          -\n"
      "noise             returned                     20            0.5        0.25            8"
      "     20.125\n");
}

TEST(StoryText, SaysHowManyEchoesAnEffectAdded) {
  FiringStory story = HitOnAWagon();
  story.steps.front() = {"clutter", Outcome::kReturned, 20.0F,     0.5F,
                         kNotKnown, kNotKnown,          kNotKnown, 2};
  EXPECT_NE(TextOf(story).find("\nclutter +2        returned  "), std::string::npos);
}

TEST(StoryText, SaysThatAFiringHitsNothing) {
  FiringStory story = HitOnAWagon();
  story.label = 0;
  EXPECT_NE(TextOf(story).find("\nhits nothing\nafter "), std::string::npos);
}

TEST(StoryText, CallsALabelThatTheTableLacksByItsNumber) {
  FiringStory story = HitOnAWagon();
  story.label = 13;
  EXPECT_NE(TextOf(story).find("\nhits 13, instance 3"), std::string::npos);
}

TEST(StoryText, ListsEchoesWithTheirSlotsWhereThereIsMoreThanOne) {
  FiringStory story = HitOnAWagon();
  const FiringStory::Echo wagon{12, 20.0F, 20.125F, 8.0F, 0.75F, Outcome::kReturned, 17};
  story.echoes = {wagon};
  EXPECT_EQ(TextOf(story), TextOf(HitOnAWagon()));
  story.echoes.push_back(
      {0, kNotKnown, kNotKnown, kNotKnown, 0.25F, Outcome::kNoSurface, std::nullopt});
  const std::string text = TextOf(story);
  EXPECT_EQ(text.substr(text.find("echo ")),
            "echo              outcome            true_range_m          share"
            "              power_ratio    range_m  slot\n"
            "wagon             returned                     20           0.75"
            "                        8     20.125  17\n"
            "nothing           no_surface                    -           0.25"
            "                        -          -  none\n");
}

}  // namespace
}  // namespace railcast
