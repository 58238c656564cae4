#include "analysis/stats/dropout.h"

#include <algorithm>
#include <functional>
#include <numbers>

#include "analysis/stats/bins.h"
#include "analysis/stats/headings.h"
#include "analysis/stats/sums.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

using Count = Dropout::Count;

// Causes for which a surface that was met brings no point back.
constexpr Outcome kCauses[] = {Outcome::kOutOfRange, Outcome::kBelowThreshold,
                               Outcome::kRainAbsorbed, Outcome::kNearRange,
                               Outcome::kSensorDropout};

/// Rows of a table: how each is called and what it counts.
using NamedCounts = std::vector<std::pair<std::string, const Count*>>;

Table MakeTable(TableColumn first, const NamedCounts& counts) {
  Table table;
  table.columns = {std::move(first), {"firings", "Firings", ""}, {"dropout", "Dropout", ""}};
  std::vector<Outcome> causes;
  for (const Outcome cause : kCauses) {
    for (const auto& [name, count] : counts) {
      if (count->of(cause) == 0) continue;
      causes.push_back(cause);
      table.columns.push_back({std::string(OutcomeName(cause)), InWords(OutcomeName(cause)), ""});
      break;
    }
  }
  for (const auto& [name, count] : counts) {
    std::vector<Cell> row = {name, count->num,
                             Proportion(count->num - count->of(Outcome::kReturned), count->num)};
    for (const Outcome cause : causes) row.emplace_back(Proportion(count->of(cause), count->num));
    table.rows.push_back(std::move(row));
  }
  return table;
}

NamedCounts InBins(const std::vector<Count>& counts, const Bins& bins) {
  NamedCounts named;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i].num > 0) named.emplace_back(bins.Name(i), &counts[i]);
  }
  return named;
}

// Against range: all causes together and each.
Chart RangeChart(const std::vector<Count>& by_range) {
  Chart chart;
  chart.key = "dropout_by_range";
  chart.title = "Dropout against range";
  chart.caption =
      "Share of the firings that met a surface at this true range and brought no point "
      "of it back, by cause.";
  chart.x = {"True range", "m"};
  chart.y = {"Dropout", ""};
  const auto add = [&](const std::string& title,
                       const std::function<std::uint64_t(const Count&)>& f) {
    ChartSeries series{title, SeriesStyle::kLinePoints, {}};
    bool is_zero = true;
    for (std::size_t i = 0; i < by_range.size(); ++i) {
      const Count& count = by_range[i];
      series.points.push_back(PointAt(RangeBins().middle(i), Proportion(f(count), count.num)));
      is_zero = is_zero && f(count) == 0;
    }
    if (!is_zero) chart.series.push_back(std::move(series));
  };
  add("all causes", [](const Count& c) { return c.num - c.of(Outcome::kReturned); });
  for (const Outcome cause : kCauses) {
    add(InWords(OutcomeName(cause)), [cause](const Count& c) { return c.of(cause); });
  }
  return chart;
}

Chart LabelChart(const NamedCounts& counts) {
  Chart chart;
  chart.key = "dropout_by_label";
  chart.title = "Dropout by label";
  chart.caption = "Over all ranges. Lines show the 95 % interval.";
  chart.x = {"Label", ""};
  chart.y = {"Dropout", ""};
  ChartSeries series{"dropout", SeriesStyle::kBars, {}};
  for (const auto& [name, count] : counts) {
    const Estimate share = Proportion(count->num - count->of(Outcome::kReturned), count->num);
    series.points.push_back(PointAt(static_cast<double>(chart.x.categories.size()), share));
    chart.x.categories.push_back(name);
  }
  chart.series.push_back(std::move(series));
  return chart;
}

}  // namespace

void Dropout::Count::Add(const Count& other) {
  num += other.num;
  for (std::size_t i = 0; i < outcomes.size(); ++i) outcomes[i] += other.outcomes[i];
}

