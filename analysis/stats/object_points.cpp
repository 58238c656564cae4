#include "analysis/stats/object_points.h"

#include <algorithm>

#include "analysis/stats/bins.h"
#include "analysis/stats/headings.h"

namespace railcast {

void ObjectPoints::Add(const RecordedFrame& recorded) {
  for (const RecordedObject& object : recorded.objects) {
    // Out of sight even alone: behind the sensor, or beside what it looks at.
    if (object.firings_alone == 0) continue;
    const auto bin = RangeBins().Find(object.sensor_from_box.translation().norm());
    if (!bin) continue;
    Object& sum = objects_[object.name];
    sum.label = object.label;
    sum.bins.resize(RangeBins().size());
    sum.bins[*bin].points.Add(static_cast<double>(object.points));
    sum.bins[*bin].num_visible += object.firings_visible;
    sum.bins[*bin].num_points += object.points;
  }
}

void ObjectPoints::Add(const ObjectPoints& other) {
  for (const auto& [name, object] : other.objects_) {
    Object& sum = objects_[name];
    sum.label = object.label;
    sum.bins.resize(object.bins.size());
    for (std::size_t i = 0; i < object.bins.size(); ++i) {
      sum.bins[i].points.Add(object.bins[i].points);
      sum.bins[i].num_visible += object.bins[i].num_visible;
      sum.bins[i].num_points += object.bins[i].num_points;
    }
  }
}

Section ObjectPoints::MakeSection() const {
  Section section;
  section.key = "objects";
  section.title = "Points on objects";
  section.paragraphs = {
      "By the distance of the box's middle; frames in which the object is out of the sensor's "
      "sight "
      "even alone do not count."};
  Table table;
  table.key = "object_points";
  table.title = "Points on each object by distance";
  table.note =
      "Samples are frames. Returned: of the beams that met the object first, those whose "
      "point came back.";
  table.columns = {{"object", "Object", ""},
                   {"label", "Label", ""},
                   {"distance_m", "Distance", "m"},
                   {"points", "Points a frame", ""},
                   {"returned", "Returned", ""}};
  Chart chart;
  chart.key = "object_points";
  chart.title = "Points on objects against distance";
  chart.x = {"Distance", "m"};
  chart.y = {"Points a frame", "", true};
  for (const auto& [name, object] : objects_) {
    ChartSeries series{name, SeriesStyle::kLinePoints, {}};
    for (std::size_t i = 0; i < object.bins.size(); ++i) {
      const auto& [points, num_visible, num_points] = object.bins[i];
      if (points.num() == 0) continue;
      // A beam may bring several points back.
      table.rows.push_back({name, object.label, RangeBins().Name(i), points.Mean(),
                            Proportion(std::min(num_points, num_visible), num_visible)});
      const Estimate mean = points.Mean();
      if (mean.value > 0.0) series.points.push_back(PointAt(RangeBins().middle(i), mean));
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  section.tables.push_back(std::move(table));
  section.charts.push_back(std::move(chart));
  return section;
}

}  // namespace railcast
