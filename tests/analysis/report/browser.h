#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/io/image/png.h"
#include "core/io/write_file.h"
#include "tests/support/run_command.h"

// What Chromium makes of a report's page.

namespace railcast {

inline bool IsInstalled(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Runs Chromium on a page, headless and without network.
inline Ended Browse(const std::string& options, const std::filesystem::path& page) {
  return RunCommand(
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync "
      "--host-resolver-rules='MAP * ~NOTFOUND' --hide-scrollbars "
      "--user-data-dir='" +
      (page.parent_path() / "profile").string() + "' " + options + " 'file://" + page.string() +
      "'");
}

/// A script, inserted into a copy of the page, that reports how a browser renders it.
inline constexpr const char* kProbe = R"(<pre id="probe"></pre><script>
const box = e => { const b = e.getBoundingClientRect(); return [b.left, b.right, b.width, b.height]; };
const style = (e, name) => e ? getComputedStyle(e)[name] : null;
const of = selector => document.querySelector(selector);
const rgb = color => color.match(/[\d.]+/g).map(Number);
const luminance = color => {
  const [r, g, b] = rgb(color).map(v => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const groundOf = e => {
  while (rgb(style(e, "backgroundColor"))[3] === 0) e = e.parentElement;
  return style(e, "backgroundColor");
};
const contrast = e => {
  const ink = luminance(style(e, e instanceof SVGElement ? "fill" : "color")), ground = luminance(groundOf(e));
  return (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05);
};
const isText = e => e.id !== "probe" && !["SCRIPT", "STYLE"].includes(e.tagName) &&
    [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim() !== "");
const texts = [...document.body.querySelectorAll("*")].filter(isText);
const scrolls = e => e.closest(".scroll, .drawing, #probe") !== null;
const width = document.documentElement.clientWidth;
document.getElementById("probe").textContent = "PROBE" + JSON.stringify({
  charts: [...document.querySelectorAll("svg.chart")].map(box),
  drawn: [...document.querySelectorAll("svg.chart")].map(s => s.getBBox().width),
  texts: [...document.querySelectorAll("svg.chart")].map(s => {
    const b = s.getBoundingClientRect();
    return [...s.querySelectorAll("text")].every(t => {
      const r = t.getBoundingClientRect();
      return r.left >= b.left - 1 && r.right <= b.right + 1 && r.top >= b.top - 1 && r.bottom <= b.bottom + 1;
    });
  }),
  pictures: [...document.images].map(i => i.naturalWidth),
  requests: performance.getEntriesByType("resource").map(r => r.name).filter(n => !n.startsWith("data:")),
  width: width, needed: document.documentElement.scrollWidth,
  wide: [...document.body.querySelectorAll("*")].filter(e => !scrolls(e) && e.getBoundingClientRect().right > width + 1)
      .map(e => e.tagName + " " + e.className),
  pale: texts.filter(e => contrast(e) < 4.5).map(e => e.tagName + " " + e.textContent.trim()),
  titles: ["h1", "h2", "h3"].map(of).filter(e => e).map(e => {
    const range = document.createRange();
    range.selectNodeContents(e);
    const b = range.getBoundingClientRect();
    return [b.left, b.top, b.right, b.bottom].map(Math.round);
  }),
  ground: style(document.body, "backgroundColor"), ink: style(of(".chart"), "color"),
  series: style(of(".chart [stroke='#0072b2']"), "stroke"),
}) + "PROBE";
</script></body>)";

/// Options of a dark scheme; light is the default.
inline constexpr const char* kDarkScheme = " --blink-settings=preferredColorScheme=0 ";

/// A copy of the page with the probe in it, beside it.
inline std::filesystem::path WithProbe(const std::filesystem::path& page) {
  std::string text = ReadFileWhole(page);
  const std::size_t policy = text.find("<meta http-equiv");
  text.erase(policy, text.find('>', policy) + 1 - policy);
  text.replace(text.find("</body>"), 7, kProbe);
  const auto copy = page.parent_path() / "probe.html";
  WriteFileWhole(copy, text);
  return copy;
}

/// Result of the probe in a window whose size the options give.
inline nlohmann::json Probe(const std::string& options, const std::filesystem::path& page) {
  const Ended dumped = Browse("--dump-dom " + options, WithProbe(page));
  const std::size_t begin = dumped.said.find("PROBE{");
  const std::size_t end = dumped.said.find("}PROBE", begin);
  EXPECT_NE(end, std::string::npos) << dumped.said;
  if (end == std::string::npos) return {};
  return nlohmann::json::parse(dumped.said.substr(begin + 5, end - begin - 4));
}

/// Contrast of the brightest with the darkest pixel in a box of left, top, right and bottom (Web
/// Content Accessibility Guidelines 2.1).
inline double ContrastIn(const DecodedImage<std::uint8_t>& picture, const nlohmann::json& box) {
  const auto linear = [](std::uint8_t value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  double least = 1.0, most = 0.0;
  for (std::size_t y = box[1]; y < box[3].get<std::size_t>() && y < picture.size.height_px; ++y) {
    for (std::size_t x = box[0]; x < box[2].get<std::size_t>() && x < picture.size.width_px; ++x) {
      const std::uint8_t* const pixel = &picture.values[3 * (y * picture.size.width_px + x)];
      const double luminance =
          0.2126 * linear(pixel[0]) + 0.7152 * linear(pixel[1]) + 0.0722 * linear(pixel[2]);
      least = std::min(least, luminance);
      most = std::max(most, luminance);
    }
  }
  return (most + 0.05) / (least + 0.05);
}

/// Expects that in light and dark nothing is wider than the window, and that all text stands out
/// from its ground, by the browser's own account and, of titles, in a picture of the page.
inline void ExpectReadable(const std::filesystem::path& page) {
  for (const std::string& scheme : {std::string(), std::string(kDarkScheme)}) {
    const std::string options = "--window-size=1000,2000 " + scheme;
    const nlohmann::json look = Probe(options, page);
    EXPECT_EQ(look["wide"], nlohmann::json::array()) << scheme;
    EXPECT_EQ(look["pale"], nlohmann::json::array()) << scheme;
    const auto picture = page.parent_path() / "picture.png";
    Browse("--screenshot='" + picture.string() + "' " + options, page);
    const auto pixels = DecodePngRgb(ReadFileWhole(picture));
    ASSERT_FALSE(look["titles"].empty());
    for (const nlohmann::json& title : look["titles"]) {
      if (title[3] >= 2000) continue;
      EXPECT_GT(ContrastIn(pixels, title), 4.5) << title << scheme;
    }
  }
}

/// The page on paper: a PDF beside it.
inline std::filesystem::path Printed(const std::filesystem::path& page) {
  auto pdf = page.parent_path() / "report.pdf";
  Browse("--no-pdf-header-footer --print-to-pdf='" + pdf.string() + "'", page);
  EXPECT_TRUE(std::filesystem::exists(pdf));
  return pdf;
}

/// Expects at most ten printed pages and no word beyond their edges.
inline void ExpectFitsOnPaper(const std::filesystem::path& page) {
  const auto pdf = Printed(page);
  const std::string words = RunCommand("pdftotext -bbox '" + pdf.string() + "' -").said;
  const std::regex page_form("<page width=\"([0-9.]+)\"");
  const std::regex word_form("<word xMin=\"(-?[0-9.]+)\" yMin=\"[^\"]*\" xMax=\"([0-9.]+)\"");
  std::smatch first;
  ASSERT_TRUE(std::regex_search(words, first, page_form)) << words;
  const double width = std::stod(first[1]);
  EXPECT_LE(std::distance(std::sregex_iterator(words.begin(), words.end(), page_form), {}), 10);
  for (std::sregex_iterator word(words.begin(), words.end(), word_form), end; word != end; ++word) {
    EXPECT_GE(std::stod((*word)[1]), 0.0) << word->str();
    EXPECT_LE(std::stod((*word)[2]), width) << word->str();
  }
}

}  // namespace railcast
