// Measures the speed of the published scan in the demo scene, with all rows interleaved in one
// process.
//
//   railcast-bench [--benchmark_filter=demo] [other options of Google Benchmark]
//
// Rows are <what>/<scene>/threads:<n>. <what> is: raw_trace (Embree's packets of 16, with rays
// aimed beforehand and ranges kept); sets of effects, complete to a filled Frame; the same written
// as PCD to tmpfs (to the temporary folder where /dev/shm cannot be written); the same encoded in
// the railcast protocol and sent to a listener on loopback; and finished frames only encoded and
// sent. Scenes are the demo, the demo in a wind of 10 m/s, and the demo without some of its parts.
// Ratios to the raw trace of the same scene and number of threads are printed at the end; compare
// these, because absolute times are noisy.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/io/net/udp.h"
#include "core/io/run/camera_files.h"
#include "core/io/stream/stream_encoder.h"
#include "core/io/write_file.h"
#include "core/program/program.h"
#include "railcast/effects.h"
#include "railcast/error.h"
#include "railcast/io/cloud_files.h"
#include "railcast/scenario.h"
#include "tests/bench/bench_reporter.h"

namespace railcast {
namespace {

// The vehicle stays in one chunk for these frames, so that every row sees the same window.
constexpr std::uint32_t kNumFrames = 8;

/// Receives what is sent to it, as a client on the same machine does.
class Listener {
 public:
  Listener() : thread_([this] { Listen(); }) {}
  ~Listener() {
    receiver_.Interrupt();
    thread_.join();
  }
  [[nodiscard]] const Endpoint& at() const { return receiver_.at(); }

 private:
  void Listen() {
    while (!receiver_.is_interrupted()) static_cast<void>(receiver_.Receive(-1));
  }

  UdpReceiver receiver_{{0x7F000001, 0}};
  std::thread thread_;
};

/// The file that frames are written to. It is removed by the destructor.
class FrameFileOnTmpfs {
 public:
  FrameFileOnTmpfs() {
    for (const std::filesystem::path& folder :
         {std::filesystem::path("/dev/shm"), std::filesystem::temp_directory_path()}) {
      if (::access(folder.c_str(), W_OK) != 0) continue;
      path_ = folder / ("railcast_bench_" + std::to_string(::getpid()) + ".pcd");
      return;
    }
    throw InputError("/dev/shm: must be a folder that can be written, or TMPDIR must be one");
  }
  ~FrameFileOnTmpfs() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  FrameFileOnTmpfs(const FrameFileOnTmpfs&) = delete;
  FrameFileOnTmpfs& operator=(const FrameFileOnTmpfs&) = delete;

  void Write(const std::string& bytes) const { WriteFileWhole(path_, bytes); }

 private:
  std::filesystem::path path_;
};

/// A scene, ready to be scanned with any effects.
struct Bench {
  explicit Bench(const ScenarioSpec& scenario)
      : spec(scenario), simulator(MakeSimulator(scenario, 1)) {
    for (std::uint32_t i = 0; i < kNumFrames; ++i) {
      raw_traces.push_back(simulator->MakeRawTrace(i));
    }
    files.labels = LabelTable(scenario.labels);
    for (std::uint32_t i = 0; i < kNumFrames; ++i) simulator->Scan(i, scanned.emplace_back());
    ScenarioSpec with_camera = scenario;
    with_camera.camera = CameraSpec{.width_px = 240, .height_px = 120, .horizontal_fov_deg = 60.0};
    camera = MakeCamera(with_camera);
    with_camera.camera = CameraSpec{.width_px = 1250, .height_px = 800, .horizontal_fov_deg = 60.0};
    large_camera = MakeCamera(with_camera);
    stream = std::make_unique<StreamEncoder>(BuildScanPattern(scenario.lidar.scan), StreamSpec{});
  }

