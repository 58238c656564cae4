#include "analysis/pictures/grid_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "analysis/report/chart_script.h"
#include "core/base/units.h"
#include "core/io/recording/recorded_motion.h"

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

constexpr double kSide_deg = 60.0;
constexpr std::size_t kMostPoints = 60'000;  // More do not fit a picture.
constexpr double kShapeOfPlace = static_cast<double>(kPlaceWidth_px) / kPlaceHeight_px;

struct SeenPoint {
  SeenDirection at{};
  double range_m{};
  unsigned int color{};
};

/// A range of directions, from right to left and from low to high.
struct SeenExtent {
  double right_deg{}, left_deg{}, low_deg{}, high_deg{};

  [[nodiscard]] double width_deg() const { return left_deg - right_deg; }
  [[nodiscard]] double height_deg() const { return high_deg - low_deg; }
};

SeenDirection DirectionOf(const Vector3& point_m) {
  return {DegFromRad(std::atan2(point_m.y(), point_m.x())),
          DegFromRad(std::atan2(point_m.z(), std::hypot(point_m.x(), point_m.y())))};
}

unsigned int ColorOf(unsigned int red, unsigned int green, unsigned int blue) {
  return red << 16U | green << 8U | blue;
}

unsigned int ColorOfLabel(std::uint32_t id, const RecordingInfo& info) {
  const Label* const label = info.labels.Find(id);
  return label == nullptr ? ColorOf(200, 200, 200)
                          : ColorOf(label->rgb[0], label->rgb[1], label->rgb[2]);
}

// From yellow at the nearest points to blue at the farthest, but for a fiftieth at either end.
void ColorByRange(std::vector<SeenPoint>& points) {
  if (points.empty()) return;
  std::vector<double> ranges_m;
  for (const SeenPoint& point : points) ranges_m.push_back(point.range_m);
  std::ranges::sort(ranges_m);
  const std::size_t fiftieth = ranges_m.size() / 50;
  const double near_m = std::max(0.1, ranges_m[fiftieth]);
  const double far_m = std::max(1.5 * near_m, ranges_m[ranges_m.size() - 1 - fiftieth]);
  for (SeenPoint& point : points) {
    const double share =
        std::clamp(std::log(point.range_m / near_m) / std::log(far_m / near_m), 0.0, 1.0);
    const auto mixed = [&](double near, double far) {
      return static_cast<unsigned int>(std::lround(near + share * (far - near)));
    };
    point.color = ColorOf(mixed(255.0, 40.0), mixed(220.0, 110.0), mixed(60.0, 255.0));
  }
}

bool IsWithin(const SeenWindow& window, const SeenDirection& at) {
  return std::abs(at.azimuth_deg - window.middle.azimuth_deg) <= window.half_width_deg &&
         std::abs(at.elevation_deg - window.middle.elevation_deg) <= window.half_height_deg;
}

void KeepShown(const std::optional<SeenWindow>& window, std::vector<SeenPoint>& points) {
  if (window) {
    std::erase_if(points, [&](const SeenPoint& point) { return !IsWithin(*window, point.at); });
    return;
  }
  const auto is_ahead = [](const SeenPoint& point) {
    return std::abs(point.at.azimuth_deg) <= kSide_deg;
  };
  if (!std::ranges::any_of(points, is_ahead)) return;
  std::erase_if(points, [&](const SeenPoint& point) { return !is_ahead(point); });
}

// From the farthest on, so that the nearest are drawn last.
std::vector<SeenPoint> ShownPointsOf(const RecordedFrame& recorded,
                                     const RecordingInfo& info,
                                     const std::optional<SeenWindow>& window) {
  const Frame& frame = recorded.frame;
  const RecordedMotion motion(recorded, Compensation::kAll);
  const bool has_labels = recorded.Has("label") && !info.labels.labels().empty();
  std::vector<SeenPoint> points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.x[slot] + frame.y[slot] + frame.z[slot])) continue;
    const Vector3 point_m = motion.PointOf(slot).cast<double>();
    points.push_back({DirectionOf(point_m), point_m.norm(),
                      has_labels ? ColorOfLabel(frame.label[slot], info) : 0U});
  }
  KeepShown(window, points);
  if (!has_labels) ColorByRange(points);
  const std::size_t step = points.size() / kMostPoints + 1;
  std::vector<SeenPoint> kept;
  for (std::size_t i = 0; i < points.size(); i += step) kept.push_back(points[i]);
  std::ranges::stable_sort(kept, std::greater(), &SeenPoint::range_m);
  return kept;
}

SeenExtent ExtentOf(const std::vector<SeenPoint>& points, const std::optional<SeenWindow>& window) {
  if (window) {
    return {window->middle.azimuth_deg - window->half_width_deg,
            window->middle.azimuth_deg + window->half_width_deg,
            window->middle.elevation_deg - window->half_height_deg,
            window->middle.elevation_deg + window->half_height_deg};
  }
  const auto [right, left] =
      std::ranges::minmax(points, {}, [](const SeenPoint& point) { return point.at.azimuth_deg; });
  const auto [low, high] = std::ranges::minmax(
      points, {}, [](const SeenPoint& point) { return point.at.elevation_deg; });
  const double width_margin_deg = 0.01 * std::max(1.0, left.at.azimuth_deg - right.at.azimuth_deg);
  const double height_margin_deg =
      0.01 * std::max(1.0, high.at.elevation_deg - low.at.elevation_deg);
  return {right.at.azimuth_deg - width_margin_deg, left.at.azimuth_deg + width_margin_deg,
          low.at.elevation_deg - height_margin_deg, high.at.elevation_deg + height_margin_deg};
}

