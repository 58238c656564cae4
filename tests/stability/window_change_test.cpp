#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "railcast/scenario.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/stability/regime.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

// A vehicle at 300 km/h crosses from one chunk into the next within a scan. The frame is traced in
// the window of the chunk in which it begins, and the next frame in another. Neither the place of
// the seam nor the change of the window may show: the same world, seen from the same places, looks
// the same whichever chunk the scan began in.

constexpr double kFastTrain_mps = 83.0;

// A straight line with bumps and wires, scanned from `start_s_m` on.
ScenarioSpec LineFrom(double start_s_m, const std::string& detail = "full") {
  const TemporaryFolder folder;
  const std::string scenarios = ScenariosDir().string();
  return ReadScenario(folder.Write("scenario.json", R"({
    "version": 1, "fidelity": "geometry",
    "lidar": {"range_max_m": 60, "mount": {"position_m": [0, 0, 3], "pitch_deg": 12},
              "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 40,
                       "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}},
    "world": {"alignment": {"course": {"type": "elements",
                            "elements": [{"type": "straight", "length_m": 400}]}},
              "vegetation": {"trees_per_hectare": 0, "grass": false}, "detail": ")" +
                                                        detail +
                                                        R"("},
    "vehicle": {"start_s_m": )" + std::to_string(start_s_m) +
                                                        R"(, "motion":
                {"profile": [{"time_s": 0, "speed_mps": 83}]}},
    "materials": ")" + scenarios + R"(/materials/railway.json",
    "labels": ")" + scenarios + R"(/labels.json"})"));
}

Frame FirstFrame(double start_s_m, const std::string& detail = "full") {
  return FrameBy(*MakeSimulator(LineFrom(start_s_m, detail), 0));
}

// The seam is at 150 m. A millimetre before it the scan begins in one chunk and ends in the other,
// a millimetre behind it begins and ends in the other.
TEST(WindowChange, WithinAScanDoesNotShow) {
  constexpr double kAside_m = 1e-3;
  const Frame before = FirstFrame(150.0 - kAside_m);
  const Frame behind = FirstFrame(150.0 + kAside_m);
  ASSERT_GT(kFastTrain_mps * 1e-9 * before.duration_ns, 5.0);
  ASSERT_EQ(before.num_slots(), behind.num_slots());
  std::vector<double> differences_m;
  std::size_t num_points = 0;
  std::size_t num_labels_changed = 0;
  for (std::size_t slot = 0; slot < before.num_slots(); ++slot) {
    if (!HasPoint(before.outcome[slot]) || !HasPoint(behind.outcome[slot])) continue;
    ++num_points;
    num_labels_changed += before.label[slot] != behind.label[slot] ? 1 : 0;
    differences_m.push_back(
        static_cast<double>(std::abs(before.range_m[slot] - behind.range_m[slot])));
  }
  ASSERT_GT(num_points, 2000U);
  // 2 mm further, a beam meets the ground 2 mm nearer; only beams at an edge jump.
  std::ranges::sort(differences_m);
  RecordRegime(
      "a scan across the seam of two windows at 300 km/h",
      {"-", "95 % of the ranges within " + TwoDigits(1e3 * differences_m[num_points * 95 / 100]) +
                " mm, " + std::to_string(num_labels_changed) + " of " + std::to_string(num_points) +
                " labels changed"});
  EXPECT_LT(differences_m[num_points * 95 / 100], 4e-3);
  EXPECT_LT(static_cast<double>(num_labels_changed), 0.01 * static_cast<double>(num_points));
}

// With scene detail `auto`, the ground of chunks that come near enough in the next window becomes
// finer: single points on it move by its roughness, neither nearer nor farther on the whole.
TEST(WindowChange, MovesFewPointsWithSceneDetail) {
  constexpr double kAside_m = 1e-3;
  const Frame before = FirstFrame(150.0 - kAside_m, "auto");
  const Frame behind = FirstFrame(150.0 + kAside_m, "auto");
  std::vector<double> moves_m;
  std::size_t num_points = 0;
  for (std::size_t slot = 0; slot < before.num_slots(); ++slot) {
    if (!HasPoint(before.outcome[slot]) || !HasPoint(behind.outcome[slot])) continue;
    ++num_points;
    const double move_m = static_cast<double>(behind.range_m[slot] - before.range_m[slot]);
    if (std::abs(move_m) > 4e-3) moves_m.push_back(move_m);
  }
  ASSERT_GT(moves_m.size(), 20U) << "a chunk changes its form here";
  EXPECT_LT(static_cast<double>(moves_m.size()), 0.1 * static_cast<double>(num_points));
  const auto number = static_cast<double>(moves_m.size());
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  for (const double move_m : moves_m) {
    sum_m += move_m;
    squares_m2 += move_m * move_m;
  }
  EXPECT_LT(std::abs(sum_m / number), 3.0 * std::sqrt(squares_m2) / number);
}

