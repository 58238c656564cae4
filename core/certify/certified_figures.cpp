#include "core/certify/certified_figures.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>

#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/scenario/archive.h"

namespace railcast {
namespace {

/// The numbers of the drawn firings, by their numbers.
struct PerFiring {
  explicit PerFiring(std::size_t num) : found(num), missed(num), wrong(num), other_label(num) {}
  std::vector<double> found, missed, wrong, other_label;

  [[nodiscard]] std::vector<double> Sum(const std::vector<double>& a) const {
    std::vector<double> sum = found;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += a[i];
    return sum;
  }
};

// Whether the interval of a figure is within a limit, beyond it, or neither.
enum class Side { kWithin, kBeyond, kOpen };
Side SideOf(const std::optional<CertifiedFigure>& figure, double limit) {
  if (!figure) return Side::kOpen;
  if (figure->low > limit) return Side::kBeyond;
  return figure->high && *figure->high <= limit ? Side::kWithin : Side::kOpen;
}

// Whether the figures of all quantities are within a tolerance, one of them is beyond it, or
// neither.
Side SideOf(const CertifiedPart& part, const ToleranceSpec& tolerance) {
  const Side sides[] = {SideOf(part.missed, tolerance.missed_share),
                        SideOf(part.wrong, tolerance.false_share),
                        SideOf(part.range_p50_m, tolerance.range_m)};
  Side all = Side::kWithin;
  for (const Side side : sides) {
    if (side == Side::kBeyond) return side;
    if (side == Side::kOpen) all = side;
  }
  return all;
}

std::string RangeName(std::uint32_t bin) {
  constexpr std::uint32_t kNumEnds = std::size(kStratumEnds_m);
  if (bin == kNumEnds) return "beyond " + NumberText(kStratumEnds_m[kNumEnds - 1]) + " m";
  const std::string begin = bin == 0 ? "0" : NumberText(kStratumEnds_m[bin - 1]);
  return begin + " to " + NumberText(kStratumEnds_m[bin]) + " m";
}

std::string RoundedText(double value, int num_digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(num_digits) << value;
  return text.str();
}

std::string ShareText(const CertifiedFigure& figure) {
  const auto percent = [](double share) { return RoundedText(100.0 * share, 1); };
  return percent(figure.value) + " % (" + percent(figure.low) + " to " +
         percent(figure.high.value_or(1.0)) + ")";
}

// Up to one significant digit: 30 of 21.7.
double RoundedUp(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)));
  return std::ceil(value / unit * (1.0 - 1e-9)) * unit;
}

// What would tell the share of missed echoes to five points, if this certificate does not; an
// interval narrows with the root of the number of firings.
std::string WhatWouldTell(const RunCertificate& certificate) {
  constexpr double kWanted = 0.05;         // Half an interval.
  constexpr double kEchoesWanted = 400.0;  // With so many, an unknown share is known as well.
  if (!(certificate.cost_share > 0.0) || certificate.firings == 0) return "";
  const auto& missed = certificate.all.missed;
  const double half = missed ? 0.5 * (missed->high.value_or(1.0) - missed->low) : 1.0;
  if (half <= kWanted) return "";
  const auto drawn = static_cast<double>(certificate.drawn);
  const double times =
      missed ? std::pow(half / kWanted, 2)
             : kEchoesWanted / std::max(static_cast<double>(certificate.all.echoes), 1.0);
  const double percent = RoundedUp(100.0 * times * certificate.cost_share);
  if (times * std::max(drawn, 1.0) > static_cast<double>(certificate.firings) ||
      percent > kMostCertifiedPercent) {
    return "  only more frames would tell the share of missed echoes to +-5 points\n";
  }
  return "  --certify " + NumberText(percent) +
         "% would tell the share of missed echoes to +-5 points\n";
}

std::string MillimetresText(const CertifiedFigure& figure) {
  const auto mm = [](double metres) { return RoundedText(1e3 * metres, 1); };
  return mm(figure.value) + " mm (" + mm(figure.low) +
         (figure.high ? " to " + mm(*figure.high) : " and more") + ")";
}

}  // namespace

void Describe(Archive& a, CertifiedFigure& s) {
  a.Required("value", s.value, "The estimate.");
  a.Required("low", s.low, "Lower end of the 95 % interval.");
  a.Optional("high", s.high, "Upper end; left out where too little was drawn to tell.");
}

void Describe(Archive& a, CertifiedPart& s) {
  a.Required("name", s.name, "Name of the class, range or object.");
  a.Required("echoes", s.echoes, "Number of the reference's echoes in the drawn firings.");
  a.Optional("missed", s.missed, "Share of the reference's echoes that the run lacks.");
  a.Optional("false", s.wrong, "Share of the run's echoes that the reference lacks.");
  a.Optional("other_label", s.other_label, "Share of the found echoes that have another label.");
  a.Optional("range_p50_m", s.range_p50_m, "Median of the range errors before noise.");
  a.Optional("range_p95_m", s.range_p95_m, "The 95 % quantile of the range errors before noise.");
  a.Optional("power_p50", s.power_p50,
             "Median of the relative errors of the power, without a sign.");
  a.Optional("power_p95", s.power_p95, "The 95 % quantile of the relative errors of the power.");
}

