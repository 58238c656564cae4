#include "generator/extras/import/network/moved_run.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

constexpr double kSampleStep_m = 20.0;
/// So many samples on either side belong to the surroundings of one.
constexpr std::size_t kAbout = 2;
/// Elsewhere, one in so many samples is enough.
constexpr std::size_t kSparse = 3;
/// A point that is nearer to a track lies on it.
constexpr double kOnTrack_m = 1.5;

/// A place of a run, and between which offsets it may be moved.
struct Sample {
  double s_m{};
  double d_m{};
  double least_d_m = -std::numeric_limits<double>::infinity();
  double most_d_m = std::numeric_limits<double>::infinity();
  double raised_m = 0.0;  ///< By so much more than it needs, since the fit came out nearer.

  [[nodiscard]] double Moved_m() const {
    const double least_m = least_d_m + raised_m;
    const double most_m = most_d_m - raised_m;
    if (least_m > most_m) return d_m;
    const double moved_m = std::clamp(d_m, least_m, most_m);
    return std::abs(moved_m - d_m) <= kMovedApart_m + raised_m ? moved_m : d_m;
  }
  [[nodiscard]] bool IsMoved() const { return Moved_m() != d_m; }
};

/// The fit of a run, at its beginning, its end and every 20 m between.
std::vector<Sample> SamplesOf(const RunFit& fit) {
  std::vector<Sample> samples;
  const double length_m = fit.plan.length_m();
  const double num_steps = std::max(1.0, std::ceil(length_m / kSampleStep_m));
  for (double step = 0.0; step <= num_steps; ++step) {
    const PlanPoint at = fit.course.At(length_m * step / num_steps);
    if (samples.empty() || at.x_m > samples.back().s_m) samples.push_back({at.x_m, at.y_m});
  }
  return samples;
}

class RunMoving {
 public:
  RunMoving(const TrackNetwork& network, const TrackRun& run, std::vector<Sample> samples)
      : network_(network), run_(run), samples_(std::move(samples)) {
    for (const TrackDraft& track : network.tracks()) LimitBy(track);
  }

  [[nodiscard]] std::optional<TrackRun> Move() {
    if (std::ranges::none_of(samples_, &Sample::IsMoved)) return std::nullopt;
    // Where the fit rounds a corner, it comes nearer than its points.
    constexpr int kMostRounds = 3;
    for (int round = 1; round < kMostRounds; ++round) {
      if (!RaiseWhereNear(RunFit(Moved(), kMovedSigma_m))) break;
    }
    return Moved();
  }

 private:
  /// Keeps the samples away from a track: each from where it is, those that are too near together
  /// from where they come from and go to.
  void LimitBy(const TrackDraft& track) {
    const auto from_axis_m = [&](std::size_t i) {
      return samples_[i].d_m - track.OffsetNear_m(samples_[i].s_m);
    };
    const auto is_beside = [&](std::size_t i) { return track.Has(samples_[i].s_m); };
    const auto is_near = [&](std::size_t i) {
      return is_beside(i) && std::abs(from_axis_m(i)) < kApart_m;
    };
    for (std::size_t i = 0; i < samples_.size();) {
      if (!is_near(i)) {
        if (is_beside(i)) Limit(i, track, from_axis_m(i));
        ++i;
        continue;
      }
      std::size_t end = i;
      double sum_m = 0.0;
      for (; end < samples_.size() && is_near(end); ++end) sum_m += from_axis_m(end);
      const bool has_before = i > 0 && is_beside(i - 1);
      const bool has_behind = end < samples_.size() && is_beside(end);
      const double before_m = has_before ? from_axis_m(i - 1) : 0.0;
      const double behind_m = has_behind ? from_axis_m(end) : 0.0;
      double side = has_before ? before_m : behind_m;
      if (!has_before && !has_behind) side = sum_m;
      if (before_m * behind_m >= 0.0) {
        for (std::size_t k = i; k < end; ++k) {
          if (!IsWhereItMeets(k, i == 0, end == samples_.size(), track)) Limit(k, track, side);
        }
      }
      i = end;
    }
  }

