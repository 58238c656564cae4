#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <string>

#include "core/base/text.h"
#include "core/certify/certified_figures.h"
#include "core/certify/certifier.h"
#include "core/fidelity/sample_frames.h"
#include "generator/check/check_report.h"

namespace railcast {
namespace {

constexpr int kNumFrames = 50;
constexpr int kNumSampled = 3;
constexpr double kNumSampleFirings = 500.0;

RunCertificate SampledCertificate(const ScenarioSpec& scenario,
                                  double cost_share,
                                  Simulator& simulator) {
  const Certifier certifier(scenario, cost_share, simulator);
  CertificateSums sums({.cost_share = cost_share, .rungs = certifier.rungs()});
  Frame frame;
  const std::uint32_t last = LastFrameOfRun(scenario, simulator, kNumSampled);
  for (const std::uint32_t index : SpreadFrames(last, kNumSampled)) {
    const auto begun = simulator.Begin(index);
    simulator.Scan(*begun, frame);
    sums.Add(certifier.Certify(simulator, *begun, frame));
  }
  return sums.Result(LabelTable(scenario.labels));
}

}  // namespace

std::string CertificateBudgetText(const ScenarioSpec& scenario,
                                  double cost_share,
                                  Simulator& simulator) {
  const double num_a_frame = Certifier(scenario, cost_share, simulator).num_expected();
  const double sampled_share = cost_share * kNumSampleFirings / (kNumSampled * num_a_frame);
  RunCertificate sampled = SampledCertificate(scenario, sampled_share, simulator);
  std::ostringstream text;
  text << std::setprecision(3) << "--certify " << 100.0 * cost_share << "% makes about "
       << num_a_frame << " firings of each frame anew";
  if (const auto& missed = sampled.all.missed) {
    // Intervals narrow with the root of the number of firings.
    const double half = (*missed->high - missed->low) / 2.0;
    const double of_run =
        half * std::sqrt(static_cast<double>(sampled.drawn) / (kNumFrames * num_a_frame));
    text << ": " << kNumFrames << " frames would know the share of missed echoes to +-"
         << std::setprecision(2) << 100.0 * std::min(of_run, 1.0) << " points";
  }
  sampled.cost_share = 0.0;  // It is no run of which more could be asked.
  std::string lines = ReportLine("certified", text.str());
  std::istringstream sampled_lines(CertificateText(sampled));
  for (std::string line; std::getline(sampled_lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    lines += ReportLine("", line.substr(std::min(begin, line.size())));
  }
  return lines;
}

}  // namespace railcast
