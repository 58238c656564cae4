#include "analysis/stats/statistics.h"

#include <algorithm>

#include "analysis/report/cell_text.h"
#include "analysis/report/provenance.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/certificate_section.h"
#include "core/base/text.h"

namespace railcast {
namespace {

// The last part of the path: "demo" for "out/demo/".
std::string NameOfPart(const std::filesystem::path& source) {
  const std::filesystem::path path = source.lexically_normal();
  return ShownPath(path.has_filename() ? path.filename() : path.parent_path().filename());
}

std::string SourcesText(const std::vector<RecordingInfo>& sources) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (const RecordingInfo& info : sources) {
    if (&info - sources.data() == kMost) {
      return text + " and " + std::to_string(sources.size() - kMost) + " more";
    }
    if (!text.empty()) text += ", ";
    text += ShownPath(info.source);
    text += " (";
    text += info.kind;
    text += ")";
  }
  return text;
}

void AddScenarioFacts(const std::vector<RecordingInfo>& sources, Report& report) {
  const auto add = [&](const char* name,
                       const std::function<std::string(const ScenarioSpec&)>& text_of) {
    const std::string all = DifferentTexts(sources, [&](const RecordingInfo& info) {
      return info.scenario ? text_of(*info.scenario) : std::string();
    });
    if (!all.empty()) report.facts.emplace_back(name, all);
  };
  add("Sensor", [](const ScenarioSpec& scenario) { return scenario.lidar.name; });
  add("Fidelity",
      [](const ScenarioSpec& scenario) { return std::string(NameOf(scenario.fidelity)); });
  add("Seed", [](const ScenarioSpec& scenario) { return std::to_string(scenario.seed); });
}

void AddNoiseHeadline(std::string title, std::size_t bin, const Estimate& sigma_m, Report& report) {
  constexpr double kMm = 1e3;
  title += ", ";
  title += SpanText(RangeBins().span(bin));
  title += " m";
  report.headlines.push_back({std::move(title), "mm", Scaled(sigma_m, kMm)});
}

// Uses the bin with the most samples, which is the most precise, and the truth where there is any.
void AddNoiseHeadline(const Noise& noise, Report& report) {
  const auto best_of = [](const auto& bins, auto num) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      if (num(bins[i]) > num(bins[best])) best = i;
    }
    return best;
  };
  const auto& truth = noise.truth();
  const auto& planes = noise.planes();
  if (!truth.empty()) {
    const std::size_t bin = best_of(truth, [](const Scatter& t) { return t.num(); });
    AddNoiseHeadline("Range noise", bin, truth[bin].robust.RobustScale(), report);
  } else if (!planes.empty()) {
    const std::size_t bin =
        best_of(planes, [](const Noise::Planes& p) { return p.range_sigmas_m.num(); });
    AddNoiseHeadline("Range noise on planes", bin, planes[bin].RobustRangeSigma_m(), report);
  }
}

void AddVelocityHeadline(const Velocity& velocity, Report& report) {
  if (!velocity.has_truth()) return;
  const auto& sums = velocity.by_range();
  const auto best = std::ranges::max_element(
      sums, {}, [](const Velocity::Sum& sum) { return sum.errors_mps.num(); });
  const auto bin = static_cast<std::size_t>(best - sums.begin());
  report.headlines.push_back(
      {Joined({"Noise of velocity, ", SpanText(RangeBins().span(bin)), " m"}), "m/s",
       best->errors_mps.robust.RobustScale()});
}

// Uses the surface with the most points.
template <typename Curves, typename Name>
void AddDensityHeadline(const Curves& curves, Name name, Report& report) {
  const Density::Curve* best = nullptr;
  std::string best_name;
  std::uint64_t most = 0;
  for (const auto& [key, curve] : curves) {
    std::uint64_t num = 0;
    for (const Density::Count& count : curve) num += count.num_points;
    if (num <= most) continue;
    most = num;
    best = &curve;
    best_name = name(key);
  }
  if (best == nullptr) return;
  report.headlines.push_back(
      {"Exponent of density against range, " + best_name, "", Density::LawOf(*best).exponent});
}

