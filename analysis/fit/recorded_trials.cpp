#include "analysis/fit/recorded_trials.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>

#include "analysis/estimate/robust.h"
#include "analysis/fit/label_trials.h"
#include "analysis/fit/plane_trials.h"
#include "analysis/fit/trial_sample.h"
#include "analysis/fit/truth_trials.h"
#include "core/base/error.h"
#include "core/base/shown_text.h"
#include "core/io/recording/scan_table.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

/// What is settled before trials are taken: from the scenario, or from the first frames.
struct Setting {
  SensorFacts facts;
  std::optional<ScanTable> scan;  // Of all frames if it is fixed; else of the first.
  bool is_fixed_scan{};
  PlaneScene scene;
  bool has_planes{};
};

SensorFacts FactsOf(const RecordingInfo& info) {
  SensorFacts facts;
  if (!info.scenario) return facts;
  const LidarSpec& lidar = info.scenario->lidar;
  facts.range_min_m = lidar.range_min_m;
  facts.range_max_m = lidar.range_max_m;
  facts.beam = lidar.beam;
  return facts;
}

std::vector<FitSurface> SurfacesOf(const RecordingInfo& info) {
  std::vector<FitSurface> surfaces;
  for (const std::string& name : info.materials) surfaces.push_back(MakeLambertSurface(name));
  if (!info.scenario) return surfaces;
  const ScenarioSpec& scenario = *info.scenario;
  const double wetness = EffectsOf(scenario).surface_condition ? scenario.weather.wetness : 0.0;
  for (FitSurface& surface : surfaces) {
    for (const Material& material : scenario.materials) {
      if (material.name != surface.name) continue;
      surface = MakeShapedSurface(material, scenario.lidar.beam.wavelength_nm, wetness);
    }
  }
  return surfaces;
}

// Labels for surfaces where there are no materials.
std::string LabelName(const LabelTable& labels, std::uint32_t id) {
  const Label* const label = labels.Find(id);
  return label != nullptr ? label->name : "label " + std::to_string(id);
}

/// Points of the first frames: directions, planes and the shape of the noise rest on them.
class FirstFrames {
 public:
  void Add(const RecordedFrame& recorded) {
    const Frame& frame = recorded.frame;
    if (recorded.is_grid && !scan_) scan_ = MakeScanTable(frame);
    if (!frame_) frame_ = recorded;
    for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
      if (std::isnan(frame.x[slot])) continue;
      points_m_.push_back(
          Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>());
    }
  }
  [[nodiscard]] const std::vector<Vector3>& points_m() const { return points_m_; }
  [[nodiscard]] const std::optional<ScanTable>& scan() const { return scan_; }
  [[nodiscard]] const std::optional<RecordedFrame>& frame() const { return frame_; }

 private:
  std::vector<Vector3> points_m_;
  std::optional<ScanTable> scan_;
  std::optional<RecordedFrame> frame_;
};

FirstFrames ReadFirstFrames(const std::filesystem::path& source) {
  constexpr int kNumFirst = 5;
  FirstFrames first;
  const auto recording = OpenRecording(source);
  for (int i = 0; i < kNumFirst; ++i) {
    const auto reader = recording->Next();
    if (!reader) break;
    first.Add((*reader)());
  }
  return first;
}

/// What one frame gives.
struct FrameTrials {
  std::vector<std::pair<Trial, std::size_t>> trials;  ///< With their slots.
  std::vector<double> lateral_m;                      ///< Of returned ones, above their row.
  std::uint64_t num_hidden{};
  bool knows_losses{};
};

// How far points lie above the line of their row: nothing, if noise is along the beam.
double Above_m(const Frame& frame, std::size_t slot, const ScanTable& scan) {
  const double elevation_rad =
      std::asin(static_cast<double>(frame.z[slot]) / static_cast<double>(frame.range_m[slot]));
  return static_cast<double>(frame.range_m[slot]) *
         (elevation_rad - scan.elevation_rad[slot / frame.width()]);
}

