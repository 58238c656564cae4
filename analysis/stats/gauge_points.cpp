#include "analysis/stats/statistics.h"

#include <numeric>

#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/error.h"

namespace railcast {

void GaugePoints::Add(const RecordedFrame& recorded, const FrameTrack& track) {
  if (!recorded.has_pose) {
    throw InputError(recorded.name + ": must have the sensor's pose for --track");
  }
  const Frame& frame = recorded.frame;
  const TrackFields fields = TrackFieldsOf(frame, track);
  std::uint64_t num_in_gauge = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    const std::size_t bin = BinOf(kBinDistances_m, static_cast<double>(frame.range_m[slot]));
    ++all_[bin];
    if (fields.in_gauge[slot] == 0) continue;
    ++num_in_gauge;
    ++in_gauge_[frame.label[slot]][bin];
  }
  ++num_frames_;
  num_frames_with_any_ += num_in_gauge > 0 ? 1U : 0U;
}

Section GaugePoints::MakeSection(const Names& names) const {
  Table table = TableOf(kStatsWords, "points_in_gauge");
  table.columns = DistanceColumns("label: Label");
  RangeCounts sums{};
  for (const auto& [label, counts] : in_gauge_) {
    table.rows.push_back(RowOf({label == 0 ? "no label" : names.OfLabel(label)}, counts));
    AddTo(sums, counts);
  }
  std::vector<Cell>& shares = table.rows.emplace_back(1, "share, percent");
  for (std::size_t i = 0; i < sums.size(); ++i) shares.emplace_back(Percent(sums[i], all_[i]));
  const std::uint64_t num = std::accumulate(sums.begin(), sums.end(), std::uint64_t{0});
  Section section = SectionOf(kStatsWords, "gauge",
                              {{"num", CountText(num)},
                               {"num_frames_with_any", CountText(num_frames_with_any_)},
                               {"num_frames", CountText(num_frames_)}});
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
