// Compares ways of giving a scene and its rays to Embree, in turns in one process, on one thread.
// Prints a table in Markdown with a column for each scenario.
//
//   railcast-layouts SCENARIO... [--turns N]
//
// A turn casts the rays of frame 0 twice, of which the second time counts, in time that the
// processor spent on it. Figures are medians over the turns of the ratio to the first row of the
// same turn.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "core/program/run_program.h"
#include "railcast/scenario.h"
#include "tests/bench/layouts.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

/// Scenes that are traced one after another, each up to what the ones before it hit.
struct Way {
  std::string name;
  struct Pass {
    std::shared_ptr<const LaidOutScene> scene;
    CastForm form;
  };
  std::vector<Pass> passes;
  RayOrder order = RayOrder::kSquares;
};

constexpr CastForm kPackets{.width = 16, .is_coherent = true};
constexpr CastForm kParting{.width = 16, .is_coherent = false};
constexpr CastForm kSingle{.width = 1, .is_coherent = false};
constexpr RTCSceneFlags kRobust = RTC_SCENE_FLAG_ROBUST;
constexpr RTCSceneFlags kOpen = RTC_SCENE_FLAG_NONE;
constexpr RTCBuildQuality kHigh = RTC_BUILD_QUALITY_HIGH;

/// Makes scenes of the same models.
class LayoutShop {
 public:
  explicit LayoutShop(const std::vector<PlacedModel>& models) : models_(models) {}

  [[nodiscard]] std::shared_ptr<const LaidOutScene> Lay(const Layout& layout) const {
    return std::make_shared<const LaidOutScene>(models_, layout);
  }
  /// Null if copying the models of these kinds would take too much memory.
  [[nodiscard]] std::shared_ptr<const LaidOutScene> Bake(KindBits kinds) const {
    constexpr std::size_t kMostTriangles = 20'000'000;
    std::size_t num_triangles = 0;
    for (const PlacedModel& placed : models_) {
      if ((BitOf(placed.kind) & kinds) != 0) num_triangles += placed.model->num_triangles();
    }
    return num_triangles > kMostTriangles ? nullptr : Lay({.baked = kinds});
  }

 private:
  const std::vector<PlacedModel>& models_;
};

void AddForms(const LayoutShop& shop, std::vector<Way>& ways) {
  const auto base = shop.Lay({});
  ways.push_back(
      {"packets of 16, coherent; all robust, of medium quality, instances", {{base, kPackets}}});
  ways.push_back({"incoherent", {{base, kParting}}});
  ways.push_back({"packets of 8", {{base, {8, true}}}});
  ways.push_back({"packets of 8, incoherent", {{base, {8, false}}}});
  ways.push_back({"packets of 4", {{base, {4, true}}}});
  ways.push_back({"single rays", {{base, kSingle}}});
  ways.push_back({"packets of 16 in a row instead of 4 x 4", {{base, kPackets}}, RayOrder::kRows});
  ways.push_back({"packets of 16 in a column", {{base, kPackets}}, RayOrder::kColumns});
}

void AddFlags(const LayoutShop& shop, std::vector<Way>& ways) {
  const auto open = shop.Lay({.flags = kOpen, .plant_flags = kOpen, .top_flags = kOpen});
  const auto open_plants = shop.Lay({.plant_flags = kOpen});
  const auto high = shop.Lay({.quality = kHigh, .plant_quality = kHigh, .top_quality = kHigh});
  const auto high_plants = shop.Lay({.plant_quality = kHigh});
  const auto open_high_plants = shop.Lay({.plant_quality = kHigh, .plant_flags = kOpen});
  const RTCSceneFlags compact_flags = kRobust | RTC_SCENE_FLAG_COMPACT;
  const auto compact = shop.Lay({.flags = compact_flags, .plant_flags = compact_flags});
  ways.push_back({"nothing robust", {{open, kPackets}}});
  ways.push_back({"nothing robust, incoherent", {{open, kParting}}});
  ways.push_back({"nothing robust, single rays", {{open, kSingle}}});
  ways.push_back({"plants not robust", {{open_plants, kPackets}}});
  ways.push_back({"**plants not robust, incoherent**", {{open_plants, kParting}}});
  ways.push_back({"all of high quality", {{high, kPackets}}});
  ways.push_back({"plants of high quality, incoherent", {{high_plants, kParting}}});
  ways.push_back(
      {"plants of high quality, not robust, incoherent", {{open_high_plants, kParting}}});
  ways.push_back({"compact", {{compact, kPackets}}});
}

void AddCopies(const LayoutShop& shop, std::vector<Way>& ways) {
  ways.push_back(
      {"a chunk's grass in one model", {{shop.Bake(BitOf(PlacedKind::kGrass)), kPackets}}});
  ways.push_back(
      {"a chunk's trees in one model", {{shop.Bake(BitOf(PlacedKind::kTree)), kPackets}}});
  ways.push_back({"a chunk's sleepers and masts in one model",
                  {{shop.Bake(BitOf(PlacedKind::kPiece)), kPackets}}});
}

void AddPasses(const LayoutShop& shop, std::vector<Way>& ways) {
  const auto hard = shop.Lay({.kinds = ~kPlants});
  const auto plants = shop.Lay({.kinds = kPlants, .plant_flags = kOpen, .top_flags = kOpen});
  const auto high = shop.Lay({.kinds = kPlants,
                              .plant_quality = kHigh,
                              .plant_flags = kOpen,
                              .top_quality = kHigh,
                              .top_flags = kOpen});
  ways.push_back({"first all but plants, then plants not robust, incoherent",
                  {{hard, kPackets}, {plants, kParting}}});
  ways.push_back({"the same, plants of high quality", {{hard, kPackets}, {high, kParting}}});
  ways.push_back({"the same, plants by single rays", {{hard, kPackets}, {high, kSingle}}});
  ways.push_back({"without plants", {{hard, kPackets}}});
  ways.push_back({"without plants, incoherent", {{hard, kParting}}});
  const auto flat = shop.Lay({.kinds = ~kPlants, .is_flat = true});
  ways.push_back({"without plants, one level", {{flat, kPackets}}});
}

