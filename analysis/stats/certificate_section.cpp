#include "analysis/stats/certificate_section.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"
#include "core/certify/weighted_shares.h"
#include "core/io/record/read_record.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"

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
  Table table = TableOf(kStatsWords, "certificate_by", {{"of", of}});
  table.key = std::move(key);
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
  Table table = TableOf(kStatsWords, "certificate_rungs");
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

/// A folder with certificates: a run, or what was put into a recording.
struct CertifiedFolder {
  std::filesystem::path ledger;  ///< The file with those of its frames.
  RunCertificate certificate;
};

// Adds a folder with such a file, if it is complete and certified.
void AddCertified(const std::filesystem::path& ledger, std::vector<CertifiedFolder>& folders) {
  const std::filesystem::path file = ledger.parent_path() / kManifestFile;
  if (!std::filesystem::exists(ledger) || !std::filesystem::exists(file)) return;
  const Json manifest = ReadRecordedJson(ReadManifestText(file), ShownPath(file));
  const auto certificate = manifest.find("certificate");
  if (certificate == manifest.end()) return;
  folders.push_back({ledger, ReadRecord<RunCertificate>(certificate->dump(), ShownPath(file))});
}

// The certified folders that a source is of: a run, runs below a data set or of several sensors, or
// the insertion around a recording that is no run.
std::vector<CertifiedFolder> CertifiedFolders(const RecordingInfo& info) {
  const std::filesystem::path& source = info.source;
  std::vector<CertifiedFolder> folders;
  if (std::filesystem::exists(source / kRunFile)) {
    AddCertified(source / kFramesFile, folders);
    return folders;
  }
  if (source.filename() == kRecordingFolder) {
    AddCertified(source.parent_path() / kInsertFile, folders);
  }
  if (!info.origin || !std::filesystem::is_directory(source)) return folders;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source)) {
    if (entry.path().filename() == kFramesFile) AddCertified(entry.path(), folders);
  }
  std::ranges::sort(folders, {}, &CertifiedFolder::ledger);
  return folders;
}

// Adds up the frames of a folder.
void AddFrames(const CertifiedFolder& folder, CertificateSums& sums) {
  std::ifstream lines(folder.ledger, std::ios::binary);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = ShownPath(folder.ledger) + ":" + std::to_string(++number);
    const Json record = ReadRecordedJson(line, place);
    const auto certificate = record.find("certificate");
    if (certificate == record.end()) continue;
    sums.Add(ReadRecord<FrameCertificate>(certificate->dump(), place));
  }
}

}  // namespace

std::optional<RunCertificate> CertificateOf(const std::vector<RecordingInfo>& sources) {
  std::vector<CertifiedFolder> folders;
  LabelTable labels;
  for (const RecordingInfo& info : sources) {
    for (CertifiedFolder& folder : CertifiedFolders(info)) {
      if (folders.empty()) labels = info.labels;
      folders.push_back(std::move(folder));
    }
  }
  if (folders.empty()) return std::nullopt;
  const RunCertificate& first = folders.front().certificate;
  if (folders.size() == 1) return first;
  CertifySpec spec{.cost_share = first.cost_share};
  const auto has_same_rungs = [&](const CertifiedFolder& other) {
    return std::ranges::equal(other.certificate.rungs, first.rungs, {}, &CertifiedRung::name,
                              &CertifiedRung::name);
  };
  // Frames of different rungs have no neighbours in common.
  if (std::ranges::all_of(folders, has_same_rungs)) {
    for (const CertifiedRung& rung : first.rungs) {
      spec.rungs.push_back({rung.name, {}, rung.cost});
    }
  }
  CertificateSums sums(std::move(spec));
  for (const CertifiedFolder& folder : folders) AddFrames(folder, sums);
  return sums.Result(labels);
}

Section MakeCertificateSection(const RunCertificate& certificate) {
  const double without = kCertifiedPercent * certificate.without_drawn;
  Section section = SectionOf(kStatsWords, "certificate",
                              {{"drawn", CountText(certificate.drawn)},
                               {"firings", CountText(certificate.firings)},
                               {"certificate", CertificateText(certificate)},
                               {"without", without > 0.0 ? ShortText(without) : ""}});
  for (std::string& line : section.paragraphs) line.erase(0, line.find_first_not_of(' '));
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
