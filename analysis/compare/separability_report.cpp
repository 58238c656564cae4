#include "analysis/compare/compare_report.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

std::string PatchCounts(const PatchPairs& patches) {
  return Joined({CountText(patches.num_a()), " patches of A and ", CountText(patches.num_b()),
                 " of B in ", CountText(patches.pairs().size()), " pairs of frames"});
}

Table TellingTable(const Separability& told) {
  Table table = TableOf(kCompareWords, "telling_features");
  for (const Separability::Feature& feature : told.features) {
    const PatchFeature& described = kPatchFeatures.at(feature.index);
    table.rows.push_back({WithUnit(std::string(described.title), std::string(described.unit)),
                          feature.lost_area, feature.own_area, feature.median_a.value,
                          feature.median_b.value});
  }
  return table;
}

Table RangesTable(const Separability& told) {
  Table table = TableOf(kCompareWords, "told_by_range");
  for (std::size_t bin = 0; bin < kNumDistanceBins; ++bin) {
    table.rows.push_back({DistanceBinText(bin), told.area_by_range.at(bin)});
  }
  return table;
}

}  // namespace

Section MakeSeparabilitySection(const PatchPairs& patches, const Separability& told) {
  const bool is_enough = told.is_enough();
  Section section =
      SectionOf(kCompareWords, "told_apart",
                {{"is_enough", is_enough},
                 {"min_samples", std::to_string(kMinSamples)},
                 {"min_patches", std::to_string(Separability::kMinPatches)},
                 {"counts", PatchCounts(patches)},
                 {"apart", told.area.low > 0.5},
                 {"alike", told.area.high < 0.5},
                 {"unclear", !(told.area.low > 0.5) && !(told.area.high < 0.5)},
                 {"area", Joined({TextOf(told.area).value, " ", TextOf(told.area).interval})},
                 {"stride", patches.stride() == 1 ? "" : std::to_string(patches.stride())}});
  if (!is_enough) return section;
  Table results = TableOf(kCompareWords, "told_apart");
  results.rows = {{"AUC", told.area}, {"Balanced accuracy", told.balanced_accuracy}};
  if (told.shape_area.is_enough()) {
    results.rows.push_back({"AUC without intensities", told.shape_area});
  }
  Table ranges = RangesTable(told);
  Chart chart = ChartOfTable(kCompareWords, "told_by_range", ranges);
  chart.x = DistanceAxis("Range");
  section.charts.push_back(std::move(chart));
  section.tables = {std::move(results), TellingTable(told), std::move(ranges)};
  return section;
}

}  // namespace railcast
