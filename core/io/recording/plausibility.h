#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/io/cloud/cloud.h"
#include "railcast/io/recording.h"

namespace railcast {

// Whether values can be what they are said to be. A wrong layout, byte order or unit shows in them.

/// Whether the positions of a cloud can be metres: 99 % of the points are less than 10 km from 0,
/// or all of them lie together farther away, as in a national grid. Points that are not finite, or
/// 0, are none.
/// Nor can they be polar: a range that is never below 0, an azimuth that fills a whole turn, in deg
/// or rad, and an elevation of few values, in any order.
/// @return Remarks of those few that are farther than 10 km away, and of a cloud of 100 points or
///   more that is within 0.1 m.
/// @throws InputError "name: x, y, z: rule (got value)" if they cannot.
/// @pre The cloud has x, y and z (FindFieldOf()).
[[nodiscard]] std::vector<Remark> CheckPositions(const Cloud& cloud, const std::string& name);

/// Leaves out the times of points, with a remark, if these are all around the sensor and their
/// times within less than any turn takes: the unit is another, or the clock stands still.
void LeaveOutUnlikelyTimes(RecordedFrame& recorded);

/// What is wrong with the intensities of a cloud, if it has any; empty if 99 % of them can be such.
[[nodiscard]] std::string FaultOfIntensities(const Cloud& cloud);

/// A remark (RemarkKind::kFarReturns) if the frame has returns beyond the sensor's range. Of
/// captures, whose packets state the unit, and of railcast's own sequences there is nothing to
/// doubt.
/// @throws InputError "NAME: range_m: rule (got value)" if more than 1 % of the returns of others
/// are.
[[nodiscard]] std::optional<Remark> CheckRanges(const RecordedFrame& recorded,
                                                const RecordingInfo& info,
                                                double range_max_m);

/// Remarks (RemarkKind::kFarReturns) on a cloud whose rows are those of a spinning sensor that
/// railcast knows, within 0.1 deg, and which has returns beyond its range. Of other clouds a remark
/// (RemarkKind::kUnitsAssumed) if the median of their ranges is beyond 300 m, where no sensor has
/// half of its returns.
/// @throws InputError "NAME: range_m: rule (got value)" if more than 10 % of the returns are.
void CheckUnit(RecordedFrame& recorded);

/// @throws InputError "NAME: rule: why" unless it is known where the sensor was among the points.
void NeedRanges(const RecordedFrame& recorded);

/// Tells if more than 1 % of the points have a stored range more than 1 m from their distance to
/// the origin, as when points were moved behind the sensor.
void RemarkOtherRanges(RecordedFrame& recorded);

}  // namespace railcast
