#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viewer/color/color_map.h"
#include "viewer/color/field_values.h"

namespace railcast {

/// One kind of point in a legend.
struct Category {
  double value{};
  std::string name;
  Rgb rgb{};
  std::size_t num_points{};
};

/// The colour of every point, and what colours mean.
struct Coloring {
  std::string title;
  std::vector<Rgb> colors{};           ///< Of each point; kNoValueColor without a value.
  std::vector<Category> categories{};  ///< Those that occur, by rising value; empty on a scale.
  /// The scale's ends, if it is one.
  std::optional<std::array<double, 2>> ends{};
  ColorMap map{};
};

/// Ends of a scale for these values: the 1st and 99th percentiles, so that a few odd points do not
/// take all its colours; of differences as far to either side of 0. Never equal.
[[nodiscard]] std::array<double, 2> FitScale(const FieldValues& field);

/// Colours amounts.
/// @param ends Of the scale, rising.
[[nodiscard]] Coloring ColorByScale(const FieldValues& field,
                                    ColorMap map,
                                    const std::array<double, 2>& ends);

/// Colours kinds: labels by their table, outcomes and materials by name, instances by their
/// object's name where they have one.
/// @param name The field's.
/// @throws InputError if a value is no whole number.
[[nodiscard]] Coloring ColorByCategory(const FieldValues& field,
                                       const std::string& name,
                                       const RecordingInfo& info,
                                       const RecordedFrame& recorded);

}  // namespace railcast
