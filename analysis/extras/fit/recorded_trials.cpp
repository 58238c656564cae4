#include "analysis/extras/fit/recorded_trials.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>

#include "analysis/stats/holes.h"
#include "analysis/stats/neighbour_noise.h"
#include "analysis/stats/plane_patches.h"
#include "analysis/stats/range_noise.h"
#include "core/io/recording/column_finder.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/recording/plausibility.h"
#include "core/io/recording/range_step.h"

namespace railcast {
namespace {

/// The frame after the one whose trials are taken, in which its firings are looked for.
struct NextFrame {
  const Frame& frame;
  ColumnFinder columns;
  double reach_rad{};  ///< Half a column.
};

std::optional<NextFrame> FindNext(const RecordedFrame& recorded, const RecordedFrame* next) {
  if (next == nullptr || next->frame.rows != recorded.frame.rows ||
      next->frame.returns != recorded.frame.returns) {
    return std::nullopt;
  }
  if (recorded.has_pose && next->has_pose && HasMoved(recorded, *next)) return std::nullopt;
  const auto scan = MakeScanTable(next->frame);
  if (!scan) return std::nullopt;
  return NextFrame{next->frame, ColumnFinder(*scan), 0.5 * scan->column_step_rad};
}

/// Measured less expected range of a point on a piece's plane, and the expected one.
struct OnPiece {
  OnPiece(const Frame& frame, std::size_t slot, const FlatPiece& piece)
      : direction(Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot])
                      .cast<double>()
                      .normalized()),
        cosine(piece.normal.dot(direction)),
        range_m(piece.normal.dot(piece.middle_m) / cosine),
        residual_m(static_cast<double>(frame.range_m[slot]) - range_m) {}

  Vector3 direction;
  double cosine;
  double range_m;
  double residual_m;
};

double LaterResidual_m(const FlatPiece& piece,
                       std::size_t slot,
                       const Frame& frame,
                       const ScanTable& scan,
                       const NextFrame& next) {
  const std::size_t row = slot / frame.width();
  const std::size_t in_row = slot % frame.width();
  const auto found = next.columns.Nearest(scan.column_azimuth_rad[in_row / frame.returns]);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!found || !(std::abs(found->offset_rad) <= next.reach_rad)) return kNone;
  const std::size_t later =
      row * next.frame.width() + found->column * frame.returns + in_row % frame.returns;
  return OnPiece(next.frame, later, piece).residual_m;
}

float Bend_m(const RecordedFrame& recorded, std::size_t slot) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const Frame& frame = recorded.frame;
  // Only of first returns are the neighbours' first returns the same surface.
  if (!recorded.is_grid || slot % frame.returns != 0) return kNone;
  const auto bend_m =
      SecondDifference_m(recorded, slot / frame.width(), slot % frame.width() / frame.returns);
  return bend_m ? static_cast<float>(*bend_m) : kNone;
}

// Pieces overlap where the frame has few flat places. A point belongs to the first of its pieces,
// so that none is counted twice and pieces are independent, as the intervals take them to be.
template <typename Change>
void TakeNoise(const RecordedFrame& recorded,
               const FlatPiece& piece,
               const Change& change_m,
               std::vector<bool>& is_taken,
               RecordedTrials& trials) {
  const Frame& frame = recorded.frame;
  const auto num = static_cast<double>(piece.slots.size());
  const double grow = std::sqrt(num / (num - 3.0));
  for (const std::size_t slot : piece.slots) {
    if (is_taken[slot]) continue;
    is_taken[slot] = true;
    const OnPiece at(frame, slot, piece);
    const double tangent = std::sqrt(1.0 / (at.cosine * at.cosine) - 1.0);
    trials.noise.push_back({.range_m = static_cast<float>(at.range_m),
                            .slant_m_per_rad = static_cast<float>(at.range_m * tangent),
                            .residual_m = static_cast<float>(grow * at.residual_m),
                            .change_m = change_m(slot, at.residual_m),
                            .bend_m = Bend_m(recorded, slot),
                            .intensity = frame.intensity[slot],
                            .piece = trials.num_pieces,
                            .channel = frame.ring[slot]});
  }
  ++trials.num_pieces;
}

void TakeLosses(const RecordedFrame& recorded, RecordedTrials& trials) {
  const Frame& frame = recorded.frame;
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 1; column + 1 < frame.columns; ++column) {
      const std::size_t slot = row * frame.width() + column * frame.returns;
      if (IsOnOwnVehicle(recorded, slot)) continue;
      const auto range_m = RangeBetweenNeighbours_m(frame, row, column);
      if (!range_m) continue;
      LossBin& bin = trials.losses[static_cast<int>(*range_m)];
      ++bin.num;
      bin.num_lost += std::isfinite(frame.range_m[slot]) ? 0 : 1;
      bin.range_sum_m += *range_m;
    }
  }
}

}  // namespace

