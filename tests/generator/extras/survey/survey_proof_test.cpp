#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/write_file.h"
#include "generator/extras/survey/survey.h"
#include "railcast/railcast.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/survey/survey_proof.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

constexpr std::uint32_t kNumFrames = 21;
constexpr double kRange_m = 60.0;

/// A station with platforms, a fence and a contact line, without things. The sensor is noisy.
ScenarioSpec StationToSurvey() {
  ScenarioSpec scenario = ReadScenario(kScenariosFolder + "station.json");
  scenario.world.objects.clear();
  return scenario;
}

/// What the sensor of a scenario saw.
struct SeenRun {
  std::vector<SurveyFrame> even;  ///< Frames 0, 2, 4, ...
  SurveyLabels labels;
  RecordedCells cells;     ///< Of the even frames.
  std::vector<Frame> odd;  ///< Frames 1, 3, 5, ... without noise.
};

SeenRun SeeRun(ScenarioSpec scenario) {
  SeenRun run;
  RecordingInfo info;
  info.labels = LabelTable(scenario.labels);
  info.scenario = scenario;
  info.origin = SequenceOrigin{};
  const auto simulator = MakeSimulator(scenario, 0);
  for (std::uint32_t k = 0; k < kNumFrames; k += 2) {
    RecordedFrame recorded;
    simulator->Scan(k, recorded.frame);
    recorded.fields = {"x", "y", "z", "intensity", "time_ns", "label", "outcome"};
    recorded.has_pose = true;
    run.even.push_back(
        BeamsOf(recorded, info, {.recordings = {}, .range_max_m = kRange_m}, run.labels));
    for (const SurveyBeam& beam : run.even.back().beams) run.cells.Add(beam.point_m);
  }
  scenario.fidelity = Fidelity::kGeometry;
  const auto exact = MakeSimulator(scenario, 0);
  for (std::uint32_t k = 1; k < kNumFrames; k += 2) exact->Scan(k, run.odd.emplace_back());
  return run;
}

/// What is seen of the station, which several tests survey.
const SeenRun& SeenStation() {
  static const SeenRun run = SeeRun(StationToSurvey());
  return run;
}

Survey SurveyOfRun(const SeenRun& run, const SurveyOptions& options = {}) {
  return MakeSurvey([&](const auto& visit) { std::ranges::for_each(run.even, visit); }, run.labels,
                    options);
}

/// The line of a scenario with a survey in place of all that stands there, as a file gives it.
ScenarioSpec OnSurvey(const ScenarioSpec& scenario, const std::filesystem::path& file) {
  ScenarioSpec on_survey = scenario;
  on_survey.world.structures.clear();
  on_survey.world.survey = file.string();
  return ReadScenarioText(ResolvedScenarioJson(on_survey), "scenario.json");
}

/// What the beams of frames 1, 3, 5, ... meet, and what they should.
struct Prediction {
  std::vector<ProvenBeam> beams;
  std::size_t num_empty = 0;                 ///< Beams that should meet nothing, ...
  std::size_t num_wrong = 0;                 ///< ... and those of them that meet something.
  std::map<std::string, std::size_t> exact;  ///< Beams that end on a thing, by its label, ...
  std::map<std::string, std::size_t> found;  ///< ... and those that end on one in the survey.
};

