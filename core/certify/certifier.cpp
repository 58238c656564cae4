#include "core/certify/certifier.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"
#include "core/fidelity/frame_comparison.h"

namespace railcast {
namespace {

// The standard deviations of what is wrong with a firing, as they were found in the scenarios of
// tests/core/certify: only their ratios count, and wrong ones cost nothing but precision.
constexpr double kInnerScatter = 0.2;
constexpr double kEdgeScatter = 0.45;
constexpr double kVagueScatter = 0.5;
// Not that they are wrong more often, but they are what users ask about, and few.
constexpr double kObjectScatter = 0.6;
constexpr double kLostScatter = 0.25;  // Nothing came back, though there is something.
constexpr double kNothingScatter = 0.05;
// Their mean over the firings of a usual frame.
constexpr double kMeanScatter = 0.25;

constexpr const char* kVagueLabels[] = {"grass",          "tree",    "bush", "contact_wire",
                                        "messenger_wire", "dropper", "fence"};

// The places of 0.1 mm and of a thousandth suffice, and are short in a file.
double ToPlaces(float value, double per_unit) {
  return std::round(static_cast<double>(value) * per_unit) / per_unit;
}

CertifiedEcho EchoOf(EchoVerdict verdict, const Frame& frame, std::size_t slot) {
  return {.verdict = verdict,
          .label = frame.label[slot],
          .instance = frame.instance[slot],
          .range_m = ToPlaces(frame.true_range_m[slot], 1e3)};
}

// Echoes of surfaces on either side; those of clutter may match, but are not counted.
std::vector<CertifiedEcho> Compare(const Frame& reference,
                                   const Frame& other,
                                   std::size_t firing,
                                   float match_distance_m) {
  const FiringEchoes theirs(reference, firing);
  const FiringEchoes ours(other, firing);
  const auto matches = MatchEchoes(theirs.ranges_m, ours.ranges_m, match_distance_m);
  std::vector<CertifiedEcho> echoes;
  for (std::size_t i = 0; i < theirs.slots.size(); ++i) {
    const std::size_t slot = theirs.slots[i];
    if (!IsSurfaceEcho(reference, slot)) continue;
    const auto match = std::ranges::find(matches, i, &std::pair<std::size_t, std::size_t>::first);
    CertifiedEcho& echo = echoes.emplace_back(EchoOf(EchoVerdict::kMissed, reference, slot));
    if (match == matches.end()) continue;
    const std::size_t found = ours.slots[match->second];
    echo.verdict = EchoVerdict::kFound;
    echo.range_error_m = ToPlaces(std::abs(other.range_m[found] - reference.range_m[slot]), 1e4);
    const float power = other.power_ratio[found] / reference.power_ratio[slot];
    if (std::isfinite(power)) echo.power = ToPlaces(power, 1e3);
    echo.has_other_label = other.label[found] != reference.label[slot];
  }
  for (std::size_t k = 0; k < ours.slots.size(); ++k) {
    const std::size_t slot = ours.slots[k];
    const bool is_found =
        std::ranges::any_of(matches, [k](const auto& m) { return m.second == k; });
    if (IsSurfaceEcho(other, slot) && !is_found) {
      echoes.push_back(EchoOf(EchoVerdict::kFalse, other, slot));
    }
  }
  return echoes;
}

VerdictCounts CountsOf(const std::vector<CertifiedEcho>& echoes) {
  VerdictCounts counts;
  for (const CertifiedEcho& echo : echoes) {
    if (echo.verdict == EchoVerdict::kFound) ++counts.found;
    if (echo.verdict == EchoVerdict::kMissed) ++counts.missed;
    if (echo.verdict == EchoVerdict::kFalse) ++counts.wrong;
  }
  return counts;
}

/// Counts the firings of a frame by strata. A map would take as long as the trace does.
class StrataCounter {
 public:
  void Count(std::uint32_t label, std::uint8_t kind) {
    // Neighbours mostly have one label, and a frame some ten.
    if (label != label_) FindLabel(label);
    ++counts_[first_ + kind];
  }
  [[nodiscard]] std::vector<StratumCount> Strata() const {
    std::vector<StratumCount> strata;
    for (std::uint32_t place = 0; place < counts_.size(); ++place) {
      if (counts_[place] == 0) continue;
      strata.push_back({StratumOf(labels_[place / kNumStratumKinds], place % kNumStratumKinds),
                        counts_[place], 0.0});
    }
    return strata;
  }

