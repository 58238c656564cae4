#include "analysis/stats/dropout.h"

#include <algorithm>
#include <numbers>

#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

using Count = Dropout::Count;

// Reasons why a surface that was met yields no point.
constexpr Outcome kCauses[] = {Outcome::kOutOfRange,    Outcome::kBelowThreshold,
                               Outcome::kRainAbsorbed,  Outcome::kNearRange,
                               Outcome::kSensorDropout, Outcome::kCoverBlocked};

/// Rows of a table: name and counts.
using NamedCounts = std::vector<std::pair<Cell, const Count*>>;

Table MakeTable(TableColumn first, const NamedCounts& counts) {
  Table table;
  table.columns = {
      std::move(first), {"firings", "Firings", ""}, {"dropout_percent", "Dropout", "%"}};
  std::vector<Outcome> causes;
  for (const Outcome cause : kCauses) {
    for (const auto& [name, count] : counts) {
      if (count->of(cause) == 0) continue;
      causes.push_back(cause);
      table.columns.push_back(
          {std::string(OutcomeName(cause)) + "_percent", InWords(OutcomeName(cause)), "%"});
      break;
    }
  }
  for (const auto& [name, count] : counts) {
    std::vector<Cell> row = {
        name, count->num,
        PercentProportion(count->num - count->of(Outcome::kReturned), count->num)};
    for (const Outcome cause : causes)
      row.emplace_back(PercentProportion(count->of(cause), count->num));
    table.rows.push_back(std::move(row));
  }
  return table;
}

NamedCounts InBins(const std::vector<Count>& counts, const Bins& bins) {
  NamedCounts named;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i].num > 0) named.emplace_back(bins.span(i), &counts[i]);
  }
  return named;
}

// Dropout by range for all causes together and for each.
Chart DropoutChart(const Table& table) {
  Chart chart = {
      table.key,
      "Dropout against range",
      "The highest line below all causes is what loses most at that range: shares of the "
      "firings that met a surface there and brought no point of it back.",
      {"True range", "m"},
      {"Dropout", "%"},
      {}};
  for (std::size_t i = 2; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    chart.series.push_back(SeriesOf(table, {"true_range_m", column.key},
                                    column.key == "dropout_percent" ? "all causes" : column.title));
  }
  return chart;
}

Chart LabelChart(const Table& table) {
  return {table.key,
          "Dropout by label",
          "The longest bars are the surfaces that lose most points, over all ranges, with 95 % "
          "intervals.",
          {"Label", "", false, TextsOf(table, "label")},
          {"Dropout", "%"},
          {SeriesOf(table, {"label", "dropout_percent"}, "dropout", SeriesStyle::kBars)}};
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
  Section section{
      "dropout",
      "Dropout, exact",
      {"Counted from the outcome of every firing. Dropout is the share of the firings that met a "
       "surface within reach and brought no point of it back; firings into the open had nothing to "
       "lose. Where clutter answered, the surface behind is unknown: those firings stand in the "
       "first table only. Intervals take firings as independent (Wilson)."},
      {},
      {}};

  Table outcomes = {
      "outcomes",
      "What became of all firings",
      "",
      {{"outcome", "Outcome", ""}, {"firings", "Firings", ""}, {"share_percent", "Share", "%"}},
      {}};
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    const std::uint64_t num = all_.outcomes[i];
    if (num == 0) continue;
    outcomes.rows.push_back({InWords(kOutcomeNames[i]), num, PercentProportion(num, all_.num)});
  }
  section.tables.push_back(std::move(outcomes));

  const auto add = [&](const char* key, const char* title, TableColumn first,
                       const NamedCounts& counts, Chart (*chart_of)(const Table&) = nullptr) {
    if (counts.empty()) return;
    Table table = MakeTable(std::move(first), counts);
    table.key = key;
    table.title = title;
    if (chart_of != nullptr) section.charts.push_back(chart_of(table));
    section.tables.push_back(std::move(table));
  };
  add("dropout_by_range", "Dropout by range", {"true_range_m", "True range", "m"},
      InBins(by_range_, RangeBins()), DropoutChart);
  add("dropout_by_incidence", "Dropout by incidence", {"incidence_deg", "Incidence", "deg"},
      InBins(by_incidence_, IncidenceBins()));
  NamedCounts labels, materials, rings;
  for (const auto& [label, count] : by_label_) labels.emplace_back(names.OfLabel(label), &count);
  for (const auto& [id, count] : by_material_) materials.emplace_back(names.OfMaterial(id), &count);
  for (std::size_t i = 0; i < by_ring_.size(); ++i) {
    if (by_ring_[i].num > 0) rings.emplace_back(std::to_string(i), &by_ring_[i]);
  }
  add("dropout_by_label", "Dropout by label", {"label", "Label", ""}, labels, LabelChart);
  add("dropout_by_material", "Dropout by material", {"material", "Material", ""}, materials);
  if (!by_ring_.empty()) {
    add("dropout_by_ring", "Dropout by ring", {"ring", "Ring", ""}, rings);
  }
  return section;
}

}  // namespace railcast
