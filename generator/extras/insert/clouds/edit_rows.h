#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "generator/extras/insert/clouds/label_numbers.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"

namespace railcast {

/// The rows of a cloud with what was inserted.
struct EditedRows {
  OtherPoints points;
  /// For each row its slot in the frame, or kNoSlot.
  std::vector<std::uint32_t> slots;
};

/// What there is to know of a cloud besides its rows.
struct RowContext {
  const LabelNumbers* labels{};  ///< Null: as the plan's.
  std::string kitti_columns{};   ///< As ParseCloudFile() takes them.
  /// Whether every slot has a row, so that none may be left out or added. Clouds with several rows
  /// of slots, and those in which rows without a point were found, are so in any case.
  bool is_organised{};
};

/// Returns the rows of a frame's cloud with what was inserted. Rows of recorded returns stay as
/// they are but for the values that changed. Lost returns are left out, or in an organised cloud
/// marked as it marks the absence of a point. Those that were added follow the returns of the
/// firings before theirs, in the cloud's own order; fields that railcast does not know are NaN or
/// 0.
/// @param cloud That the entries of `firings` belong to.
/// @throws InputError "NAME: rule" if the cloud has no place for a return.
[[nodiscard]] EditedRows EditRows(const Cloud& cloud,
                                  const RecordedFirings& firings,
                                  const InsertedFrame& inserted,
                                  const RowContext& context);

/// The slots of the points of a cloud that was not edited, in its order; kNoSlot for those that
/// belong to none.
[[nodiscard]] std::vector<std::uint32_t> SlotsOfEntries(const RecordedFirings& firings);

}  // namespace railcast
