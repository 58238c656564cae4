#include "analysis/fit/recorded_trials.h"

#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/stats/holes.h"
#include "analysis/stats/plane_patches.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

// Pieces overlap where the frame has few flat places. A point belongs to the first of its pieces,
// so that none is counted twice and pieces are independent, as the intervals take them to be.
void TakeNoise(const Frame& frame,
               const FlatPiece& piece,
               std::vector<bool>& is_taken,
               RecordedTrials& trials) {
  const auto num = static_cast<double>(piece.slots.size());
  const double grow = std::sqrt(num / (num - 3.0));
  for (const std::size_t slot : piece.slots) {
    if (is_taken[slot]) continue;
    is_taken[slot] = true;
    const Vector3 direction =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>().normalized();
    const double cosine = piece.normal.dot(direction);
    const double range_m = piece.normal.dot(piece.middle_m) / cosine;
    const double measured_m = static_cast<double>(frame.range_m[slot]);
    trials.noise.push_back(
        {.range_m = static_cast<float>(range_m),
         .slant_m_per_rad = static_cast<float>(range_m * std::sqrt(1.0 / (cosine * cosine) - 1.0)),
         .residual_m = static_cast<float>(grow * (measured_m - range_m)),
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
}

RecordedTrials TakeTrials(const RecordedFrame& recorded) {
  RecordedTrials trials;
  trials.num_frames = 1;
  std::optional<ScanTable> scan;
  if (recorded.is_grid) {
    scan = MakeScanTable(recorded.frame);
    TakeLosses(recorded, trials);
  }
  std::vector<bool> is_taken(recorded.frame.num_slots(), false);
  for (const FlatPiece& piece : FindFlatPieces(recorded, scan ? &*scan : nullptr)) {
    TakeNoise(recorded.frame, piece, is_taken, trials);
  }
  return trials;
}

RecordedTrials ReadTrials(const std::vector<std::filesystem::path>& sources,
                          const std::function<void(std::uint64_t num_frames)>& on_progress) {
  using Reader = Recording::FrameReader;
  const std::size_t num_at_once =
      std::size_t{2} * std::max(1U, std::thread::hardware_concurrency());
  constexpr std::size_t kMaxPoints = 1'000'000;
  TrialSum sum(kMaxPoints);
  for (const std::filesystem::path& source : sources) {
    const auto recording = OpenRecording(source);
    const auto next = tbb::make_filter<void, Reader>(tbb::filter_mode::serial_in_order,
                                                     [&](tbb::flow_control& control) -> Reader {
                                                       auto reader = recording->Next();
                                                       if (reader) return *std::move(reader);
                                                       control.stop();
                                                       return {};
                                                     });
    const auto take = tbb::make_filter<Reader, RecordedTrials>(
        tbb::filter_mode::parallel, [](const Reader& reader) { return TakeTrials(reader()); });
    const auto add = tbb::make_filter<RecordedTrials, void>(tbb::filter_mode::serial_in_order,
                                                            [&](RecordedTrials frame) {
                                                              sum.Add(std::move(frame));
                                                              on_progress(sum.sum().num_frames);
                                                            });
    tbb::parallel_pipeline(num_at_once, next & take & add);
  }
  return sum.sum();
}

}  // namespace railcast
