// Trials from frames: what they know, and what they must not.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "analysis/fit/known_planes.h"
#include "analysis/fit/plane_trials.h"
#include "analysis/fit/truth_stretch.h"
#include "analysis/fit/truth_trials.h"
#include "core/base/error.h"
#include "tests/analysis/fit/made_street.h"

namespace railcast {
namespace {

Frame ScanStreet(const SimulatorSpec& spec, const ScanPattern& pattern) {
  Simulator simulator(MakeStreet(), pattern, MaterialLibrary(StreetMaterials()), spec, 0);
  Frame frame;
  simulator.Scan(1, frame);
  return frame;
}

std::vector<Trial> TruthTrials(const Frame& frame) {
  std::vector<Trial> trials;
  ForEachTruthTrial(AsRecorded(frame), {},
                    [&](const Trial& trial, std::size_t) { trials.push_back(trial); });
  return trials;
}

TEST(TruthTrials, DoNotKnowWhyABeamIsLost) {
  SimulatorSpec spec = StreetSpec("plausibility", 1);
  spec.plausibility.reference_range_m = 80.0;
  spec.plausibility.dropout_probability = 0.2;
  spec.weather.rain_rate_mmph = 25.0;
  Frame frame = ScanStreet(spec, MakeRaster(60.0, 30.0, 0.5));
  const std::vector<Trial> told = TruthTrials(frame);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Nor does the receiver's own reckoning count.
    frame.power_ratio[slot] = std::nanf("");
    if (!HasPoint(frame.outcome[slot])) frame.outcome[slot] = Outcome::kNoSurface;
  }
  const std::vector<Trial> untold = TruthTrials(frame);
  ASSERT_EQ(told.size(), untold.size());
  std::size_t num_lost = 0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    ASSERT_EQ(told[i].answer, untold[i].answer);
    ASSERT_EQ(told[i].expected_m, untold[i].expected_m);
    num_lost += told[i].answer == Answer::kLost ? 1 : 0;
  }
  EXPECT_GT(num_lost, 500U);
}

TEST(TruthTrials, LeaveOutWhatStandsNearTheGate) {
  const SimulatorSpec spec = StreetSpec("geometry", 1);
  const RecordedFrame recorded = AsRecorded(ScanStreet(spec, MakeRaster(60.0, 30.0, 0.5)));
  std::size_t num = 0;
  ForEachTruthTrial(recorded, {.range_min_m = 20.0, .range_max_m = 40.0, .beam = {}},
                    [&](const Trial& trial, std::size_t) {
                      EXPECT_GT(trial.expected_m, 21.0F);
                      EXPECT_LT(trial.expected_m, 39.0F);
                      ++num;
                    });
  EXPECT_GT(num, 100U);
}

// The simulator knows the normals; the fit finds pulse stretch from ranges and incidences alone.
TEST(TruthStretch, AgreesWithTheSimulator) {
  SimulatorSpec spec = StreetSpec("surface", 1);
  spec.effects = {.surface_response = true, .pulse_stretch = true};
  SimulatorSpec plain = spec;
  plain.effects.pulse_stretch = false;
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.5);
  const Frame stretched = ScanStreet(spec, pattern);
  const Frame unstretched = ScanStreet(plain, pattern);
  const std::optional<ScanTable> scan = MakeScanTable(pattern);
  const TruthStretch stretch(spec.beam, &*scan);
  std::size_t num = 0, num_known = 0;
  for (std::size_t slot = 0; slot < stretched.num_slots(); ++slot) {
    if (std::isnan(stretched.true_range_m[slot])) continue;
    ++num;
    const double found = stretch.At(stretched, slot);
    if (std::isnan(found)) continue;
    ++num_known;
    const double truth = static_cast<double>(stretched.power_ratio[slot]) /
                         static_cast<double>(unstretched.power_ratio[slot]);
    // Where no neighbour is on the same surface, the middle of what is possible within 2 %.
    ASSERT_NEAR(found / truth, 1.0, 0.0105) << slot;
  }
  EXPECT_GT(num, 3000U);
  EXPECT_GT(num_known, num * 95 / 100);
}

