// The ways to put a thing into a recording side by side, and whether what we put in can be told
// from what is simulated at once.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/rail/objects/person.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/generator/extras/insert/two_samples.h"

namespace railcast {
namespace {

std::shared_ptr<const Model> PersonModel(const ScenarioSpec& scenario) {
  const PersonSpec look;
  return std::make_shared<const Model>(MakePerson(
      FindPersonSurfaces(look, LabelTable(scenario.labels), MaterialLibrary(scenario.materials)),
      {.look = look, .height_m = kPersonHeight_m, .steady_speed_mps = 1.3}));
}

/// A thing upright on the ground, or hanging.
struct AblatedThing {
  const char* name;
  std::shared_ptr<const Model> model;
  double height_m = 0.0;  ///< Of its foot.
};

std::vector<AblatedThing> AblatedThings(const ScenarioSpec& scenario) {
  return {{"person", PersonModel(scenario)},
          {"box, 0.5 m", LoopBox(scenario, {0.5, 0.5, 0.5}, "clothing", "object")},
          {"post, 0.1 m", LoopBox(scenario, {0.1, 0.1, 2.0}, "clothing", "object")},
          {"rod, 20 mm", LoopBox(scenario, {0.02, 0.02, 1.5}, "clothing", "object"), 1.0}};
}

std::shared_ptr<SimpleWorld> LevelGround(const ScenarioSpec& scenario) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.name = "scene";
  world->ground.parts.push_back({MakeFloor(0.0F, 400.0F),
                                 MaterialLibrary(scenario.materials).Index("ballast"),
                                 LabelTable(scenario.labels).Id("ground")});
  return world;
}

/// A recording of level ground, into which things are put.
class LevelRecording {
 public:
  LevelRecording(const std::string& name, Fidelity rung, ReturnMode mode)
      : sensor_(MakeLoopSensor(name, rung, {4.0, -12.0, 8.0})) {
    sensor_.scenario.lidar.receiver.return_mode = mode;
    recorded_ = RecordedOf(ScanLoop(sensor_, LevelGround(sensor_.scenario)), sensor_.pattern);
    ForgetOwnFields(recorded_);
  }

  /// The shares of their beams of the returns on a thing that was put in.
  [[nodiscard]] std::vector<float> SharesOn(const AblatedThing& thing,
                                            double ahead_m,
                                            double left_m) const {
    auto alone = std::make_shared<SimpleWorld>();
    alone->AddObject(thing.model,
                     MakeTransform(Eigen::Matrix3d::Identity(), {ahead_m, left_m, thing.height_m}));
    const InsertedFrame inserted =
        Inserter(PlanOf(sensor_.scenario, alone, sensor_.pattern), 0).Insert(recorded_, 0);
    std::vector<float> shares;
    for (const SlotEdit& edit : inserted.edits) {
      if (edit.is_added) shares.push_back(inserted.recorded.frame.footprint_share[edit.slot]);
    }
    return shares;
  }
  /// The mean over places of a bin of range.
  [[nodiscard]] double MeanPoints(const AblatedThing& thing, double from_m, double to_m) const {
    constexpr int kNumPlaces = 20;
    double sum = 0.0;
    for (int k = 0; k < kNumPlaces; ++k) {
      const double ahead_m = from_m + (k + 0.5) / kNumPlaces * (to_m - from_m);
      sum += static_cast<double>(SharesOn(thing, ahead_m, 0.11 * (k % 7 - 3)).size());
    }
    return sum / kNumPlaces;
  }
  [[nodiscard]] const ScenarioSpec& scenario() const { return sensor_.scenario; }

