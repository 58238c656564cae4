#include "analysis/compare/compare_report.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

std::string PatchCounts(const PatchPairs& patches) {
  return Joined({CountText(patches.num_a()), " patches of A and ", CountText(patches.num_b()),
                 " of B in ", CountText(patches.pairs().size()), " pairs of frames"});
}

Table TellingTable(const Separability& told) {
  Table table = {"telling_features",
                 "What tells them apart",
                 "Importance: area lost when the feature is shuffled among the patches; of "
                 "features that say the same, each may be small. Alone: how often the feature is "
                 "greater in a patch of B than in one of A; 0.5 is as often as not.",
                 ColumnsOf("feature: Feature; importance: Importance; own_auc: Alone; "
                           "median_a: Median of A; median_b: Median of B"),
                 {},
                 true};
  for (const Separability::Feature& feature : told.features) {
    const PatchFeature& described = kPatchFeatures.at(feature.index);
    table.rows.push_back({WithUnit(std::string(described.title), std::string(described.unit)),
                          feature.lost_area, feature.own_area, feature.median_a.value,
                          feature.median_b.value});
  }
  return table;
}

Table RangesTable(const Separability& told) {
  Table table = {"told_by_range", "Told apart by range",
                 "The same classifier's scores, of the patches in each range.",
                 ColumnsOf("range [m]: Range; auc: AUC")};
  for (std::size_t bin = 0; bin < kNumDistanceBins; ++bin) {
    table.rows.push_back({DistanceBinText(bin), told.area_by_range.at(bin)});
  }
  return table;
}

std::string VerdictText(const Separability& told) {
  if (told.area.low > 0.5) return "B's patches can be told from A's.";
  if (told.area.high < 0.5) {
    return "B's patches look more like A's than A's own do: what differs in some frames differs "
           "the other way round in others.";
  }
  return "B's patches cannot be told from A's by these figures.";
}

}  // namespace

Section MakeSeparabilitySection(const PatchPairs& patches, const Separability& told) {
  Section section{"told_apart", "Whether the clouds can be told apart"};
  if (!told.is_enough()) {
    section.paragraphs = {
        Joined({"Not enough to tell: it takes ", std::to_string(kMinSamples),
                " pairs of frames with ", std::to_string(Separability::kMinPatches),
                " patches of each recording, some in every tenth of the pairs (got ",
                PatchCounts(patches), "). A patch is a cube of 2 m with 20 points at least."})};
    return section;
  }
  section.paragraphs = {
      Joined({VerdictText(told),
              " A classifier that has seen other frames of both gives a patch of B a higher score "
              "than one of A with a probability (AUC) of ",
              TextOf(told.area).value, " ", TextOf(told.area).interval,
              "; 0.5 is guessing, 1 is never wrong."}),
      Joined({"Classifier two-sample test (Lopez-Paz and Oquab 2017): ", PatchCounts(patches),
              patches.stride() == 1
                  ? std::string()
                  : Joined({", one of ", std::to_string(patches.stride()), " pairs,"}),
              " are cut into ten runs of pairs. A random forest (Breiman 2001) is grown to nine "
              "and tried on the tenth, ten times. Intervals are Student's over the ten, widened "
              "for what the forests have in common (Nadeau and Bengio 2003). A patch is a cube of "
              "2 m with 20 points at least; its figures do not say where it is."})};
  Table results = {"told_apart",
                   "How well they can be told apart",
                   "",
                   ColumnsOf("figure: Figure; value: Value"),
                   {{"AUC", told.area}, {"Balanced accuracy", told.balanced_accuracy}},
                   true};
  if (told.shape_area.is_enough()) {
    results.rows.push_back({"AUC without intensities", told.shape_area});
  }
  Table ranges = RangesTable(told);
  section.charts.push_back({"told_by_range",
                            "How well patches can be told apart, by range",
                            "0.5 is guessing.",
                            DistanceAxis("Range"),
                            {"AUC", ""},
                            {SeriesOf(ranges, {"range", "auc"}, "", SeriesStyle::kLinePoints)}});
  section.tables = {std::move(results), TellingTable(told), std::move(ranges)};
  return section;
}

}  // namespace railcast
