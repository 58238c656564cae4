#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/frame/labels.h"
#include "viewer/cloud.h"

namespace railcast {

using Rgb = std::array<std::uint8_t, 3>;

/// One kind of point in a legend.
struct Category {
  double value{};
  std::string name;
  Rgb rgb{};
};

/// Colours by kind: labels, outcomes.
struct CategoryColoring {
  std::vector<double> values;        ///< Of each point.
  std::vector<Category> categories;  ///< Those that occur, by rising value.
};

/// Colours by amount, on a perceptually uniform scale.
struct ScalarColoring {
  std::vector<double> values;  ///< Of each point; NaN has no colour of the scale.
  double lowest{};             ///< The scale's ends: the 1st and 99th percentiles, so that a few
  double highest{};            ///< odd points do not take all its colours.
  std::string title;
};

using Coloring = std::variant<CategoryColoring, ScalarColoring>;

/// What --color-by offers.
inline constexpr std::array<const char*, 5> kColorBy = {"label", "range", "height", "intensity",
                                                        "outcome"};

/// @param color_by One of kColorBy.
/// @param labels Names and colours; ids it lacks get a name and a colour of their own.
/// @throws InputError if the cloud lacks the field.
[[nodiscard]] Coloring ColorCloud(const Cloud& cloud,
                                  const std::string& color_by,
                                  const LabelTable& labels);

/// The colour of a place in [0, 1] on the scale: "viridis" (van der Walt and Smith, matplotlib 1.5:
/// even steps in perceived lightness, readable by the colour-blind) between its published anchors,
/// without its darkest quarter, which would sink into the background.
[[nodiscard]] Rgb ScaleColor(double place);

}  // namespace railcast