Prediction PredictOddFrames(const ScenarioSpec& scenario,
                            const ScenarioSpec& on_survey,
                            const SeenRun& run) {
  const auto prediction = MakeSimulator(on_survey, 0);
  const LabelTable labels(scenario.labels);
  const double spacing_rad =
      RadFromDeg(std::get<RasterSpec>(scenario.lidar.scan.pattern).angular_resolution_deg);
  Prediction made;
  Frame predicted;
  for (const Frame& exact : run.odd) {
    prediction->Scan(exact.index, predicted);
    const ScanMotion motion(exact);
    const auto is_met = [](const Frame& frame, std::size_t i) {
      return HasPoint(frame.outcome[i]) && double{frame.true_range_m[i]} <= kRange_m;
    };
    for (std::size_t i = 0; i < exact.num_slots(); ++i) {
      const bool is_found = is_met(predicted, i);
      if (is_found) ++made.found[labels.Find(predicted.label[i])->name];
      if (!HasPoint(exact.outcome[i])) {
        ++made.num_empty;
        if (is_found) ++made.num_wrong;
      }
      if (!is_met(exact, i)) continue;
      const std::string label = labels.Find(exact.label[i])->name;
      ++made.exact[label];
      const Vector3 sensor_m(exact.x[i], exact.y[i], exact.z[i]);
      const Vector3 world_m = exact.world_from_sensor * motion.AtStamp(sensor_m, exact.time_ns[i]);
      const int num_points = run.cells.NumAbout(world_m);
      if (num_points < kLeastPointsOfSurface) continue;
      const double range_m{exact.true_range_m[i]};
      const double found_m = HasPoint(predicted.outcome[i])
                                 ? double{predicted.true_range_m[i]}
                                 : std::numeric_limits<double>::quiet_NaN();
      made.beams.push_back({label, range_m, DegFromRad(double{exact.incidence_rad[i]}), num_points,
                            run.cells.HasWithin(spacing_rad * range_m, world_m),
                            found_m - range_m});
    }
  }
  return made;
}

bool IsAny(const ProvenBeam& /*beam*/) {
  return true;
}
bool IsGround(const ProvenBeam& beam) {
  return std::set<std::string>{"ground", "ballast", "sleeper", "platform"}.contains(beam.label);
}
bool IsWall(const ProvenBeam& beam) {
  return std::set<std::string>{"noise_wall", "bridge", "retaining_wall"}.contains(beam.label);
}

template <class Value>
void PrintCurve(const std::string& what,
                const std::vector<ProvenBeam>& beams,
                const std::vector<double>& edges,
                const Value& value) {
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    PrintRow(what + " " + NumberText(edges[i]) + " to " + NumberText(edges[i + 1]),
             ProvenBy(beams, [&](const ProvenBeam& beam) {
               return value(beam) >= edges[i] && value(beam) < edges[i + 1];
             }));
  }
}