 private:
  void FindLabel(std::uint32_t label) {
    const auto at = std::ranges::find(labels_, label);
    first_ = static_cast<std::size_t>(at - labels_.begin()) * kNumStratumKinds;
    label_ = label;
    if (at != labels_.end()) return;
    labels_.push_back(label);
    counts_.resize(labels_.size() * kNumStratumKinds);
  }

  std::vector<std::uint32_t> labels_;
  std::vector<std::uint64_t> counts_;
  std::optional<std::uint32_t> label_;  ///< The last one, whose counters begin at ...
  std::size_t first_ = 0;
};

/// Draws cells, each with one probability, in their order: from one to the next, the distance is
/// geometrically distributed, so that those in between cost nothing.
class CellDraws {
 public:
  CellDraws(std::uint64_t seed, std::uint32_t frame, double probability)
      : seed_(seed), frame_(frame), log_not_(std::log1p(-probability)) {}

  /// The next cell, and a number in [0, 1) of its own; may be beyond the last one.
  struct Draw {
    double cell{};
    double number{};
  };
  [[nodiscard]] Draw Next() {
    const auto words = RandomWords(seed_, RandomUse::kCertificate, frame_, num_++);
    const double u = (static_cast<double>(words[0]) + 0.5) * 0x1p-32;
    // With probability 1, log_not_ is minus infinity, and the distance 0.
    cell_ += 1.0 + std::floor(std::log(u) / log_not_);
    return {cell_, static_cast<double>(words[1]) * 0x1p-32};
  }
  /// Passes over what is before a cell, at no cost if every cell is drawn.
  void SkipTo(std::uint32_t cell) {
    if (!std::isinf(log_not_)) return;
    num_ = cell;
    cell_ = static_cast<double>(cell) - 1.0;
  }

