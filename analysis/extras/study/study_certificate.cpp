#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "analysis/extras/study/study_report.h"
#include "analysis/stats/certificate_section.h"

namespace railcast {
namespace {

// Numbers from 1 of all targets that are certified, by name.
std::map<std::string, std::uint32_t> NumbersOfTargets(const std::vector<ApproachRecord>& all) {
  std::map<std::string, std::uint32_t> numbers;
  for (const ApproachRecord& approach : all) {
    if (!approach.certificate) continue;
    for (const auto& [name, instance] : approach.certificate->objects) {
      numbers.emplace(TargetOf(name), 0);
    }
  }
  std::uint32_t number = 0;
  for (auto& [target, its_number] : numbers) its_number = ++number;
  return numbers;
}

}  // namespace

std::optional<RunCertificate> CertificateOfStudy(const StudyResult& result) {
  const auto numbers = NumbersOfTargets(result.approaches);
  CertifySpec spec{.cost_share = result.identity.certify.value_or(0.0)};
  for (const auto& [target, number] : numbers) spec.objects.emplace(number, target);
  CertificateSums sums(std::move(spec));
  std::uint32_t num_frames = 0;
  for (const ApproachRecord& approach : result.approaches) {
    if (!approach.certificate) continue;
    num_frames += approach.certificate->frames;
    // Each approach has instances of its own, of which those of one target are one.
    std::map<std::uint32_t, std::uint32_t> number_of;
    for (const auto& [name, instance] : approach.certificate->objects) {
      number_of[instance] = numbers.at(TargetOf(name));
    }
    FrameCertificate sum = approach.certificate->sum;
    for (DrawnFiring& drawn : sum.drawn) {
      for (CertifiedEcho& echo : drawn.echoes) echo.instance = number_of[echo.instance];
    }
    sums.Add(sum);
  }
  if (num_frames == 0) return std::nullopt;
  // All echoes are those of objects, so that their classes say nothing more.
  RunCertificate certificate = sums.Result({});
  certificate.frames = num_frames;
  certificate.classes.clear();
  return certificate;
}

Section StudyCertificateSection(const std::optional<RunCertificate>& certificate) {
  if (!certificate) return {};
  Section section = MakeCertificateSection(*certificate);
  section.title = "Numerical error on the objects";
  section.paragraphs.insert(section.paragraphs.begin(),
                            "This is about the objects that the study follows: its firings are "
                            "those whose beams may meet "
                            "one of them in a frame that was traced, and only their echoes count.");
  std::erase_if(section.tables,
                [](const Table& table) { return table.key == "certificate_by_class"; });
  for (Table& table : section.tables) table.is_open = true;
  return section;
}

}  // namespace railcast
