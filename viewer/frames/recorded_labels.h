#pragma once

#include "railcast/frame.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Returns the meaning of a recording's label numbers: from its own table, or from a labels.json
/// near its files. That may be in the directory or beside the file, or beside the frames/ that the
/// source is or lies in; for KITTI clouds, up to beside sequences/00/velodyne/. Empty if there is
/// none.
/// @throws InputError with one line if the labels.json is damaged.
[[nodiscard]] LabelTable LabelsOf(const RecordingInfo& info);

}  // namespace railcast