void TrialSum::Add(RecordedTrials frame) {
  const std::uint64_t index = sum_.num_frames;
  if (index % stride_ == 0) {
    begins_.emplace_back(index, sum_.noise.size());
  } else {
    frame.noise.clear();
  }
  sum_.Add(frame);
  while (sum_.noise.size() > max_points_ && begins_.size() > 1) DropEverySecondFrame();
}

void TrialSum::DropEverySecondFrame() {
  stride_ *= 2;
  std::vector<NoiseTrial> kept;
  std::vector<std::pair<std::uint64_t, std::size_t>> begins;
  for (std::size_t i = 0; i < begins_.size(); ++i) {
    if (begins_[i].first % stride_ != 0) continue;
    const std::size_t end = i + 1 < begins_.size() ? begins_[i + 1].second : sum_.noise.size();
    begins.emplace_back(begins_[i].first, kept.size());
    kept.insert(kept.end(), sum_.noise.begin() + static_cast<std::ptrdiff_t>(begins_[i].second),
                sum_.noise.begin() + static_cast<std::ptrdiff_t>(end));
  }
  sum_.noise = std::move(kept);
  begins_ = std::move(begins);
}

void RecordedTrials::Add(const RecordedTrials& frame) {
  for (NoiseTrial trial : frame.noise) {
    trial.piece += num_pieces;
    noise.push_back(trial);
  }
  for (const auto& [metre, bin] : frame.losses) {
    LossBin& sum = losses[metre];
    sum.num += bin.num;
    sum.num_lost += bin.num_lost;
    sum.range_sum_m += bin.range_sum_m;
  }
  num_frames += frame.num_frames;
  num_pieces += frame.num_pieces;
  step_m = std::max(step_m, frame.step_m);
}

RecordedTrials TakeTrials(const RecordedFrame& recorded, const RecordedFrame* next) {
  NeedRanges(recorded);
  RecordedTrials trials;
  trials.num_frames = 1;
  trials.step_m = RangeStep_m(recorded);
  std::optional<ScanTable> scan;
  if (recorded.is_grid) {
    scan = MakeScanTable(recorded.frame);
    TakeLosses(recorded, trials);
  }
  const auto next_frame = scan ? FindNext(recorded, next) : std::nullopt;
  std::vector<bool> is_taken(recorded.frame.num_slots(), false);
  for (const FlatPiece& piece : FindFlatPieces(recorded, scan ? &*scan : nullptr)) {
    const auto change_m = [&](std::size_t slot, double residual_m) {
      if (!next_frame) return std::numeric_limits<float>::quiet_NaN();
      const double later_m = LaterResidual_m(piece, slot, recorded.frame, *scan, *next_frame);
      return static_cast<float>((later_m - residual_m) / std::numbers::sqrt2);
    };
    TakeNoise(recorded, piece, change_m, is_taken, trials);
  }
  return trials;
}

RecordedTrials ReadTrials(const std::vector<std::filesystem::path>& sources,
                          const std::function<void(std::uint64_t num_frames)>& on_progress) {
  using Reader = Recording::FrameReader;
  using FramePointer = std::shared_ptr<const RecordedFrame>;
  const std::size_t num_at_once =
      std::size_t{2} * std::max(1U, std::thread::hardware_concurrency());
  constexpr std::size_t kMaxPoints = 1'000'000;
  TrialSum sum(kMaxPoints);
  for (const std::filesystem::path& source : sources) {
    const auto recording = OpenRecording(source);
    FramePointer last;
    const auto next = tbb::make_filter<void, Reader>(tbb::filter_mode::serial_in_order,
                                                     [&](tbb::flow_control& control) -> Reader {
                                                       auto reader = recording->Next();
                                                       if (reader) return *std::move(reader);
                                                       control.stop();
                                                       return {};
                                                     });
    const auto read = tbb::make_filter<Reader, FramePointer>(
        tbb::filter_mode::parallel,
        [](const Reader& reader) { return std::make_shared<const RecordedFrame>(reader()); });
    const auto pair = tbb::make_filter<FramePointer, std::pair<FramePointer, FramePointer>>(
        tbb::filter_mode::serial_in_order,
        [&](const FramePointer& frame) { return std::pair(std::exchange(last, frame), frame); });
    const auto take = tbb::make_filter<std::pair<FramePointer, FramePointer>, RecordedTrials>(
        tbb::filter_mode::parallel, [](const std::pair<FramePointer, FramePointer>& frames) {
          return frames.first ? TakeTrials(*frames.first, frames.second.get()) : RecordedTrials{};
        });
    const auto add_trials = [&](RecordedTrials frame) {
      if (frame.num_frames == 0) return;
      sum.Add(std::move(frame));
      on_progress(sum.sum().num_frames);
    };
    const auto add =
        tbb::make_filter<RecordedTrials, void>(tbb::filter_mode::serial_in_order, add_trials);
    tbb::parallel_pipeline(num_at_once, next & read & pair & take & add);
    if (last) add_trials(TakeTrials(*last));
  }
  return sum.sum();
}

}  // namespace railcast
