#pragma once

#include <string>
#include <vector>

#include "generator/insert/inserted_frame.h"
#include "generator/insert/recorded_firings.h"

namespace railcast {

/// Returns a line of objects.jsonl with the objects that were inserted alone.
[[nodiscard]] std::string InsertedObjectsLine(const InsertedFrame& inserted);

/// Returns a line of objects.jsonl with the recorded objects and, behind them, those that were
/// inserted. Recorded objects have the points that they have left; how many firings met them stays
/// as it was recorded.
/// @param line The recorded one, without its end.
[[nodiscard]] std::string ObjectsWith(const std::string& line,
                                      const RecordedFirings& firings,
                                      const InsertedFrame& inserted);

}  // namespace railcast
