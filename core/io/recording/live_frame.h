#pragma once

#include <string>

#include "core/io/recording/recording.h"
#include "core/io/stream/received_frame.h"

namespace railcast {

/// A frame of a live stream like those of files.
///
/// Where nothing was lost and ring and column were sent (of several returns return_index, too), the
/// frame is a grid of the sender's shape: with every slot's outcome if those were sent, with what
/// returned if not. Else it is one row of the points that arrived, since a slot without a point
/// could as well have been lost; so it is, too, if the grid would have 2^20 more slots than points.
///
/// Left-handed axes are made right-handed. Points in the vehicle's or the world's axes stay there,
/// since the stream says neither the mounting nor the origin that was subtracted: has_pose is false
/// then, and range_m is unknown unless it was sent. Both poses of `frame` are the sender's anyway.
/// @param name For messages, like RecordedFrame::name.
/// @throws InputError with one line if x, y or z was not sent, a value does not fit its field, or
///   two points say that they are of one slot.
[[nodiscard]] RecordedFrame MakeLiveFrame(const ReceivedFrame& received, const std::string& name);

}  // namespace railcast
