#include "viewer/draw/pane.h"

#include <vtkActor2D.h>
#include <vtkCoordinate.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <string>

#include "viewer/composition/status_text.h"
#include "viewer/draw/actors.h"
#include "viewer/draw/text_style.h"
#include "viewer/draw/vtk_values.h"

namespace railcast {
namespace {

constexpr int kScaleSteps = 256;
constexpr std::size_t kMaxLines = 24;

/// Makes a square with its lower left corner at (left, bottom), in pixels.
vtkSmartPointer<vtkActor2D> MakeSwatch(const Rgb& rgb, double left, double bottom, double side) {
  const double right = left + side;
  const double top = bottom + side;
  return MakeShape({{left, bottom}, {right, bottom}, {right, top}, {left, top}}, true, rgb);
}

/// Returns the categories to be listed, by rising value; `num_others` counts the rest.
std::vector<Category> MostFrequent(std::vector<Category> categories, std::size_t& num_others) {
  num_others = 0;
  if (categories.size() <= kMaxLines) return categories;
  num_others = categories.size() - kMaxLines;
  std::ranges::stable_sort(categories, std::greater(), &Category::num_points);
  categories.resize(kMaxLines);
  std::ranges::sort(categories, {}, &Category::value);
  return categories;
}

/// Writes lines downwards from the view's upper left corner.
class KindList {
 public:
  KindList(const std::array<int, 2>& size_px, const Background& background)
      : height_px_(size_px[1]), background_(background), line_px_(0.03 * height_px_) {
    middle_px_ = 0.98 * height_px_ - 0.5 * line_px_;
  }

  void Add(const Category& category, bool is_clickable, Legend& legend) {
    const double side_px = 0.6 * line_px_;
    legend.props.emplace_back(
        MakeSwatch(category.rgb, 0.02 * height_px_, middle_px_ - 0.5 * side_px, side_px));
    if (is_clickable) {
      legend.lines.push_back({.value = category.value,
                              .bottom_px = middle_px_ - 0.5 * line_px_,
                              .top_px = middle_px_ + 0.5 * line_px_,
                              .right_px = 0.3 * height_px_});
    }
    std::string words = category.name;
    words += "  ";
    words += GroupedDigits(category.num_points);
    Add(words, legend);
  }

  void Add(const std::string& words, Legend& legend) {
    const double left_px = 0.02 * height_px_ + 0.96 * line_px_;
    const auto text =
        MakeText(words, background_, height_px_, {left_px, middle_px_}, TextAnchor::kLeftMiddle);
    AddPlate(*text->GetTextProperty(), background_);
    legend.props.emplace_back(text);
    middle_px_ -= line_px_;
  }

 private:
  int height_px_;
  const Background& background_;
  double line_px_;
  double middle_px_;
};

void ListKinds(const Coloring& coloring, KindList& list, Legend& legend) {
  std::size_t num_others = 0;
  for (const Category& category : MostFrequent(coloring.categories, num_others)) {
    list.Add(category, true, legend);
  }
  if (num_others > 0) list.Add("and " + std::to_string(num_others) + " others", legend);
}

void ShowScale(const Coloring& coloring,
               const std::array<int, 2>& size_px,
               const Background& background,
               Legend& legend) {
  vtkNew<vtkLookupTable> colors;
  colors->SetNumberOfTableValues(kScaleSteps);
  colors->SetRange(coloring.ends->data());
  for (int i = 0; i < kScaleSteps; ++i) {
    const auto rgb = VtkColor(MapColor(coloring.map, i / (kScaleSteps - 1.0)));
    colors->SetTableValue(i, rgb[0], rgb[1], rgb[2]);
  }
  constexpr double kFoot = 0.12;
  constexpr double kHeight = 0.7;
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colors);
  bar->SetMaximumNumberOfColors(kScaleSteps);
  bar->SetNumberOfLabels(5);
  bar->SetLabelFormat("%-.4g");
  // The bar's size is given as shares of the view, which may be narrow.
  const double height_in_widths = static_cast<double>(size_px[1]) / size_px[0];
  bar->SetPosition(1.0 - 0.17 * height_in_widths, kFoot);
  bar->SetWidth(0.15 * height_in_widths);
  bar->SetHeight(kHeight);
  bar->UnconstrainedFontSizeOn();
  StyleText(*bar->GetLabelTextProperty(), background, size_px[1]);
  legend.props.emplace_back(bar);
  // VTK's own title would be cut off at the edge.
  const std::array<double, 2> title_px = {0.985 * size_px[0],
                                          (kFoot + kHeight + 0.025) * size_px[1]};
  const auto title =
      MakeText(coloring.title, background, size_px[1], title_px, TextAnchor::kRightBottom);
  legend.props.emplace_back(title);
}

}  // namespace

std::optional<Legend::Line> Legend::LineAt(const std::array<double, 2>& place_px) const {
  for (const Line& line : lines) {
    if (place_px[0] <= line.right_px && place_px[1] >= line.bottom_px &&
        place_px[1] < line.top_px) {
      return line;
    }
  }
  return std::nullopt;
}

Legend MakeLegend(const Coloring& coloring,
                  const std::vector<Category>& beam_kinds,
                  const std::array<int, 2>& size_px,
                  const Background& background) {
  Legend legend;
  KindList list(size_px, background);
  if (coloring.ends) {
    ShowScale(coloring, size_px, background, legend);
  } else {
    ListKinds(coloring, list, legend);
  }
  for (const Category& kind : beam_kinds) list.Add(kind, false, legend);
  return legend;
}

}  // namespace railcast
