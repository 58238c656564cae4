#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewer/color/palette.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// One category of points in a legend.
struct Category {
  double value{};
  std::string name;
  Rgb rgb{};
  std::size_t num_points{};
};

/// The colour of every point, and what the colours mean.
struct Coloring {
  std::string title;
  std::vector<Rgb> colors{};  ///< One per point; kNoValueColor where there is no value.
  /// The categories that occur, by rising value; empty for a scale.
  std::vector<Category> categories{};
  /// The ends of the scale; empty for categories.
  std::optional<std::array<double, 2>> ends{};
  ColorMap map{};
};

/// Returns the ends of a scale for these values: the 1st and 99th percentiles, so that a few
/// outliers do not take up all its colours, or the least and the greatest value where the
/// percentiles are equal; for differences, ends symmetric about 0. The two are never equal.
[[nodiscard]] std::array<double, 2> FitScale(const FieldValues& field);

/// Colours points by a quantity.
/// @param ends The lower and the upper end of the scale.
[[nodiscard]] Coloring ColorByScale(const FieldValues& field,
                                    ColorMap map,
                                    const std::array<double, 2>& ends);

/// Colours points by category: labels as their table says, outcomes and materials under their
/// names, instances under the name of their object where they have one.
/// @param name The name of the field.
/// @throws InputError if a value is no whole number.
[[nodiscard]] Coloring ColorByCategory(const FieldValues& field,
                                       const std::string& name,
                                       const RecordingInfo& info,
                                       const RecordedFrame& recorded);

/// Says of each point whether its label is not among those selected; empty if none are selected.
[[nodiscard]] std::vector<bool> FaintPoints(const ShownFrame& shown,
                                            const std::set<std::uint32_t>& labels);

}  // namespace railcast
