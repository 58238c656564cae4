#pragma once

#include <string>

namespace railcast {

/// Text as it stands in a page, between tags or quotes.
[[nodiscard]] std::string EscapedHtml(const std::string& text);

/// "<h2>text</h2>", the text escaped; a tag may have attributes.
[[nodiscard]] std::string Element(const std::string& tag, const std::string& text);

/// Numbers with a real minus sign, which is as wide as a digit, and powers of ten as such:
/// "-3e-05" as "−3 × 10<sup>−5</sup>".
[[nodiscard]] std::string NumberHtml(const std::string& numbers);

/// A unit behind a figure; nothing if there is none.
[[nodiscard]] std::string UnitHtml(const std::string& unit);

}  // namespace railcast
