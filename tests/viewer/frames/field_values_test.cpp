#include "viewer/frames/shown_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsNan;
using testing::SizeIs;
using Kind = FieldValues::Kind;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// What a field to colour by must give, computed from the frame's own fields.
struct Expected {
  std::string title;
  Kind kind;
  std::string needs;  ///< Name in railcast/frame.h.
  std::function<double(const Frame&, std::size_t slot)> value;
};

template <typename T>
auto Plain(std::vector<T> Frame::*values) {
  return [values](const Frame& frame, std::size_t i) {
    return static_cast<double>((frame.*values)[i]);
  };
}

double Noise_mm(const Frame& frame, std::size_t i) {
  return 1000.0 *
         (static_cast<double>(frame.range_m[i]) - static_cast<double>(frame.true_range_m[i]));
}

const std::map<std::string, Expected>& AllExpected() {
  static const std::map<std::string, Expected> all = {
      {"label", {"label", Kind::kCategory, "label", Plain(&Frame::label)}},
      {"instance", {"instance", Kind::kCategory, "instance", Plain(&Frame::instance)}},
      {"outcome", {"outcome", Kind::kCategory, "outcome", Plain(&Frame::outcome)}},
      {"range", {"range [m]", Kind::kAmount, "range_m", Plain(&Frame::range_m)}},
      {"height", {"height [m]", Kind::kAmount, "", Plain(&Frame::z)}},
      {"intensity", {"intensity", Kind::kAmount, "intensity", Plain(&Frame::intensity)}},
      {"power", {"power / threshold", Kind::kAmount, "power_ratio", Plain(&Frame::power_ratio)}},
      {"time",
       {"time [ms]", Kind::kAmount, "time_ns",
        [](const Frame& frame, std::size_t i) { return frame.time_ns[i] / 1e6; }}},
      {"ring", {"ring", Kind::kAmount, "ring", Plain(&Frame::ring)}},
      {"column", {"column", Kind::kAmount, "column", Plain(&Frame::column)}},
      {"return", {"return", Kind::kCategory, "return_index", Plain(&Frame::return_index)}},
      {"returns",
       {"returns of the firing", Kind::kCategory, "return_count", Plain(&Frame::return_count)}},
      {"noise", {"measured - true [mm]", Kind::kDifference, "true_range_m", Noise_mm}},
      {"true_range",
       {"true range [m]", Kind::kAmount, "true_range_m", Plain(&Frame::true_range_m)}},
      {"incidence",
       {"incidence [deg]", Kind::kAmount, "incidence_rad",
        [](const Frame& frame, std::size_t i) {
          return static_cast<double>(frame.incidence_rad[i]) / std::numbers::pi * 180.0;
        }}},
      {"velocity",
       {"velocity along the beam [m/s]", Kind::kDifference, "radial_velocity_mps",
        Plain(&Frame::radial_velocity_mps)}},
      {"true_velocity",
       {"true velocity along the beam [m/s]", Kind::kDifference, "true_radial_velocity_mps",
        Plain(&Frame::true_radial_velocity_mps)}},
      {"material", {"material", Kind::kCategory, "material", Plain(&Frame::material)}},
      {"footprint_share",
       {"share of the beam", Kind::kAmount, "footprint_share", Plain(&Frame::footprint_share)}},
      {"mixed_share",
       {"mixed share of the beam", Kind::kAmount, "mixed_share", Plain(&Frame::mixed_share)}},
      {"x", {"x [m]", Kind::kAmount, "", Plain(&Frame::x)}},
      {"y", {"y [m]", Kind::kAmount, "", Plain(&Frame::y)}}};
  return all;
}

ShownFrame FullFrame() {
  return MakeShownFrame(Record(WithVelocities(ExampleFrame(3))));
}

RecordedFrame ForeignCloud() {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  recorded.foreign = {{"curvature", {0.5F, kNaN, -2.0F}},
                      {"height", {100.0F, 200.0F, 300.0F}},
                      {"ambient", {9.0F, 8.0F, 7.0F}}};
  return recorded;
}

TEST(ColorFields, AreAllOfThoseThatAFullFrameHas) {
  const std::vector<std::string> names = ColorableFields(*FullFrame().recorded);
  EXPECT_THAT(names, SizeIs(AllExpected().size()));
  for (const std::string& name : names) EXPECT_TRUE(AllExpected().contains(name)) << name;
  // The fields that users look at most come first.
  EXPECT_THAT(std::vector(names.begin(), names.begin() + 5),
              ElementsAre("label", "instance", "outcome", "range", "height"));
}

TEST(ColorFields, HaveTheFramesValuesInTheUnitOfTheirTitle) {
  const ShownFrame shown = FullFrame();
  ASSERT_GT(shown.num_points(), 5U);
  ASSERT_LT(shown.num_points(), shown.frame().num_slots()) << "some slots have no point";
  for (const auto& [name, expected] : AllExpected()) {
    const FieldValues field = ValuesOf(shown, name);
    EXPECT_EQ(field.title, expected.title);
    EXPECT_EQ(field.kind, expected.kind) << name;
    ASSERT_THAT(field.values, SizeIs(shown.num_points())) << name;
    for (std::size_t i = 0; i < shown.num_points(); ++i) {
      // Rounding of a product or quotient of doubles of 3e5 mm at most.
      ASSERT_NEAR(field.values[i], expected.value(shown.frame(), shown.slots[i]), 1e-9) << name;
    }
  }
}

