#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "generator/extras/import/fit/line_fit.h"
#include "generator/extras/import/fit/plan_window.h"

namespace railcast {

/// A line that is being fitted, with its points.
class LineDraft {
 public:
  /// Divides the points into arcs and fits these one after another.
  LineDraft(std::span<const Eigen::Vector2d> points_m, const LinePrior& prior);

  [[nodiscard]] const PlanModel& plan() const { return plan_; }
  [[nodiscard]] std::size_t num_plateaus() const { return plan_.plateaus.size(); }

  /// Some neighbouring plateaus of the line, apart from it.
  struct Part {
    std::size_t first{};  ///< Plateau of the line.
    std::size_t last{};
    PlanWindow window;
    std::vector<std::size_t> points;  ///< Points of the window, by their numbers on the line.
  };
  /// The part from the middle of plateau `first`, or the beginning of the line, to the middle of
  /// plateau `last`, or the end of the line.
  [[nodiscard]] Part PartOf(std::size_t first, std::size_t last) const;
  /// Puts a part that was fitted into the line. What is behind it moves with its end, and so do the
  /// feet there, so that only those of the part's own points are sought anew.
  void Replace(const Part& part);

  /// Chainages of the points' feet on the plan.
  [[nodiscard]] const std::vector<double>& feet_m() const { return feet_m_; }
  /// How many feet were sought, which is what the first draft costs.
  [[nodiscard]] std::size_t num_feet() const { return num_feet_; }

 private:
  /// An arc between two of the points.
  struct Arc {
    std::size_t end{};  ///< Its last point.
    double curvature_per_m{};
  };
  [[nodiscard]] Arc LongestArc(std::size_t begin, double tolerance_m) const;
  void Append(std::size_t begin, const Arc& arc);
  /// Chainage of the middle of a plateau's constant part.
  [[nodiscard]] double MiddleOf_m(std::size_t plateau) const {
    return plan_.ConstantBegin_m(plateau) + 0.5 * plan_.ConstantLength_m(plateau);
  }
  /// Moves the feet behind a part that becomes longer.
  void MoveFeet(const Part& part, double longer_m);

  std::span<const Eigen::Vector2d> points_m_;
  const LinePrior& prior_;
  std::vector<double> along_m_;  ///< Distance of each point along the points.
  PlanModel plan_;
  std::vector<double> feet_m_;  ///< Feet of the points that the plan reaches by now.
  std::size_t num_feet_ = 0;
};

}  // namespace railcast
