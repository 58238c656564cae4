#include "generator/extras/survey/survey.h"

#include <gtest/gtest.h>

#include <cmath>

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
            "the survey: must have surfaces (got 1 points of 1 frames and no surface)");
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

}  // namespace
}  // namespace railcast
