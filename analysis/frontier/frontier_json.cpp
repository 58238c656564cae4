#include <nlohmann/json.hpp>
#include <thread>

#include "analysis/frontier/frontier_report.h"
#include "analysis/frontier/pareto.h"
#include "analysis/report/provenance.h"
#include "analysis/stats/names.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

Json ObjectOf(const Matched& matched) {
  return {{"num", matched.num}, {"num_matched", matched.num_matched}, {"share", matched.share()}};
}

Json PerLabel(const std::map<std::uint32_t, Matched>& counts, const LabelTable& labels) {
  Json object = Json::object();
  for (const auto& [id, matched] : counts) {
    object[LabelName(id, labels)] = ObjectOf(matched);
  }
  return object;
}

Json QuantilesObject(const ErrorQuantiles& quantiles) {
  return {{"median", quantiles.median}, {"p95", quantiles.p95}, {"p99", quantiles.p99}};
}

Json PointsByRange(const TargetPoints& points) {
  Json bins = Json::array();
  for (std::size_t i = 0; i < points.bins.size(); ++i) {
    bins.push_back({{"from_m", TargetPoints::kBin_m * static_cast<float>(i)},
                    {"num_reference", points.bins[i].num_reference},
                    {"num", points.bins[i].num}});
  }
  return bins;
}

Json EffectsIn(const EffectSet& effects) {
  return EffectNames(effects);
}

Json ErrorsOf(const RowErrors& d, const LabelTable& labels) {
  Json errors = Json::object();
  for (const FrontierError& error : kFrontierErrors) errors[error.name] = error.of(d);
  Json bins = Json::array();
  for (const FrameDifference::RangeBin& bin : d.range_bins) {
    bins.push_back({{"num_firings", bin.num_firings},
                    {"num_reference_returned", bin.num_reference_returned},
                    {"num_returned", bin.num_returned}});
  }
  errors["recall"] = ObjectOf(d.reference_echoes);
  errors["precision"] = ObjectOf(d.echoes);
  errors["thin_recall"] = ObjectOf(d.thin);
  errors["further_echo_recall"] = ObjectOf(d.further);
  errors["second_surface_recall"] = ObjectOf(d.second);
  errors["step_recall"] = ObjectOf(d.steps);
  errors["step_range_m"] = QuantilesObject(d.step_range_m);
  errors["bright_edge_intensity"] = QuantilesObject(d.bright_edges);
  errors["person_points_by_range"] = PointsByRange(d.persons);
  errors["pole_points_by_range"] = PointsByRange(d.poles);
  errors["recall_per_label"] = PerLabel(d.reference_echoes_per_label, labels);
  errors["precision_per_label"] = PerLabel(d.echoes_per_label, labels);
  errors["range_bins"] = bins;
  return errors;
}

Json EstimateObject(const Estimate& estimate) {
  return {{"value", estimate.value},
          {"low", estimate.low},
          {"high", estimate.high},
          {"num_in_full_detail", estimate.num}};
}

Json DetailOf(const RowResult& result, const LabelTable& labels) {
  Json list = Json::array();
  for (const DetailDifference& difference : result.detail_differences) {
    list.push_back({{"class", LabelName(difference.label, labels)},
                    {"from_m", kDetailBin_m * difference.bin},
                    {"to_m", kDetailBin_m * (difference.bin + 1)},
                    {"first_echoes", EstimateObject(difference.first)},
                    {"further_echoes", EstimateObject(difference.further)},
                    {"mean_intensity", EstimateObject(difference.intensity)}});
  }
  return list;
}

Json RowObject(const RowResult& result, const LabelTable& labels) {
  Json object = {{"name", result.row.name},
                 {"group", RowGroupName(result.row.group)},
                 {"effects", EffectsIn(result.row.effects)},
                 {"footprint_rays", result.row.footprint_rays},
                 {"num_timed", result.times_ms.size()},
                 {"p50_ms", result.p50_ms()},
                 {"p99_ms", result.p99_ms()},
                 {"ratio_to_raw_trace", result.ratio()}};
  if (!result.row.footprint_labels.empty()) {
    object["footprint_of"] = Json::array();
    for (const std::uint32_t label : result.row.footprint_labels) {
      object["footprint_of"].push_back(LabelName(label, labels));
    }
  }
  object["detail"] = result.row.has_auto_detail() ? "auto" : "full";
  if (result.row.has_auto_detail()) {
    object["statistical_differences_from_full_detail"] = DetailOf(result, labels);
  }
  if (result.row.sub_rays) object["sub_rays"] = *result.row.sub_rays;
  if (result.difference) object["errors"] = ErrorsOf(*result.difference, labels);
  return object;
}

Json ParetoObject(const std::vector<RowResult>& results) {
  Json object = Json::object();
  for (const FrontierError& error : kFrontierErrors) {
    object[error.name] = ParetoFront(results, error);
  }
  return object;
}

Json DefeatsList(const std::vector<RowResult>& results) {
  Json list = Json::array();
  for (const Defeat& defeat : FindDefeats(results)) {
    list.push_back(
        {{"error", defeat.error}, {"brute_force", defeat.brute_force}, {"ours", defeat.ours}});
  }
  return list;
}

}  // namespace

std::string FrontierJson(const FrontierPlan& plan,
                         const FrontierCircumstances& circumstances,
                         const LabelTable& labels,
                         const std::vector<RowResult>& results) {
  const TimingConditions conditions = ConditionsOf(plan, results);
  Json json = {
      {"version", circumstances.version},
      {"date", circumstances.date},
      {"scenario", circumstances.scenario},
      {"scenario_xxh3", circumstances.scenario_hash},
      {"weather", circumstances.weather},
      {"seed", circumstances.seed},
      {"machine",
       {{"processor", ProcessorName()}, {"num_threads", std::thread::hardware_concurrency()}}},
      {"timed_with_threads", plan.num_threads},
      {"timing",
       {{"is_busy", conditions.is_busy()},
        {"processor_share", conditions.processor_share},
        {"raw_trace_p99_over_p50", conditions.raw_spread}}},
      {"frames", plan.frames},
      {"detail_frames", plan.detail_frames},
      {"yardstick_sub_rays", plan.yardstick_rays},
      {"matching",
       {{"rule",
         "echoes of one firing, nearest pair first, one to one, ranges nearer than "
         "match_distance_m"},
        {"match_distance_m", circumstances.match_distance_m}}}};
  Json rows = Json::array();
  for (const RowResult& result : results) rows.push_back(RowObject(result, labels));
  json["rows"] = rows;
  json["pareto_front"] = ParetoObject(results);
  json["brute_force_faster_and_more_accurate"] = DefeatsList(results);
  json["fidelity_auto"] = Json::parse(circumstances.choice_json);
  return json.dump();
}

}  // namespace railcast