  ScenarioSpec spec;
  std::unique_ptr<Simulator> simulator;
  std::vector<std::function<void()>> raw_traces;
  std::vector<Frame> scanned;  ///< Scanned with the scenario's own effects and weather.
  Frame frame;
  std::optional<Camera> camera;
  std::optional<Camera> large_camera;
  CameraImage image;
  FrameFileSpec files;
  std::vector<FrameFile> encoded;
  std::unique_ptr<StreamEncoder> stream;
  Datagrams datagrams;
  Listener listener;
  UdpSender sender{{listener.at()}, 1};
  FrameFileOnTmpfs file;
};

using Work = std::function<void(Bench&, std::uint32_t frame)>;

void ScanFrame(Bench& bench, std::uint32_t frame) {
  bench.simulator->Scan(frame, bench.frame);
}

void ScanAndWrite(Bench& bench, std::uint32_t frame) {
  ScanFrame(bench, frame);
  EncodeFrameFiles(bench.frame, bench.files, frame, bench.encoded);
  bench.file.Write(bench.encoded.front().bytes);
}

void EncodeDatagrams(Bench& bench, std::uint32_t frame) {
  bench.datagrams.Clear();
  bench.stream->Encode(bench.scanned[frame], bench.datagrams);
}

void Send(Bench& bench, std::uint32_t frame) {
  EncodeDatagrams(bench, frame);
  bench.sender.Send(bench.datagrams, bench.datagrams.items);
}

void ScanAndSend(Bench& bench, std::uint32_t frame) {
  ScanFrame(bench, frame);
  bench.datagrams.Clear();
  bench.stream->Encode(bench.frame, bench.datagrams);
  bench.sender.Send(bench.datagrams, bench.datagrams.items);
}

// As many pixels as the published scan has beams, over nearly the same field of view.
void RenderImage(Bench& bench, std::uint32_t frame) {
  bench.camera->Render(*bench.simulator, frame, bench.image);
}

void RenderMegapixel(Bench& bench, std::uint32_t frame) {
  bench.large_camera->Render(*bench.simulator, frame, bench.image);
}

void RenderAndEncodeMegapixel(Bench& bench, std::uint32_t frame) {
  RenderMegapixel(bench, frame);
  benchmark::DoNotOptimize(EncodeCameraFiles(bench.image, "camera", frame));
}

struct Row {
  std::string what;
  EffectSet effects;
  bool rain = false;  ///< With neither rain nor snow, the weather is dry.
  bool snow = false;
  Work work;
  CoverSpec cover{};
  double halo_share = 0.0;
  std::optional<double> visibility_m{};  ///< Of fog; none by default.
  double puddle_share = 0.0;
  double sun_klx = 0.0;
};

std::vector<Row> Rows() {
  const EffectSet all{.threshold = true, .rain = true, .snow = true, .noise = true};
  const EffectSet surface = EffectsOfRung(Fidelity::kSurface);
  EffectSet surface_and_wires = surface;
  surface_and_wires.thin_conductors = true;
  return {
      {"raw_trace", {}, false, false, [](Bench& b, std::uint32_t f) { b.raw_traces[f](); }},
      {"geometry", {}, false, false, &ScanFrame},
      {"threshold", {.threshold = true}, false, false, &ScanFrame},
      {"threshold+noise", {.threshold = true, .noise = true}, false, false, &ScanFrame},
      {"plausibility", all, true, false, &ScanFrame},
      {"plausibility_in_snow", all, true, true, &ScanFrame},
      {"surface", surface, true, false, &ScanFrame},
      {"surface_in_snow", surface, true, true, &ScanFrame},
      {"surface_behind_dirt", surface, true, false, &ScanFrame, {.dirt_coverage = 0.1}},
      {"surface_behind_drops", surface, true, false, &ScanFrame, {.drop_coverage = 0.1}},
      {"surface_with_halo", surface, true, false, &ScanFrame, {}, 1e-6},
      {"surface_with_puddles", surface, true, false, &ScanFrame, {}, 0.0, {}, 0.2},
      {"surface_in_haze_of_2_km", surface, true, false, &ScanFrame, {}, 0.0, 2000.0},
      {"surface_in_fog_of_200_m", surface, true, false, &ScanFrame, {}, 0.0, 200.0},
      {"surface_in_fog_of_50_m", surface, true, false, &ScanFrame, {}, 0.0, 50.0},
      {"surface+thin_conductors", surface_and_wires, true, false, &ScanFrame},
      {"footprint", EffectsOfRung(Fidelity::kFootprint), true, false, &ScanFrame},
      {"reference", EffectsOfRung(Fidelity::kReference), true, false, &ScanFrame},
      {"geometry_pcd", {}, false, false, &ScanAndWrite},
      {"plausibility_pcd", all, true, false, &ScanAndWrite},
      {"encode_stream", {}, false, false, &EncodeDatagrams},
      {"send_stream", {}, false, false, &Send},
      {"plausibility_stream", all, true, false, &ScanAndSend},
      {"camera_of_28800_pixels", {}, false, false, &RenderImage},
      {"camera_of_28800_pixels_in_sun", {}, false, false, &RenderImage, {}, 0.0, {}, 0.0, 100.0},
      {"camera_megapixel_in_sun", {}, false, false, &RenderMegapixel, {}, 0.0, {}, 0.0, 100.0},
      {"camera_megapixel_files",
       {},
       false,
       false,
       &RenderAndEncodeMegapixel,
       {},
       0.0,
       {},
       0.0,
       100.0},
  };
}

void Run(benchmark::State& state, Bench& bench, const Row& row, int num_threads) {
  using Clock = std::chrono::steady_clock;
  SimulatorSpec spec = bench.simulator->spec();
  spec.detector.effects = row.effects;
  spec.detector.weather.rain_rate_mmph = row.rain ? 2.0 : 0.0;
  spec.detector.weather.snow_rate_mmph = row.snow ? 2.0 : 0.0;
  spec.detector.cover = row.cover;
  spec.detector.receiver.halo_share_at_1_deg = row.halo_share;
  spec.detector.weather.visibility_m = row.visibility_m;
  spec.detector.weather.puddle_share = row.puddle_share;
  spec.detector.weather.sun.illuminance_klx = row.sun_klx;
  bench.simulator->UseThreads(num_threads);
  bench.simulator->Use(spec);
  row.work(bench, 0);  // Warms the caches, because the rows before it ran on other memory.
  std::vector<double> times_ms;
  std::uint32_t frame = 0;
  for (auto _ : state) {
    const auto begin = Clock::now();
    row.work(bench, frame);
    const std::chrono::duration<double> elapsed_s = Clock::now() - begin;
    state.SetIterationTime(elapsed_s.count());
    times_ms.push_back(elapsed_s.count() * 1e3);
    frame = (frame + 1) % kNumFrames;
  }
  std::sort(times_ms.begin(), times_ms.end());
  const auto quantile = [&](double q) {
    return times_ms[static_cast<std::size_t>(q * static_cast<double>(times_ms.size() - 1))];
  };
  state.counters["p50_ms"] = quantile(0.5);
  state.counters["p99_ms"] = quantile(0.99);
}

/// Prints the medians over the repetitions and their ratios to the raw trace, in the order of
/// registration. (--benchmark_out=FILE writes everything else that Google Benchmark measures.)
class RatioReporter : public BenchReporter {
 public:
  explicit RatioReporter(std::vector<std::string> names) : names_(std::move(names)) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.aggregate_name != "median") continue;
      const auto p99 = run.counters.find("p99_ms");
      rows_[run.run_name.function_name] = {run.counters.at("p50_ms").value, p99->second.value};
    }
  }

  void Finalize() override {
    std::printf("\n%-44s %10s %10s %12s\n", "median over the repetitions", "p50 ms", "p99 ms",
                "x raw_trace");
    for (const std::string& name : names_) {
      const auto row = rows_.find(name);
      if (row == rows_.end()) continue;
      const auto raw = rows_.find("raw_trace" + name.substr(name.find('/')));
      std::printf("%-44s %10.3f %10.3f", name.c_str(), row->second.p50_ms, row->second.p99_ms);
      if (raw != rows_.end()) std::printf(" %12.3f", row->second.p50_ms / raw->second.p50_ms);
      std::printf("\n");
    }
  }

 private:
  struct Times {
    double p50_ms{};
    double p99_ms{};
  };
  std::vector<std::string> names_;
  std::map<std::string, Times> rows_;
};