TEST(ColorFields, SayMillisecondsMillimetresAndDegrees) {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{20, 0, 0}});
  recorded.fields.insert({"time_ns", "true_range_m", "incidence_rad"});
  recorded.frame.time_ns[0] = 2'500'000;
  recorded.frame.true_range_m[0] = 20.125F;
  recorded.frame.incidence_rad[0] = std::numbers::pi_v<float> / 6.0F;
  const ShownFrame shown = Show(std::move(recorded));
  EXPECT_DOUBLE_EQ(ValuesOf(shown, "time").values[0], 2.5);
  EXPECT_DOUBLE_EQ(ValuesOf(shown, "noise").values[0], -125.0);
  EXPECT_NEAR(ValuesOf(shown, "incidence").values[0], 30.0, 2e-6) << "pi / 6 as float";
}

TEST(ColorFields, OfPlacesAreWherePointsAreShown) {
  ShownFrame shown = Show(RecordedCloud("a.pcd", {{1, 2, 3}}));
  shown.positions_m = {1.5F, 2.5F, 3.5F};  // As if the motion had been undone.
  EXPECT_THAT(ValuesOf(shown, "x").values, ElementsAre(1.5));
  EXPECT_THAT(ValuesOf(shown, "y").values, ElementsAre(2.5));
  EXPECT_THAT(ValuesOf(shown, "height").values, ElementsAre(3.5));
}

TEST(ColorFields, AreLeftOutWhereTheFrameLacksWhatTheyAreMadeOf) {
  for (const auto& [name, expected] : AllExpected()) {
    if (expected.needs.empty()) continue;
    RecordedFrame recorded = Record(ExampleFrame(3));
    recorded.fields.erase(expected.needs);
    for (const std::string& left : ColorableFields(recorded)) {
      EXPECT_NE(AllExpected().at(left).needs, expected.needs) << left;
    }
    const ShownFrame shown = MakeShownFrame(std::move(recorded));
    // Clang 14 cannot capture the names of a structured binding.
    const std::string& missing = name;
    const std::string message = MessageOf([&] { (void)ValuesOf(shown, missing); });
    EXPECT_EQ(message.rfind("has no field " + missing + " to color by (has: ", 0), 0U) << message;
  }
}

TEST(ColorFields, ThatABareCloudLacksAreRefusedWithThoseItHas) {
  const ShownFrame shown = Show(RecordedCloud("a.pcd", {{1, 2, 3}}));
  EXPECT_THAT(ColorableFields(*shown.recorded), ElementsAre("range", "height", "x", "y"));
  EXPECT_EQ(MessageOf([&] { (void)ValuesOf(shown, "power"); }),
            "has no field power to color by (has: range, height, x, y)");
  EXPECT_EQ(MessageOf([&] { (void)ValuesOf(shown, "power_ratio"); }),
            "has no field power_ratio to color by (has: range, height, x, y)");
  EXPECT_EQ(MessageOf([&] { (void)ValuesOf(shown, ""); }),
            "has no field  to color by (has: range, height, x, y)");
}

TEST(ColorFields, BeginWithLabelsWhereThereAreSomeElseWithHeight) {
  EXPECT_EQ(DefaultColorField(Record(ExampleFrame(0))), "label");
  EXPECT_EQ(DefaultColorField(RecordedCloud("a.pcd", {{1, 2, 3}})), "height");
}

TEST(ColorFields, EndWithTheForeignOnesByTheirOwnNames) {
  EXPECT_THAT(ColorableFields(ForeignCloud()),
              ElementsAre("range", "height", "x", "y", "curvature", "file_height", "ambient"));
}

TEST(ColorFields, OfForeignNamesAreAmountsAsTheFileHasThem) {
  ShownFrame shown = Show(ForeignCloud());
  const FieldValues curvature = ValuesOf(shown, "curvature");
  EXPECT_EQ(curvature.kind, Kind::kAmount);
  EXPECT_EQ(curvature.title, "curvature");
  EXPECT_THAT(curvature.values, ElementsAre(0.5, IsNan(), -2.0));
  // Foreign values are stored per slot.
  shown.slots = {2, 0};
  EXPECT_THAT(ValuesOf(shown, "ambient").values, ElementsAre(7.0, 9.0));
}

TEST(ColorFields, OfOursAreNotShadowedByForeignOnes) {
  const ShownFrame shown = Show(ForeignCloud());
  EXPECT_THAT(ValuesOf(shown, "height").values, ElementsAre(3.0, 6.0, 9.0));
  EXPECT_THAT(ValuesOf(shown, "file_height").values, ElementsAre(100.0, 200.0, 300.0));
}

TEST(ColorFields, OfOursThatTheFrameLacksAreNotForeignOnes) {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{1, 2, 3}});
  recorded.foreign = {{"noise", {4.0F}}};
  const ShownFrame shown = Show(std::move(recorded));
  EXPECT_EQ(MessageOf([&] { (void)ValuesOf(shown, "noise"); }),
            "has no field noise to color by (has: range, height, x, y, file_noise)");
  EXPECT_THAT(ValuesOf(shown, "file_noise").values, ElementsAre(4.0));
}

}  // namespace
}  // namespace railcast
