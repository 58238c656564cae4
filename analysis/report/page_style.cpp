#include "analysis/report/page_style.h"

#include "analysis/report/chart_script.h"
#include "analysis/report/chart_series.h"
#include "analysis/report/joined.h"

namespace railcast {
namespace {

constexpr const char* kLightColors = R"(:root {
  color-scheme: light dark;
  --ground: #f5f6f8; --surface: #ffffff; --edge: #e2e5ea; --grid: #e4e7ec;
  --ink: #17202a; --muted: #5c6773; --accent: #0b63a5; --hover: #eef2f7;
  --series-1: #0072b2; --series-2: #d55e00; --series-3: #009e73; --series-4: #cc79a7;
  --series-5: #e69f00; --series-6: #56b4e9; --series-7: #7f7f7f;
}
)";

constexpr const char* kDarkColors = R"(@media screen and (prefers-color-scheme: dark) {
  :root {
    --ground: #0f1318; --surface: #171d24; --edge: #29323c; --grid: #2a333d;
    --ink: #e4e9ef; --muted: #98a4b1; --accent: #6bb5f0; --hover: #1f2730;
    --series-1: #4ea8de; --series-2: #ff8b4a; --series-3: #35c596; --series-4: #e39ac4;
    --series-5: #f3b942; --series-6: #9bd4f5; --series-7: #a6a6a6;
  }
}
)";

constexpr const char* kLayout = R"(* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
body { margin: 0; background: var(--ground); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif;
  font-variant-numeric: tabular-nums; }
header, .page, footer { max-width: 88rem; margin: 0 auto; padding: 0 clamp(1rem, 3vw, 2.5rem); }
h1, h2, h3 { line-height: 1.25; font-weight: 650; letter-spacing: -0.012em; margin: 0; }
h1 { font-size: clamp(1.5rem, 1.1rem + 1.6vw, 2.1rem); overflow-wrap: anywhere; }
h2 { font-size: 1.35rem; }
h3 { font-size: 1rem; letter-spacing: 0; }
a { color: var(--accent); }
code { font: 0.86em/1.5 ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace;
  overflow-wrap: anywhere; }
header { padding-top: 2.5rem; padding-bottom: 1.5rem; }
dl, dd { margin: 0; }
.facts { display: flex; flex-wrap: wrap; gap: 0.9rem 2.2rem; margin-top: 1.1rem; }
.facts dt, .card dt { color: var(--muted); font-size: 0.8rem; }
.facts dd { font-size: 0.95rem; overflow-wrap: anywhere; }
.page { display: grid; gap: 1.5rem; }
nav ol { display: flex; flex-wrap: wrap; gap: 0.3rem 1.2rem; list-style: none; margin: 0;
  padding: 0.7rem 0; border-block: 1px solid var(--edge); font-size: 0.92rem; }
nav a { text-decoration: none; }
nav a:hover { text-decoration: underline; }
main { min-width: 0; }
.cards { display: grid; gap: 0.8rem; grid-template-columns: repeat(auto-fill, minmax(11.5rem, 1fr)); }
.card { background: var(--surface); border: 1px solid var(--edge); border-radius: 0.6rem;
  padding: 0.85rem 1rem 0.8rem; }
.figure { font-size: 1.65rem; font-weight: 650; letter-spacing: -0.02em; line-height: 1.3;
  overflow-wrap: anywhere; }
.figure.words { font-size: 1.05rem; letter-spacing: 0; }
.unit { color: var(--muted); font-weight: 400; }
.card .interval { display: block; min-height: 1.4em; color: var(--muted); font-size: 0.8rem;
  line-height: 1.4; }
.samples { white-space: nowrap; }
sup { line-height: 0; }
.absent { color: var(--muted); font-style: italic; }
.card .absent .figure { font-size: 1.05rem; font-weight: 400; letter-spacing: 0; line-height: 2; }
section { margin-top: 2.6rem; scroll-margin-top: 1rem; }
section > p { max-width: 46rem; margin: 0.6rem 0 0; color: var(--muted); }
.charts { display: grid; gap: 1.1rem; margin-top: 1.1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 30rem), 1fr)); }
.charts:has(> figure:only-child) { grid-template-columns: minmax(0, 44rem); }
figure { margin: 0; min-width: 0; background: var(--surface); border: 1px solid var(--edge);
  border-radius: 0.6rem; padding: 1rem 1.1rem 0.9rem; }
