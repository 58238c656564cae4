#include "viewer/plan/draw_plan.h"

#include <vtkActor2D.h>
#include <vtkNew.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/text.h"
#include "viewer/draw/actors.h"
#include "viewer/draw/text_style.h"
#include "viewer/draw/vtk_values.h"

namespace railcast {
namespace {

using Place = Eigen::Vector2d;

constexpr Rgb kPlanWordsRgb{225, 225, 225};
constexpr std::size_t kMostEntries = 40;

/// Draws a plan in pixels, from the lower left corner.
class PlanSheet {
 public:
  PlanSheet(const Background& background, const std::array<int, 2>& size_px)
      : background_(background), width_px_(size_px[0]), height_px_(size_px[1]) {
    font_px_ = std::max(9, std::min(width_px_ / 95, height_px_ / 24));
    window_->SetOffScreenRendering(true);
    window_->SetMultiSamples(0);
    window_->SetSize(width_px_, height_px_);
    const auto rgb = VtkColor(background.rgb);
    renderer_->SetBackground(rgb[0], rgb[1], rgb[2]);
    window_->AddRenderer(renderer_);
  }

  vtkSmartPointer<vtkRenderWindow> Draw(const Plan& plan, const std::string& title) {
    const double legend_px = AddLegend(plan);
    (void)AddText(title, kPlanWordsRgb,
                  {font_px_, height_px_ - 0.5 * font_px_ - 0.5 * LineHeight_px()});
    Fit(plan, legend_px + 1.5 * LineHeight_px());
    for (const Plan::Line& line : plan.lines) {
      std::vector<Place> points;
      for (const Place& point_m : line.points_m) points.push_back(OnSheet(point_m));
      AddShape(points, false, line.rgb)->SetLineWidth(static_cast<float>(line.width_px));
      last_->SetOpacity(line.opacity);
    }
    for (const Plan::Mark& mark : plan.marks) {
      AddMark(OnSheet(mark.at_m), mark.from_tip, mark.rgb);
    }
    for (const Plan::Word& word : plan.words) AddWord(word);
    AddScaleBar(plan, legend_px);
    window_->Render();
    return window_;
  }

 private:
  [[nodiscard]] double LineHeight_px() const { return 1.6 * font_px_; }
  [[nodiscard]] Place OnSheet(const Place& at_m) const {
    return corner_px_ + px_per_m_ * (at_m - least_m_);
  }

  /// Chooses the scale so that all lines are between the margins, above `foot_px`.
  void Fit(const Plan& plan, double foot_px) {
    Eigen::AlignedBox2d box;
    for (const Plan::Line& line : plan.lines) {
      for (const Place& point_m : line.points_m) box.extend(point_m);
    }
    for (const Plan::Mark& mark : plan.marks) box.extend(mark.at_m);
    const double left_px = 4.0 * font_px_;
    // Names of tracks stand to the right of their ends, chainages above their ticks.
    const double right_px = 9.0 * font_px_;
    const double head_px = 3.0 * LineHeight_px();
    const Place room_px(std::max(8.0, width_px_ - left_px - right_px),
                        std::max(8.0, height_px_ - head_px - foot_px));
    const Place size_m = box.sizes().cwiseMax(Place(1.0, 1.0));
    px_per_m_ = (room_px.array() / size_m.array()).minCoeff();
    least_m_ = box.min();
    corner_px_ = Place(left_px, foot_px) + 0.5 * (room_px - px_per_m_ * box.sizes());
  }

  /// A line through the points, or the area between them.
  vtkProperty2D* AddShape(const std::vector<Place>& points, bool is_filled, const Rgb& rgb) {
    const auto actor = MakeShape(points, is_filled, OnBackground(rgb, background_));
    renderer_->AddActor2D(actor);
    last_ = actor->GetProperty();
    return last_;
  }

  void AddMark(const Place& at, const Place& from_tip, const Rgb& rgb) {
    if (from_tip.isZero()) {
      const double half_px = 0.2 * font_px_;
      AddShape({at + Place(-half_px, -half_px), at + Place(half_px, -half_px),
                at + Place(half_px, half_px), at + Place(-half_px, half_px)},
               true, rgb);
      return;
    }
    const Place base = at + 1.1 * font_px_ * from_tip;
    const Place aside = 0.45 * font_px_ * Place(-from_tip.y(), from_tip.x());
    AddShape({at, base + aside, base - aside}, true, rgb);
  }

  /// Adds words that begin at a place and are centred on it in height.
  vtkSmartPointer<vtkTextActor> AddText(const std::string& words, const Rgb& rgb, const Place& at) {
    auto actor =
        MakeText(words, background_, height_px_, {at.x(), at.y()}, TextAnchor::kLeftMiddle);
    actor->GetTextProperty()->SetFontSize(font_px_);
    actor->GetTextProperty()->SetColor(VtkColor(OnBackground(rgb, background_)).data());
    renderer_->AddActor2D(actor);
    return actor;
  }

  [[nodiscard]] double WidthOf_px(vtkTextActor& text) {
    std::array<double, 2> size_px{};
    text.GetSize(renderer_, size_px.data());
    return size_px[0];
  }

