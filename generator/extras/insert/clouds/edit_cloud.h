#pragma once

#include <string>
#include <vector>

#include "generator/extras/insert/clouds/edit_rows.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Puts what was inserted into the files of a frame: its cloud, and behind it the file of its
/// labels if it has one. Files of frames in which nothing changed stay as they are.
/// @return For each point of the cloud now, in its order, the slot, or kNoSlot.
/// @throws InputError if the files are damaged, or as EditRows() does.
[[nodiscard]] std::vector<std::uint32_t> EditCloud(const RecordedFirings& firings,
                                                   const InsertedFrame& inserted,
                                                   const RowContext& context,
                                                   std::vector<FrameFile>& files);

/// ContentHash() of the files' bytes, one after another.
[[nodiscard]] std::string SourceHash(const std::vector<FrameFile>& files);

}  // namespace railcast