void Describe(Archive& a, CertifiedRung& s) {
  a.Required("name", s.name, "Name of the rung.");
  a.Required("cost", s.cost, "Its cost in multiples of the run's own, by the table of costs.");
  a.Optional("missed", s.missed, "Share of the reference's echoes that the rung lacks.");
  a.Optional("false", s.wrong, "Share of the rung's echoes that the reference lacks.");
}

void Describe(Archive& a, CertifiedTolerance& s) {
  a.Required("frames_within", s.frames_within,
             "Number of frames whose intervals are within the tolerance.");
  a.Required("frames_beyond", s.frames_beyond,
             "Number of frames with an interval beyond the tolerance.");
  a.Required("within", s.is_within,
             "Whether the figures of the whole run are within the tolerance.");
}

void Describe(Archive& a, RunCertificate& s) {
  a.Required("cost_share", s.cost_share,
             "Share of the time that `--certify` gave to certificates.");
  a.Required("frames", s.frames, "Number of certified frames.");
  a.Required("firings", s.firings, "Number of firings in these frames.");
  a.Required("drawn", s.drawn, "Number of firings that were made anew.");
  a.Required("without_drawn", s.without_drawn,
             "Share of the firings in strata of which none was drawn.");
  a.Required("all", s.all, "Figures over all echoes of surfaces.");
  a.Optional("classes", s.classes, "Figures for each label.");
  a.Optional("ranges", s.ranges, "Figures for each bin of range.");
  a.Optional("objects", s.objects, "Figures for each object.");
  a.Optional("rungs", s.rungs,
             "What the neighbouring rungs would have given for the same firings.");
  a.Optional("tolerance", s.tolerance, "Where the tolerance of fidelity `auto` held.");
}

void CertificateSums::Add(const FrameCertificate& frame) {
  ++num_frames_;
  for (const StratumCount& stratum : frame.strata) {
    shares_.AddFirings(stratum, stratum.firings, stratum.probability);
  }
  for (const DrawnFiring& drawn : frame.drawn) {
    shares_.AddDrawn(frame.strata[drawn.stratum]);
    drawn_.push_back(drawn);
  }
  if (!spec_.tolerance) return;
  CertifySpec alone = spec_;
  alone.tolerance.reset();
  CertificateSums of_frame(std::move(alone));
  of_frame.Add(frame);
  const Side side = SideOf(of_frame.PartOfTolerance(), *spec_.tolerance);
  if (side == Side::kWithin) ++num_within_;
  if (side == Side::kBeyond) ++num_beyond_;
}

CertifiedPart CertificateSums::PartOf(std::string name,
                                      const IsOf& is_of,
                                      std::uint64_t least) const {
  PerFiring numbers(drawn_.size());
  std::vector<std::pair<std::size_t, double>> range_errors_m;
  std::vector<std::pair<std::size_t, double>> power_errors;
  CertifiedPart part{.name = std::move(name)};
  std::uint64_t num_found = 0;
  std::uint64_t num_wrong = 0;
  for (std::size_t i = 0; i < drawn_.size(); ++i) {
    for (const CertifiedEcho& echo : drawn_[i].echoes) {
      if (!is_of(echo)) continue;
      if (echo.verdict == EchoVerdict::kFalse) {
        numbers.wrong[i] += 1.0;
        ++num_wrong;
        continue;
      }
      ++part.echoes;
      if (echo.verdict == EchoVerdict::kMissed) {
        numbers.missed[i] += 1.0;
        continue;
      }
      ++num_found;
      numbers.found[i] += 1.0;
      if (echo.has_other_label) numbers.other_label[i] += 1.0;
      if (echo.range_error_m) range_errors_m.emplace_back(i, *echo.range_error_m);
      if (echo.power) power_errors.emplace_back(i, std::abs(*echo.power - 1.0));
    }
  }
  if (part.echoes >= least)
    part.missed = shares_.Share(numbers.missed, numbers.Sum(numbers.missed));
  if (num_found + num_wrong >= least) {
    part.wrong = shares_.Share(numbers.wrong, numbers.Sum(numbers.wrong));
  }
  if (num_found >= least) {
    part.other_label = shares_.Share(numbers.other_label, numbers.found);
    part.range_p50_m = shares_.Quantile(range_errors_m, 0.5);
    part.range_p95_m = shares_.Quantile(range_errors_m, 0.95);
  }
  if (power_errors.size() >= least) {
    part.power_p50 = shares_.Quantile(power_errors, 0.5);
    part.power_p95 = shares_.Quantile(power_errors, 0.95);
  }
  return part;
}

