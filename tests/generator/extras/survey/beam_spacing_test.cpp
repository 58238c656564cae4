#include "generator/extras/survey/survey_voxels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "tests/generator/extras/survey/survey_scenes.h"

namespace railcast {
namespace {

/// Beams in rows and columns at 20 m, but for a square without points.
SurveyFrame GridOfBeams(double row_deg, double column_deg) {
  MadeFrames frames;
  SurveyFrame& frame = frames.Add({3.0, 4.0, 5.0});
  for (int row = -8; row <= 8; ++row) {
    for (int column = -40; column <= 40; ++column) {
      if (row > 5 && column > 30) continue;
      const double elevation_rad = RadFromDeg(row_deg * row);
      const double azimuth_rad = RadFromDeg(column_deg * column);
      AddPoint(
          Vector3(3.0, 4.0, 5.0) + 20.0 * Vector3(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                                  std::cos(elevation_rad) * std::sin(azimuth_rad),
                                                  std::sin(elevation_rad)),
          frame);
    }
  }
  return frame;
}

TEST(SpacingsOf, AreThoseOfTheRowsWhereColumnsAreNoFartherApart) {
  for (const auto& [row_deg, column_deg] : {std::pair(0.25, 0.25), {2.0, 0.2}}) {
    const SurveyFrame frame = GridOfBeams(row_deg, column_deg);
    const std::vector<float> spacings_rad = SpacingsOf_rad(frame);
    ASSERT_EQ(spacings_rad.size(), frame.beams.size());
    const double expected_rad = RadFromDeg(row_deg);
    // Chords are shorter than arcs by 1/24 of their square.
    for (const float spacing_rad : spacings_rad) {
      EXPECT_NEAR(double{spacing_rad}, expected_rad, 1e-3 * expected_rad);
    }
  }
}

TEST(SpacingsOf, DoNotExceedTwiceTheMedian) {
  SurveyFrame frame = GridOfBeams(0.25, 0.25);
  AddPoint({3.0, 4.0, 25.0}, frame);
  EXPECT_NEAR(double{SpacingsOf_rad(frame).back()}, 2.0 * RadFromDeg(0.25), 1e-4);
}

TEST(SpacingsOf, AreUnknownWhereNobodyKnowsFromWhereBeamsCame) {
  SurveyFrame frame = GridOfBeams(0.25, 0.25);
  frame.has_origins = false;
  EXPECT_TRUE(SpacingsOf_rad(frame).empty());
}

}  // namespace
}  // namespace railcast
