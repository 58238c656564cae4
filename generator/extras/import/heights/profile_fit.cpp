#include "generator/extras/import/heights/profile_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/rail/line/piecewise_linear.h"
#include "generator/extras/import/heights/knot_fit.h"

namespace railcast {
namespace {

/// What one more knot, a place and a height, must lower the sum of losses by: twice the price of a
/// parameter of the plan.
constexpr double kKnotPrice = 20.0;
/// A change is fitted with this many knots on either side.
constexpr std::size_t kKnotReach = 4;
constexpr double kFirstSpacing_m = 100.0;
constexpr double kNearestKnots_m = 20.0;
/// Vertical curves still grow a little when heights are fitted to the line that has them.
constexpr double kRoom = 1.05;
constexpr double kGradientSteps_per_permil = 1e6;
constexpr double kChainageSteps_per_m = 1e3;

/// A profile that is being fitted.
class ProfileDraft {
 public:
  ProfileDraft(std::span<const HeightSample> samples, const ProfilePrior& prior);

  /// Removes and moves knots until nothing gains.
  void Simplify() {
    constexpr int kMostRounds = 8;
    for (int round = 0; round < kMostRounds; ++round) {
      const bool has_removed = RemoveAll();
      if (!has_removed && round > 0) return;
      if (!MoveAll()) return;
    }
  }

  /// Removes knots until the vertical curve at each has the room it needs.
  void MakeRoom() {
    while (knots_.size() > 2) {
      std::optional<std::size_t> worst;
      double worst_lack_m = 0.0;
      for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
        for (const std::size_t other : {i - 1, i + 1}) {
          const bool is_end = other == 0 || other + 1 == knots_.size();
          const double needed_m = kRoom * (is_end ? 0.5 : 1.0) * CurveLength_m(i);
          const double lack_m = needed_m - std::abs(knots_[other].s_m - knots_[i].s_m);
          if (lack_m <= worst_lack_m) continue;
          worst_lack_m = lack_m;
          // The one of the two that matters less goes.
          worst = is_end || GainWithout(i) >= GainWithout(other) ? i : other;
        }
      }
      if (!worst) return;
      Remove(*worst);
    }
  }

  /// One knot in place of knot `first` and the next one, where the gradients before and behind both
  /// meet, if these are the beginning and the end of what may be one vertical curve.
  [[nodiscard]] std::optional<ProfileDraft> Merged(std::size_t first) const {
    if (first == 0 || first + 2 >= knots_.size()) return std::nullopt;
    const Knot& begin = knots_[first];
    const Knot& end = knots_[first + 1];
    const double before = GradientAfter(knots_, first - 1);
    const double after = GradientAfter(knots_, first + 1);
    const double s_m =
        (end.z_m - begin.z_m + before * begin.s_m - after * end.s_m) / (before - after);
    if (!(s_m >= begin.s_m && s_m <= end.s_m)) return std::nullopt;
    constexpr double kLongest = 1.5;  // Times the needed length.
    const double needed_m =
        NeededVerticalRadius_m(prior_->speed_kmph(s_m)) * std::abs(after - before);
    if (end.s_m - begin.s_m > kLongest * needed_m + kNearestKnots_m) return std::nullopt;
    ProfileDraft merged = *this;
    merged.knots_[first] = {s_m, begin.z_m + before * (s_m - begin.s_m)};
    merged.knots_.erase(merged.knots_.begin() + static_cast<std::ptrdiff_t>(first) + 1);
    return merged;
  }

  /// Fits all heights to others than those of the beginning.
  void FitHeights(std::span<const HeightSample> samples) {
    KnotWindow whole{knots_, samples};
    whole.Fit(prior_->sigma_m);
    knots_ = std::move(whole.knots);
  }

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }
  /// Length of the vertical curve at a knot; 0 at the ends.
  [[nodiscard]] double CurveLength_m(std::size_t knot) const {
    if (knot == 0 || knot + 1 == knots_.size()) return 0.0;
    return NeededVerticalRadius_m(prior_->speed_kmph(knots_[knot].s_m)) *
           std::abs(GradientAfter(knots_, knot) - GradientAfter(knots_, knot - 1));
  }

