#include "core/rail/line/alignment_course.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace railcast {
namespace {

double SpacingOf_mm(const AlignmentSpec& spec) {
  return spec.gauge_mm + kRailHeadWidth_mm;
}

/// Balancing cant in mm over the square of the speed in km/h and the curvature in 1/m.
double BalancingCantOf(const AlignmentSpec& spec) {
  return kBalancingCant * (SpacingOf_mm(spec) / kStandardSpacing_mm);
}

double HeightByRuleMm(double curvature_per_m, double speed_kmph, const AlignmentSpec& spec) {
  const double balanced_mm =
      BalancingCantOf(spec) * speed_kmph * speed_kmph * std::abs(curvature_per_m);
  const double cant_mm = std::clamp(balanced_mm - spec.cant_deficiency_mm, 0.0, spec.cant_max_mm);
  return std::copysign(cant_mm, curvature_per_m);
}

struct StretchOfTrack {
  double begin_s_m{}, end_s_m{};
  double begin_curvature_per_m{}, end_curvature_per_m{};
};

// The chainages between which the rule is linear: where it reaches 0 or its maximum.
std::vector<double> CornersOf(const StretchOfTrack& stretch,
                              double speed_kmph,
                              const AlignmentSpec& spec) {
  std::vector<double> corners_s_m;
  const double rise_per_m = stretch.end_curvature_per_m - stretch.begin_curvature_per_m;
  for (const double balanced_mm :
       {spec.cant_deficiency_mm, spec.cant_deficiency_mm + spec.cant_max_mm}) {
    const double corner_per_m = balanced_mm / (BalancingCantOf(spec) * speed_kmph * speed_kmph);
    for (const double curvature_per_m : {-corner_per_m, corner_per_m}) {
      const double part = (curvature_per_m - stretch.begin_curvature_per_m) / rise_per_m;
      const double s_m = stretch.begin_s_m + part * (stretch.end_s_m - stretch.begin_s_m);
      // Also false if there is no change of curvature and the division yields NaN or infinity.
      if (s_m > stretch.begin_s_m && s_m < stretch.end_s_m) corners_s_m.push_back(s_m);
    }
  }
  corners_s_m.push_back(stretch.begin_s_m);
  std::sort(corners_s_m.begin(), corners_s_m.end());
  corners_s_m.erase(std::unique(corners_s_m.begin(), corners_s_m.end()), corners_s_m.end());
  return corners_s_m;
}

PiecewiseLinear HeightByRule(const PiecewiseLinear& curvature,
                             const PiecewiseLinear& speed_kmph,
                             const AlignmentSpec& spec) {
  std::vector<double> bounds_s_m{curvature.end_s_m()};
  for (const LinearPiece& piece : curvature.pieces()) bounds_s_m.push_back(piece.begin_s_m);
  for (const LinearPiece& piece : speed_kmph.pieces()) bounds_s_m.push_back(piece.begin_s_m);
  std::sort(bounds_s_m.begin(), bounds_s_m.end());
  bounds_s_m.erase(std::unique(bounds_s_m.begin(), bounds_s_m.end()), bounds_s_m.end());

  std::vector<LinearPiece> pieces;
  for (std::size_t i = 0; i + 1 < bounds_s_m.size(); ++i) {
    const StretchOfTrack stretch{bounds_s_m[i], bounds_s_m[i + 1], curvature.Value(bounds_s_m[i]),
                                 curvature.Value(bounds_s_m[i + 1])};
    const double speed = speed_kmph.Value(stretch.begin_s_m);
    const std::vector<double> corners_s_m = CornersOf(stretch, speed, spec);
    for (std::size_t k = 0; k < corners_s_m.size(); ++k) {
      const double end_s_m = k + 1 < corners_s_m.size() ? corners_s_m[k + 1] : stretch.end_s_m;
      pieces.push_back({corners_s_m[k],
                        HeightByRuleMm(curvature.Value(corners_s_m[k]), speed, spec),
                        HeightByRuleMm(curvature.Value(end_s_m), speed, spec)});
    }
  }
  return {std::move(pieces), curvature.end_s_m()};
}

/// Shorter pieces would be lost in rounding against the chainage of a long line.
constexpr double kShortestStretch_m = 1e-3;

PiecewiseLinear Straight() {
  return {{LinearPiece{}}, 1.0};
}

double CurvatureOfRadius(const std::optional<double>& radius_m) {
  return radius_m ? 1.0 / *radius_m : 0.0;
}

void CheckRadius(const std::optional<double>& radius_m,
                 const std::string& pointer,
                 ErrorList& errors) {
  if (radius_m && !(std::abs(*radius_m) >= kSmallestRadius_m)) {
    errors.Add({pointer,
                "must be at least " + NumberText(kSmallestRadius_m) +
                    " m, negative to the right, absent where straight",
                NumberText(*radius_m)});
  }
}

// Limits full turns, because all turns of a line that coils upon itself would be in view at once.
// Mountain spirals have at most three.
void CheckTurns(const PiecewiseLinear& curvature, const std::string& pointer, ErrorList& errors) {
  constexpr double kMostTurns = 10.0;
  for (std::size_t i = 0; i < curvature.pieces().size(); ++i) {
    const LinearPiece& piece = curvature.pieces()[i];
    const double length_m = curvature.EndOf(i) - piece.begin_s_m;
    const double sharpest_per_m = std::max(std::abs(piece.begin_value), std::abs(piece.end_value));
    const double turns = sharpest_per_m * length_m / (2.0 * std::numbers::pi);
    if (turns <= kMostTurns) continue;
    errors.Add({pointer + "/" + std::to_string(i),
                "must be shorter than 10 full circles of its smallest radius", NumberText(turns)});
  }
}

// Checks that chainages start at 0, ascend strictly and stay before the end.
template <typename Item>
void CheckChainages(const std::vector<Item>& items,
                    double length_m,
                    const std::string& pointer,
                    ErrorList& errors) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const double s_m = items[i].s_m;
    const auto add = [&](const std::string& rule) {
      errors.Add({pointer + "/" + std::to_string(i) + "/s_m", rule, NumberText(s_m)});
    };
    if (i == 0) {
      if (s_m != 0.0) add("must be 0, the beginning of the line");
    } else if (!(s_m > items[i - 1].s_m)) {
      add("must be greater than " + NumberText(items[i - 1].s_m) + " before it");
    } else if (!(s_m - items[i - 1].s_m >= kShortestStretch_m)) {
      add("must be at least " + NumberText(kShortestStretch_m) + " m after " +
          NumberText(items[i - 1].s_m) + " before it");
    }
    if (!(s_m < length_m)) {
      add("must be less than the line's length of " + NumberText(length_m) + " m");
    } else if (!(length_m - s_m >= kShortestStretch_m)) {
      add("must be at least " + NumberText(kShortestStretch_m) + " m before the line's end at " +
          NumberText(length_m) + " m");
    }
  }
}