std::map<std::string, ScenarioSpec> Scenes() {
  const ScenarioSpec demo =
      ReadScenario(std::filesystem::path(RAILCAST_SCENARIOS_DIR) / "st_gallen_approach.json");
  std::map<std::string, ScenarioSpec> scenes{{"demo", demo}};
  scenes.emplace("demo-in-wind", demo).first->second.weather.wind_speed_mps = 10.0;
  const auto without = [&](const std::string& name, const std::function<void(WorldSpec&)>& edit) {
    ScenarioSpec scene = demo;
    edit(scene.world);
    scenes.emplace("demo-without-" + name, std::move(scene));
  };
  without("grass", [](WorldSpec& world) { world.vegetation.grass = false; });
  // In this lean scene the trace is cheap, so that the steps after it weigh most.
  without("plants", [](WorldSpec& world) {
    world.vegetation.trees_per_hectare = 0.0;
    world.vegetation.grass = false;
  });
  without("trees", [](WorldSpec& world) { world.vegetation.trees_per_hectare = 0.0; });
  without("wires", [](WorldSpec& world) { world.catenary.enabled = false; });
  without("objects", [](WorldSpec& world) { world.objects.clear(); });
  // Rails, sleepers and ballast end under the vehicle, and so do the objects that stand on them:
  // compare with demo-without-objects.
  without("objects-and-tracks", [](WorldSpec& world) {
    world.objects.clear();
    world.tracks.resize(1);
    world.tracks.front().end_s_m = 2191.0;
  });
  without("second-track", [](WorldSpec& world) {
    world.tracks.resize(1);
    std::erase_if(world.objects, [](const ObjectSpec& object) { return object.track != "main"; });
  });
  return scenes;
}

