#include "core/fidelity/scene_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/fidelity/frame_comparison.h"
#include "tests/support/echo_frame.h"

namespace railcast {
namespace {

// Newcombe 1998 (Stat. Med. 17, 857), table I, method 4.
TEST(LeastShare, IsThatOfThePublishedExamples) {
  EXPECT_NEAR(LeastShare(81, 263), 0.2535, 5e-5);
  EXPECT_NEAR(LeastShare(15, 148), 0.0598, 5e-5);
  EXPECT_EQ(LeastShare(0, 20), 0.0);
  EXPECT_NEAR(LeastShare(1, 29), 0.0018, 5e-5);
}

// docs/frontier.md says so.
TEST(LeastShare, IsBeyondATenthFrom4Of10And7Of30And17Of100On) {
  EXPECT_LE(LeastShare(3, 10), 0.1);
  EXPECT_GT(LeastShare(4, 10), 0.1);
  EXPECT_LE(LeastShare(6, 30), 0.1);
  EXPECT_GT(LeastShare(7, 30), 0.1);
  EXPECT_LE(LeastShare(16, 100), 0.1);
  EXPECT_GT(LeastShare(17, 100), 0.1);
}

TEST(LeastShare, OfOneEchoIsBelowATenth) {
  EXPECT_LT(LeastShare(1, 1), 0.1);
  EXPECT_EQ(LeastShare(0, 0), 0.0);
}

TEST(MedianOf, HasALowerEndByRanks) {
  std::vector<float> errors(101);
  std::iota(errors.begin(), errors.end(), 1.0F);
  // (101 - 1.96 x sqrt(101)) / 2 = 40.65.
  EXPECT_EQ(MedianOf(errors).median, 51.0);
  EXPECT_EQ(MedianOf(errors).least, 40.0);
}

TEST(MedianOf, OfAFewErrorsSaysNothing) {
  EXPECT_EQ(MedianOf({1.0F, 2.0F, 3.0F}).least, 0.0);
  EXPECT_TRUE(std::isnan(MedianOf({}).median));
}

std::vector<ScenePart> Parts() {
  std::vector<Label> labels(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    labels[i].id = i + 1;
    labels[i].name = std::array{"ground", "contact_wire", "person"}[i];
  }
  std::vector<SceneObject> objects(2);
  objects[0].name = "a person";
  objects[0].instance = 7;
  objects[1].name = "ego";
  objects[1].is_ego = true;
  return MakeSceneParts(120.0, LabelTable(labels), {2}, objects);
}

TEST(SceneParts, AreRangesClassesAndObjects) {
  std::vector<std::string> names;
  for (const ScenePart& part : Parts()) names.push_back(part.name);
  EXPECT_THAT(names, testing::ElementsAre("0 to 50 m", "50 to 100 m", "100 to 150 m", "ground",
                                          "person", "a person"));
}

// A person of 30 echoes far off loses 13 of them, among a thousand echoes of the ground: 1.3 % of
// all.
TEST(SceneParts, ShowWhatTheMeanHides) {
  std::vector<std::vector<MadeEcho>> reference(1000, {{20.0F, 1}});
  std::vector<std::vector<MadeEcho>> other = reference;
  for (int i = 0; i < 30; ++i) {
    reference.push_back({{110.0F, 3}});
    other.push_back({{i < 13 ? 90.0F : 110.0F, 3}});
  }
  Frame seen = MakeEchoFrame(reference);
  for (std::size_t slot = 3000; slot < seen.num_slots(); ++slot) seen.instance[slot] = 7;
  FrameComparison comparison(
      {.match_distance_m = 0.375F, .range_max_m = 120.0F, .thin_labels = {}, .parts = Parts()});
  comparison.Add(seen, MakeEchoFrame(other));
  const FrameDifference d = comparison.Result();
  EXPECT_NEAR(1.0 - d.reference_echoes.share(), 0.013, 1e-3);
  EXPECT_EQ(d.parts[0].reference_echoes, (Matched{1000, 1000}));
  EXPECT_EQ(d.parts[1].echoes, (Matched{13, 0}));
  for (const std::size_t part : {2U, 4U, 5U}) {
    EXPECT_EQ(d.parts[part].reference_echoes, (Matched{30, 17})) << d.parts[part].part.name;
  }
  EXPECT_EQ(d.parts[2].range_m.median, 0.0);
}

}  // namespace
}  // namespace railcast
