#include "analysis/report/svg.h"

#include <array>
#include <cstdio>
#include <string_view>

namespace railcast {
namespace {

void ReplaceAll(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// Everything from `from` to the end of the next `to`.
void EraseAll(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    const std::size_t end = text.find(to, at + from.size());
    if (end == std::string::npos) return;
    text.erase(at, end + to.size() - at);
  }
}

// "rgb(  0, 114, 178)" as "#0072b2", black as currentColor.
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

// gnuplot writes many groups with nothing in them.
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

}  // namespace

std::string CleanSvg(const std::string& gnuplot_svg, const std::string& prefix) {
  std::string text = WithPlainColors(gnuplot_svg);
  EraseAll(text, "<title>", "</title>");
  EraseAll(text, "<desc>", "</desc>");
  EraseAll(text, "<filter", "</filter>");
  EraseAll(text, " id=\"gnuplot_", "\"");
  ReplaceAll(text, " color=\"black\"", "");
  ReplaceAll(text, " color=\"white\"", "");
  ReplaceAll(text, "\"black\"", "\"currentColor\"");
  ReplaceAll(text, " shape-rendering='crispEdges'", "");
  ReplaceAll(text, "fill = '", "fill='");
  ReplaceAll(text, "#gp", "#" + prefix + "-gp");
  ReplaceAll(text, "id='gp", "id='" + prefix + "-gp");
  EraseEmptyGroups(text);
  return text;
}

std::string InlineSvg(const std::string& clean_svg, const std::string& attributes) {
  const std::size_t begin = clean_svg.find("<svg");
  if (begin == std::string::npos) return {};
  return "<svg " + attributes + clean_svg.substr(begin + 4);
}

}  // namespace railcast