int Main(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  // The defaults come first, so that the user's options override them.
  std::string defaults[] = {"--benchmark_enable_random_interleaving=true",
                            "--benchmark_repetitions=15", "--benchmark_min_time=0.1",
                            "--benchmark_report_aggregates_only=true"};
  for (std::string& option : defaults) arguments.insert(arguments.begin() + 1, option.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return kExitUsage;

  std::vector<std::string> names;
  for (const auto& [scene, spec] : Scenes()) {
    const auto bench = std::make_shared<Bench>(spec);
    for (const Row& row : Rows()) {
      const bool has_all_rows = scene == "demo" || scene == "demo-without-plants";
      const bool is_in_wind = scene == "demo-in-wind" &&
                              (row.what == "surface" || row.what == "surface+thin_conductors" ||
                               row.what == "footprint");
      if (!has_all_rows && !is_in_wind && row.what != "raw_trace") continue;
      for (const int num_threads : {1, 2}) {
        const std::string name = row.what + "/" + scene + "/threads:" + std::to_string(num_threads);
        names.push_back(name);
        benchmark::RegisterBenchmark(
            name.c_str(), [=](benchmark::State& state) { Run(state, *bench, row, num_threads); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  RatioReporter reporter(std::move(names));
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return kExitSuccess;
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::RunProgram(
      "railcast-bench", [&] { return railcast::Main(argc, argv); }, std::cerr);
}
