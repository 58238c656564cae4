#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/run/object_record.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"

namespace railcast {

/// Returns a line of objects.jsonl with the objects of the recording, if it knows them, and, behind
/// them, those that were inserted. Recorded objects have the points that they have left; how many
/// firings met them stays as it was recorded.
/// @param number,stamp_ns Of the frame, as insert.jsonl has them.
[[nodiscard]] std::string InsertedObjectsLine(const RecordedFirings& firings,
                                              const InsertedFrame& inserted,
                                              std::uint32_t number,
                                              std::int64_t stamp_ns);

/// As InsertedObjectsLine(), for what a recorded line says.
[[nodiscard]] std::string ObjectsWith(ObjectsRecord record,
                                      const RecordedFirings& firings,
                                      const InsertedFrame& inserted);

}  // namespace railcast