/// Prints the tables of docs/results/surveys.md:
///   RAILCAST_PRINT_SURVEY=1 build/release/tests/generator/generator_tests
///   --gtest_filter=SurveyProof.*
void PrintTables(const Prediction& made) {
  const std::vector<ProvenBeam>& beams = made.beams;
  std::puts(
      "| beams on | beams | hit % | within 0.3 m % | median error cm | 90 % of the errors below cm "
      "|");
  std::set<std::string> names;
  for (const ProvenBeam& beam : beams) names.insert(beam.label);
  for (const std::string& name : names) {
    PrintRow(name, ProvenBy(beams, [&](const ProvenBeam& beam) { return beam.label == name; }));
  }
  for (const auto& [name, num] : made.exact) {
    const auto found = made.found.find(name);
    std::printf("%s: %zu beams, %zu in the survey\n", name.c_str(), num,
                found == made.found.end() ? 0 : found->second);
  }
  std::printf("of %zu beams that should meet nothing, %zu meet something\n", made.num_empty,
              made.num_wrong);
  PrintRow("all", ProvenBy(beams, IsAny));
  PrintRow("all with a point within the beams' spacing",
           ProvenBy(beams, [](const ProvenBeam& beam) { return beam.is_within_spacing; }));
  PrintRow("trees, likewise", ProvenBy(beams, [](const ProvenBeam& beam) {
             return beam.label == "tree" && beam.is_within_spacing;
           }));
  for (const auto& [kind, is_of_kind] : {std::pair("ground", &IsGround), {"walls", &IsWall}}) {
    std::vector<ProvenBeam> some;
    std::ranges::copy_if(beams, std::back_inserter(some), is_of_kind);
    PrintRow(kind, ProvenBy(some, IsAny));
    PrintCurve(std::string(kind) + ", range, m", some, {0, 10, 15, 20, 30, 40, 60},
               [](const ProvenBeam& beam) { return beam.range_m; });
    PrintCurve(std::string(kind) + ", incidence, deg", some, {0, 45, 60, 70, 75, 80, 85, 90},
               [](const ProvenBeam& beam) { return beam.incidence_deg; });
    PrintCurve(std::string(kind) + ", points nearby", some, {4, 10, 30, 100, 300, 10'000},
               [](const ProvenBeam& beam) { return 1.0 * beam.num_points; });
  }
}

/// What even frames of a run predict of the odd ones.
Prediction Predict(ScenarioSpec scenario,
                   const SeenRun& run,
                   const Survey& survey,
                   const std::filesystem::path& scene) {
  WriteFileWhole(scene, EncodeSurvey(survey.labels, survey.tiles));
  scenario.fidelity = Fidelity::kGeometry;
  return PredictOddFrames(scenario, OnSurvey(scenario, scene), run);
}

class SurveyProof : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scenario_ = new ScenarioSpec(StationToSurvey());
    survey_ = new Survey(SurveyOfRun(SeenStation()));
    directory_ = new TemporaryDirectory;
    const auto file = directory_->path() / "scene.survey";
    WriteFileWhole(file, EncodeSurvey(survey_->labels, survey_->tiles));
    scenario_->fidelity = Fidelity::kGeometry;
    on_survey_ = new ScenarioSpec(OnSurvey(*scenario_, file));
  }
  static void TearDownTestSuite() {
    delete on_survey_;
    delete directory_;
    delete survey_;
    delete scenario_;
  }

  static inline ScenarioSpec* scenario_ = nullptr;
  static inline ScenarioSpec* on_survey_ = nullptr;
  static inline Survey* survey_ = nullptr;
  static inline TemporaryDirectory* directory_ = nullptr;
};

