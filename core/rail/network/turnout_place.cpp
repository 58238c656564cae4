#include "core/rail/network/turnout_place.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/network/branch_course.h"
#include "core/rail/network/network.h"

namespace railcast {
namespace {

/// A turnout that ends where its arc does.
TurnoutGeometry ArcToTheEnd(double radius_m, double run) {
  const double angle_rad = std::atan(1.0 / run);
  const double tangent_m = radius_m * std::tan(0.5 * angle_rad);
  return {radius_m, angle_rad, tangent_m, 2.0 * tangent_m};
}

}  // namespace

std::optional<double> ClearChainage_m(const TrackCourse& track,
                                      const TrackCourse& branch,
                                      const TurnoutSite& turnout,
                                      double distance_m) {
  const auto is_clear = [&](double s_m) {
    return std::abs(branch.OffsetAt(s_m).d_m - track.OffsetAt(s_m).d_m) >= distance_m - 1e-9;
  };
  constexpr double kStep_m = 1.0;
  constexpr double kFarthest_m = 1000.0;
  constexpr double kExact_m = 1e-6;
  const double side = turnout.opens_ahead() ? kStep_m : -kStep_m;
  double before_m = turnout.s_m;
  double after_m = turnout.s_m;
  do {
    before_m = after_m;
    after_m += side;
    const bool is_on_both = std::clamp(after_m, branch.begin_s_m(), branch.end_s_m()) == after_m &&
                            std::clamp(after_m, track.begin_s_m(), track.end_s_m()) == after_m;
    if (!is_on_both || std::abs(after_m - turnout.s_m) > kFarthest_m) return std::nullopt;
  } while (!is_clear(after_m));
  while (std::abs(after_m - before_m) > kExact_m) {
    const double middle_m = std::midpoint(before_m, after_m);
    (is_clear(middle_m) ? after_m : before_m) = middle_m;
  }
  return after_m;
}

TurnoutGeometry GeometryOf(TurnoutType type) {
  switch (type) {
    case TurnoutType::k9_190: {
      TurnoutGeometry geometry = ArcToTheEnd(190.0, 9.0);
      geometry.length_m = geometry.tangent_m + ArcToTheEnd(300.0, 9.0).tangent_m;
      return geometry;
    }
    case TurnoutType::k9_300:
      return ArcToTheEnd(300.0, 9.0);
    case TurnoutType::k12_500:
      return ArcToTheEnd(500.0, 12.0);
    case TurnoutType::k14_760:
      return ArcToTheEnd(760.0, 14.0);
  }
  Check(false, "the type is one of the enumeration");
  return {};
}

double TurnoutEnd_m(const TurnoutPlace& place, double s_m) {
  const double side = place.opens_ahead ? 1.0 : -1.0;
  // From its middle on, where the curvature is that inside the turnout.
  const double middle_s_m = s_m + side * 0.5 * place.geometry.length_m;
  const double per_m = place.course.OffsetAt(middle_s_m).curvature_per_m();
  BranchCourse main(place.course, s_m, !place.opens_ahead);
  main.Add(place.geometry.length_m, per_m, per_m);
  return main.end_s_m();
}

std::optional<std::vector<LinearPiece>> CurvatureThrough(const TurnoutPlace& place,
                                                         double s_m,
                                                         WorldFaults& faults) {
  constexpr int kNumSamples = 64;
  constexpr double kSameCurvature_per_m = 1e-7;
  constexpr double kSamePlace_m = 1e-3;
  const double end_s_m = TurnoutEnd_m(place, s_m);
  const auto [least_m, most_m] = std::minmax(s_m, end_s_m);
  const std::string chainage = place.pointer + "/s_m";
  const std::string name = Quoted(place.spec.track);
  if (least_m < place.course.begin_s_m() - kSamePlace_m ||
      most_m > place.course.end_s_m() + kSamePlace_m) {
    faults.Add(chainage,
               "must put the turnout on track " + name + ", " +
                   StretchText(place.course.begin_s_m(), place.course.end_s_m()),
               StretchText(least_m, most_m));
    return std::nullopt;
  }
  double least_per_m = 1e9;
  double most_per_m = -1e9;
  for (int i = 0; i < kNumSamples; ++i) {
    const double at_m = std::lerp(least_m, most_m, (i + 0.5) / kNumSamples);
    const double per_m = place.course.OffsetAt(at_m).curvature_per_m();
    least_per_m = std::min(least_per_m, per_m);
    most_per_m = std::max(most_per_m, per_m);
  }
  if (most_per_m - least_per_m <= kSameCurvature_per_m) {
    const double per_m = 0.5 * (least_per_m + most_per_m);
    return std::vector<LinearPiece>{{0.0, per_m, per_m}};
  }
  std::vector<LinearPiece> pieces;
  const auto curvature_per_m = [&](int sample) {
    return place.course.OffsetAt(std::lerp(s_m, end_s_m, 1.0 * sample / kNumSamples))
        .curvature_per_m();
  };
  for (int i = 0; i < kNumSamples; ++i) {
    pieces.push_back(
        {place.geometry.length_m * i / kNumSamples, curvature_per_m(i), curvature_per_m(i + 1)});
  }
  return pieces;
}

std::string NamesOfTracks(const WorldSpec& world) {
  std::string names;
  for (const TrackSpec& known : world.tracks) {
    names += (names.empty() ? "" : ", ") + Quoted(known.name);
  }
  return names;
}

bool AreNamesKnown(const WorldSpec& world, const WorldFaults& faults) {
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    if (!faults.AreKnown({"/world/tracks/" + std::to_string(i) + "/name"})) return false;
  }
  return true;
}

std::string MetresText(double length_m) {
  return NumberText(std::round(length_m * 1e3) / 1e3);
}

std::string StretchText(double begin_s_m, double end_s_m) {
  return "from " + MetresText(begin_s_m) +
         (std::isinf(end_s_m) ? " m on" : " to " + MetresText(end_s_m) + " m");
}

}  // namespace railcast
