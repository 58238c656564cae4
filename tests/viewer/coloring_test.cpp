#include "viewer/coloring.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "viewer/point_colors.h"

namespace railcast {
namespace {

Cloud Line(std::size_t num_points) {
  Cloud cloud;
  for (std::size_t i = 0; i < num_points; ++i) {
    for (const float value : {3.0F, 4.0F, static_cast<float>(i)})
      cloud.positions_m.push_back(value);
  }
  return cloud;
}

Label MakeLabel(std::uint32_t id, const char* name, const Rgb& rgb) {
  Label label;
  label.id = id;
  label.name = name;
  label.rgb = rgb;
  return label;
}

std::string FaultOf(const Cloud& cloud, const std::string& color_by) {
  try {
    static_cast<void>(ColorCloud(cloud, color_by, {}));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ColorCloud, NamesAndColoursTheLabelsThatOccur) {
  Cloud cloud = Line(4);
  cloud.fields["label"] = {7, 2, 7, 90};
  const LabelTable labels({MakeLabel(2, "sleeper", {1, 2, 3}),
                           MakeLabel(7, "contact_wire", {4, 5, 6}),
                           MakeLabel(8, "dropper", {7, 8, 9})});
  const auto coloring = std::get<CategoryColoring>(ColorCloud(cloud, "label", labels));
  ASSERT_EQ(coloring.categories.size(), 3U);
  EXPECT_EQ(coloring.categories[0].name, "sleeper");
  EXPECT_EQ(coloring.categories[1].name, "contact_wire");
  EXPECT_EQ(coloring.categories[2].name, "label 90");
  const std::vector<Rgb> colors = PointColors(coloring);
  EXPECT_EQ(colors[0], (Rgb{4, 5, 6}));
  EXPECT_EQ(colors[1], (Rgb{1, 2, 3}));
  EXPECT_EQ(colors[2], (Rgb{4, 5, 6}));
}

TEST(ColorCloud, NamesOutcomes) {
  Cloud cloud = Line(2);
  cloud.fields["outcome"] = {5, 0};
  const auto coloring = std::get<CategoryColoring>(ColorCloud(cloud, "outcome", {}));
  ASSERT_EQ(coloring.categories.size(), 2U);
  EXPECT_EQ(coloring.categories[0].name, "returned");
  EXPECT_EQ(coloring.categories[1].name, "clutter");
}

TEST(ColorCloud, SpansTheScaleFromThe1stToThe99thPercentile) {
  const auto coloring = std::get<ScalarColoring>(ColorCloud(Line(101), "height", {}));
  EXPECT_EQ(coloring.lowest, 1.0);
  EXPECT_EQ(coloring.highest, 99.0);
  const std::vector<Rgb> colors = PointColors(coloring);
  EXPECT_EQ(colors[0], ScaleColor(0.0));
  EXPECT_EQ(colors[50], ScaleColor(0.5));
  EXPECT_EQ(colors[100], ScaleColor(1.0));
}

TEST(ColorCloud, TakesRangesFromPositionsWhereTheFileHasNone) {
  Cloud cloud = Line(1);
  EXPECT_EQ(std::get<ScalarColoring>(ColorCloud(cloud, "range", {})).values[0], 5.0);
  cloud.fields["range_m"] = {17.0};
  EXPECT_EQ(std::get<ScalarColoring>(ColorCloud(cloud, "range", {})).values[0], 17.0);
}

TEST(ColorCloud, GreysPointsWithoutAValue) {
  Cloud cloud = Line(3);
  cloud.fields["intensity"] = {0.0, std::nan(""), 1.0};
  const std::vector<Rgb> colors = PointColors(ColorCloud(cloud, "intensity", {}));
  EXPECT_EQ(colors[0], ScaleColor(0.0));
  EXPECT_EQ(colors[1], (Rgb{110, 110, 110}));
  EXPECT_EQ(colors[2], ScaleColor(1.0));
}

TEST(ColorCloud, RefusesFieldsThatAreMissingOrNoKinds) {
  Cloud cloud = Line(1);
  EXPECT_EQ(FaultOf(cloud, "intensity"), "has no field intensity to color by");
  cloud.fields["label"] = {1.5};
  EXPECT_EQ(FaultOf(cloud, "label"), "field label must hold whole numbers (got 1.500000)");
}

TEST(ScaleColor, GrowsLighterAllTheWay) {
  const auto lightness = [](double place) {
    const Rgb rgb = ScaleColor(place);
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];  // Rec. 709 luma.
  };
  for (int i = 1; i <= 64; ++i) EXPECT_GT(lightness(i / 64.0), lightness((i - 1) / 64.0)) << i;
}

}  // namespace
}  // namespace railcast
