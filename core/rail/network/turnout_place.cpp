#include "core/rail/network/turnout_place.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/rail/network/branch_course.h"

namespace railcast {

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
