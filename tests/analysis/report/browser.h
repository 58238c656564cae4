#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

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

/// A page with a script in it, without the policy that forbids it.
inline std::string WithScript(const std::filesystem::path& page, const std::string& script) {
  std::string text = ReadFileWhole(page);
  const std::size_t policy = text.find("<meta http-equiv");
  text.erase(policy, text.find('>', policy) + 1 - policy);
  return text.replace(text.find("</body>"), 7, script);
}

/// What a script of a page writes between two words PROBE.
inline nlohmann::json ProbeOf(const std::string& options, const std::filesystem::path& page) {
  const Ended dumped = Browse("--dump-dom " + options, page);
  const std::size_t begin = dumped.said.find("PROBE{");
  const std::size_t end = dumped.said.find("}PROBE", begin);
  EXPECT_NE(end, std::string::npos) << dumped.said;
  if (end == std::string::npos) return {};
  return nlohmann::json::parse(dumped.said.substr(begin + 5, end - begin - 4));
}

/// Result of the probe in a window whose size the options give. The picture that they may ask for
/// is that of the page with the probe's result at its end.
inline nlohmann::json Probe(const std::string& options, const std::filesystem::path& page) {
  const auto copy = page.parent_path() / "probe.html";
  WriteFileWhole(copy, WithScript(page, kProbe));
  return ProbeOf(options, copy);
}

/// A script that tells the window around its own, with its own name, what lies beyond its place
/// with all tables unfolded: beyond the window and, unless the window is that of a phone or the
/// table is too long for paper, beyond the card that scrolls it.
inline constexpr const char* kOverflowProbe = R"(<script>
document.querySelectorAll("details").forEach(d => d.open = true);
const isPhone = innerWidth < 500, isPaper = innerWidth === 703;
const all = [...document.body.querySelectorAll("*")];
const told = e => e.tagName + " " + e.className + ": " + e.textContent.trim().slice(0, 60);
const wide = all.filter(e => (isPaper || !e.closest(".scroll, .drawing")) && e.getBoundingClientRect().right > innerWidth + 1);
const scrolled = isPhone || isPaper ? [] : all.filter(e =>
  e.matches(".scroll, .drawing") && !e.closest("details.screen") && e.scrollWidth > e.clientWidth + 1);
parent.postMessage({page: name, [innerWidth]: wide.concat(scrolled).map(told)}, "*");
</script></body>)";

/// Expects that on none of the pages anything lies beyond its place on a phone, on a screen of 1300
/// pixels, and on paper of A4 between the page's margins, in frames of one window: one of Chromium
/// itself has at least 500 pixels.
inline void ExpectFitWidths(const std::vector<std::filesystem::path>& pages) {
  std::string windows = R"(<pre id="probe"></pre><script>
const found = {};
let num = 0;
onmessage = m => {
  const {page, ...beyond} = m.data;
  Object.assign(found[page] ??= {}, beyond);
  if (++num === frames.length) document.getElementById("probe").textContent = "PROBE" + JSON.stringify(found) + "PROBE";
};
</script>)";
  nlohmann::json expected;
  for (const std::filesystem::path& page : pages) {
    const auto folder = page.parent_path();
    std::string text = WithScript(page, kOverflowProbe);
    WriteFileWhole(folder / "on_screen.html", text);
    text.replace(text.find("@media print"), 12, "@media all");
    WriteFileWhole(folder / "on_paper.html", text);
    const auto frame = [&](const std::string& size, const std::string& file) {
      windows += "<iframe " + size + " frameborder=\"0\" name=\"" + page.string() +
                 "\" src=\"file://" + (folder / file).string() + "\"></iframe>";
    };
    frame("width=\"390\" height=\"844\"", "on_screen.html");
    frame("width=\"1300\" height=\"900\"", "on_screen.html");
    frame("width=\"703\" height=\"1000\"", "on_paper.html");
    const auto none = nlohmann::json::array();
    expected[page.string()] = {{"390", none}, {"1300", none}, {"703", none}};
  }
  const auto file = pages.front().parent_path() / "windows.html";
  WriteFileWhole(file, windows);
  EXPECT_EQ(ProbeOf("--virtual-time-budget=10000", file), expected);
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
    const auto picture = page.parent_path() / "picture.png";
    const nlohmann::json look =
        Probe("--window-size=1000,2000 --screenshot='" + picture.string() + "'" + scheme, page);
    EXPECT_EQ(look["wide"], nlohmann::json::array()) << scheme;
    EXPECT_EQ(look["pale"], nlohmann::json::array()) << scheme;
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

/// Expects at most so many printed pages and no word in their margins.
inline void ExpectFitsOnPaper(const std::filesystem::path& pdf,
                              std::ptrdiff_t max_pages,
                              double margin_mm) {
  const std::string words = RunCommand("pdftotext -bbox '" + pdf.string() + "' -").said;
  const std::regex page_form("<page width=\"([0-9.]+)\"");
  const std::regex word_form("<word xMin=\"(-?[0-9.]+)\" yMin=\"[^\"]*\" xMax=\"([0-9.]+)\"");
  std::smatch first;
  ASSERT_TRUE(std::regex_search(words, first, page_form)) << words;
  const double margin = margin_mm / 25.4 * 72.0 - 1.0;  // Points, rounded down.
  const double width = std::stod(first[1]);
  EXPECT_LE(std::distance(std::sregex_iterator(words.begin(), words.end(), page_form), {}),
            max_pages);
  for (std::sregex_iterator word(words.begin(), words.end(), word_form), end; word != end; ++word) {
    EXPECT_GE(std::stod((*word)[1]), margin) << word->str();
    EXPECT_LE(std::stod((*word)[2]), width - margin) << word->str();
  }
}

}  // namespace railcast
