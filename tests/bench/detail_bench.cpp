// railcast-measure detail: compares a scene that is coarser far away with full detail, echoes by
// range and times.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/fidelity/echoes_by_range.h"
#include "core/program/command_line.h"
#include "railcast/scenario.h"
#include "tests/bench/mean_surface.h"
#include "tests/bench/measurements.h"
#include "tests/bench/scene_cost.h"

namespace railcast {
namespace {

constexpr double kBin_m = 30.0;

struct Options {
  std::filesystem::path scenario;
  Fidelity rung = Fidelity::kSurface;
  std::uint32_t num_frames = 60;
  double step_m = 31.0;
  int num_turns = 0;
};

/// The scenario on a rung, in clear air, without objects and with three echoes a firing. Its
/// vehicle moves `step_m` from frame to frame.
ScenarioSpec Prepared(const Options& options, SceneDetail detail) {
  ScenarioSpec spec = ReadScenario(options.scenario);
  spec.fidelity = options.rung;
  spec.weather = {};
  spec.world.objects.clear();
  spec.world.detail = detail;
  spec.lidar.receiver.return_mode = ReturnMode::kTriple;
  if (options.num_turns == 0) {
    spec.vehicle.motion.profile = {
        {.time_s = 0.0, .s_m = {}, .speed_mps = options.step_m * spec.lidar.scan.rate_hz}};
  }
  return spec;
}

std::string ChangeText(const RelativeChange& change) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << std::showpos << 100.0 * change.change
       << std::noshowpos << " ± " << 100.0 * change.margin;
  return text.str();
}

/// Three cells of a label: first echoes, further ones and intensity, in percent.
std::string CellsOf(const std::vector<EchoesByRange::Sums>& full,
                    const std::vector<EchoesByRange::Sums>& coarser) {
  constexpr double kLeastNumber = 400.0;  // With fewer, an interval is wider than what it is for.
  using Sums = EchoesByRange::Sums;
  const double first = TotalOf(full, &Sums::first);
  const double further = TotalOf(full, &Sums::further);
  if (first < kLeastNumber) return " | | |";
  const std::string of_further =
      further < kLeastNumber ? "" : ChangeText(ChangeOfSum(full, coarser, &Sums::further));
  return " " + ChangeText(ChangeOfSum(full, coarser, &Sums::first)) + " | " + of_further + " | " +
         ChangeText(ChangeOfIntensity(full, coarser)) + " |";
}

/// Cells of what is low beside and under the track.
void PrintSurfaces(const EchoesByRange& full,
                   const EchoesByRange& coarser,
                   const ScenarioSpec& spec) {
  constexpr double kLeastNumber = 400.0;
  const LabelTable labels(spec.labels);
  std::cout << "\n| range | ballast: first | further | intensity | heights | ground: heights | "
               "sleepers: first | rails: first |\n|---|---|---|---|---|---|---|---|\n";
  for (int bin = 0; bin * kBin_m < spec.lidar.range_max_m; ++bin) {
    const auto heights = [&](const char* label) {
      const auto& of_full = full.Of(labels.Id(label), bin);
      if (TotalOf(of_full, &EchoesByRange::Sums::num_surveyed) < kLeastNumber)
        return std::string(" |");
      return " " + ChangeText(ChangeOfHeights(of_full, coarser.Of(labels.Id(label), bin))) + " |";
    };
    const auto first = [&](const char* label) {
      const std::string cells =
          CellsOf(full.Of(labels.Id(label), bin), coarser.Of(labels.Id(label), bin));
      return cells.substr(0, cells.find('|') + 1);
    };
    std::cout << "| " << bin * kBin_m << " m |"
              << CellsOf(full.Of(labels.Id("ballast"), bin), coarser.Of(labels.Id("ballast"), bin))
              << heights("ballast") << heights("ground") << first("sleeper") << first("rail")
              << "\n";
  }
}

void PrintTable(const EchoesByRange& full, const EchoesByRange& coarser, const ScenarioSpec& spec) {
  const LabelTable labels(spec.labels);
  std::cout
      << "| range | trees: first | further | intensity | grass: first | further | intensity | "
         "ground: first | further | intensity |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (int bin = 0; bin * kBin_m < spec.lidar.range_max_m; ++bin) {
    std::cout << "| " << bin * kBin_m << " m |";
    for (const char* label : {"tree", "grass", "ground"}) {
      std::cout << CellsOf(full.Of(labels.Id(label), bin), coarser.Of(labels.Id(label), bin));
    }
    std::cout << "\n";
  }
}

/// Prints which share of neighbouring firings on a label, in percent, see the same range.
void PrintNeighbours(const EchoesByRange& echoes, const ScenarioSpec& spec, const char* name) {
  const std::uint32_t label = LabelTable(spec.labels).Id(name);
  for (int bin = 0; bin * kBin_m < spec.lidar.range_max_m; ++bin) {
    double neighbours = 0.0;
    double near_neighbours = 0.0;
    for (const EchoesByRange::Sums& frame : echoes.Of(label, bin)) {
      neighbours += frame.neighbours;
      near_neighbours += frame.near_neighbours;
    }
    std::cout << " " << std::fixed << std::setprecision(1) << 100.0 * near_neighbours / neighbours;
  }
}