.drawing { overflow-x: auto; margin-top: 0.5rem; }
.chart { display: block; width: 100%; min-width: 26rem; height: auto; color: var(--ink); }
figcaption { margin-top: 0.5rem; color: var(--muted); font-size: 0.86rem; line-height: 1.5; }
details { margin-top: 0.9rem; background: var(--surface); border: 1px solid var(--edge);
  border-radius: 0.6rem; }
summary { cursor: pointer; padding: 0.6rem 1rem; font-weight: 600; font-size: 0.94rem; }
summary:hover { background: var(--hover); border-radius: 0.6rem; }
.rows { color: var(--muted); font-weight: 400; font-size: 0.84rem; margin-left: 0.4em; }
.note { margin: 0; padding: 0.1rem 1rem 0.7rem; max-width: 50rem; color: var(--muted);
  font-size: 0.88rem; }
.scroll { overflow-x: auto; padding: 0 1rem 0.8rem; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; border-radius: 0.3rem; }
table { border-collapse: collapse; font-size: 0.87rem; line-height: 1.4; }
th, td { padding: 0.32rem 1.4rem 0.32rem 0; text-align: left; vertical-align: baseline;
  border-bottom: 1px solid var(--edge); }
th { font-weight: 600; }
thead th { vertical-align: bottom; border-bottom-color: var(--muted); }
tbody th { font-weight: 500; white-space: nowrap; }
tbody tr:last-child > * { border-bottom: 0; }
tbody tr:hover { background: var(--hover); }
td.number, td.absent { white-space: nowrap; }
td.number, th.number:not([colspan]), td.absent:not([colspan]) { text-align: right; }
td.interval, td.samples { color: var(--muted); font-size: 0.93em; white-space: nowrap; }
td.number:has(+ td.interval), td.interval { padding-right: 0.6rem; }
td.samples { text-align: right; }
.paper { display: none; }
footer { padding-top: 2.5rem; padding-bottom: 3rem; color: var(--muted); font-size: 0.85rem; }
footer p { margin: 0.25rem 0; }
@media (min-width: 80rem) {
  .page { grid-template-columns: 11.5rem minmax(0, 1fr); gap: 2.5rem; }
  nav { border-top: 1px solid var(--edge); padding-top: 0.7rem; }
  nav ol { position: sticky; top: 1.5rem; display: block; border: 0; padding: 0; }
  nav li { margin-bottom: 0.45rem; line-height: 1.35; }
}
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
)";

constexpr const char* kPaper = R"(@page { margin: 14mm 12mm; }
@media print {
  :root { color-scheme: light; --ground: #ffffff; font-size: 12px; }
  body { font-size: 1rem; }
  header, .page, footer { max-width: none; padding-inline: 0; }
  header { padding-top: 0; }
  .page { display: block; }
  nav { display: none; }
  .cards { grid-template-columns: repeat(4, 1fr); }
  .charts { grid-template-columns: 1fr 1fr; gap: 4mm; }
  .chart { min-width: 0; }
  section { margin-top: 8mm; }
  h2, h3, summary, .note { break-after: avoid; }
  .card, figure, tr { break-inside: avoid; }
  details { border: 0; }
  details::details-content { display: block; content-visibility: visible; block-size: auto; }
  summary { list-style: none; padding-inline: 0; }
  summary::-webkit-details-marker { display: none; }
  .note, .scroll { padding-inline: 0; }
  .scroll, .drawing { overflow: visible; }
  .screen { display: none; }
  .paper { display: block; }
  .paper table { margin-bottom: 1rem; }
  table { font-size: 8pt; }
  th, td { padding-right: 0.8rem; }
  thead { display: table-header-group; }
}
)";

// One of a chart's colours, found by its name in the drawing.
std::string Repainted(const std::string& color, const std::string& variable) {
  std::string style;
  for (const char* const property : {"fill", "stroke", "color"}) {
    style += Joined(
        {".chart [", property, "=\"", color, "\"] { ", property, ": var(--", variable, "); }\n"});
  }
  return style;
}

}  // namespace

std::string PageStyle() {
  std::string style = kLightColors;
  style += kDarkColors;
  style += kLayout;
  for (std::size_t i = 0; i < kSeriesColors.size(); ++i) {
    style += Repainted(kSeriesColors[i], "series-" + std::to_string(i + 1));
  }
  style += Repainted(kGridColor, "grid");
  style += Repainted(kMutedColor, "muted");
  style +=
      ".chart text { font-family: system-ui, -apple-system, \"Segoe UI\", Roboto, sans-serif; }\n";
  return style += kPaper;
}

}  // namespace railcast
