#include "analysis/compare/comparison.h"

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>

#include "analysis/report/cell_text.h"
#include "analysis/stats/sums.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/points/point_alignment.h"

namespace railcast {
namespace {

std::int64_t Apart_ns(const RecordedFrame& a, const RecordedFrame& b) {
  return std::abs(a.frame.stamp_ns - b.frame.stamp_ns);
}

constexpr std::size_t kMaxPairsKept = 2000;

std::vector<double> ValuesOf(const std::optional<CloudDistances>& distances,
                             const std::vector<double>& distances_m) {
  if (!distances) {
    return std::vector<double>(7 + 3 * distances_m.size(),
                               std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<double> values = {distances->chamfer_m,    distances->chamfer_squares_m2,
                                distances->a_to_b_m,     distances->b_to_a_m,
                                distances->hausdorff_m,  distances->hausdorff95_m,
                                distances->density_aware};
  for (const WithinDistance& within : distances->within) {
    for (const double share : {within.precision, within.recall, within.f_score}) {
      values.push_back(100.0 * share);
    }
  }
  return values;
}

/// Lays B's cloud on A's.
LaidCloud LayOnOther(const ComparedCloud& a, const std::string& name_b, ComparedCloud& b) {
  const ThinnedCloud onto(a.points_m), cloud(b.points_m);
  const std::size_t num_points = std::min(onto.size(), cloud.size());
  if (num_points < kFewestLaid) {
    throw InputError(name_b + ": must have, like its partner, at least " + NumberText(kFewestLaid) +
                     " points in cells of 0.4 m to be registered" + Got(num_points));
  }
  const auto laid = LayOn(onto, cloud, Transform::Identity());
  if (!laid) throw InputError(name_b + ": must match its partner (got no convergence)");
  const Eigen::Isometry3f a_from_b = laid->onto_from_cloud.cast<float>();
  for (std::size_t i = 0; i < b.size(); ++i) {
    b.points_m[i] = a_from_b * b.points_m[i];
    if (!b.range_m.empty()) b.range_m[i] = b.points_m[i].norm();
  }
  return *laid;
}

}  // namespace

void FramePairs::Side::Fill() {
  while (frames.size() < 2) {
    const std::optional<Recording::FrameReader> read = recording.Next();
    if (!read) return;
    frames.push_back((*read)());
  }
}

RecordedFrame FramePairs::Side::Take() {
  RecordedFrame frame = std::move(frames.front());
  frames.pop_front();
  return frame;
}

void FramePairs::Side::Drop() {
  frames.pop_front();
  ++num_dropped;
}

void FramePairs::Side::DropRest() {
  num_dropped += frames.size();
  frames.clear();
  // The remaining frames are counted without being decoded.
  while (recording.Next()) ++num_dropped;
}

std::optional<std::int64_t> FramePairs::Side::Spacing_ns() const {
  if (frames.size() < 2) return std::nullopt;
  const std::int64_t spacing_ns = frames[1].frame.stamp_ns - frames[0].frame.stamp_ns;
  return spacing_ns > 0 ? std::optional(spacing_ns) : std::nullopt;
}

FramePairs::FramePairs(Recording& a, Recording& b, std::optional<Pairing> pairing)
    : a_{a, {}, 0}, b_{b, {}, 0} {
  a_.Fill();
  b_.Fill();
  const bool has_stamps = a_.Spacing_ns() && b_.Spacing_ns();
  pairing_ = pairing.value_or(has_stamps ? Pairing::kStamp : Pairing::kIndex);
}

std::optional<FramePair> FramePairs::Next() {
  a_.Fill();
  b_.Fill();
  std::optional<FramePair> pair = pairing_ == Pairing::kIndex ? NextByIndex() : NextByStamp();
  if (pair) {
    pair->num_frames_a = ++num_pairs_ + a_.num_dropped;
  } else {
    a_.DropRest();
    b_.DropRest();
  }
  return pair;
}

std::optional<FramePair> FramePairs::NextByIndex() {
  if (a_.frames.empty() || b_.frames.empty()) return std::nullopt;
  FramePair pair;
  pair.a = a_.Take();
  pair.b = b_.Take();
  return pair;
}

std::optional<FramePair> FramePairs::NextByStamp() {
  while (!a_.frames.empty() && !b_.frames.empty()) {
    // The last frame of A has no successor: it is assumed to last as long as the one before.
    if (const auto spacing_ns = a_.Spacing_ns()) tolerance_ns_ = *spacing_ns / 2;
    const RecordedFrame& a = a_.frames.front();
    const RecordedFrame& b = b_.frames.front();
    const bool next_b_is_nearer =
        b_.frames.size() > 1 && Apart_ns(a, b_.frames[1]) < Apart_ns(a, b);
    const bool next_a_is_nearer =
        a_.frames.size() > 1 && Apart_ns(a_.frames[1], b) < Apart_ns(a, b);
    if (Apart_ns(a, b) <= tolerance_ns_ && !next_a_is_nearer && !next_b_is_nearer) {
      return NextByIndex();
    }
    // The earlier frame has no partner.
    Side& earlier = b.frame.stamp_ns < a.frame.stamp_ns ? b_ : a_;
    earlier.Drop();
    a_.Fill();
    b_.Fill();
  }
  return std::nullopt;
}

std::string PairingName(Pairing pairing) {
  return pairing == Pairing::kIndex ? "index" : "stamp";
}

std::vector<TableColumn> PairMetrics(const std::vector<double>& distances_m, bool registers) {
  std::string text =
      "chamfer_m: Chamfer distance; chamfer_squares_m2: Chamfer distance of squares; a_to_b_m: "
      "Mean distance of A from B; b_to_a_m: Mean distance of B from A; hausdorff_m: Hausdorff "
      "distance; hausdorff95_m: Hausdorff distance of 95 %; density_aware_chamfer: Density-aware "
      "Chamfer distance";
  for (const double distance_m : distances_m) {
    const std::string distance = NumberText(distance_m);
    const std::string rest = Joined({"_percent_", distance, "_m [%]: "});
    const std::string within = Joined({" within ", distance, " m"});
    text += Joined({"; precision", rest, "Precision", within, "; recall", rest, "Recall", within,
                    "; f_score", rest, "F-score", within});
  }
  text +=
      "; jsd_range [bit]: Divergence of ranges; jsd_intensity [bit]: Divergence of intensities; "
      "jsd_ring [bit]: Divergence of rings; jsd_velocity [bit]: Divergence of velocities; "
      "jsd_occupancy [bit]: Divergence of bird's-eye occupancy; mape_points_percent: MAPE of "
      "points; mape_intensity_percent: MAPE of mean intensity; velocity_error_mps: Mean absolute "
      "error of mean velocity";
  if (registers) {
    text +=
        "; registration_residual_m: Residual of the registration; registration_shift_m: Shift by "
        "the registration; registration_turn_deg: Turn by the registration";
  }
  return ColumnsOf(text);
}

double Comparison::Summary::Mean() const {
  return moments.num() == 0 ? std::numeric_limits<double>::quiet_NaN()
                            : sum / static_cast<double>(moments.num());
}

Comparison::Comparison(std::vector<double> distances_m, bool registers)
    : distances_m_(std::move(distances_m)),
      registers_(registers),
      metrics_(PairMetrics(distances_m_, registers)),
      summaries_(metrics_.size()) {}

Comparison::Part Comparison::Compare(const RecordedFrame& a, const RecordedFrame& b) const {
  const ComparedCloud cloud_a = CloudOf(a);
  ComparedCloud cloud_b = CloudOf(b);
  const auto laid = registers_ ? std::optional(LayOnOther(cloud_a, b.name, cloud_b)) : std::nullopt;
  Part part{{a.frame.index, b.frame.index, a.frame.stamp_ns, b.frame.stamp_ns, cloud_a.size(),
             cloud_b.size(), ValuesOf(DistancesOf(cloud_a, cloud_b, distances_m_), distances_m_)},
            HistogramsOf(cloud_a),
            HistogramsOf(cloud_b),
            BinnedByRange(cloud_a),
            BinnedByRange(cloud_b)};
  std::vector<double>& values = part.figures.values;
  std::ranges::copy(
      DistributionFigures(part.histograms_a, part.histograms_b, ErrorsOf(part.bins_a, part.bins_b)),
      std::back_inserter(values));
  if (laid) {
    const Eigen::AngleAxisd turn(laid->onto_from_cloud.linear());
    values.insert(values.end(), {laid->residual_m, laid->onto_from_cloud.translation().norm(),
                                 DegFromRad(turn.angle())});
  }
  return part;
}

void Comparison::Add(const Part& part) {
  for (std::size_t i = 0; i < summaries_.size(); ++i) {
    const double value = part.figures.values[i];
    if (std::isnan(value)) continue;
    Summary& summary = summaries_[i];
    summary.moments.Add(value);
    summary.sum += value;
    summary.least = std::min(summary.least, value);
    summary.largest = std::max(summary.largest, value);
  }
  AddTo(histograms_a_, part.histograms_a);
  AddTo(histograms_b_, part.histograms_b);
  bins_.Add(part.bins_a, part.bins_b);
  if (num_pairs_++ % stride_ != 0) return;
  pairs_.push_back(part.figures);
  if (pairs_.size() < kMaxPairsKept) return;
  // Drop every other pair, so that memory does not grow with the length of the recordings.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) std::swap(pairs_[kept++], pairs_[i]);
  pairs_.resize(kept);
  stride_ *= 2;
}

void CompareAll(FramePairs& pairs,
                Comparison& comparison,
                PatchPairs& patches,
                const ComparisonProgress& on_progress) {
  using SharedPair = std::shared_ptr<FramePair>;
  struct Compared {
    Comparison::Part part;
    PatchPairs::Pair patches;
    std::uint64_t num_frames_a{};
  };
  // Enough pairs in flight to keep all cores busy; more would only take memory.
  const auto max_pairs = 2 * static_cast<std::size_t>(tbb::info::default_concurrency());
  const auto read = tbb::make_filter<void, SharedPair>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> SharedPair {
        std::optional<FramePair> pair = pairs.Next();
        if (pair) return std::make_shared<FramePair>(std::move(*pair));
        control.stop();
        return {};
      });
  const auto compare = tbb::make_filter<SharedPair, std::shared_ptr<Compared>>(
      tbb::filter_mode::parallel, [&](const SharedPair& pair) {
        return std::make_shared<Compared>(Compared{comparison.Compare(pair->a, pair->b),
                                                   {PatchesOf(pair->a), PatchesOf(pair->b)},
                                                   pair->num_frames_a});
      });
  const auto add = tbb::make_filter<std::shared_ptr<Compared>, void>(
      tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<Compared>& compared) {
        comparison.Add(compared->part);
        patches.Add(std::move(compared->patches));
        on_progress(compared->num_frames_a);
      });
  tbb::parallel_pipeline(max_pairs, read & compare & add);
}

}  // namespace railcast
