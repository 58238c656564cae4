#include "analysis/stats/certificate_section.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "analysis/report/cell_text.h"
#include "core/base/text.h"
#include "core/certify/weighted_shares.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/frame_record.h"

namespace railcast {
namespace {

constexpr double kCertifiedPercent = 100.0;
constexpr double kCertifiedMm = 1e3;

Estimate CertifiedEstimate(const std::optional<CertifiedFigure>& figure,
                           double factor,
                           std::uint64_t num) {
  if (!figure) return NotEnough(num);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return Scaled({figure->value, figure->low, figure->high.value_or(kNaN), num}, factor);
}

Table CertifiedTable(std::string key,
                     const std::string& of,
                     const std::vector<CertifiedPart>& parts) {
  Table table = {
      std::move(key), "Numerical error by " + of,
      "Echoes: those of the reference that were drawn. Error of power: |power / the reference's - "
      "1|.",
      ColumnsOf("part: Part; echoes: Echoes; missed_percent: Missed; false_percent: False; "
                "range_p50_mm: Range error, median; range_p95_mm: Range error, 95 % quantile; "
                "power_p50_percent: Error of power, median; other_label_percent: Other label")};
  for (const CertifiedPart& part : parts) {
    const auto of_part = [&](const std::optional<CertifiedFigure>& figure, double factor) {
      return CertifiedEstimate(figure, factor, part.echoes);
    };
    table.rows.push_back(
        {part.name, part.echoes, of_part(part.missed, kCertifiedPercent),
         of_part(part.wrong, kCertifiedPercent), of_part(part.range_p50_m, kCertifiedMm),
         of_part(part.range_p95_m, kCertifiedMm), of_part(part.power_p50, kCertifiedPercent),
         of_part(part.other_label, kCertifiedPercent)});
  }
  return table;
}

Table RungsTable(const RunCertificate& certificate) {
  Table table = {"certificate_rungs", "What other rungs would have given",
                 "On the same firings. Time: in multiples of the run's own, by the table of costs.",
                 ColumnsOf("rung: Rung; time_ratio: Time; missed_percent: Missed; "
                           "false_percent: False")};
  const std::uint64_t num = certificate.all.echoes;
  const auto add = [&](const std::string& name, double cost, const auto& missed,
                       const auto& wrong) {
    table.rows.push_back({name, cost, CertifiedEstimate(missed, kCertifiedPercent, num),
                          CertifiedEstimate(wrong, kCertifiedPercent, num)});
  };
  add("this run", 1.0, certificate.all.missed, certificate.all.wrong);
  for (const CertifiedRung& rung : certificate.rungs) {
    add(rung.name, rung.cost, rung.missed, rung.wrong);
  }
  return table;
}

// The runs that a source has: itself, or those below a data set or a run of several sensors.
std::vector<std::filesystem::path> RunsOf(const std::filesystem::path& source) {
  if (std::filesystem::exists(source / kRunFile)) return {source};
  std::vector<std::filesystem::path> runs;
  if (!std::filesystem::is_directory(source)) return runs;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source)) {
    if (entry.path().filename() == kFramesFile) runs.push_back(entry.path().parent_path());
  }
  std::ranges::sort(runs);
  return runs;
}

// Adds up the frames of a run.
void AddFrames(const std::filesystem::path& run, CertificateSums& sums) {
  const std::filesystem::path file = run / kFramesFile;
  std::ifstream lines(file, std::ios::binary);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const FrameRecord record =
        ReadFrameLine(line, ShownPath(file) + ":" + std::to_string(++number));
    if (record.certificate) sums.Add(*record.certificate);
  }
}

}  // namespace

std::optional<RunCertificate> CertificateOf(const std::vector<RecordingInfo>& sources) {
  std::vector<std::filesystem::path> certified;
  std::vector<RunCertificate> certificates;
  LabelTable labels;
  for (const RecordingInfo& info : sources) {
    if (!info.origin) continue;
    for (const std::filesystem::path& run : RunsOf(info.source)) {
      const SequenceSummary summary = ReadSequenceSummary(run);
      if (!summary.manifest || !summary.manifest->certificate) continue;
      if (certified.empty()) labels = info.labels;
      certified.push_back(run);
      certificates.push_back(*summary.manifest->certificate);
    }
  }
  if (certificates.empty()) return std::nullopt;
  if (certificates.size() == 1) return certificates.front();
  CertifySpec spec{.cost_share = certificates.front().cost_share};
  const auto has_same_rungs = [&](const RunCertificate& other) {
    return std::ranges::equal(other.rungs, certificates.front().rungs, {}, &CertifiedRung::name,
                              &CertifiedRung::name);
  };
  // Frames of different rungs have no neighbours in common.
  if (std::ranges::all_of(certificates, has_same_rungs)) {
    for (const CertifiedRung& rung : certificates.front().rungs) {
      spec.rungs.push_back({rung.name, {}, rung.cost});
    }
  }
  CertificateSums sums(std::move(spec));
  for (const std::filesystem::path& run : certified) AddFrames(run, sums);
  return sums.Result(labels);
}

Section MakeCertificateSection(const RunCertificate& certificate) {
  Section section{
      "certificate",
      "Numerical error",
      {Joined({"What the run's rung leaves out, measured on itself: ", CountText(certificate.drawn),
               " of ", CountText(certificate.firings),
               " firings were drawn at random and made anew on rung reference, in the same scene "
               "and with the same random draws, and their echoes compared before range noise. "
               "Intervals are of 95 %."})}};
  std::istringstream lines(CertificateText(certificate));
  for (std::string line; std::getline(lines, line);) {
    section.paragraphs.push_back(line.substr(std::min(line.find_first_not_of(' '), line.size())));
  }
  if (certificate.without_drawn > 0.0) {
    section.paragraphs.push_back(Joined({"Of firings of some kinds, ",
                                         ShortText(kCertifiedPercent * certificate.without_drawn),
                                         " % of all, none was drawn; others stand for them."}));
  }
  section.tables.push_back(CertifiedTable("certificate", "part", {certificate.all}));
  if (!certificate.rungs.empty()) section.tables.push_back(RungsTable(certificate));
  section.tables.push_back(CertifiedTable("certificate_by_class", "class", certificate.classes));
  section.tables.push_back(CertifiedTable("certificate_by_range", "range", certificate.ranges));
  if (!certificate.objects.empty()) {
    section.tables.push_back(
        CertifiedTable("certificate_by_object", "object", certificate.objects));
  }
  return section;
}

void AddCertificateHeadlines(const RunCertificate& certificate, Report& report) {
  const CertifiedPart& all = certificate.all;
  report.headlines.push_back({"Echoes missed for the rung", "%",
                              CertifiedEstimate(all.missed, kCertifiedPercent, all.echoes)});
  report.headlines.push_back({"Range error of the rung", "mm",
                              CertifiedEstimate(all.range_p50_m, kCertifiedMm, all.echoes)});
}

}  // namespace railcast