// The second frame of one run, in the next window, is the first of a run that begins there.
TEST(WindowChange, BetweenFramesDoesNotShow) {
  const auto simulator = MakeSimulator(LineFrom(145.0), 0);
  Frame second = FrameBy(*simulator);
  simulator->Scan(1, second);
  const Frame first = FirstFrame(145.0 + 0.1 * kFastTrain_mps);
  ASSERT_EQ(first.num_slots(), second.num_slots());
  std::size_t num_other = 0;
  for (std::size_t slot = 0; slot < first.num_slots(); ++slot) {
    const bool is_same = first.outcome[slot] == second.outcome[slot] &&
                         (!HasPoint(first.outcome[slot]) ||
                          std::abs(first.range_m[slot] - second.range_m[slot]) < 2e-3F);
    num_other += is_same ? 0 : 1;
  }
  EXPECT_LE(static_cast<double>(num_other), 1e-3 * static_cast<double>(first.num_slots()));
}

// Chunks that no firing meets are traced in their coarsest form. What they look like must not
// matter: frames are the same if there is nothing.

/// A world whose chunks have no ground, ballast and rails in their coarsest form.
class BareWhereUnseen final : public World {
 public:
  explicit BareWhereUnseen(std::shared_ptr<const World> whole) : whole_(std::move(whole)) {}

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override {
    return whole_->WorldFromVehicle(time_ns);
  }
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override {
    return whole_->HomeChunk(time_ns);
  }
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int home_chunk) const override {
    return whole_->VehiclePosesIn(home_chunk);
  }
  [[nodiscard]] std::vector<int> ChunksInReach(int chunk, double range_m) const override {
    return whole_->ChunksInReach(chunk, range_m);
  }
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override {
    return whole_->WorldFromChunk(chunk);
  }
  [[nodiscard]] Chunk BuildChunk(int chunk) const override { return whole_->BuildChunk(chunk); }
  [[nodiscard]] std::vector<CoarserSurfaces> CoarserSurfacesOf(int chunk) const override {
    return whole_->CoarserSurfacesOf(chunk);
  }
  [[nodiscard]] Chunk BuildCoarserChunk(int chunk, std::size_t level) const override {
    Chunk built = whole_->BuildCoarserChunk(chunk, level);
    if (level < CoarserSurfacesOf(chunk).size()) return built;
    ++num_bare_;
    for (Part& part : built.ground.parts) part.mesh = {};
    return built;
  }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override {
    return whole_->objects();
  }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override {
    return whole_->WorldFromObject(object, time_ns);
  }
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override {
    return whole_->WorldFromPieces(object, time_ns);
  }
  [[nodiscard]] int num_bare() const { return num_bare_; }

 private:
  std::shared_ptr<const World> whole_;
  mutable std::atomic<int> num_bare_ = 0;
};

/// Ranges, 0 where there are none.
std::vector<float> RangesOf(const Frame& frame) {
  std::vector<float> ranges_m = frame.true_range_m;
  for (float& range_m : ranges_m) range_m = std::isnan(range_m) ? 0.0F : range_m;
  return ranges_m;
}

// From one chunk into the next, at 300 km/h.
TEST(UnseenChunks, MakeNoDifferenceToAnyFiring) {
  ScenarioSpec spec = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json");
  spec.fidelity = Fidelity::kSurface;
  spec.world.objects.clear();
  spec.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 83.0}};
  const auto whole = MakeSimulator(spec, 2);
  const auto world = std::make_shared<const BareWhereUnseen>(whole->shared_world());
  Simulator bare(world, whole->pattern(), MaterialLibrary(spec.materials), whole->spec(), 2);
  Frame expected;
  Frame frame;
  for (std::uint32_t index = 0; index < 7; ++index) {
    whole->Scan(index, expected);
    bare.Scan(index, frame);
    EXPECT_EQ(RangesOf(frame), RangesOf(expected)) << index;
    EXPECT_EQ(frame.label, expected.label) << index;
  }
  EXPECT_GE(world->num_bare(), 6);
}

}  // namespace
}  // namespace railcast