  void AddWord(const Plan::Word& word) {
    Place at = OnSheet(word.at_m);
    const auto actor = AddText(word.text, word.rgb, at);
    const Place size_px(WidthOf_px(*actor), font_px_);
    at += word.is_above ? Place(-0.5 * size_px.x(), 0.8 * font_px_) : Place(0.5 * font_px_, 0.0);
    const Eigen::AlignedBox2d box(at - Place(0.0, 0.5 * font_px_),
                                  at + Place(size_px.x(), 0.5 * font_px_));
    const bool is_free = std::ranges::none_of(
        word_boxes_, [&](const Eigen::AlignedBox2d& other) { return box.intersects(other); });
    if (!is_free || box.max().x() > width_px_) {
      renderer_->RemoveActor2D(actor);
      return;
    }
    actor->SetPosition(at.x(), at.y());
    word_boxes_.push_back(box);
  }

  void AddSample(const Plan::Entry& entry, const Place& at) {
    const double half_px = 0.7 * font_px_;
    switch (entry.sample) {
      case Plan::Sample::kLine:
      case Plan::Sample::kBand: {
        const bool is_band = entry.sample == Plan::Sample::kBand;
        AddShape({at - Place(half_px, 0.0), at + Place(half_px, 0.0)}, false, entry.rgb)
            ->SetLineWidth(is_band ? 9.0F : 2.0F);
        last_->SetOpacity(is_band ? 0.3 : 1.0);
        break;
      }
      case Plan::Sample::kTriangle:
        AddMark(at - Place(0.5 * font_px_, 0.0), {1.0, 0.0}, entry.rgb);
        break;
      case Plan::Sample::kSquare:
        AddMark(at, Place::Zero(), entry.rgb);
        break;
    }
  }

  /// Writes the legend in rows at the foot of the sheet, and returns its height.
  double AddLegend(const Plan& plan) {
    std::vector<Plan::Entry> entries = plan.entries;
    if (entries.size() > kMostEntries) {
      const std::size_t num_others = entries.size() - kMostEntries;
      entries.resize(kMostEntries);
      entries.push_back(
          {"and " + std::to_string(num_others) + " others", kPlanWordsRgb, Plan::Sample::kSquare});
    }
    const double left_px = 1.8 * font_px_;
    std::vector<vtkSmartPointer<vtkTextActor>> texts;
    std::vector<Place> places;  // Rows count downwards from 0.
    Place next(left_px, 0.0);
    for (const Plan::Entry& entry : entries) {
      texts.push_back(AddText(ShownText(entry.text), kPlanWordsRgb, {0.0, 0.0}));
      const double width_px = WidthOf_px(*texts.back()) + 3.2 * font_px_;
      if (next.x() > left_px && next.x() + width_px > width_px_) {
        next = Place(left_px, next.y() - LineHeight_px());
      }
      places.push_back(next);
      next.x() += width_px;
    }
    const double top_px = 0.7 * LineHeight_px() - next.y();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Place at = places[i] + Place(0.0, top_px);
      AddSample(entries[i], at);
      texts[i]->SetPosition(at.x() + font_px_, at.y());
    }
    return top_px + 0.7 * LineHeight_px();
  }

  /// The scale bar and the arrow to the north, above the legend.
  void AddScaleBar(const Plan& plan, double legend_px) {
    // The longest round length that is at most a sixth of the width.
    const double least_m = width_px_ / (15.0 * px_per_m_);
    const double length_m = RoundUp125(least_m);
    const Place from(font_px_, legend_px + 0.6 * LineHeight_px());
    const Place to = from + Place(length_m * px_per_m_, 0.0);
    const Place tick(0.0, 0.35 * font_px_);
    AddShape({from + tick, from - tick, from, to, to + tick, to - tick}, false, kPlanWordsRgb)
        ->SetLineWidth(2.0F);
    const auto text =
        AddText(NumberText(length_m) + " m", kPlanWordsRgb, to + Place(0.5 * font_px_, 0.0));
    const Place middle = to + Place(WidthOf_px(*text) + 3.0 * font_px_, 0.0);
    const Place half = 0.7 * font_px_ * plan.north;
    AddShape({middle - half, middle + half}, false, kPlanWordsRgb)->SetLineWidth(2.0F);
    AddMark(middle + half, -plan.north * 0.6, kPlanWordsRgb);
    (void)AddText("N", kPlanWordsRgb, middle + Place(font_px_, 0.0));
  }

  const Background& background_;
  int width_px_;
  int height_px_;
  int font_px_{};
  vtkSmartPointer<vtkRenderWindow> window_ = vtkSmartPointer<vtkRenderWindow>::New();
  vtkNew<vtkRenderer> renderer_;
  vtkProperty2D* last_{};  ///< Properties of the last shape.
  double px_per_m_ = 1.0;
  Place least_m_ = Place::Zero();
  Place corner_px_ = Place::Zero();
  std::vector<Eigen::AlignedBox2d> word_boxes_;
};

}  // namespace

vtkSmartPointer<vtkRenderWindow> DrawPlan(const Plan& plan,
                                          const std::string& title,
                                          const Background& background,
                                          const std::array<int, 2>& size_px) {
  return PlanSheet(background, size_px).Draw(plan, title);
}

}  // namespace railcast
