#pragma once

#include <optional>
#include <string_view>

namespace railcast {

/// Returns the metres of the unit of length that a comment of a header names: 0.001 for "units: mm"
/// and "File units = millimeters". Absent if it names none or metres.
[[nodiscard]] std::optional<double> UnitOfComment_m(std::string_view comment);

}  // namespace railcast
