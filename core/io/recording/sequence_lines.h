#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/run/object_survey.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Reads the objects of a line of objects.jsonl.
/// @param place Names the file and line in errors: "out/objects.jsonl:3".
/// @throws InputError "place: rule" if it is not such a line, or belongs to another frame.
[[nodiscard]] std::vector<RecordedObject> ReadObjectsLine(std::string_view line,
                                                          std::uint32_t frame,
                                                          const std::string& place);

/// An object of a frame as ReadObjectsLine() gives it, but with no number rounded.
[[nodiscard]] RecordedObject RecordedOf(const ObjectInFrame& object,
                                        const Transform& sensor_from_world);

/// The name of the class of SemanticKITTI that the object's points have: of the moving one if it
/// moves. Its own label if there is none.
/// @param labels railcast's own, which objects.jsonl names. @param kitti Those that the clouds
/// have.
[[nodiscard]] std::string KittiClassOf(const RecordedObject& object,
                                       const LabelTable& labels,
                                       const LabelTable& kitti);

}  // namespace railcast