FrameTrials TakeTrials(const RecordedFrame& recorded, const Setting& setting) {
  FrameTrials taken;
  const Frame& frame = recorded.frame;
  // Turns of a capture begin anywhere: each has directions of its own.
  std::optional<ScanTable> own_scan;
  SensorFacts facts = setting.facts;
  if (!setting.is_fixed_scan) {
    if (recorded.is_grid) own_scan = MakeScanTable(frame);
    facts.scan = own_scan ? &*own_scan : nullptr;
  }
  const bool has_scan = facts.scan != nullptr && facts.scan->rows == frame.rows;
  // Files of points only may know the truth of what came back, and of nothing else.
  taken.knows_losses = setting.has_planes ? has_scan : recorded.is_grid && recorded.Has("outcome");
  const auto take = [&](const Trial& trial, std::size_t slot) {
    taken.trials.emplace_back(trial, slot);
    if (trial.answer == Answer::kReturned && has_scan) {
      taken.lateral_m.push_back(Above_m(frame, slot, *facts.scan));
    }
  };
  if (setting.has_planes) {
    ForEachPlaneTrial(recorded, setting.scene, facts, take);
    return taken;
  }
  if (!HasTruth(recorded)) {
    if (!recorded.Has("label")) {
      throw InputError(recorded.name +
                       ": must have truth fields or labels, or planes given with --planes (got "
                       "neither)");
    }
    taken.knows_losses = false;
    ForEachLabelTrial(recorded, facts, take);
    return taken;
  }
  ForEachTruthTrial(recorded, facts, take);
  if (recorded.Has("outcome")) {
    taken.num_hidden = static_cast<std::uint64_t>(
        std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kClutter));
  }
  return taken;
}

/// Sums frames up in their order.
class TrialSum {
 public:
  void Add(const FrameTrials& taken) {
    constexpr std::size_t kMaxLateral = 200'000;
    for (const auto& [trial, slot] : taken.trials) {
      sample_.Add(trial, (num_frames_ << 32U) + slot);
      if (trial.answer == Answer::kReturned && along_m_.size() < kMaxLateral) {
        along_m_.push_back(static_cast<double>(trial.residual_m));
      }
    }
    if (lateral_m_.size() < kMaxLateral) {
      lateral_m_.insert(lateral_m_.end(), taken.lateral_m.begin(), taken.lateral_m.end());
    }
    num_hidden_ += taken.num_hidden;
    knows_losses_ = knows_losses_ && taken.knows_losses;
    ++num_frames_;
  }
  [[nodiscard]] std::uint64_t num_frames() const { return num_frames_; }

  void Give(RecordedTrials& result) {
    result.trials = sample_.trials();
    result.num_frames = num_frames_;
    result.num_seen = sample_.num_seen();
    result.num_hidden = num_hidden_;
    result.knows_losses = knows_losses_ && num_frames_ > 0;
    result.lateral_ratio = RobustScale(lateral_m_).value / RobustScale(along_m_).value;
  }

 private:
  TrialSample sample_;
  std::vector<double> along_m_;
  std::vector<double> lateral_m_;
  std::uint64_t num_frames_{};
  std::uint64_t num_hidden_{};
  bool knows_losses_ = true;
};

void ReadAll(Recording& recording,
             const Setting& setting,
             const TrialProgress& on_progress,
             TrialSum& sum) {
  using Reader = Recording::FrameReader;
  // Frames in work at a time.
  const std::size_t num_at_once =
      std::size_t{2} * std::max(1U, std::thread::hardware_concurrency());
  const auto next = tbb::make_filter<void, Reader>(tbb::filter_mode::serial_in_order,
                                                   [&](tbb::flow_control& control) -> Reader {
                                                     auto reader = recording.Next();
                                                     if (reader) return *std::move(reader);
                                                     control.stop();
                                                     return {};
                                                   });
  const auto take = tbb::make_filter<Reader, FrameTrials>(
      tbb::filter_mode::parallel,
      [&](const Reader& reader) { return TakeTrials(reader(), setting); });
  const auto add = tbb::make_filter<FrameTrials, void>(tbb::filter_mode::serial_in_order,
                                                       [&](const FrameTrials& taken) {
                                                         sum.Add(taken);
                                                         on_progress(sum.num_frames());
                                                       });
  tbb::parallel_pipeline(num_at_once, next & take & add);
}

