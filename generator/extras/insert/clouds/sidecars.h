#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/extras/insert/insert_record.h"
#include "generator/extras/insert/clouds/edit_rows.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/extras/insert/insert_plan.h"

namespace railcast {

/// What became of a point of a cloud, as points/NNNNNN.npy says it.
enum class PointChange : std::uint8_t {
  kKept = 0,     ///< As it was recorded.
  kWeaker = 1,   ///< Recorded, with another intensity.
  kAdded = 2,    ///< Not recorded.
  kRemoved = 3,  ///< A place of an organised cloud whose recorded point is lost.
  kNone = 4,     ///< A place of an organised cloud without a point, as it was recorded.
};

/// The files of a frame that say what was changed, relative to the folder of the run:
/// points/NNNNNN.npy (a structured NumPy array with a row for each point of the output's cloud, in
/// its order), added/NNNNNN.pcd and removed/NNNNNN.pcd (clouds of these points alone; none if there
/// are none).
/// @param slots WrittenFrame::slots.
[[nodiscard]] std::vector<FrameFile> SidecarFiles(const RecordedFirings& firings,
                                                  const InsertedFrame& inserted,
                                                  const std::vector<std::uint32_t>& slots,
                                                  const LabelNumbers& labels,
                                                  std::uint32_t frame);

/// The frame's line in insert.jsonl, but for its files and the hash of its other lines.
[[nodiscard]] InsertRecord InsertEntry(const RecordedFirings& firings,
                                       const InsertedFrame& inserted,
                                       const InsertPlan& plan,
                                       std::uint32_t frame);

}  // namespace railcast
