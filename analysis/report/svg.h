#pragma once

#include <string>

namespace railcast {

/// gnuplot's SVG made fit for a page: what was black takes the colour of the text around it
/// (`currentColor`), other colours are written as "#0072b2" so that a style sheet can find and
/// change them, names are unique to `prefix`, and there are no titles that pop up.
[[nodiscard]] std::string CleanSvg(const std::string& gnuplot_svg, const std::string& prefix);

/// The drawing without the XML declaration, to be put into a page, with attributes for its <svg>.
[[nodiscard]] std::string InlineSvg(const std::string& clean_svg, const std::string& attributes);

}  // namespace railcast