 private:
  std::uint64_t seed_;
  std::uint32_t frame_;
  double log_not_;
  std::uint32_t num_ = 0;
  double cell_ = -1.0;
};

// Draws firings of a frame, or of a region of it, with the probabilities of their strata.
// @param kinds Of all firings, or of those of the region.
void DrawFirings(std::uint64_t seed,
                 const Frame& frame,
                 const CertifiedRegion* region,
                 const std::vector<std::uint8_t>& kinds,
                 FrameCertificate& certificate) {
  double most = 0.0;
  for (const StratumCount& stratum : certificate.strata) most = std::max(most, stratum.probability);
  const double num_cells = static_cast<double>(frame.rows) * static_cast<double>(frame.columns);
  CellDraws draws(seed, frame.index, most);
  for (auto draw = draws.Next(); draw.cell < num_cells; draw = draws.Next()) {
    const auto cell = static_cast<std::uint32_t>(draw.cell);
    std::size_t place = cell;  // Among the kinds.
    if (region != nullptr) {
      const auto next = std::ranges::lower_bound(region->cells, cell);
      if (next == region->cells.end()) return;
      place = static_cast<std::size_t>(next - region->cells.begin());
      if (*next > cell) {
        draws.SkipTo(*next);
        continue;
      }
    }
    const Stratum stratum = StratumOf(frame.label[std::size_t{cell} * frame.returns], kinds[place]);
    const auto at =
        std::ranges::find(certificate.strata, stratum, [](const Stratum& each) { return each; });
    if (draw.number * most >= at->probability) continue;
    DrawnFiring& drawn = certificate.drawn.emplace_back();
    drawn.cell = cell;
    drawn.stratum = static_cast<std::uint32_t>(at - certificate.strata.begin());
  }
}

}  // namespace

std::optional<double> CertifiedShareOf(const std::string& text) {
  if (text == "off") return std::nullopt;
  const bool has_percent = text.ends_with('%');
  const auto percent =
      has_percent ? ParseNumber<double>(text.substr(0, text.size() - 1)) : std::nullopt;
  if (percent && *percent > 0.0 && *percent <= kMostCertifiedPercent) return *percent / 100.0;
  throw InputError("--certify: must be off, or a share of the frames' time such as 1% (got " +
                   ShownText(text) + ")");
}

double NumCertified(const ScenarioSpec& scenario,
                    const DetectorSpec& own,
                    std::size_t num_firings,
                    double cost_share) {
  const double frame = InstructionsPerFiring(own.effects, own.beam);
  double drawn =
      frame + InstructionsPerFiring(EffectsAt(Fidelity::kReference, scenario), scenario.lidar.beam);
  for (const RungBeside& rung : RungsBeside(scenario, own)) drawn += rung.cost * frame;
  return cost_share * static_cast<double>(num_firings) * frame / drawn;
}

Certifier::Certifier(const ScenarioSpec& scenario, double cost_share, Simulator& simulator)
    : Certifier(scenario,
                cost_share,
                simulator.spec().detector,
                simulator.pattern().num_firings(),
                simulator.world()) {
  simulator.UseVariants(variants_);
}

Certifier::Certifier(const ScenarioSpec& scenario,
                     double cost_share,
                     const DetectorSpec& own,
                     std::size_t num_firings,
                     const World& world)
    : seed_(own.seed),
      match_distance_m_(static_cast<float>(0.5 * PulseLength_m(scenario.lidar.beam))),
      rungs_(RungsBeside(scenario, own)) {
  if (own.effects.dense_footprint) {
    throw InputError(
        "--certify: must not be given at fidelity reference, against which it compares");
  }
  num_expected_ = NumCertified(scenario, own, num_firings, cost_share);
  probability_per_scatter_ = num_expected_ / static_cast<double>(num_firings) / kMeanScatter;
  const LabelTable labels(scenario.labels);
  for (const char* name : kVagueLabels) {
    if (const Label* label = labels.Find(name)) vague_labels_.insert(label->id);
  }
  for (const SceneObject& object : world.objects()) object_labels_.insert(object.label);
  const int rays = own.beam.footprint_rays;
  variants_ = {{.effects = WithoutRangeErrors(EffectsAt(Fidelity::kReference, scenario)),
                .footprint_rays = rays,
                .has_full_detail = true},
               {WithoutRangeErrors(own.effects), rays}};
  for (const RungBeside& rung : rungs_) variants_.push_back(rung.variant);
}

double Certifier::ScatterOf(const Stratum& stratum) const {
  double scatter = stratum.has_return ? kInnerScatter : kLostScatter;
  if (object_labels_.contains(stratum.label)) {
    scatter = kObjectScatter;
  } else if (vague_labels_.contains(stratum.label)) {
    scatter = kVagueScatter;
  } else if (stratum.is_edge) {
    scatter = kEdgeScatter;
  } else if (stratum.label == 0) {
    scatter = kNothingScatter;
  }
  return scatter;
}

FrameCertificate Certifier::Certify(Simulator& simulator,
                                    BegunFrame& begun,
                                    const Frame& frame,
                                    const CertifiedRegion* region) const {
  return Certify(frame, region, [&](std::span<const std::uint32_t> cells, std::span<Frame> frames) {
    simulator.ScanFirings(begun, cells, frames);
  });
}

FrameCertificate Certifier::Certify(const Frame& frame,
                                    const CertifiedRegion* region,
                                    const ScanFirings& scan) const {
  const std::vector<std::uint8_t> kinds = region == nullptr ? StratumKindsOf(frame, EdgesOf(frame))
                                                            : StratumKindsAt(frame, region->cells);
  StrataCounter counter;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::size_t cell = region == nullptr ? i : region->cells[i];
    counter.Count(frame.label[cell * frame.returns], kinds[i]);
  }
  FrameCertificate certificate{counter.Strata(), {}};
  double per_scatter = probability_per_scatter_;
  if (region != nullptr && region->num_wanted) {
    double scatters = 0.0;
    for (const StratumCount& stratum : certificate.strata) {
      scatters += ScatterOf(stratum) * static_cast<double>(stratum.firings);
    }
    if (scatters > 0.0) per_scatter = *region->num_wanted / scatters;
  }
  for (StratumCount& stratum : certificate.strata) {
    stratum.probability = std::min(ScatterOf(stratum) * per_scatter, 1.0);
  }
  DrawFirings(seed_, frame, region, kinds, certificate);
  std::vector<std::uint32_t> cells;
  for (const DrawnFiring& drawn : certificate.drawn) cells.push_back(drawn.cell);
  if (cells.empty()) return certificate;
  std::vector<Frame> frames(variants_.size());
  scan(cells, frames);
  const auto compare = [&](const Frame& other, std::size_t i) {
    std::vector<CertifiedEcho> echoes = Compare(frames[0], other, i, match_distance_m_);
    if (region == nullptr || region->instances.empty()) return echoes;
    std::erase_if(echoes, [&](const CertifiedEcho& echo) {
      return !region->instances.contains(echo.instance);
    });
    return echoes;
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    DrawnFiring& drawn = certificate.drawn[i];
    drawn.echoes = compare(frames[1], i);
    for (std::size_t k = 2; k < frames.size(); ++k) {
      drawn.rungs.push_back(CountsOf(compare(frames[k], i)));
    }
  }
  return certificate;
}

}  // namespace railcast