TEST_F(SurveyProof, EvenFramesPredictOddOnes) {
  const Prediction made = PredictOddFrames(*scenario_, *on_survey_, SeenStation());
  if (std::getenv("RAILCAST_PRINT_SURVEY") != nullptr) PrintTables(made);
  const std::vector<ProvenBeam>& beams = made.beams;
  EXPECT_GE(ProvenBy(beams, IsAny).hit_share, 0.98);
  EXPECT_GE(
      ProvenBy(beams, [](const ProvenBeam& beam) { return beam.is_within_spacing; }).hit_share,
      0.98);
  EXPECT_LE(made.num_wrong, made.num_empty * 35 / 1000);
  const Proven platform =
      ProvenBy(beams, [](const ProvenBeam& beam) { return beam.label == "platform"; });
  EXPECT_GT(platform.num_beams, 50'000U);
  EXPECT_GE(platform.hit_share, 0.97);
  EXPECT_LE(platform.median_error_m, 0.015);
  const Proven ground = ProvenBy(beams, IsGround);
  EXPECT_GE(ground.hit_share, 0.98);
  EXPECT_LE(ground.median_error_m, 0.02);
  // Stones of several centimetres, met at a few degrees: only points as near as they tell them.
  const auto ballast = [&](int least_points) {
    return ProvenBy(beams, [least_points](const ProvenBeam& beam) {
      return beam.label == "ballast" && beam.num_points >= least_points;
    });
  };
  EXPECT_LE(ballast(kLeastPointsOfSurface).median_error_m, 0.03);
  EXPECT_LE(ballast(150).median_error_m, 0.02);
  EXPECT_GT(ballast(150).num_beams, 10'000U);
  const Proven masts = ProvenBy(beams, [](const ProvenBeam& beam) { return beam.label == "mast"; });
  EXPECT_GE(masts.hit_share, 0.93);
}

TEST(SurveyProofBesideWalls, EvenFramesPredictOddOnes) {
  ScenarioSpec scenario = StationToSurvey();
  scenario.vehicle.start_s_m = 450.0;
  const TemporaryDirectory directory;
  const SeenRun run = SeeRun(scenario);
  const Prediction made =
      Predict(scenario, run, SurveyOfRun(run), directory.path() / "scene.survey");
  if (std::getenv("RAILCAST_PRINT_SURVEY") != nullptr) PrintTables(made);
  const Proven walls = ProvenBy(made.beams, IsWall);
  EXPECT_GT(walls.num_beams, 40'000U);
  EXPECT_GE(walls.hit_share, 0.985);
  EXPECT_LE(walls.median_error_m, 0.01);
  EXPECT_GE(ProvenBy(made.beams, IsAny).hit_share, 0.98);
}

/// What a size of surfels gains. With RAILCAST_SURVEY_SIZES=FOLDER all those of the chart are made,
/// and their scenes stay there (scripts/dev/draw_survey_sizes.py).
TEST(SurfelSize, LargerSurfelsHitMoreAndErrMore) {
  struct Size {
    double voxel_m, factor;
  };
  const char* const kept = std::getenv("RAILCAST_SURVEY_SIZES");
  std::vector<Size> sizes{{0.04, 1.2}, {0.04, 1.8}};
  if (kept != nullptr) {
    sizes = {{0.02, 1.2}, {0.02, 1.8}};
    for (const double voxel_m : {0.04, 0.08, 0.16}) {
      for (const double factor : {1.2, 1.5, 1.8, 2.2}) sizes.push_back({voxel_m, factor});
    }
  }
  const ScenarioSpec scenario = StationToSurvey();
  const TemporaryDirectory directory;
  const std::filesystem::path folder = kept == nullptr ? directory.path() : kept;
  std::vector<Proven> ground;
  for (const Size& size : sizes) {
    const Survey survey = SurveyOfRun(
        SeenStation(), {.voxel_m = size.voxel_m, .surfels = {.size_factor = size.factor}});
    const std::string name = NumberText(size.voxel_m) + "_" + NumberText(size.factor);
    const Prediction made = Predict(scenario, SeenStation(), survey, folder / (name + ".survey"));
    ground.push_back(ProvenBy(made.beams, IsGround));
    if (kept == nullptr) continue;
    const Proven all = ProvenBy(made.beams, IsAny);
    std::printf("%s\t%zu\t%.1f\t%.2f\t%.1f\n", name.c_str(), survey.num_surfels,
                100.0 * all.hit_share, 100.0 * ground.back().median_error_m,
                100.0 * all.near_share);
  }
  EXPECT_GT(ground[1].hit_share, ground[0].hit_share + 0.01);
  EXPECT_GT(ground[1].median_error_m, ground[0].median_error_m);
}

TEST_F(SurveyProof, FindsNothingMovingWhereNothingMoves) {
  EXPECT_LT(survey_->num_moving, survey_->num_surfels / 500);
}

TEST_F(SurveyProof, StandsObjectsOnTheSurveyedGround) {
  ObjectSpec box;
  box.name = "box";
  box.type = ObjectType::kBox;
  box.s_m = 260.0;
  box.d_m = -3.5;  // On the platform.
  box.size_m = {0.5, 0.5, 0.5};
  const auto height_m = [&](ScenarioSpec scenario) {
    scenario.world.objects.push_back(box);
    return MakeWorld(scenario)->WorldFromObject(0, 0).translation().z();
  };
  constexpr double kTolerance_m = 0.03;  // Noise, and the lowest point of a cell.
  EXPECT_NEAR(height_m(*on_survey_), height_m(*scenario_), kTolerance_m);
}

TEST_F(SurveyProof, IsTheSameWhateverTheNumberOfThreads) {
  Frame one;
  Frame many;
  MakeSimulator(*on_survey_, 1)->Scan(3, one);
  MakeSimulator(*on_survey_, 4)->Scan(3, many);
  EXPECT_EQ(one.label, many.label);
  EXPECT_EQ(one.outcome, many.outcome);
}

}  // namespace
}  // namespace railcast