/// Whether it is not known of any frame where its sensor was.
bool HaveNoRanges(const std::vector<RecordingInfo>& sources, std::uint64_t num_frames) {
  std::uint64_t num = 0;
  for (const RecordingInfo& info : sources) {
    for (const Remark& remark : info.remarks->List()) {
      num += remark.kind == RemarkKind::kRangesUnknown ? remark.number : 0;
    }
  }
  return num_frames > 0 && num >= num_frames;
}

void AddSections(const Statistics& statistics,
                 const Names& names,
                 const std::vector<RecordingInfo>& sources,
                 const std::optional<RunCertificate>& certificate,
                 Report& report) {
  const bool has_ranges = !HaveNoRanges(sources, statistics.coverage.num_frames());
  const auto add = [&](const auto& figures, const auto&... given) {
    if (!figures.is_empty()) report.sections.push_back(figures.MakeSection(given...));
  };
  add(statistics.classes, names);
  add(statistics.dropout, names);
  add(statistics.holes);
  add(statistics.density, names);
  add(statistics.objects);
  add(statistics.difficulty);
  if (!statistics.difficulty.is_empty()) {
    report.sections.push_back(
        MakeOsdarBalanceSection(statistics.difficulty, sources.front().labels));
  }
  add(statistics.gauge, names);
  if (has_ranges) {
    Section& noise = report.sections.emplace_back(statistics.noise.MakeSection());
    if (!statistics.neighbour_noise.bins().empty()) {
      noise.tables.push_back(statistics.neighbour_noise.MakeTable());
    }
  }
  if (certificate) report.sections.push_back(MakeCertificateSection(*certificate));
  if (has_ranges) report.sections.push_back(statistics.temporal_noise.MakeSection());
  add(statistics.velocity);
  add(statistics.intensity, names);
  report.sections.push_back(statistics.coverage.MakeSection());
}

}  // namespace

Report MakeStatisticsReport(const Statistics& statistics,
                            const std::vector<RecordingInfo>& sources,
                            const std::string& command) {
  const Names names(sources.front());
  Report report;
  report.title = "Statistics of " + NameOfPart(sources.front().source);
  if (sources.size() > 1) report.title += " and " + std::to_string(sources.size() - 1) + " more";
  report.command = command;
  report.facts.emplace_back("Source", SourcesText(sources));
  report.facts.emplace_back("Frames", std::to_string(statistics.coverage.num_frames()));
  report.facts.emplace_back("Points", std::to_string(statistics.coverage.num_points()));
  AddScenarioFacts(sources, report);

  report.headlines.push_back({"Points a frame", "", statistics.coverage.PointsPerFrame()});
  const bool is_exact = !statistics.dropout.is_empty();
  if (is_exact) {
    report.headlines.push_back({"Dropout, exact", "%", Scaled(statistics.dropout.Share(), 100.0)});
  }
  if (!statistics.holes.is_empty()) {
    report.headlines.push_back(
        {"Dropout, estimated from holes", "%", Scaled(statistics.holes.Share(), 100.0)});
  } else if (!is_exact) {
    report.facts.emplace_back(
        "Dropout", "unknown: where the sensor fired without a return cannot be told for certain");
  }
  AddNoiseHeadline(statistics.noise, report);
  // Error beside noise: what the rung leaves out, beside what the sensor adds.
  const std::optional<RunCertificate> certificate = CertificateOf(sources);
  if (certificate) AddCertificateHeadlines(*certificate, report);
  AddVelocityHeadline(statistics.velocity, report);
  AddDensityHeadline(
      statistics.density.by_label(), [&](std::uint32_t id) { return names.OfLabel(id); }, report);
  AddDensityHeadline(
      statistics.density.by_attitude(), [](const std::string& attitude) { return attitude; },
      report);

  AddSections(statistics, names, sources, certificate, report);
  return report;
}

}  // namespace railcast