/// What one way gave on one scenario.
struct Result {
  std::vector<double> times_ms;
  std::vector<float> ranges_m;  ///< In the order of RayOrder::kSquares.
  double build_s{};
  double memory_mb{};
};

class Comparison {
 public:
  Comparison(const std::string& file, int num_turns)
      : scenario_(ReadScenario(file)), scene_(MakeLayoutScene(scenario_)) {
    const LayoutShop shop(scene_.models);
    AddForms(shop, ways_);
    AddFlags(shop, ways_);
    AddCopies(shop, ways_);
    AddPasses(shop, ways_);
    results_.resize(ways_.size());
    for (int turn = 0; turn < num_turns; ++turn) {
      for (std::size_t i = 0; i < ways_.size(); ++i) Take(ways_[i], results_[i]);
    }
    for (Way& way : ways_) way.passes.clear();  // Gigabytes.
  }

  [[nodiscard]] std::size_t num_ways() const { return ways_.size(); }
  [[nodiscard]] const std::string& name_of(std::size_t way) const { return ways_[way].name; }
  [[nodiscard]] const Result& result_of(std::size_t way) const { return results_[way]; }
  [[nodiscard]] bool has(std::size_t way) const { return !results_[way].times_ms.empty(); }
  [[nodiscard]] double RatioOf(std::size_t way) const {
    std::vector<double> ratios;
    for (std::size_t turn = 0; turn < results_[way].times_ms.size(); ++turn) {
      ratios.push_back(results_[way].times_ms[turn] / results_.front().times_ms[turn]);
    }
    return Median(ratios);
  }
  /// The rays whose range differs from that of the first way by more than a millimetre.
  [[nodiscard]] std::size_t NumOtherRanges(std::size_t way) const {
    std::size_t count = 0;
    for (std::size_t ray = 0; ray < results_[way].ranges_m.size(); ++ray) {
      const float change_m = results_[way].ranges_m[ray] - results_.front().ranges_m[ray];
      count += std::abs(change_m) > 1e-3F ? 1 : 0;
    }
    return count;
  }

 private:
  [[nodiscard]] static bool IsBuilt(const Way& way) {
    return std::ranges::all_of(way.passes, [](const auto& pass) { return pass.scene != nullptr; });
  }

  void Take(const Way& way, Result& result) {
    if (!IsBuilt(way)) return;
    OrderedRays rays = scene_.rays.In(way.order);
    const auto cast = [&] {
      rays.Restore(static_cast<float>(scenario_.lidar.range_max_m));
      return CpuTimeOf_ms([&] {
        for (const Way::Pass& pass : way.passes) CastRanges(*pass.scene, pass.form, rays.tiles);
      });
    };
    static_cast<void>(cast());  // Warms the caches.
    result.times_ms.push_back(cast());
    result.ranges_m = rays.Ranges_m();
    result.build_s = 0.0;
    result.memory_mb = 0.0;
    for (const Way::Pass& pass : way.passes) {
      result.build_s += pass.scene->build_s();
      result.memory_mb += pass.scene->memory_mb();
    }
  }

  ScenarioSpec scenario_;
  LayoutScene scene_;
  std::vector<Way> ways_;
  std::vector<Result> results_;
};

void Print(const std::vector<std::string>& files, const std::vector<Comparison>& comparisons) {
  std::printf("| |");
  for (const std::string& file : files) {
    std::printf(" %s |", std::filesystem::path(file).stem().c_str());
  }
  std::printf(" other ranges | build s | MB |\n|---|");
  for (std::size_t i = 0; i < files.size() + 3; ++i) std::printf("---|");
  std::printf("\n");
  for (std::size_t way = 0; way < comparisons.front().num_ways(); ++way) {
    std::printf("| %s |", comparisons.front().name_of(way).c_str());
    std::size_t num_other = 0;
    for (const Comparison& comparison : comparisons) {
      if (!comparison.has(way)) {
        std::printf(" - |");
        continue;
      }
      std::printf(" %.2f |", comparison.RatioOf(way));
      num_other += comparison.NumOtherRanges(way);
    }
    const Result& first = comparisons.front().result_of(way);
    std::printf(" %zu | %.2f | %.0f |\n", num_other, first.build_s, first.memory_mb);
  }
  std::printf("\nFirst row:");
  for (const Comparison& comparison : comparisons) {
    std::printf(" %.1f ms for %zu rays;", Median(comparison.result_of(0).times_ms),
                comparison.result_of(0).ranges_m.size());
  }
  std::printf("\n");
}

int Main(int argc, char** argv) {
  std::vector<std::string> files;
  int num_turns = 9;
  CLI::App app("Compares ways of giving a scene and its rays to Embree.");
  app.add_option("SCENARIO", files, "Scenario files")->required()->check(NonEmpty());
  app.add_option("--turns", num_turns, "Turns that each way takes")
      ->transform(Whole({1, 1'000'000}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::vector<Comparison> comparisons;
  for (const std::string& file : files) comparisons.emplace_back(file, num_turns);
  Print(files, comparisons);
  return kExitSuccess;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-layouts", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