CertifiedPart CertificateSums::PartOfTolerance() const {
  const std::vector<std::uint32_t>& labels = spec_.tolerance_labels;
  return PartOf(
      "all",
      [&](const CertifiedEcho& echo) {
        return labels.empty() || std::ranges::binary_search(labels, echo.label);
      },
      CertifiedPart::kLeastEchoes);
}

CertifiedRung CertificateSums::RungOf(std::size_t i) const {
  PerFiring numbers(drawn_.size());
  for (std::size_t k = 0; k < drawn_.size(); ++k) {
    const VerdictCounts& counts = drawn_[k].rungs.at(i);
    numbers.found[k] = counts.found;
    numbers.missed[k] = counts.missed;
    numbers.wrong[k] = counts.wrong;
  }
  const auto share_of = [&](const std::vector<double>& of) -> std::optional<CertifiedFigure> {
    const std::vector<double> among = numbers.Sum(of);
    if (std::accumulate(among.begin(), among.end(), 0.0) < CertifiedPart::kLeastEchoes) return {};
    return shares_.Share(of, among);
  };
  return {.name = spec_.rungs[i].name,
          .cost = spec_.rungs[i].cost,
          .missed = share_of(numbers.missed),
          .wrong = share_of(numbers.wrong)};
}

RunCertificate CertificateSums::Result(const LabelTable& labels) const {
  RunCertificate result{.cost_share = spec_.cost_share,
                        .frames = num_frames_,
                        .firings = shares_.num_firings(),
                        .drawn = shares_.num_drawn()};
  if (shares_.num_firings() > 0) result.without_drawn = shares_.share_without_drawn();
  result.all = PartOf(
      "all", [](const CertifiedEcho&) { return true; }, CertifiedPart::kLeastEchoes);
  std::set<std::uint32_t> ids;
  std::set<std::uint32_t> bins;
  std::set<std::uint32_t> instances;
  const auto bin_of = [](const CertifiedEcho& echo) {
    return StratumBinOf(static_cast<float>(echo.range_m));
  };
  for (const DrawnFiring& drawn : drawn_) {
    for (const CertifiedEcho& echo : drawn.echoes) {
      ids.insert(echo.label);
      bins.insert(bin_of(echo));
      if (spec_.objects.contains(echo.instance)) instances.insert(echo.instance);
    }
  }
  for (const std::uint32_t id : ids) {
    const Label* const label = labels.Find(id);
    result.classes.push_back(PartOf(label == nullptr ? NumberText(id) : label->name,
                                    [id](const CertifiedEcho& echo) { return echo.label == id; }));
  }
  for (const std::uint32_t bin : bins) {
    result.ranges.push_back(
        PartOf(RangeName(bin), [&](const CertifiedEcho& echo) { return bin_of(echo) == bin; }));
  }
  for (const std::uint32_t instance : instances) {
    result.objects.push_back(PartOf(spec_.objects.at(instance), [&](const CertifiedEcho& echo) {
      return echo.instance == instance;
    }));
  }
  for (std::size_t i = 0; i < spec_.rungs.size(); ++i) result.rungs.push_back(RungOf(i));
  if (spec_.tolerance) {
    result.tolerance = {num_within_, num_beyond_,
                        SideOf(PartOfTolerance(), *spec_.tolerance) == Side::kWithin};
  }
  return result;
}

std::string CertificateText(const RunCertificate& certificate) {
  const CertifiedPart& all = certificate.all;
  std::string text = "certificate: ";
  if (all.missed && all.wrong) {
    text += ShareText(*all.missed) + " of the echoes missed, " + ShareText(*all.wrong) + " false";
  } else {
    text += "too few echoes were drawn to tell";
  }
  if (all.range_p50_m)
    text += ", range errors " + MillimetresText(*all.range_p50_m) + " in the median";
  text += "; " + NumberText(certificate.drawn) + " of " + NumberText(certificate.firings) +
          " firings were made anew on rung reference\n" + WhatWouldTell(certificate);
  for (const CertifiedRung& rung : certificate.rungs) {
    if (!rung.missed || !all.missed) continue;
    text += "  " + rung.name + " would take " + RoundedText(rung.cost, rung.cost < 10.0 ? 2 : 0) +
            " times as long and miss " + ShareText(*rung.missed) + " instead of " +
            ShareText(*all.missed) + "\n";
  }
  if (certificate.tolerance) {
    const auto& [within, beyond, is_within] = *certificate.tolerance;
    text += "  the tolerance held for certain in " + NumberText(within) + " of " +
            NumberText(certificate.frames) + " frames, and did not in " + NumberText(beyond) +
            "; the run as a whole is " + (is_within ? "within it" : "not known to be within it") +
            "\n";
  }
  return text;
}

}  // namespace railcast
