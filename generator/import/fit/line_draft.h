#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "generator/import/fit/line_fit.h"
#include "generator/import/fit/plan_window.h"

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
  };
  /// The part from the middle of plateau `first`, or the beginning of the line, to the middle of
  /// plateau `last`, or the end of the line.
  [[nodiscard]] Part PartOf(std::size_t first, std::size_t last) const;
  /// Puts a part that was fitted into the line. What is behind it moves with its end.
  void Replace(const Part& part);

  /// Chainages of the points' feet on the plan.
  [[nodiscard]] const std::vector<double>& feet_m() const { return feet_m_; }

 private:
  /// An arc between two of the points.
  struct Arc {
    std::size_t end{};  ///< Its last point.
    double curvature_per_m{};
  };
  [[nodiscard]] Arc LongestArc(std::size_t begin, double tolerance_m) const;
  void Append(std::size_t begin, const Arc& arc);
  void FindFeet();

  std::span<const Eigen::Vector2d> points_m_;
  const LinePrior& prior_;
  std::vector<double> along_m_;  ///< Distance of each point along the points.
  PlanModel plan_;
  std::vector<double> feet_m_;  ///< Of those points that the plan reaches by now.
};

}  // namespace railcast