void Dropout::Add(const RecordedFrame& recorded) {
  if (!HasOutcomes(recorded)) return;
  const Frame& frame = recorded.frame;
  by_range_.resize(RangeBins().size());
  by_incidence_.resize(IncidenceBins().size());
  by_ring_.resize(std::max<std::size_t>(by_ring_.size(), frame.rows));
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    const Outcome outcome = frame.outcome[slot];
    all_.Add(outcome);
    if (!KnowsSurface(frame, slot)) continue;
    surface_.Add(outcome);
    by_ring_[slot / frame.width()].Add(outcome);
    const auto range_bin = RangeBins().Find(static_cast<double>(frame.true_range_m[slot]));
    if (range_bin) by_range_[*range_bin].Add(outcome);
    const double incidence_deg = kDegrees * static_cast<double>(frame.incidence_rad[slot]);
    if (const auto bin = IncidenceBins().Find(incidence_deg)) by_incidence_[*bin].Add(outcome);
    if (recorded.Has("label")) by_label_[frame.label[slot]].Add(outcome);
    if (recorded.Has("material")) by_material_[frame.material[slot]].Add(outcome);
  }
}

void Dropout::Add(const Dropout& other) {
  all_.Add(other.all_);
  surface_.Add(other.surface_);
  AddEach(by_range_, other.by_range_);
  AddEach(by_incidence_, other.by_incidence_);
  AddEach(by_ring_, other.by_ring_);
  for (const auto& [label, count] : other.by_label_) by_label_[label].Add(count);
  for (const auto& [material, count] : other.by_material_) by_material_[material].Add(count);
}

Estimate Dropout::Share() const {
  return Proportion(surface_.num - surface_.of(Outcome::kReturned), surface_.num);
}

Section Dropout::MakeSection(const Names& names) const {
  Section section;
  section.key = "dropout";
  section.title = "Dropout, exact";
  section.paragraphs = {
      "Counted from the outcome of every firing. Dropout is the share of the firings that met a "
      "surface within reach and brought no point of it back; firings into the open had nothing to "
      "lose. Where clutter answered, the surface behind is unknown: those firings stand in the "
      "first table only. Intervals take firings as independent (Wilson)."};

  Table outcomes;
  outcomes.key = "outcomes";
  outcomes.title = "What became of all firings";
  outcomes.columns = {
      {"outcome", "Outcome", ""}, {"firings", "Firings", ""}, {"share", "Share", ""}};
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    const std::uint64_t num = all_.outcomes[i];
    if (num == 0) continue;
    outcomes.rows.push_back({InWords(kOutcomeNames[i]), num, Proportion(num, all_.num)});
  }
  section.tables.push_back(std::move(outcomes));

  const auto add = [&](const char* key, const char* title, TableColumn first,
                       const NamedCounts& counts) {
    if (counts.empty()) return;
    Table table = MakeTable(std::move(first), counts);
    table.key = key;
    table.title = title;
    section.tables.push_back(std::move(table));
  };
  add("dropout_by_range", "Dropout by range", {"true_range_m", "True range", "m"},
      InBins(by_range_, RangeBins()));
  add("dropout_by_incidence", "Dropout by incidence", {"incidence_deg", "Incidence", "deg"},
      InBins(by_incidence_, IncidenceBins()));
  NamedCounts labels, materials, rings;
  for (const auto& [label, count] : by_label_) labels.emplace_back(names.OfLabel(label), &count);
  for (const auto& [id, count] : by_material_) materials.emplace_back(names.OfMaterial(id), &count);
  for (std::size_t i = 0; i < by_ring_.size(); ++i) {
    if (by_ring_[i].num > 0) rings.emplace_back(std::to_string(i), &by_ring_[i]);
  }
  add("dropout_by_label", "Dropout by label", {"label", "Label", ""}, labels);
  add("dropout_by_material", "Dropout by material", {"material", "Material", ""}, materials);
  add("dropout_by_ring", "Dropout by ring", {"ring", "Ring", ""}, rings);

  section.charts.push_back(RangeChart(by_range_));
  if (!labels.empty()) section.charts.push_back(LabelChart(labels));
  return section;
}

}  // namespace railcast
