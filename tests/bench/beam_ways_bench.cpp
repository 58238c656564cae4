// Compares ways of tracing the beams of effect `footprint`, in turns in one process, on one thread,
// and shows what kinds of beams take how much of the time. Prints tables in Markdown.
//
//   railcast-beamways SCENARIO... [--turns N]
//
// Frame 0 without moving objects and wires. Times are what the processor spent, medians over the
// turns; those of all ways include the aiming of the sub-rays.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/program/command_line.h"
#include "core/program/run_program.h"
#include "railcast/scenario.h"
#include "tests/bench/beam_ways.h"
#include "tests/bench/beam_ways_scene.h"
#include "tests/bench/layouts.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

enum BeamKind : std::uint8_t {
  kSky,
  kOneFacet,
  kFewTriangles,
  kManyTriangles,
  kCrowded,
  kNumKinds
};
constexpr std::array<const char*, kNumKinds> kKindNames = {
    "nothing", "one facet", "several facets, up to 16 triangles met",
    "several facets, 17 to 96 triangles met", "a crowd"};

BeamKind KindOf(const BeamRays& beam) {
  constexpr std::uint32_t kFew = 16;
  if (beam.num_rays < kNumSubRays) return kCrowded;
  const bool is_one = std::all_of(beam.facet, beam.facet + beam.num_rays,
                                  [&](std::uint32_t facet) { return facet == beam.facet[0]; });
  if (is_one) return beam.facet[0] == 0 ? kSky : kOneFacet;
  return beam.num_met <= kFew ? kFewTriangles : kManyTriangles;
}

/// The share of a beam's sub-rays that are not on its main surface; surfaces are 0.5 m apart.
double ShareBeside(const BeamRays& beam) {
  constexpr float kGap_m = 0.5F;
  std::vector<float> ranges_m(beam.range_m, beam.range_m + beam.num_rays);
  std::ranges::sort(ranges_m);
  std::size_t most = 0;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= ranges_m.size(); ++i) {
    if (i < ranges_m.size() && ranges_m[i] - ranges_m[i - 1] < kGap_m) continue;
    most = std::max(most, i - begin);
    begin = i;
  }
  return 1.0 - static_cast<double>(most) / static_cast<double>(beam.num_rays);
}

/// What one way has taken and found.
struct TimedWay {
  std::vector<double> times_ms;
  std::size_t num_found = 0;  ///< Of the beams with a second surface.
  std::size_t num_other = 0;  ///< Beams that do not have the product's ranges.
};

class WayComparison {
 public:
  WayComparison(const std::string& file, int num_turns)
      : scene_(ReadScenario(file)), tile_(kBeamsOfTile), timed_(BeamWays().size()) {
    const LaidOutScene robust(scene_.layout().models, {});
    const LaidOutScene open(scene_.layout().models, {.plant_flags = RTC_SCENE_FLAG_NONE});
    Find();
    OrderedRays rays = scene_.layout().rays.In(RayOrder::kSquares);
    const auto raw_ms = [&](const LaidOutScene& laid, bool is_coherent) {
      rays.Restore(scene_.range_max_m());
      return CpuTimeOf_ms([&] { CastRanges(laid, {16, is_coherent}, rays.tiles); });
    };
    for (int turn = 0; turn < num_turns; ++turn) {
      raw_ms(robust, true);  // Warms the caches.
      robust_ms_.push_back(raw_ms(robust, true));
      raw_ms(open, false);
      raw_ms_.push_back(raw_ms(open, false));
      for (std::size_t way = 0; way < timed_.size(); ++way) {
        const auto nothing = [](std::size_t, std::size_t) {};
        timed_[way].times_ms.push_back(CpuTimeOf_ms([&] { Trace(ways_[way], nothing); }));
      }
      for (std::size_t kind = 0; kind < kNumKinds; ++kind) TakeKind(kind);
    }
  }