 private:
  LoopSensor sensor_;
  RecordedFirings recorded_;
};

constexpr std::array<double, 6> kBinEdges_m = {20.0, 40.0, 60.0, 80.0, 100.0, 125.0};

// Points that are pasted are those of the thing where it is nearest.
TEST(InsertAblation, PastedPointsAreTooManyAndThinRaysMeetTooLittle) {
  const LevelRecording beams("vls128", Fidelity::kFootprint, ReturnMode::kStrongest);
  const LevelRecording rays("vls128", Fidelity::kSurface, ReturnMode::kStrongest);
  for (const AblatedThing& thing : AblatedThings(beams.scenario())) {
    const auto pasted = static_cast<double>(beams.SharesOn(thing, kBinEdges_m[0], 0.0).size());
    std::string row = std::string("| ") + thing.name + " |";
    for (std::size_t k = 0; k + 1 < kBinEdges_m.size(); ++k) {
      const double of_rays = rays.MeanPoints(thing, kBinEdges_m[k], kBinEdges_m[k + 1]);
      const double of_beams = beams.MeanPoints(thing, kBinEdges_m[k], kBinEdges_m[k + 1]);
      std::array<char, 60> cell{};
      std::snprintf(cell.data(), cell.size(), " %.0f / %.1f / %.1f |", pasted, of_rays, of_beams);
      row += cell.data();
      EXPECT_GT(of_beams, of_rays);
      EXPECT_GT(pasted, of_beams);
    }
    std::puts(row.c_str());
  }
}

// A team counts 50 to 54 points a frame on a real person at 55.6 m, of a Pandar128 with two
// returns: both are on what fills 0.8 of the beam or more.
TEST(InsertAblation, GivesAPersonAt55MetresThePointsOfARealOne) {
  const auto mean_counted = [](Fidelity rung) {
    const LevelRecording recording("pandar128e4x_standard", rung, ReturnMode::kStrongest);
    const AblatedThing person = AblatedThings(recording.scenario()).front();
    constexpr int kNumPlaces = 15;
    double num_counted = 0.0;
    double num_firings = 0.0;
    for (int k = 0; k < kNumPlaces; ++k) {
      for (const float share : recording.SharesOn(person, 55.6, 0.07 * (k - 7))) {
        num_counted += share >= 0.8F ? 2.0 : 1.0;
        num_firings += 1.0;
      }
    }
    std::printf("person at 55.6 m, %s: %.1f firings, %.1f points\n",
                std::string(NameOf(rung)).c_str(), num_firings / kNumPlaces,
                num_counted / kNumPlaces);
    return num_counted / kNumPlaces;
  };
  const double of_beams = mean_counted(Fidelity::kFootprint);
  EXPECT_NEAR(of_beams, 52.0, 4.0);
  EXPECT_GT(of_beams, mean_counted(Fidelity::kSurface) + 5.0);
}

/// Things at places that a number draws, at least 3 deg apart.
std::vector<LoopThing> DrawnThings(std::uint64_t number) {
  constexpr std::uint32_t kNum = 6;
  const std::array<Vector3, 3> sizes_m = {Vector3(0.5, 0.5, 0.5), Vector3(0.4, 0.6, 1.75),
                                          Vector3(0.15, 0.15, 2.5)};
  std::vector<LoopThing> things;
  for (std::uint32_t k = 0; k < kNum; ++k) {
    const auto words = RandomWords(number, RandomUse::kNoise, 0, k);
    const double range_m = 10.0 * std::pow(8.0, static_cast<double>(UnitFloat(words[0])));
    const double azimuth_rad =
        RadFromDeg(3.6 * (k - 2.5) + static_cast<double>(UnitFloat(words[1])) - 0.5);
    things.push_back({range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad),
                      sizes_m.at(words[2] % sizes_m.size())});
  }
  return things;
}

struct Moments {
  double num = 0.0, sum = 0.0, sum_of_squares = 0.0;
  void Add(double value) {
    num += 1.0;
    sum += value;
    sum_of_squares += value * value;
  }
  [[nodiscard]] double mean() const { return num > 0.0 ? sum / num : 0.0; }
  [[nodiscard]] double spread() const {
    return num > 0.0 ? std::sqrt(std::max(0.0, sum_of_squares / num - mean() * mean())) : 0.0;
  }
};

constexpr std::array<const char*, 11> kPatchFeatures = {"range",
                                                        "number of points",
                                                        "mean range",
                                                        "spread of range",
                                                        "intensity",
                                                        "its spread",
                                                        "second returns",
                                                        "width",
                                                        "height",
                                                        "empty beside it",
                                                        "intensity of what is beside it"};