void CheckElement(const std::vector<AlignmentElement>& elements, std::size_t i, ErrorList& errors) {
  const AlignmentElement& element = elements[i];
  const std::string pointer = "/course/elements/" + std::to_string(i);
  if (!(element.length_m > 0.0)) {
    errors.Add({pointer + "/length_m", "must be > 0", NumberText(element.length_m)});
  }
  if (element.type == ElementType::kArc) {
    if (!element.radius_m) {
      errors.Add({pointer + "/radius_m", "is required for an arc", "none"});
    }
    CheckRadius(element.radius_m, pointer + "/radius_m", errors);
    return;
  }
  if (element.radius_m) {
    errors.Add({pointer + "/radius_m", "is for arcs only", NumberText(*element.radius_m)});
  }
  if (element.type == ElementType::kClothoid && i > 0 &&
      elements[i - 1].type == ElementType::kClothoid) {
    errors.Add({pointer + "/type",
                "must not be clothoid after a clothoid (put an arc or a straight between them)",
                ""});
  }
}

// Curvature of a straight or an arc; 0 beyond either end.
double ConstantCurvature(const std::vector<AlignmentElement>& elements, std::size_t i) {
  return i < elements.size() ? CurvatureOfRadius(elements[i].radius_m) : 0.0;
}

}  // namespace

Cant::Cant(const PiecewiseLinear& curvature,
           const PiecewiseLinear& speed_kmph,
           const AlignmentSpec& spec)
    : height_mm_(HeightByRule(curvature, speed_kmph, spec)),
      ramp_m_(spec.cant_ramp_m),
      spacing_mm_(SpacingOf_mm(spec)) {}