/// Where in the world the beam of a slot ended.
Vector3 TruePlace(const Simulator& simulator, const Frame& frame, std::size_t slot) {
  const Eigen::Vector3f measured_m(frame.x[slot], frame.y[slot], frame.z[slot]);
  const Vector3 true_m =
      static_cast<double>(frame.true_range_m[slot]) * measured_m.cast<double>().normalized();
  return simulator.WorldFromSensor(frame.stamp_ns + frame.time_ns[slot]) * true_m;
}

void CompareEchoes(const Options& options) {
  const ScenarioSpec spec = Prepared(options, SceneDetail::kAuto);
  const auto full = MakeSimulator(Prepared(options, SceneDetail::kFull), 2);
  const auto coarser = MakeSimulator(spec, 2);
  const MeanSurface surface(spec);
  double near_s_m = 0.0;
  const auto height_above = [&](const Frame& frame, std::size_t slot) {
    return surface.HeightAbove_m(TruePlace(*full, frame, slot), frame.label[slot], near_s_m);
  };
  EchoesByRange of_full(kBin_m, height_above);
  EchoesByRange of_coarser(kBin_m, height_above);
  Frame frame;
  for (std::uint32_t index = 0; index < options.num_frames; ++index) {
    near_s_m = spec.vehicle.start_s_m + options.step_m * index;
    full->Scan(index, frame);
    of_full.AddFrame(frame);
    coarser->Scan(index, frame);
    of_coarser.AddFrame(frame);
  }
  PrintTable(of_full, of_coarser, spec);
  PrintSurfaces(of_full, of_coarser, spec);
  for (const char* label : {"tree", "ground", "ballast"}) {
    std::cout << "\nneighbours on " << label
              << " at the same range, by range, in percent: in full detail";
    PrintNeighbours(of_full, spec, label);
    std::cout << "; as it is";
    PrintNeighbours(of_coarser, spec, label);
    std::cout << "\n";
  }
}

/// Prints the processor's time of frame 0 as it is, and without plants, as ratios to that in full
/// detail: the medians of turns in which all take part.
void CompareTimes(const Options& options) {
  ScenarioSpec bare = Prepared(options, SceneDetail::kAuto);
  bare.world.vegetation.trees_per_hectare = 0.0;
  bare.world.vegetation.grass = false;
  std::vector<std::unique_ptr<Simulator>> simulators;
  simulators.push_back(MakeSimulator(Prepared(options, SceneDetail::kFull), 1));
  simulators.push_back(MakeSimulator(Prepared(options, SceneDetail::kAuto), 1));
  simulators.push_back(MakeSimulator(bare, 1));
  std::vector<std::function<void()>> works;
  Frame frame;
  for (const auto& simulator : simulators) works.push_back(simulator->MakeRawTrace(0));
  for (const auto& simulator : simulators) {
    works.emplace_back([&frame, of = simulator.get()] { of->Scan(0, frame); });
  }
  for (const auto& work : works) work();
  WaitUntilIdle();
  std::vector<std::vector<double>> ratios(works.size());
  for (int turn = 0; turn < options.num_turns; ++turn) {
    std::vector<double> times_ms;
    for (const auto& work : works) times_ms.push_back(CpuTimeOf_ms(work));
    for (std::size_t i = 0; i < works.size(); ++i) ratios[i].push_back(times_ms[i] / times_ms[0]);
  }
  std::cout << "x raw trace in full detail: raw trace " << Median(ratios[1]) << ", without plants "
            << Median(ratios[2]) << "; frame in full detail " << Median(ratios[3]) << ", as it is "
            << Median(ratios[4]) << ", without plants " << Median(ratios[5]) << "\n";
}

}  // namespace

void AddDetail(ProgramOptions& app, ProgramCommand& command) {
  ProgramOptions detail =
      app.AddCommand("detail",
                     "Compare a scene that is coarser far away with full detail: the echoes of "
                     "plants, ground and track by range in percent, or with --turns the times");
  const auto options = std::make_shared<Options>();
  static const std::map<std::string, Fidelity> rungs = {{"plausibility", Fidelity::kPlausibility},
                                                        {"surface", Fidelity::kSurface},
                                                        {"footprint", Fidelity::kFootprint}};
  detail.AddOption("SCENARIO", options->scenario, "Scenario with one sensor").Required();
  detail
      .AddText(
          "--rung", [options](const std::string& name) { options->rung = rungs.at(name); },
          "surface or another")
      .Check(Named({"plausibility", "surface", "footprint"}));
  detail.AddOption("--frames", options->num_frames, "Frames, each at another place");
  detail.AddOption("--step", options->step_m, "Metres between them");
  detail.AddOption("--turns", options->num_turns, "Turns in which times are measured");
  detail.WhenParsed([options, &command] {
    command = [options](const std::string&) {
      if (options->num_turns > 0) {
        CompareTimes(*options);
      } else {
        CompareEchoes(*options);
      }
      return kExitSuccess;
    };
  });
}

}  // namespace railcast
