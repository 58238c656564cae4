#pragma once

#include <string>

#include "railcast/io/recording.h"
#include "railcast/io/stream.h"

namespace railcast {

/// Makes a frame of a live stream that can be used like those of files.
///
/// The frame is a grid of the sender's shape where nothing was lost and ring and column were sent
/// (and return_index, too, with several returns). It then has every slot's outcome if outcomes were
/// sent, and otherwise states only which slots returned a point. In all other cases the frame is
/// one row of the points that arrived, since a slot without a point could as well have been lost;
/// so it is, too, if the grid would have over 2^20 more slots than points.
///
/// Left-handed axes are made right-handed. Points in the vehicle's or the world's axes stay there,
/// since the stream states neither the mounting nor the origin that was subtracted: has_pose is
/// then false, and range_m is unknown unless it was sent. Both poses of `frame` are the sender's in
/// any case.
/// @param name Names the frame in messages, like RecordedFrame::name.
/// @throws InputError with one line if x, y or z was not sent, a value does not fit its field, or
///   two points claim the same slot.
[[nodiscard]] RecordedFrame MakeLiveFrame(const ReceivedFrame& received, const std::string& name);

}  // namespace railcast
