#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// One value for every point of a frame.
struct FieldValues {
  enum class Kind : std::uint8_t {
    kAmount,
    kDifference,  ///< A quantity that may be negative or positive, shown about 0.
    kCategory     ///< Whole numbers that stand for categories.
  };
  Kind kind{};
  std::string title;           ///< Title of the legend, with its unit: "range [m]".
  std::vector<double> values;  ///< One per point; NaN where there is none.
};

/// Returns the names of the fields that a frame can be coloured by, in the order in which the
/// viewer steps through them: "label", "instance", "outcome", "range", "height", ...; then the
/// foreign fields under the names in their file, or as "file_height" where a railcast field has the
/// same name.
[[nodiscard]] std::vector<std::string> ColorableFields(const RecordedFrame& recorded);

/// Returns the values of one field for every point.
/// @param name One of ColorableFields().
/// @throws InputError "has no field power to color by (has: ...)" if the frame has no such field.
[[nodiscard]] FieldValues ValuesOf(const ShownFrame& shown, const std::string& name);

/// Returns "label" if the frame has that field, else "height".
[[nodiscard]] std::string DefaultColorField(const RecordedFrame& recorded);

}  // namespace railcast
