#pragma once

#include "core/io/cloud/point_table.h"
#include "core/io/recording/cloud_fields.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Moves positions far from 0 to an origin near them. Where x, y and z are stored as float64 and
/// the median of the points lies more than 10 km from 0, as in a national grid, the positions are
/// taken from a whole kilometre near them, RecordedFrame::origin_m; as float32 they would otherwise
/// be rounded to 0.5 m at 5000 km. Leaves range_m unchanged.
/// @pre The frame has the positions as stored; slots without a point have NaN.
void TakeFromNearOrigin(const PointTable& table, const SlotPlan& plan, RecordedFrame& recorded);

}  // namespace railcast