 private:
  [[nodiscard]] KnotWindow WindowAbout(std::size_t knot) const {
    const std::size_t first = knot >= kKnotReach ? knot - kKnotReach : 0;
    const std::size_t last = std::min(knots_.size() - 1, knot + kKnotReach);
    KnotWindow window;
    window.knots.assign(knots_.begin() + static_cast<std::ptrdiff_t>(first),
                        knots_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    window.has_fixed_begin = first > 0;
    window.has_fixed_end = last + 1 < knots_.size();
    const auto begin =
        std::ranges::lower_bound(samples_, knots_[first].s_m, {}, &HeightSample::s_m);
    const auto end = std::ranges::upper_bound(samples_, knots_[last].s_m, {}, &HeightSample::s_m);
    window.samples = {begin, end};
    return window;
  }

  [[nodiscard]] double CostWithout(std::size_t knot) const;
  /// What removing a knot gains.
  [[nodiscard]] double GainWithout(std::size_t knot) const {
    KnotWindow before = WindowAbout(knot);
    KnotWindow after = before;
    const std::size_t at = std::min(knot, kKnotReach);
    after.knots.erase(after.knots.begin() + static_cast<std::ptrdiff_t>(at));
    return kKnotPrice + before.Fit(prior_->sigma_m) - after.Fit(prior_->sigma_m);
  }

  void Remove(std::size_t knot) {
    KnotWindow window = WindowAbout(knot);
    const std::size_t num_before = window.knots.size();
    const std::size_t at = std::min(knot, kKnotReach);
    window.knots.erase(window.knots.begin() + static_cast<std::ptrdiff_t>(at));
    window.Fit(prior_->sigma_m);
    Replace(knot, window, num_before);
  }

  bool RemoveAll() {
    std::vector<std::optional<double>> gains(knots_.size());
    bool has_removed = false;
    while (knots_.size() > 2) {
      std::size_t best = 0;
      for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
        if (!gains[i]) gains[i] = GainWithout(i);
        if (best == 0 || *gains[i] > *gains[best]) best = i;
      }
      if (!(*gains[best] > 0.0)) break;
      Remove(best);
      has_removed = true;
      gains.erase(gains.begin() + static_cast<std::ptrdiff_t>(best));
      // The knots whose windows touch the one that was fitted anew.
      const std::size_t first = best > 2 * kKnotReach ? best - 2 * kKnotReach : 0;
      for (std::size_t i = first; i < std::min(gains.size(), best + 2 * kKnotReach); ++i) {
        gains[i].reset();
      }
    }
    return has_removed;
  }

  bool Move(std::size_t knot, double step_m) {
    const double to_m = knots_[knot].s_m + step_m;
    if (to_m < knots_[knot - 1].s_m + kNearestKnots_m ||
        to_m > knots_[knot + 1].s_m - kNearestKnots_m) {
      return false;
    }
    KnotWindow before = WindowAbout(knot);
    KnotWindow after = before;
    after.knots[std::min(knot, kKnotReach)].s_m = to_m;
    constexpr double kLeastGain = 1e-6;
    if (!(before.Fit(prior_->sigma_m) - after.Fit(prior_->sigma_m) > kLeastGain)) return false;
    Replace(knot, after, after.knots.size());
    return true;
  }

  bool MoveAll() {
    constexpr double kLongestStep_m = 64.0;
    constexpr double kShortestStep_m = 1.0;
    constexpr int kMostMoves = 10;  // Most moves of one knot at one step.
    bool has_moved = false;
    for (double step_m = kLongestStep_m; step_m >= kShortestStep_m; step_m *= 0.5) {
      for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
        for (const double signed_m : {step_m, -step_m}) {
          int num_moves = 0;
          while (num_moves < kMostMoves && Move(i, signed_m)) ++num_moves;
          has_moved = has_moved || num_moves > 0;
          if (num_moves > 0) break;
        }
      }
    }
    return has_moved;
  }

  void Replace(std::size_t knot, const KnotWindow& window, std::size_t num_before) {
    const std::size_t first = knot >= kKnotReach ? knot - kKnotReach : 0;
    const auto begin = knots_.begin() + static_cast<std::ptrdiff_t>(first);
    knots_.insert(knots_.erase(begin, begin + static_cast<std::ptrdiff_t>(num_before)),
                  window.knots.begin(), window.knots.end());
  }

  std::span<const HeightSample> samples_;
  const ProfilePrior* prior_;
  std::vector<Knot> knots_;
};

ProfileDraft::ProfileDraft(std::span<const HeightSample> samples, const ProfilePrior& prior)
    : samples_(samples), prior_(&prior), knots_{{0.0, samples.front().z_m}} {
  std::size_t num_since = 0;
  for (const HeightSample& sample : samples) {
    ++num_since;
    if (num_since < 2 || sample.s_m < knots_.back().s_m + kFirstSpacing_m) continue;
    if (sample.s_m > prior.length_m - kFirstSpacing_m) break;
    knots_.push_back({sample.s_m, sample.z_m});
    num_since = 0;
  }
  knots_.push_back({prior.length_m, samples.back().z_m});
  FitHeights(samples);
}

