#include "core/rail/network/shared_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace railcast {
namespace {

constexpr double kReturn_m = 60.0;
constexpr double kShortestReturn_m = 30.0;

/// Distance of the axes at which both tracks have sleepers of their own (kBearerSpread_m), and that
/// at which the rails behind the frog's nose are whole again (kNoseSpread_m).
constexpr double kOwnSleepers_m = 2.7;
constexpr double kOwnRails_m = 1.7;

/// The first chainage, from one end of a course towards the other one, at which it is so far from
/// the track in which it begins or ends.
double WhereApart_m(const TrackCourse& course,
                    const TrackCourse& track,
                    bool from_end,
                    double apart_m) {
  constexpr double kStep_m = 0.5;
  constexpr double kFarthest_m = 1000.0;  // More than any turnout needs.
  const double length_m = std::min(kFarthest_m, course.end_s_m() - course.begin_s_m());
  const auto chainage_m = [&](double along_m) {
    return from_end ? course.end_s_m() - along_m : course.begin_s_m() + along_m;
  };
  double along_m = 0.0;
  while (along_m < length_m) {
    const double s_m = chainage_m(along_m);
    if (std::abs(course.OffsetAt(s_m).d_m - track.OffsetAt(s_m).d_m) >= apart_m) break;
    along_m += kStep_m;
  }
  return chainage_m(std::min(along_m, length_m));
}

std::vector<SharedPlane> PlanesBetween(const TrackCourse& course,
                                       const TrackCourse& begin,
                                       const TrackCourse& end) {
  double from_s_m = WhereApart_m(course, begin, false, kOwnSleepers_m);
  double to_s_m = WhereApart_m(course, end, true, kOwnSleepers_m);
  if (to_s_m - from_s_m < kShortestReturn_m) {
    from_s_m = WhereApart_m(course, begin, false, kOwnRails_m);
    to_s_m = WhereApart_m(course, end, true, kOwnRails_m);
  }
  // Only tracks too close to be permitted leave less.
  constexpr double kLeast_m = 1.0;
  if (to_s_m - from_s_m < kLeast_m) {
    const double middle_s_m = std::midpoint(from_s_m, to_s_m);
    from_s_m = middle_s_m - 0.5 * kLeast_m;
    to_s_m = middle_s_m + 0.5 * kLeast_m;
  }
  const bool has_room = to_s_m - from_s_m >= 2.0 * kReturn_m;
  return {{begin, from_s_m, has_room ? from_s_m + kReturn_m : to_s_m},
          {end, to_s_m, has_room ? to_s_m - kReturn_m : from_s_m}};
}

}  // namespace

TrackCourse InPlanesOfTurnouts(const TrackCourse& course,
                               const TrackCourse* begin,
                               const TrackCourse* end) {
  if (begin != nullptr && end != nullptr) {
    return course.InPlanes(PlanesBetween(course, *begin, *end));
  }
  if (begin != nullptr) {
    const double from_s_m = WhereApart_m(course, *begin, false, kOwnSleepers_m);
    return course.InPlanes({{*begin, from_s_m, from_s_m + kReturn_m}});
  }
  if (end != nullptr) {
    const double to_s_m = WhereApart_m(course, *end, true, kOwnSleepers_m);
    return course.InPlanes({{*end, to_s_m, to_s_m - kReturn_m}});
  }
  return course;
}

}  // namespace railcast