/// What shows of a thing in a frame, and of what is beside it; nothing if it has few points.
std::vector<double> PatchOf(const Frame& frame, const LoopThing& thing, std::uint32_t instance) {
  Moments range_m, intensity, beside;
  double num_second = 0.0;
  double num_empty = 0.0;
  std::array<std::uint32_t, 4> box = {frame.rows, 0, frame.columns, 0};
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot]) || frame.instance[slot] != instance) continue;
    const auto cell = static_cast<std::uint32_t>(slot / frame.returns);
    range_m.Add(static_cast<double>(frame.range_m[slot]));
    intensity.Add(static_cast<double>(frame.intensity[slot]));
    num_second += frame.return_count[slot] > 1 ? 1.0 : 0.0;
    box = {std::min(box[0], cell / frame.columns), std::max(box[1], cell / frame.columns),
           std::min(box[2], cell % frame.columns), std::max(box[3], cell % frame.columns)};
  }
  if (range_m.num < 5.0) return {};
  for (std::uint32_t row = box[0] - std::min(box[0], 1U);
       row <= std::min(box[1] + 1, frame.rows - 1); ++row) {
    for (std::uint32_t column = box[2] - std::min(box[2], 2U);
         column <= std::min(box[3] + 2, frame.columns - 1); ++column) {
      const std::size_t slot = (std::size_t{row} * frame.columns + column) * frame.returns;
      if (std::isnan(frame.x[slot])) {
        num_empty += 1.0;
      } else if (frame.instance[slot] != instance) {
        beside.Add(static_cast<double>(frame.intensity[slot]));
      }
    }
  }
  const double distance_m = std::hypot(thing.ahead_m, thing.left_m);
  return {std::log(distance_m),
          std::log(range_m.num),
          range_m.mean() - distance_m,
          range_m.spread(),
          intensity.mean(),
          intensity.spread(),
          num_second / range_m.num,
          (box[3] - box[2]) * distance_m,
          (box[1] - box[0]) * distance_m,
          num_empty / range_m.num,
          beside.mean()};
}

// All that is drawn is drawn anew for each: places, noise, losses, errors of the channels.
TEST(InsertedThings, CannotBeToldFromThoseSimulatedAtOnce) {
  constexpr std::uint64_t kNumScenes = 80;
  TwoSamples samples;
  for (std::uint64_t number = 0; number < 2 * kNumScenes; ++number) {
    LoopSensor sensor = MakeLoopSensor("vls128", Fidelity::kFootprint, {12.0, -15.0, 8.0});
    sensor.scenario.lidar.receiver.return_mode = ReturnMode::kDual;
    sensor.scenario.seed = 1000 + number;
    const std::vector<LoopThing> things = DrawnThings(number);
    const auto scene = MakeLoopScene(sensor.scenario);
    const bool is_inserted = number % 2 == 1;
    Frame frame;
    if (is_inserted) {
      RecordedFirings recorded = RecordedOf(ScanLoop(sensor, scene), sensor.pattern);
      ForgetOwnFields(recorded);
      Inserter inserter(
          PlanOf(sensor.scenario, ThingsAlone(sensor.scenario, things), sensor.pattern), 0);
      frame = inserter.Insert(recorded, 0).recorded.frame;
    } else {
      AddThings(sensor.scenario, things, *scene);
      frame = ScanLoop(sensor, scene);
    }
    for (std::uint32_t k = 0; k < things.size(); ++k) {
      std::vector<double> patch = PatchOf(frame, things[k], k + 1);
      if (!patch.empty()) samples.Add(std::move(patch), is_inserted);
    }
  }
  const double area = CrossValidatedArea(samples);
  std::printf("%zu patches, area %.3f\n", samples.features.size(), area);
  for (std::size_t k = 0; k < kPatchFeatures.size(); ++k) {
    std::printf("| %s | %.2f |\n", kPatchFeatures.at(k), AreaOfFeature(samples, k));
  }
  EXPECT_LE(area, 0.55);
}

}  // namespace
}  // namespace railcast
