#include "analysis/stats/statistics.h"

#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>

#include <optional>

#include "analysis/stats/plane_patches.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

using Reader = Recording::FrameReader;

/// Two consecutive frames. Pairs do not overlap, so that the samples of temporal noise are
/// independent.
struct PairOfReaders {
  Reader first;
  std::optional<Reader> second;
};

// Scan table of a railcast sequence, from its scenario: exact, and the same for all frames.
std::optional<ScanTable> FixedScanTable(const RecordingInfo& info) {
  if (!info.scenario) return std::nullopt;
  return MakeScanTable(BuildScanPattern(info.scenario->lidar.scan));
}

std::optional<ScanTable> ScanTableOf(const RecordedFrame& recorded,
                                     const std::optional<ScanTable>& fixed) {
  if (!recorded.is_grid) return std::nullopt;
  const bool fits =
      fixed && fixed->rows == recorded.frame.rows && fixed->columns == recorded.frame.columns;
  return fits ? fixed : MakeScanTable(recorded.frame);
}

const ScanTable* PointerTo(const std::optional<ScanTable>& table) {
  return table ? &*table : nullptr;
}

Statistics MeasurePair(const PairOfReaders& readers,
                       const std::optional<ScanTable>& fixed,
                       const FrameTrack* track) {
  Statistics statistics;
  const RecordedFrame first = readers.first();
  const auto first_scan = ScanTableOf(first, fixed);
  statistics.Add(first, PointerTo(first_scan));
  if (track != nullptr) statistics.gauge.Add(first, *track);
  if (!readers.second) return statistics;
  const RecordedFrame second = (*readers.second)();
  const auto second_scan = ScanTableOf(second, fixed);
  statistics.Add(second, PointerTo(second_scan));
  if (track != nullptr) statistics.gauge.Add(second, *track);
  if (first.why_no_ranges.empty() && second.why_no_ranges.empty()) {
    statistics.temporal_noise.Add(first, second, PointerTo(first_scan), PointerTo(second_scan));
  }
  return statistics;
}

}  // namespace

void Statistics::Add(const RecordedFrame& recorded, const ScanTable* scan) {
  if (!recorded.why_no_ranges.empty()) {
    // What needs to know where the sensor was is left out, as a remark says.
    coverage.Add(recorded, nullptr);
    classes.Add(recorded);
    return;
  }
  const std::vector<PlanePatch> patches = FindPlanePatches(recorded, scan);
  dropout.Add(recorded);
  holes.Add(recorded);
  density.Add(recorded, scan);
  noise.Add(recorded, patches);
  neighbour_noise.Add(recorded);
  intensity.Add(recorded, patches);
  coverage.Add(recorded, scan);
  classes.Add(recorded);
  objects.Add(recorded);
  difficulty.Add(recorded, scan);
  velocity.Add(recorded);
}

void Statistics::ForgetRings() {
  dropout.ForgetRings();
  holes.ForgetRings();
  coverage.ForgetRings();
}

Statistics MeasureStatistics(Recording& recording,
                             const StatisticsProgress& on_progress,
                             const FrameTrack* track) {
  const std::optional<ScanTable> fixed = FixedScanTable(recording.info());
  Statistics all;
  // Enough pairs in flight to keep all cores busy; more would only take memory.
  const auto max_pairs =
      std::size_t{2} * static_cast<std::size_t>(tbb::info::default_concurrency());
  const auto read = tbb::make_filter<void, PairOfReaders>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> PairOfReaders {
        auto first = recording.Next();
        if (!first) {
          control.stop();
          return {};
        }
        return {std::move(*first), recording.Next()};
      });
  const auto measure = tbb::make_filter<PairOfReaders, Statistics>(
      tbb::filter_mode::parallel,
      [&](const PairOfReaders& readers) { return MeasurePair(readers, fixed, track); });
  const auto sum = tbb::make_filter<Statistics, void>(tbb::filter_mode::serial_in_order,
                                                      [&](const Statistics& statistics) {
                                                        AddTo(all, statistics);
                                                        on_progress(all.coverage.num_frames());
                                                      });
  tbb::parallel_pipeline(max_pairs, read & measure & sum);
  return all;
}

}  // namespace railcast
