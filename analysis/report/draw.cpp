#include "analysis/report/formats.h"

#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <cstdio>
#include <string_view>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_script.h"
#include "analysis/report/program_output.h"
#include "core/base/error.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"

namespace railcast {
namespace {

// Runs gnuplot on a script after `settings`, gnuplot commands without double quotes, and returns
// its standard output.
std::string GnuplotOutput(const std::filesystem::path& script, const std::string& settings) {
  return ProgramOutput("gnuplot -e \"" + settings + "\" " + ShellWord(script.string()),
                       "gnuplot-nox");
}

// Erases every part of the text from `from` to the end of the next `to`.
void EraseAll(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    const std::size_t end = text.find(to, at + from.size());
    if (end == std::string::npos) return;
    text.erase(at, end + to.size() - at);
  }
}

// Writes "rgb(  0, 114, 178)" as "#0072b2" and black as currentColor.
std::string WithPlainColors(const std::string& svg) {
  std::string text;
  std::size_t from = 0;
  for (std::size_t at = svg.find("rgb("); at != std::string::npos; at = svg.find("rgb(", from)) {
    unsigned int red = 0, green = 0, blue = 0;
    const std::size_t end = svg.find(')', at);
    if (end == std::string::npos ||
        std::sscanf(svg.c_str() + at, "rgb(%u,%u,%u)", &red, &green, &blue) != 3) {
      break;
    }
    std::array<char, 32> color{};
    std::snprintf(color.data(), color.size(), "#%02x%02x%02x", red, green, blue);
    text.append(svg, from, at - from);
    text += red + green + blue == 0 ? "currentColor" : color.data();
    from = end + 1;
  }
  return text.append(svg, from);
}

// gnuplot writes many empty groups.
void EraseEmptyGroups(std::string& text) {
  const std::string_view end = ">\n</g>\n";
  for (std::size_t at = text.find(end); at != std::string::npos; at = text.find(end, at)) {
    const std::size_t begin = text.rfind('<', at);
    if (text.compare(begin, 3, "<g ") == 0) {
      text.erase(begin, at + end.size() - begin);
      at = begin;
    } else {
      at += end.size();
    }
  }
}

// gnuplot can report success without having drawn anything.
void CheckDrawn(const std::string& bytes) {
  if (bytes.empty()) throw InputError("gnuplot: failed (the numbers are written)");
}

std::string DrawPicture(const Picture& picture, const std::filesystem::path& script) {
  WriteFileWhole(script, picture.script);
  const std::string png = GnuplotOutput(
      script,
      Joined({"set encoding utf8; set terminal pngcairo noenhanced background '#1b1b1d' size ",
              std::to_string(picture.width_px), ",", std::to_string(picture.height_px),
              " font 'sans-serif,12'"}));
  CheckDrawn(png);
  return png;
}

}  // namespace

std::map<std::string, std::string> DrawAll(const Report& report,
                                           const std::filesystem::path& folder) {
  // gnuplot writes its files piece by piece; they are moved once they are complete.
  const ReportScratch drawings;
  std::vector<Chart> charts;
  bool has_pictures = false;
  for (const Section& section : report.sections) {
    charts.insert(charts.end(), section.charts.begin(), section.charts.end());
    has_pictures = has_pictures || !section.pictures.empty();
  }
  // A series keeps its colour through the report.
  const SeriesPaints paints = PaintsOf(charts);
  std::string script;
  for (const Chart& chart : charts) {
    script += DrawingOf(chart, paints, drawings.path() / (chart.key + ".svg"),
                        drawings.path() / (chart.key + ".png"));
  }
  std::map<std::string, std::string> drawn;
  if (script.empty() && !has_pictures) return drawn;
  WriteFileWhole(drawings.path() / "charts.gnuplot", script);
  (void)GnuplotOutput(drawings.path() / "charts.gnuplot", "set encoding utf8");
  MakeFolders(folder);
  for (const Section& section : report.sections) {
    for (const Chart& chart : section.charts) {
      const std::string svg =
          CleanSvg(ReadFileWhole(drawings.path() / (chart.key + ".svg")), chart.key);
      WriteFileWhole(folder / (chart.key + ".svg"), svg);
      WriteFileWhole(folder / (chart.key + ".png"),
                     ReadFileWhole(drawings.path() / (chart.key + ".png")));
      drawn.emplace(chart.key, svg);
    }
    for (const Picture& picture : section.pictures) {
      const std::string png = DrawPicture(picture, drawings.path() / "picture.gnuplot");
      WriteFileWhole(folder / (picture.key + ".png"), png);
      drawn.emplace(picture.key, png);
    }
  }
  return drawn;
}

void DrawSheet(const std::vector<Chart>& charts,
               const std::string& title,
               const std::filesystem::path& picture) {
  const std::string script = picture.string() + ".gnuplot";
  WriteFileWhole(script, SheetOf(charts, title));
  const auto draw = [&](const std::string& terminal, const std::string& ending) {
    const std::string bytes = GnuplotOutput(
        script, "set encoding utf8; set terminal " + terminal + " noenhanced rounded");
    CheckDrawn(bytes);
    WriteFileWhole(picture.string() + ending, bytes);
  };
  draw("svg size 1200,900 background '#ffffff' font 'sans-serif,14'", ".svg");
  draw("pngcairo size 1200,900 font 'sans-serif,10'", ".png");
}

std::string CleanSvg(const std::string& gnuplot_svg, const std::string& prefix) {
  std::string text = WithPlainColors(gnuplot_svg);
  EraseAll(text, "<title>", "</title>");
  EraseAll(text, "<desc>", "</desc>");
  EraseAll(text, "<filter", "</filter>");
  EraseAll(text, " id=\"gnuplot_", "\"");
  boost::replace_all(text, " color=\"black\"", "");
  boost::replace_all(text, " color=\"white\"", "");
  boost::replace_all(text, "\"black\"", "\"currentColor\"");
  boost::replace_all(text, " shape-rendering='crispEdges'", "");
  boost::replace_all(text, "fill = '", "fill='");
  boost::replace_all(text, "#gp", "#" + prefix + "-gp");
  boost::replace_all(text, "id='gp", "id='" + prefix + "-gp");
  EraseEmptyGroups(text);
  return text;
}

}  // namespace railcast
