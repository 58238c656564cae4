// Measures how fast the viewer draws frames of 1 k to 500 k points. Needs a display:
//
//   xvfb-run -a -s -noreset build/release/tests/bench/railcast-view-bench
//
// Rows are <what>/<points>/<height of the picture in pixels>. <what> is: play (another frame is
// coloured and drawn, as while playing) or turn (the same frame is drawn from another side, as
// while the mouse is dragged). Under Xvfb, Mesa's llvmpipe draws on the processor's cores.
#include <benchmark/benchmark.h>
#include <vtkCamera.h>
#include <vtkRenderWindow.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/bench/bench_reporter.h"
#include "viewer/composition/composer.h"
#include "viewer/draw/stage.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

/// Points of 64 rings on level ground 3 m below the sensor and on a wall around it.
std::shared_ptr<const ShownFrame> MadeFrame(std::uint32_t num_points, std::uint32_t index) {
  constexpr std::uint32_t kRings = 64;
  RecordedFrame recorded;
  Frame& frame = recorded.frame;
  frame.index = index;
  frame.Resize(kRings, num_points / kRings, 1);
  recorded.is_grid = true;
  recorded.fields = {"x", "y", "z", "range_m", "label"};
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::uint32_t ring = slot / frame.columns;
    const double azimuth_rad =
        2.0 * std::numbers::pi * (slot % frame.columns + 0.1 * index) / frame.columns;
    const double elevation_rad = -0.4 + 0.6 * ring / kRings;
    const double range_m =
        elevation_rad < 0.0 ? std::min(60.0, -3.0 / std::sin(elevation_rad)) : 60.0;
    frame.x[slot] = static_cast<float>(range_m * std::cos(azimuth_rad) * std::cos(elevation_rad));
    frame.y[slot] = static_cast<float>(range_m * std::sin(azimuth_rad) * std::cos(elevation_rad));
    frame.z[slot] = static_cast<float>(range_m * std::sin(elevation_rad));
    frame.range_m[slot] = static_cast<float>(range_m);
    frame.label[slot] = ring / 8;
  }
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

/// A stage that shows a frame.
struct Theatre {
  explicit Theatre(const benchmark::State& state)
      : stage({static_cast<int>(state.range(1) * 16 / 9), static_cast<int>(state.range(1))}),
        composer(RecordingInfo()) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      frames.push_back(MadeFrame(static_cast<std::uint32_t>(state.range(0)), i));
    }
    choices.color_by = "range";
    FitChoices(*frames.front(), choices);
    stage.window().SetOffScreenRendering(true);
    Show(0);
  }

  void Show(std::size_t index) {
    std::vector<Composition> compositions;
    compositions.push_back(composer.Compose({frames[index % frames.size()]}, choices));
    stage.Show(std::move(compositions), Look());
    Render();
  }

  void Render() {
    stage.window().Render();
    stage.window().WaitForCompletion();
  }

  DisplayConnection display;
  Stage stage;
  Composer composer;
  Choices choices;
  std::vector<std::shared_ptr<const ShownFrame>> frames;
};

void Count(benchmark::State& state) {
  state.counters["frames/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void Play(benchmark::State& state) {
  Theatre theatre(state);
  std::size_t next = 0;
  for ([[maybe_unused]] auto step : state) theatre.Show(++next);
  Count(state);
}

void Turn(benchmark::State& state) {
  Theatre theatre(state);
  vtkCamera& camera = *theatre.stage.view(0).renderer().GetActiveCamera();
  for ([[maybe_unused]] auto step : state) {
    camera.Azimuth(1.0);
    theatre.Render();
  }
  Count(state);
}

void AllSizes(benchmark::internal::Benchmark* rows) {
  rows->ArgsProduct({{1'000, 28'800, 100'000, 200'000, 500'000}, {720, 1080}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

BENCHMARK(Play)->Apply(AllSizes);
BENCHMARK(Turn)->Apply(AllSizes);

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  railcast::BenchReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return 0;
}
