#include "analysis/pictures/picture_grid.h"

#include <algorithm>

#include "analysis/report/chart_script.h"

namespace railcast {
namespace {

constexpr int kTitleHeight_px = 30;

}  // namespace

std::string ImagePicture(const std::string& title, const std::filesystem::path& png) {
  return "set title " + GnuplotQuoted(title) +
         "\nset autoscale\nset xrange [*:*] noreverse\nset yrange [*:*]\nset size ratio -1\nplot " +
         GnuplotQuoted(png.string()) + " binary filetype=png with rgbimage notitle\n";
}

std::string EmptyPicture(const std::string& title) {
  return "set title " + GnuplotQuoted(title) +
         "\nset xrange [0:1]\nset yrange [0:1]\nset size noratio\nplot NaN notitle\n";
}

Picture GridOf(const std::vector<std::vector<std::string>>& rows) {
  std::size_t num_columns = 1;
  for (const auto& row : rows) num_columns = std::max(num_columns, row.size());
  Picture grid;
  grid.width_px = kPlaceWidth_px * static_cast<int>(num_columns);
  grid.height_px = (kPlaceHeight_px + kTitleHeight_px) * static_cast<int>(rows.size());
  const double title = static_cast<double>(kTitleHeight_px) / grid.height_px;
  grid.script =
      "unset key\nunset border\nunset tics\n"
      "set title textcolor rgb '#ffffff' noenhanced offset 0,-0.6\n"
      "set multiplot layout " +
      std::to_string(rows.size()) + "," + std::to_string(num_columns) +
      " margins 0.005,0.995,0.01," + GnuplotNumber(1.0 - title) + " spacing 0.005," +
      GnuplotNumber(title) + "\n";
  for (const auto& row : rows) {
    for (const std::string& picture : row) grid.script += picture;
    for (std::size_t i = row.size(); i < num_columns; ++i) grid.script += EmptyPicture("");
  }
  grid.script += "unset multiplot\n";
  return grid;
}

}  // namespace railcast