// Points a little larger than the way from one to the next; gnuplot's size 1 is about 8 pixels.
double PointSizeOf(const SeenExtent& extent, std::size_t num_points) {
  const double px_per_deg = std::min(0.95 * kPlaceWidth_px / extent.width_deg(),
                                     0.8 * kPlaceHeight_px / extent.height_deg());
  const double way_px =
      px_per_deg * std::sqrt(extent.width_deg() * extent.height_deg() /
                             static_cast<double>(std::max<std::size_t>(num_points, 1)));
  return std::clamp(way_px / 8.0, 0.12, 0.8);
}

void WriteData(const std::vector<SeenPoint>& points,
               const std::vector<SeenLine>& lines,
               std::ostream& text) {
  text << "$cloud << END\n";
  for (const SeenPoint& point : points) {
    text << point.at.azimuth_deg << ' ' << point.at.elevation_deg << ' ' << point.color << '\n';
  }
  text << "END\n$lines << END\n";
  for (const SeenLine& line : lines) {
    for (const SeenDirection& at : line) text << at.azimuth_deg << ' ' << at.elevation_deg << '\n';
    text << '\n';
  }
  text << "END\n";
}

// gnuplot refuses to plot nothing.
void WritePlot(double point_size, bool has_points, bool has_lines, std::ostream& text) {
  text << "plot ";
  if (has_points) {
    text << "$cloud using 1:2:3 with points pointtype 7 pointsize " << point_size
         << " linecolor rgb variable notitle" << (has_lines ? ", " : "");
  }
  if (has_lines) text << "$lines using 1:2 with lines linecolor rgb '#ffffff' notitle";
  text << '\n';
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

std::optional<RecordedFrame> ReadFrameAt(const PlacedFrame& placed, RecordingInfo& info) {
  const auto recording = OpenRecording(placed.recording);
  info = recording->info();
  std::optional<Recording::FrameReader> reader;
  for (std::size_t i = 0; i <= placed.place; ++i) {
    reader = recording->Next();
    if (!reader) return std::nullopt;
  }
  return (*reader)();
}

GridPicture CloudPicture(const RecordedFrame& recorded,
                         const RecordingInfo& info,
                         const CloudView& view) {
  const std::vector<SeenPoint> points = ShownPointsOf(recorded, info, view.window);
  if (points.empty() && (!view.window || view.lines.empty())) {
    return EmptyPicture(view.title + ": no point");
  }
  const SeenExtent extent = ExtentOf(points, view.window);
  std::ostringstream text;
  text.precision(6);
  WriteData(points, view.lines, text);
  text << "set title " << GnuplotQuoted(view.title) << "\nset xrange [" << extent.left_deg << ':'
       << extent.right_deg << "]\nset yrange [" << extent.low_deg << ':' << extent.high_deg
       << "]\nset size ratio -1\n";
  WritePlot(PointSizeOf(extent, points.size()), !points.empty(), !view.lines.empty(), text);
  const double height_px = kPlaceWidth_px * extent.height_deg() / extent.width_deg();
  return {text.str(), std::min(kPlaceHeight_px, static_cast<int>(std::ceil(height_px)))};
}

SeenWindow WindowAbout(const Transform& sensor_from_box,
                       const Vector3& size_m,
                       double min_half_height_deg) {
  SeenWindow window{.middle = DirectionOf(sensor_from_box.translation())};
  double half_width_deg = 0.0;
  double half_height_deg = 0.0;
  for (const SeenLine& line : LinesOf(sensor_from_box, size_m)) {
    for (const SeenDirection& at : line) {
      half_width_deg =
          std::max(half_width_deg, std::abs(at.azimuth_deg - window.middle.azimuth_deg));
      half_height_deg =
          std::max(half_height_deg, std::abs(at.elevation_deg - window.middle.elevation_deg));
    }
  }
  constexpr double kRoom = 1.5;
  window.half_height_deg = std::max(
      {min_half_height_deg, kRoom * half_height_deg, kRoom * half_width_deg / kShapeOfPlace});
  window.half_width_deg = kShapeOfPlace * window.half_height_deg;
  return window;
}

std::vector<SeenLine> LinesOf(const Transform& sensor_from_box, const Vector3& size_m) {
  constexpr int kPieces = 8;  // Straight edges are curves in these pictures.
  constexpr std::array<std::array<double, 2>, 4> kCornersOfEdges = {
      {{-0.5, -0.5}, {-0.5, 0.5}, {0.5, -0.5}, {0.5, 0.5}}};
  std::vector<SeenLine> lines;
  for (int axis = 0; axis < 3; ++axis) {
    for (const auto& [first, second] : kCornersOfEdges) {
      SeenLine line;
      for (int i = 0; i <= kPieces; ++i) {
        Vector3 corner;
        corner[axis] = static_cast<double>(i) / kPieces - 0.5;
        corner[(axis + 1) % 3] = first;
        corner[(axis + 2) % 3] = second;
        line.push_back(DirectionOf(sensor_from_box * corner.cwiseProduct(size_m)));
      }
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

SeenLine LineOf(const SeenWindow& window) {
  const auto& [azimuth_deg, elevation_deg] = window.middle;
  const double right_deg = azimuth_deg - window.half_width_deg;
  const double left_deg = azimuth_deg + window.half_width_deg;
  const double low_deg = elevation_deg - window.half_height_deg;
  const double high_deg = elevation_deg + window.half_height_deg;
  return {{left_deg, low_deg},
          {right_deg, low_deg},
          {right_deg, high_deg},
          {left_deg, high_deg},
          {left_deg, low_deg}};
}

}  // namespace railcast