  /// @param side > 0: it stays on the left of the track.
  void Limit(std::size_t i, const TrackDraft& track, double side) {
    Sample& sample = samples_[i];
    const double axis_m = track.OffsetNear_m(sample.s_m);
    const bool is_near = std::abs(sample.d_m - axis_m) < kApart_m;
    // A track that is a little farther away than needed stays where it is.
    const double apart_m =
        is_near ? kMovedApart_m : std::min(kMovedApart_m, std::abs(sample.d_m - axis_m));
    if (side > 0.0) sample.least_d_m = std::max(sample.least_d_m, axis_m + apart_m);
    if (side < 0.0) sample.most_d_m = std::min(sample.most_d_m, axis_m - apart_m);
  }

  /// Whether a sample is so near to an end of the run, where that lies on the track, that the two
  /// are too near to each other by nature.
  [[nodiscard]] bool IsWhereItMeets(std::size_t i,
                                    bool has_begin,
                                    bool has_end,
                                    const TrackDraft& track) const {
    const auto is_about = [&](const Eigen::Vector2d& point_m) {
      return std::abs(samples_[i].s_m - point_m.x()) < kMeeting_m && IsOn(track, point_m);
    };
    return (has_begin && is_about(run_.points_m.front())) ||
           (has_end && is_about(run_.points_m.back()));
  }

  [[nodiscard]] static bool IsOn(const TrackDraft& track, const Eigen::Vector2d& point_m) {
    return track.Has(point_m.x()) &&
           std::abs(track.OffsetNear_m(point_m.x()) - point_m.y()) < kOnTrack_m;
  }

  [[nodiscard]] TrackRun Moved() const {
    TrackRun moved = run_;
    // Its ends are where tracks meet, unless these are moved, too.
    moved.points_m.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (i % kSparse != 0 && i + 1 != samples_.size() && !IsNearMoved(i)) continue;
      moved.points_m.emplace_back(samples_[i].s_m, samples_[i].Moved_m());
    }
    if (!samples_.front().IsMoved()) moved.points_m.front() = run_.points_m.front();
    if (!samples_.back().IsMoved()) moved.points_m.back() = run_.points_m.back();
    return moved;
  }

  /// @returns Whether anything is to be raised.
  bool RaiseWhereNear(const RunFit& fit) {
    constexpr double kSlack_m = 0.02;
    bool is_raised = false;
    std::vector<double> missing_m(samples_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!IsNearMoved(i)) continue;
      const Sample& sample = samples_[i];
      const Foot foot = FootOn(fit.course, fit.plan.length_m(), {sample.s_m, sample.Moved_m()},
                               sample.s_m - run_.points_m.front().x());
      const PlanPoint at = fit.course.At(foot.s_m);
      const auto near = network_.TrackNear(at.x_m, at.y_m);
      if (!near) continue;
      const double axis_m = network_.tracks()[*near].OffsetNear_m(at.x_m);
      missing_m[i] = kApart_m + kSlack_m - std::abs(at.y_m - axis_m);
      is_raised = true;
    }
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const auto begin = missing_m.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, kAbout));
      const auto end = missing_m.begin() +
                       static_cast<std::ptrdiff_t>(std::min(i + kAbout + 1, missing_m.size()));
      samples_[i].raised_m =
          std::min(kMostRaised_m, samples_[i].raised_m + *std::max_element(begin, end));
    }
    return is_raised;
  }

  /// Whether a sample is moved or is beside one that is.
  [[nodiscard]] bool IsNearMoved(std::size_t i) const {
    const std::size_t end = std::min(i + kAbout + 1, samples_.size());
    for (std::size_t k = i - std::min(i, kAbout); k < end; ++k) {
      if (samples_[k].IsMoved()) return true;
    }
    return false;
  }

  const TrackNetwork& network_;
  const TrackRun& run_;
  std::vector<Sample> samples_;
};

}  // namespace

std::optional<TrackRun> MovedApart(const TrackNetwork& network,
                                   const TrackRun& run,
                                   const RunFit& fit) {
  return RunMoving(network, run, SamplesOf(fit)).Move();
}

}  // namespace railcast