class PlanesFile : public testing::Test {
 protected:
  std::string Write(const std::string& text) {
    const std::string file = testing::TempDir() + "planes.json";
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(PlanesFile, IsReadStrictly) {
  const std::vector<KnownPlane> planes =
      ReadKnownPlanes(Write(R"({"version": 1, "planes": [{"name": "wall", "material": "concrete",
            "point_m": [10, 0, 0], "normal": [-2, 0, 0], "radius_m": 3}]})"));
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].surface(), "concrete");
  EXPECT_EQ(planes[0].normal, Vector3(-1, 0, 0));
  const std::string file = Write(
      R"({"version": 1, "planes": [{"name": "wall", "point_m": [10, 0, 0], "normal": [0, 0, 0]}]})");
  try {
    static_cast<void>(ReadKnownPlanes(file));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("must not be [0, 0, 0]"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("must be either radius_m or corners_m"),
              std::string::npos);
  }
}

KnownPlane SquareAt(double x_m, double half_m) {
  KnownPlane plane;
  plane.name = "square";
  plane.point_m = Vector3(x_m, 0, 0);
  plane.normal = Vector3(-1, 0, 0);
  plane.corners_m = {{x_m, -half_m, -half_m},
                     {x_m, half_m, -half_m},
                     {x_m, half_m, half_m},
                     {x_m, -half_m, half_m}};
  return plane;
}

TEST(KnownPlanes, TheNearestWithinItsExtentIsHit) {
  const std::vector<KnownPlane> planes = {SquareAt(20.0, 5.0), SquareAt(10.0, 1.0)};
  EXPECT_EQ(HitPlanes(planes, Vector3(1, 0, 0))->plane, 1U);
  const auto beside = HitPlanes(planes, Vector3(10, 2, 0).normalized());
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->plane, 0U);
  EXPECT_NEAR(beside->cos_incidence, 10.0 / std::sqrt(104.0), 1e-12);
  EXPECT_FALSE(HitPlanes(planes, Vector3(0, 1, 0)));
  EXPECT_FALSE(HitPlanes(planes, Vector3(-1, 0, 0)));
}

TEST(KnownPlanes, AreMovedToThePointsWhateverElseStandsThere) {
  std::vector<KnownPlane> planes = {SquareAt(10.0, 3.0)};
  // 7 cm off, turned by 0.01, and a tenth of the points 20 cm in front.
  std::vector<Vector3> points_m;
  for (int i = 0; i < 4000; ++i) {
    const double y_m = -2.9 + 5.8 * (i % 63) / 63.0;
    const double z_m = -2.9 + 5.8 * (i % 61) / 61.0;
    points_m.emplace_back(10.07 + 0.01 * y_m - (i % 10 == 0 ? 0.2 : 0.0), y_m, z_m);
  }
  EXPECT_EQ(RefinePlanes(points_m, planes)[0], 4000U);
  EXPECT_NEAR(planes[0].normal.dot(planes[0].point_m) / planes[0].normal.x(), 10.07, 1e-6);
  EXPECT_NEAR(planes[0].normal.y() / planes[0].normal.x(), -0.01, 1e-6);
}

TEST(KnownPlanes, MustBeWhereThePointsAre) {
  std::vector<KnownPlane> planes = {SquareAt(10.0, 3.0), SquareAt(20.0, 3.0)};
  std::vector<Vector3> points_m;
  // Along the beam within the first plane's reach, as rings of a scan lie in what is no plane.
  for (int i = 0; i < 400; ++i) points_m.emplace_back(9.8 + 1e-3 * i, 0.0, 1e-3 * (i % 20));
  try {
    static_cast<void>(RefinePlanes(points_m, planes));
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("not on one turned by more than 10 deg"), std::string::npos) << text;
    EXPECT_NE(text.find("must have at least 50 points within 0.3 m in the first frames (got 0)"),
              std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace railcast
