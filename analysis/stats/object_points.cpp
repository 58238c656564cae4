#include "analysis/stats/statistics.h"

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

/// Firings that met an object, and those of them that returned a point.
struct Met {
  std::uint64_t num{};
  std::uint64_t num_returned{};
};

// Counts by instance; empty where frames do not hold the truth.
std::map<std::uint32_t, Met> CountMet(const RecordedFrame& recorded) {
  std::map<std::uint32_t, Met> counts;
  if (!HasOutcomes(recorded) || !recorded.Has("instance")) return counts;
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    if (frame.instance[slot] == 0 || !KnowsSurface(frame, slot)) continue;
    Met& met = counts[frame.instance[slot]];
    ++met.num;
    met.num_returned += frame.outcome[slot] == Outcome::kReturned ? 1 : 0;
  }
  return counts;
}

}  // namespace

void ObjectPoints::Add(const RecordedFrame& recorded) {
  const std::map<std::uint32_t, Met> counts = CountMet(recorded);
  for (const RecordedObject& object : recorded.objects) {
    // The object is out of view even without occlusion: behind the sensor, or outside its field of
    // view.
    if (object.firings_alone == 0) continue;
    const auto bin = RangeBins().Find(object.sensor_from_box.translation().norm());
    if (!bin) continue;
    Object& sum = objects_[object.name];
    sum.label = object.label;
    sum.bins[*bin].points.Add(static_cast<double>(object.points));
    const auto met = counts.find(object.instance);
    if (met == counts.end()) continue;
    sum.bins[*bin].num_met += met->second.num;
    sum.bins[*bin].num_returned += met->second.num_returned;
  }
}

Section ObjectPoints::MakeSection() const {
  Section section = SectionOf(kStatsWords, "objects");
  Table table = TableOf(kStatsWords, "object_points");
  for (const auto& [name, object] : objects_) {
    for (const auto& [bin, of] : object.bins) {
      table.rows.push_back({name, object.label, RangeBins().span(bin), of.points.Mean(),
                            PercentProportion(of.num_returned, of.num_met)});
    }
  }
  section.charts.push_back(ChartOfTable(kStatsWords, "object_points", table));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
