#include "generator/extras/survey/survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.h"
#include "generator/extras/survey/driven_axis.h"
#include "generator/extras/survey/survey_voxels.h"
#include "tests/core/io/message_of.h"
#include "tests/generator/extras/survey/survey_scenes.h"

namespace railcast {
namespace {

double AreaOf_m2(const Survey& survey) {
  double area_m2 = 0.0;
  for (const SurveyTile& tile : survey.tiles) {
    for (const Surfel& surfel : tile.surfels) {
      area_m2 += 4.0 * double{surfel.half_u_m.cross(surfel.half_v_m).norm()};
    }
  }
  return area_m2;
}

TEST(MakeSurvey, CoversAWallOnce) {
  MadeFrames frames;
  AddWall(10.0, 0.1, frames.Add({0.0, 0.0, 2.0}));
  SurveyOptions options;
  options.surfels.size_factor = 1.0;
  const Survey survey = MakeSurvey(frames.All(), {}, options);
  EXPECT_EQ(survey.num_surfels, 81U * 41U);
  // Half a spacing is missing on each side, but for half of the cubes' edge of 4 cm.
  const double covered_m2 = (8.0 + 0.04) * (4.0 + 0.04);
  EXPECT_NEAR(AreaOf_m2(survey), covered_m2, 0.02 * covered_m2);
  for (const SurveyTile& tile : survey.tiles) {
    for (const Surfel& surfel : tile.surfels) {
      const Vector3 place_m = tile.Origin_m() + surfel.center_m.cast<double>();
      EXPECT_NEAR(place_m.x(), 10.0, 1e-4);
      EXPECT_NEAR(std::abs(surfel.half_u_m.cross(surfel.half_v_m).normalized().x()), 1.0F, 1e-3F);
      EXPECT_EQ(survey.labels[surfel.surface.label], "object");
    }
  }
}

TEST(MakeSurvey, LeavesAGapOpen) {
  MadeFrames frames;
  SurveyFrame& frame = frames.Add({0.0, 0.0, 2.0});
  for (int i = -40; i <= 40; ++i) {
    if (std::abs(i) < 10) continue;
    for (int k = 0; k <= 40; ++k) AddPoint({10.0, 0.1 * i, 0.1 * k}, frame);
  }
  const Survey survey = MakeSurvey(frames.All(), {}, {});
  for (const SurveyTile& tile : survey.tiles) {
    for (const Surfel& surfel : tile.surfels) {
      const float inner_m = static_cast<float>(tile.Origin_m().y()) + surfel.center_m.y();
      const float half_m = std::abs(surfel.half_u_m.y()) + std::abs(surfel.half_v_m.y());
      EXPECT_GT(std::abs(inner_m) - half_m, 0.9F);
    }
  }
}

TEST(MakeSurvey, LeavesOutWhatIsAlone) {
  MadeFrames frames;
  SurveyFrame& frame = frames.Add({0.0, 0.0, 2.0});
  AddWall(10.0, 0.1, frame);
  for (const double z_m : {6.0, 8.0, 10.0}) AddPoint({5.0, 0.0, z_m}, frame);
  EXPECT_EQ(MakeSurvey(frames.All(), {}, {}).num_alone, 3U);
}

TEST(MakeSurvey, UndoesTheIncidenceOfReflectances) {
  MadeFrames frames;
  // Seen at 60 degrees, half of the reflectivity comes back.
  AddWall(10.0, 0.05,
          frames.Add({10.0 - 100.0 * std::cos(1.0472), -100.0 * std::sin(1.0472), 2.0}));
  const Survey survey = MakeSurvey(frames.All(), {}, {});
  EXPECT_EQ(survey.tiles.front().surfels.front().surface.level, SurveyLevelOf(0.8));
}

TEST(MakeSurvey, RefusesToMakeNothing) {
  MadeFrames frames;
  AddPoint({5.0, 0.0, 0.0}, frames.Add({0.0, 0.0, 2.0}));
  EXPECT_EQ(MessageOf([&] { static_cast<void>(MakeSurvey(frames.All(), {}, {})); }),
            "the survey: must have surfaces (got 1 point of 1 frame and no surface)");
}

/// The number of surfels within 0.5 m of a place in plan.
std::size_t NumNear(const Survey& survey, const Eigen::Vector2d& place_m) {
  std::size_t num = 0;
  for (const SurveyTile& tile : survey.tiles) {
    for (const Surfel& surfel : tile.surfels) {
      const Vector3 at_m = tile.Origin_m() + surfel.center_m.cast<double>();
      if ((at_m.head<2>() - place_m).norm() < 0.5) ++num;
    }
  }
  return num;
}

/// A panel of a person's size at x = 6 m in front of a wall, what it hides of which is missing.
void AddPanelBeforeWall(double y_m, SurveyFrame& frame) {
  SurveyFrame all = frame;
  AddWall(10.0, 0.1, all);
  const Vector3 sensor_m = frame.world_from_body.translation();
  for (const SurveyBeam& beam : all.beams) {
    const Vector3 at_m = sensor_m + 0.6 * (beam.point_m - sensor_m);
    const bool is_hidden = std::abs(at_m.y() - y_m) < 0.25 && at_m.z() < 1.8;
    AddPoint(is_hidden ? at_m : beam.point_m, frame);
  }
}

TEST(MakeSurvey, TakesOutWhatMovedAndKeepsWhatStood) {
  MadeFrames frames;
  for (int k = 0; k < 10; ++k) {
    SurveyFrame& frame = frames.Add({0.0, 0.0, 1.5});
    AddPanelBeforeWall(-2.0 + 0.6 * k, frame);
    // A post that stands there all the time.
    for (double z_m = 0.0; z_m <= 3.0; z_m += 0.05) AddPoint({5.0, 2.5, z_m}, frame);
  }
  const Survey survey = MakeSurvey(frames.All(), {}, {});
  EXPECT_GT(survey.num_moving, 500U);
  // Beams end on the wall behind the first places; no beam ends behind the last one later.
  EXPECT_EQ(NumNear(survey, {6.0, -1.4}), 0U);
  EXPECT_GT(NumNear(survey, {5.0, 2.5}), 50U);
  EXPECT_GT(NumNear(survey, {10.0, 0.0}), 100U);
  SurveyOptions keeping;
  keeping.keeps_moving = true;
  EXPECT_GT(NumNear(MakeSurvey(frames.All(), {}, keeping), {6.0, -1.4}), 20U);
}

TEST(MakeSurvey, FitsAWireThroughNoisyPoints) {
  MadeFrames frames;
  // Sag of 0.5 m over 60 m.
  const auto height_m = [](double x_m) { return 5.5 + 0.5 * (x_m / 30.0) * (x_m / 30.0); };
  for (int k = 0; k < 20; ++k) {
    SurveyFrame& frame = frames.Add({3.0 * k - 40.0, 0.0, 0.0});
    for (int i = 0; i < 20; ++i) {
      const double x_m = -30.0 + 0.15 * (20 * i + k);
      const double noise_m = 0.01 * std::sin(12.9 * i + 78.2 * k);
      AddPoint({x_m, 0.2 + noise_m, height_m(x_m) - noise_m}, frame);
    }
  }
  const Survey survey = MakeSurvey(frames.All(), {}, {});
  EXPECT_GE(survey.num_wires, 1U);
  double length_m = 0.0;
  for (const SurveyTile& tile : survey.tiles) {
    EXPECT_LE(tile.wires.size(), survey.num_wires) << "a wire is one line in each tile";
    for (const SurveyedWire& wire : tile.wires) {
      EXPECT_EQ(survey.labels[wire.surface.label], "contact_wire");
      for (std::size_t i = 0; i < wire.points_m.size(); ++i) {
        const Vector3 point_m = tile.Origin_m() + wire.points_m[i].cast<double>();
        EXPECT_NEAR(point_m.y(), 0.2, 0.01);
        EXPECT_NEAR(point_m.z(), height_m(point_m.x()), 0.015);
        if (i > 0) length_m += double{(wire.points_m[i] - wire.points_m[i - 1]).norm()};
      }
    }
  }
  EXPECT_NEAR(length_m, 60.0, 3.0);
}

// Neighbours are farther apart than points of one surface may be.
TEST(MakeSurvey, FitsAWireOfFewPoints) {
  MadeFrames frames;
  SurveyFrame& frame = frames.Add({0.0, 0.0, 0.0});
  for (int i = 0; i <= 40; ++i) AddPoint({0.7 * i - 14.0, 0.2, 5.5}, frame);
  const Survey survey = MakeSurvey(frames.All(), {}, {});
  double length_m = 0.0;
  for (const SurveyTile& tile : survey.tiles) {
    for (const SurveyedWire& wire : tile.wires) {
      for (std::size_t i = 0; i + 1 < wire.points_m.size(); ++i) {
        length_m += double{(wire.points_m[i + 1] - wire.points_m[i]).norm()};
      }
    }
  }
  EXPECT_NEAR(length_m, 28.0, 1e-3);
}

TEST(SurveyLabels, NameEachLabelOnce) {
  SurveyLabels labels;
  EXPECT_EQ(labels.IndexOf("tree"), 3U);
  EXPECT_EQ(labels.IndexOf("object"), SurveyLabels::kObject);
  EXPECT_EQ(labels.IndexOf("tree"), 3U);
  EXPECT_THAT(labels.names(), testing::ElementsAre("ground", "object", "contact_wire", "tree"));
}

constexpr double kRadius_m = 400.0;

/// A place on a left curve far from the world's origin, on a gradient of 10 permil.
Transform PlaceOnCurve(double s_m) {
  const double turn_rad = s_m / kRadius_m;
  return MakeTransform(RotationFromYawPitchRoll(turn_rad, 0.0, 0.0),
                       {3.4e6 + kRadius_m * std::sin(turn_rad),
                        5.8e6 + kRadius_m * (1.0 - std::cos(turn_rad)), 120.0 + 0.01 * s_m});
}

/// Distance from a place to the axis, which is sampled every centimetre.
double DistanceTo_m(const Alignment& axis, const Vector3& place_m) {
  double least_m = 1e9;
  for (double s_m = 0.0; s_m < axis.length_m(); s_m += 0.01) {
    least_m = std::min(least_m, (axis.At(s_m).position_m - place_m).norm());
  }
  return least_m;
}

TEST(DrivenAxis, PassesWithinCentimetresOfEveryPlaceOfACurve) {
  DrivenWay way;
  for (int frame = 0; frame <= 60; ++frame)
    way.world_from_body.push_back(PlaceOnCurve(2.0 * frame));
  const Alignment axis(AxisAlong(way, 20.0).value());
  // A natural spline's chords of 8 m err by 1/384 h^4 of the fourth derivative; rounding the
  // gradients off over 8 m lifts the ends by 1 cm.
  constexpr double kTolerance_m = 0.03;
  for (int frame = 0; frame <= 60; frame += 12) {
    EXPECT_LT(DistanceTo_m(axis, PlaceOnCurve(2.0 * frame).translation()), kTolerance_m) << frame;
  }
  EXPECT_NEAR(axis.length_m(), 120.0 + 2.0 * 20.0, 0.1);
}

TEST(DrivenAxis, TakesWhatTwoRecordingsHaveDrivenFromTheFirst) {
  DrivenWay way;
  const auto drive = [&](int from_m, int to_m, double left_m) {
    for (int s_m = from_m; s_m <= to_m; ++s_m) {
      way.world_from_body.push_back(
          MakeTransform(Eigen::Matrix3d::Identity(), {1.0 * s_m, left_m, 0.0}));
    }
  };
  drive(0, 100, 0.0);
  drive(50, 200, 0.05);  // As far apart as poses may be.
  const Alignment axis(AxisAlong(way, 20.0).value());
  EXPECT_NEAR(axis.length_m(), 2.0 * 20.0 + 200.0, 8.0);
  EXPECT_NEAR(axis.At(20.0 + 75.0).position_m.y(), 0.0, 0.01);
  EXPECT_NEAR(axis.At(20.0 + 175.0).position_m.y(), 0.05, 0.01);
}

TEST(DrivenAxis, IsNoneWhereTheWayTurnsBack) {
  DrivenWay way;
  for (const double x_m : {100.0, 110.0, 120.0, 0.0, 10.0, 20.0}) {
    way.world_from_body.push_back(MakeTransform(Eigen::Matrix3d::Identity(), {x_m, 0.0, 0.0}));
  }
  EXPECT_FALSE(AxisAlong(way, 20.0));
}

TEST(DrivenAxis, IsBelowASensorByItsHeight) {
  DrivenWay way{.world_from_body = {}, .above_rail_m = 3.5};
  for (int frame = 0; frame <= 20; ++frame) {
    way.world_from_body.push_back(
        MakeTransform(Eigen::Matrix3d::Identity(), {1.0 * frame, 0.0, 10.0}));
  }
  EXPECT_NEAR(Alignment(AxisAlong(way, 20.0).value()).At(25.0).position_m.z(), 6.5, 1e-9);
}

TEST(DrivenAxis, OfASensorThatStandsLeadsWhereItLooks) {
  const DrivenWay way{.world_from_body{
      2,
      MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0), {5.0, 6.0, 0.0})}};
  const Alignment axis(AxisAlong(way, 30.0).value());
  EXPECT_NEAR((axis.At(0.0).position_m - Vector3(5.0, -24.0, 0.0)).norm(), 0.0, 1e-6);
  EXPECT_NEAR((axis.At(30.0).position_m - Vector3(5.0, 6.0, 0.0)).norm(), 0.0, 1e-6);
}

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
