#pragma once

#include "core/frame/labels.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// What a recording's label numbers mean: by its own table, or by the labels.json that lies with
/// its files. That is in the directory or beside the file, or beside the frames/ that it is or lies
/// in; of KITTI's clouds up to beside sequences/00/velodyne/. Empty if there is none.
/// @throws InputError with one line if the labels.json is damaged.
[[nodiscard]] LabelTable LabelsOf(const RecordingInfo& info);

}  // namespace railcast