Cant::Cant(PiecewiseLinear surveyed_mm, const AlignmentSpec& spec)
    : height_mm_(std::move(surveyed_mm)), ramp_m_(0.0), spacing_mm_(SpacingOf_mm(spec)) {}

double Cant::HeightMm(double s_m) const {
  if (ramp_m_ == 0.0) return height_mm_.Value(s_m);
  const double half_m = 0.5 * ramp_m_;
  return (height_mm_.Integral(s_m + half_m) - height_mm_.Integral(s_m - half_m)) / ramp_m_;
}

double Cant::RollRad(double s_m) const {
  return -std::asin(HeightMm(s_m) / spacing_mm_);
}

PiecewiseLinear CurvatureOf(const AlignmentSectionsSpec& course, ErrorList& errors) {
  const std::size_t num_faults = errors.size();
  if (!(course.length_m > 0.0)) {
    errors.Add({"/course/length_m", "must be > 0", NumberText(course.length_m)});
  }
  if (course.sections.empty()) {
    errors.Add({"/course/sections", "must have at least one section", "none"});
  }
  CheckChainages(course.sections, course.length_m, "/course/sections", errors);
  for (std::size_t i = 0; i < course.sections.size(); ++i) {
    const std::string pointer = "/course/sections/" + std::to_string(i);
    CheckRadius(course.sections[i].radius_start_m, pointer + "/radius_start_m", errors);
    CheckRadius(course.sections[i].radius_end_m, pointer + "/radius_end_m", errors);
  }
  if (errors.size() > num_faults) return Straight();

  std::vector<LinearPiece> pieces;
  pieces.reserve(course.sections.size());
  for (const CurvatureSection& section : course.sections) {
    pieces.push_back({section.s_m, CurvatureOfRadius(section.radius_start_m),
                      CurvatureOfRadius(section.radius_end_m)});
  }
  PiecewiseLinear curvature(std::move(pieces), course.length_m);
  CheckTurns(curvature, "/course/sections", errors);
  return errors.size() > num_faults ? Straight() : curvature;
}

PiecewiseLinear CurvatureOf(const AlignmentElementsSpec& course, ErrorList& errors) {
  const std::size_t num_faults = errors.size();
  if (course.elements.empty()) {
    errors.Add({"/course/elements", "must have at least one element", "none"});
  }
  for (std::size_t i = 0; i < course.elements.size(); ++i) CheckElement(course.elements, i, errors);
  if (errors.size() > num_faults) return Straight();

  std::vector<LinearPiece> pieces;
  pieces.reserve(course.elements.size());
  double s_m = 0.0;
  for (std::size_t i = 0; i < course.elements.size(); ++i) {
    const bool is_clothoid = course.elements[i].type == ElementType::kClothoid;
    // For i = 0, i - 1 wraps to a value beyond the end, where the curvature is 0.
    const std::size_t before = is_clothoid ? i - 1 : i;
    const std::size_t after = is_clothoid ? i + 1 : i;
    pieces.push_back({s_m, ConstantCurvature(course.elements, before),
                      ConstantCurvature(course.elements, after)});
    s_m += course.elements[i].length_m;
  }
  PiecewiseLinear curvature(std::move(pieces), s_m);
  CheckTurns(curvature, "/course/elements", errors);
  return errors.size() > num_faults ? Straight() : curvature;
}

PiecewiseLinear StepsOf(const std::vector<ChainageValue>& values,
                        double length_m,
                        double otherwise,
                        const std::string& pointer,
                        ErrorList& errors) {
  const std::size_t num_faults = errors.size();
  CheckChainages(values, length_m, pointer, errors);
  if (values.empty() || errors.size() > num_faults) {
    return {{{0.0, otherwise, otherwise}}, length_m};
  }
  std::vector<LinearPiece> pieces;
  pieces.reserve(values.size());
  for (const ChainageValue& step : values) pieces.push_back({step.s_m, step.value, step.value});
  return {std::move(pieces), length_m};
}

PiecewiseLinear LinesThrough(const std::vector<ChainageValue>& values,
                             double length_m,
                             const std::string& pointer,
                             ErrorList& errors) {
  const PiecewiseLinear steps = StepsOf(values, length_m, 0.0, pointer, errors);
  std::vector<LinearPiece> pieces = steps.pieces();
  for (std::size_t i = 1; i < pieces.size(); ++i) pieces[i - 1].end_value = pieces[i].begin_value;
  return {std::move(pieces), length_m};
}

}  // namespace railcast