// Planes of one surface share its index.
void AddPlaneSurfaces(RecordedTrials& result, PlaneScene& scene) {
  for (const KnownPlane& plane : result.planes) {
    auto place = std::find_if(result.surfaces.begin(), result.surfaces.end(),
                              [&](const FitSurface& s) { return s.name == plane.surface(); });
    if (place == result.surfaces.end()) {
      result.surfaces.push_back(MakeLambertSurface(plane.surface()));
      place = std::prev(result.surfaces.end());
    }
    scene.surfaces.push_back(static_cast<std::uint16_t>(place - result.surfaces.begin()));
  }
}

// Whether points of the first frame leave their beam sideways as much as along it.
bool IsIsotropic(const RecordedFrame& recorded, Setting setting) {
  if (!setting.scan) return false;
  setting.facts.scan = &*setting.scan;
  const FrameTrials taken = TakeTrials(recorded, setting);
  std::vector<double> along_m;
  for (const auto& [trial, slot] : taken.trials) {
    if (trial.answer == Answer::kReturned) along_m.push_back(static_cast<double>(trial.residual_m));
  }
  std::vector<double> lateral_m = taken.lateral_m;
  return RobustScale(lateral_m).value > kIsotropicRatio * RobustScale(along_m).value;
}

Setting Settle(const std::filesystem::path& source,
               const RecordingInfo& info,
               RecordedTrials& result) {
  Setting setting;
  setting.facts = FactsOf(info);
  setting.has_planes = !result.planes.empty();
  const FirstFrames first = ReadFirstFrames(source);
  setting.is_fixed_scan = info.scenario.has_value();
  setting.scan = setting.is_fixed_scan ? MakeScanTable(BuildScanPattern(info.scenario->lidar.scan))
                                       : first.scan();
  if (!setting.has_planes) return setting;
  result.num_plane_points = RefinePlanes(first.points_m(), result.planes);
  AddPlaneSurfaces(result, setting.scene);
  setting.scene.planes = result.planes;
  setting.scene.is_isotropic = first.frame() && IsIsotropic(*first.frame(), setting);
  return setting;
}

}  // namespace

RecordedTrials ReadTrials(const std::vector<std::filesystem::path>& sources,
                          std::vector<KnownPlane> planes,
                          const TrialProgress& on_progress) {
  RecordedTrials result;
  result.planes = std::move(planes);
  TrialSum sum;
  std::vector<std::string> materials;
  LabelTable labels;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto recording = OpenRecording(sources[i]);
    const RecordingInfo& info = recording->info();
    if (i == 0) {
      materials = info.materials;
      labels = info.labels;
      result.surfaces = SurfacesOf(info);
    } else if (info.materials != materials) {
      throw InputError(ShownPath(info.source) + ": must have the same materials as " +
                       ShownPath(sources[0]));
    }
    Setting setting = Settle(sources[i], info, result);
    if (setting.scan) setting.facts.scan = &*setting.scan;
    ReadAll(*recording, setting, on_progress, sum);
  }
  sum.Give(result);
  std::uint16_t last = 0;
  for (const Trial& trial : result.trials) last = std::max(last, trial.surface);
  while (result.surfaces.size() <= last) {
    result.surfaces.push_back(
        MakeLambertSurface(LabelName(labels, static_cast<std::uint32_t>(result.surfaces.size()))));
  }
  return result;
}

}  // namespace railcast
