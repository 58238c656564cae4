#include "analysis/pictures/picture_grid.h"

#include <algorithm>

#include "analysis/report/chart_script.h"

namespace railcast {
namespace {

constexpr int kTitleHeight_px = 30;
constexpr int kMargin_px = 3;

int RowHeight_px(const std::vector<GridPicture>& row) {
  return kTitleHeight_px + std::ranges::max_element(row, {}, &GridPicture::height_px)->height_px;
}

// gnuplot measures from the lower left corner, in shares of the whole.
std::string MarginsText(std::size_t column, int top_px, int height_px, const Picture& grid) {
  const auto at = [](const char* name, int at_px, int all_px) {
    return std::string("set ") + name + " at screen " +
           GnuplotNumber(static_cast<double>(at_px) / all_px) + "\n";
  };
  const int left_px = kPlaceWidth_px * static_cast<int>(column);
  return at("lmargin", left_px + kMargin_px, grid.width_px) +
         at("rmargin", left_px + kPlaceWidth_px - kMargin_px, grid.width_px) +
         at("tmargin", grid.height_px - top_px - kTitleHeight_px, grid.height_px) +
         at("bmargin", grid.height_px - top_px - height_px + kMargin_px, grid.height_px);
}

}  // namespace

GridPicture ImagePicture(const std::string& title, const std::filesystem::path& png) {
  return {
      "set title " + GnuplotQuoted(title) +
      "\nset autoscale\nset xrange [*:*] noreverse\nset yrange [*:*]\nset size ratio -1\nplot " +
      GnuplotQuoted(png.string()) + " binary filetype=png with rgbimage notitle\n"};
}

GridPicture EmptyPicture(const std::string& title) {
  return {"set title " + GnuplotQuoted(title) +
          "\nset xrange [0:1]\nset yrange [0:1]\nset size noratio\nplot NaN notitle\n"};
}

Picture GridOf(const std::vector<std::vector<GridPicture>>& rows) {
  Picture grid;
  std::size_t num_columns = 1;
  for (const auto& row : rows) {
    num_columns = std::max(num_columns, row.size());
    grid.height_px += RowHeight_px(row);
  }
  grid.width_px = kPlaceWidth_px * static_cast<int>(num_columns);
  grid.script =
      "unset key\nunset border\nunset tics\n"
      "set title textcolor rgb '#ffffff' noenhanced offset 0,-0.6\nset multiplot\n";
  int top_px = 0;
  for (const auto& row : rows) {
    const int height_px = RowHeight_px(row);
    for (std::size_t column = 0; column < row.size(); ++column) {
      grid.script += MarginsText(column, top_px, height_px, grid) + row[column].script;
    }
    top_px += height_px;
  }
  grid.script += "unset multiplot\n";
  return grid;
}

}  // namespace railcast
