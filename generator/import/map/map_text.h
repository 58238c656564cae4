#pragma once

#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/strict_json.h"
#include "core/io/write_file.h"

namespace railcast {

/// @throws InputError if the file cannot be read or is no JSON.
[[nodiscard]] inline StrictJson ReadMapJson(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  try {
    return StrictJson::parse(text);
  } catch (const StrictJson::exception& error) {
    throw InputError(ShownPath(file) + ": must be JSON: " + ShownLines(error.what()));
  }
}

/// The number that a text is; absent if it is anything else, or not finite.
[[nodiscard]] inline std::optional<double> NumberIn(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

inline constexpr double kMostLongitude_deg = 180.0;
inline constexpr double kMostLatitude_deg = 90.0;

/// What a longitude or latitude of a source must be.
[[nodiscard]] inline std::string DegreesRule(double most_deg) {
  return "must be a number of degrees from " + NumberText(-most_deg) + " to " +
         NumberText(most_deg);
}

}  // namespace railcast