/// Gradients between knots, rounded for files.
std::vector<ChainageValue> GradientsOf(std::span<const Knot> knots) {
  const auto rounded = [](double value, double steps) { return std::round(value * steps) / steps; };
  std::vector<ChainageValue> gradients_permil;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    gradients_permil.push_back({rounded(knots[i].s_m, kChainageSteps_per_m),
                                rounded(1e3 * GradientAfter(knots, i), kGradientSteps_per_permil)});
  }
  return gradients_permil;
}

/// The gradients as an alignment has them.
SmoothedFunction Smoothed(const Profile& profile, double length_m) {
  std::vector<LinearPiece> pieces;
  for (const ChainageValue& step : profile.gradients_permil) {
    pieces.push_back({step.s_m, 1e-3 * step.value, 1e-3 * step.value});
  }
  return SmoothJumps({std::move(pieces), length_m}, profile.smoothing_m);
}

Profile ProfileOf(const ProfileDraft& draft) {
  constexpr double kShortestSmoothing_m = 1.0;
  Profile profile;
  profile.start_z_m = std::round(draft.knots().front().z_m * 1e4) / 1e4;
  profile.gradients_permil = GradientsOf(draft.knots());
  profile.smoothing_m = kShortestSmoothing_m;
  for (std::size_t i = 0; i < draft.knots().size(); ++i) {
    profile.smoothing_m = std::max(profile.smoothing_m, std::ceil(draft.CurveLength_m(i)));
  }
  return profile;
}

void Measure(std::span<const HeightSample> samples, const ProfilePrior& prior, Profile& profile) {
  const SmoothedFunction smoothed = Smoothed(profile, prior.length_m);
  profile.offsets_m.clear();
  for (const HeightSample& sample : samples) {
    profile.offsets_m.push_back(sample.z_m - profile.start_z_m -
                                smoothed.function.Integral(sample.s_m));
  }
  profile.least_roundness = std::numeric_limits<double>::infinity();
  for (const Jump& jump : smoothed.jumps) {
    const double radius_m = jump.length_m / std::abs(jump.after - jump.before);
    profile.least_roundness = std::min(
        profile.least_roundness, radius_m / NeededVerticalRadius_m(prior.speed_kmph(jump.s_m)));
  }
}

/// The draft with the vertical curves of an alignment, with its heights fitted to that.
Profile WithCurves(ProfileDraft& draft,
                   std::span<const HeightSample> samples,
                   const ProfilePrior& prior) {
  // Curves cut the polyline's corners: samples move by as much.
  constexpr int kNumCorrections = 4;
  for (int correction = 0; correction < kNumCorrections; ++correction) {
    const Profile profile = ProfileOf(draft);
    const SmoothedFunction smoothed = Smoothed(profile, prior.length_m);
    std::vector<HeightSample> moved(samples.begin(), samples.end());
    for (HeightSample& sample : moved) {
      sample.z_m += HeightOn(draft.knots(), sample.s_m) - profile.start_z_m -
                    smoothed.function.Integral(sample.s_m);
    }
    draft.FitHeights(moved);
  }
  Profile profile = ProfileOf(draft);
  Measure(samples, prior, profile);
  return profile;
}

double CostOf(const Profile& profile, double sigma_m) {
  double cost = kKnotPrice * static_cast<double>(profile.gradients_permil.size());
  for (const double offset_m : profile.offsets_m) cost += HeightLoss(offset_m / sigma_m);
  return cost;
}

}  // namespace

double NeededVerticalRadius_m(double speed_kmph) {
  constexpr double kRadius_mPerKmph2 = 0.35;
  return kRadius_mPerKmph2 * speed_kmph * speed_kmph;
}

Profile FitProfile(std::span<const HeightSample> samples, const ProfilePrior& prior) {
  Check(prior.length_m > 0.0, "a line has a length");
  if (samples.size() < 2) {
    Profile level;
    level.start_z_m = samples.empty() ? 0.0 : samples.front().z_m;
    level.gradients_permil = {{0.0, 0.0}};
    level.smoothing_m = AlignmentSpec{}.gradient_smoothing_m;
    Measure(samples, prior, level);
    return level;
  }
  ProfileDraft draft(samples, prior);
  draft.Simplify();
  draft.MakeRoom();
  Profile profile = WithCurves(draft, samples, prior);
  double cost = CostOf(profile, prior.sigma_m);
  for (std::size_t i = 1; i + 2 < draft.knots().size();) {
    std::optional<ProfileDraft> merged = draft.Merged(i);
    if (merged) merged->MakeRoom();
    std::optional<Profile> with_curves;
    if (merged) with_curves = WithCurves(*merged, samples, prior);
    if (!with_curves || CostOf(*with_curves, prior.sigma_m) >= cost) {
      ++i;
      continue;
    }
    draft = *std::move(merged);
    profile = *std::move(with_curves);
    cost = CostOf(profile, prior.sigma_m);
    i = 1;
  }
  return profile;
}

}  // namespace railcast
