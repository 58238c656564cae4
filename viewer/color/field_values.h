#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// One figure of every point of a frame.
struct FieldValues {
  enum class Kind : std::uint8_t {
    kAmount,
    kDifference,  ///< An amount about 0, either way.
    kCategory     ///< Whole numbers that stand for something.
  };
  Kind kind{};
  std::string title;           ///< For people, with its unit: "range [m]".
  std::vector<double> values;  ///< Of each point; NaN = none.
};

/// What a frame can be coloured by, in the order in which people go through it: "label",
/// "instance", "outcome", "range", "height", ...; then the foreign fields as their file calls them,
/// "file_height" where one of ours is called so, too.
[[nodiscard]] std::vector<std::string> ColorableFields(const RecordedFrame& recorded);

/// The short names of colours' fields (all that ColorableFields() may give but foreign ones).
[[nodiscard]] std::vector<std::string> ColorFieldNames();

/// @param name Of ColorableFields().
/// @throws InputError "has no field power to color by (has: ...)" if it is none of them.
[[nodiscard]] FieldValues ValuesOf(const ShownFrame& shown, const std::string& name);

/// `label` where the frame has one, else `height`.
[[nodiscard]] std::string DefaultColorField(const RecordedFrame& recorded);

}  // namespace railcast