  void Print() const {
    const double raw_ms = Median(raw_ms_);
    const double robust_ms = Median(robust_ms_);
    std::printf("| way | ms | x raw | x raw, robust | second %% | other beams |\n");
    std::printf("|---|---|---|---|---|---|\n");
    std::printf("| raw trace, all robust and coherent | %.1f | %.2f | 1 | | |\n", robust_ms,
                robust_ms / raw_ms);
    std::printf("| raw trace | %.1f | 1 | %.2f | | |\n", raw_ms, raw_ms / robust_ms);
    for (std::size_t way = 0; way < timed_.size(); ++way) {
      const TimedWay& timed = timed_[way];
      const double ms = Median(timed.times_ms);
      std::printf("| %s | %.1f | %.2f | %.2f | %.1f | %zu |\n", ways_[way].name, ms, ms / raw_ms,
                  ms / robust_ms,
                  100.0 * static_cast<double>(timed.num_found) / static_cast<double>(num_second_),
                  timed.num_other);
    }
    std::printf("\n| beams that meet | %% of beams | %% of their trace |\n|---|---|---|\n");
    double all_ms = 0.0;
    for (const auto& times_ms : kind_ms_) all_ms += Median(times_ms);
    for (std::size_t kind = 0; kind < kNumKinds; ++kind) {
      std::printf("| %s | %.1f | %.1f |\n", kKindNames[kind],
                  100.0 * static_cast<double>(of_kind_[kind].size()) /
                      static_cast<double>(scene_.num_firings()),
                  100.0 * Median(kind_ms_[kind]) / all_ms);
    }
  }

 private:
  template <typename Done>
  void Trace(const BeamWay& way, const Done& done) {
    for (std::size_t first = 0; first < scene_.num_firings(); first += kBeamsOfTile) {
      const std::size_t num = std::min(kBeamsOfTile, scene_.num_firings() - first);
      for (std::size_t k = 0; k < num; ++k) scene_.Aim(first + k, tile_[k]);
      way.trace(scene_.beams(), tile_.data(), num);
      done(first, num);
    }
  }

  /// Finds what all ways find, and the kinds of the beams.
  void Find() {
    constexpr double kLeastShare = 0.05;
    std::vector<float> ranges_m(scene_.num_firings() * kNumSubRays);
    std::vector<bool> has_second(scene_.num_firings());
    for (std::size_t way = 1; way < ways_.size(); ++way) {
      Trace(ways_[way], [&](std::size_t first, std::size_t num) {
        for (std::size_t k = 0; k < num; ++k) {
          const BeamRays& beam = tile_[k];
          const double beside = ShareBeside(beam);
          float* const expected_m = ranges_m.data() + (first + k) * kNumSubRays;
          if (way == 1) {
            std::copy_n(beam.range_m, beam.num_rays, expected_m);
            has_second[first + k] = beside >= kLeastShare;
            num_second_ += beside >= kLeastShare ? 1 : 0;
            of_kind_[KindOf(beam)].push_back(first + k);
          }
          if (has_second[first + k] && beside > 0.0) ++timed_[way].num_found;
          if (!std::equal(expected_m, expected_m + beam.num_rays, beam.range_m)) {
            ++timed_[way].num_other;
          }
        }
      });
    }
  }

  void TakeKind(std::size_t kind) {
    const auto trace = [&](const BeamWay& way) {
      return CpuTimeOf_ms([&] {
        for (const std::size_t firing : of_kind_[kind]) {
          scene_.Aim(firing, tile_[0]);
          way.trace(scene_.beams(), tile_.data(), 1);
        }
      });
    };
    kind_ms_[kind].push_back(std::max(trace(ways_[1]) - trace(ways_[0]), 0.0));
  }

  BeamWaysScene scene_;
  std::vector<BeamWay> ways_ = BeamWays();
  std::vector<BeamRays> tile_;
  std::vector<TimedWay> timed_;
  std::vector<double> robust_ms_, raw_ms_;
  std::size_t num_second_ = 0;
  std::array<std::vector<std::size_t>, kNumKinds> of_kind_;
  std::array<std::vector<double>, kNumKinds> kind_ms_;
};

int Main(int argc, char** argv) {
  std::vector<std::string> files;
  int num_turns = 9;
  CLI::App app("Compares ways of tracing beams.");
  app.add_option("SCENARIO", files, "Scenario files")->required()->check(NonEmpty());
  app.add_option("--turns", num_turns, "Turns that each way takes")
      ->transform(Whole({1, 1'000'000}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") == 0) throw InputError("the ways are compiled for AVX2");
#endif
  for (const std::string& file : files) {
    std::printf("%s:\n\n", std::filesystem::path(file).stem().c_str());
    WayComparison(file, num_turns).Print();
    std::printf("\n");
  }
  return kExitSuccess;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-beamways", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
