#pragma once

#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/point_table.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// Where x, y and z are stored as float64 and the middle of the points lies more than 10 km from 0,
/// as in a national grid, takes the positions from a whole kilometre near them:
/// RecordedFrame::origin_m. As float32 they would be rounded to 0.5 m at 5000 km. Leaves range_m as
/// it is.
/// @pre The frame has the positions as stored; slots without a point have NaN.
void TakeFromNearOrigin(const PointTable& table, const SlotPlan& plan, RecordedFrame& recorded);

}  // namespace railcast
