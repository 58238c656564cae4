#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "generator/extras/import/fit/plan_model.h"

namespace railcast {

/// A part of a plan that is fitted to points by itself. Its beginning and its end stay where they
/// are, except at the ends of the line.
struct PlanWindow {
  PlanModel plan;                         ///< The part: its chainages begin at 0.
  std::vector<bool> has_fixed_curvature;  ///< For each plateau.
  std::vector<Eigen::Vector2d> points_m;
  std::vector<double> feet_m;  ///< Where the feet of the points are expected.
  bool begins_line = false;    ///< Position and heading of its beginning are free.
  bool ends_line = false;
  PlanPoint end;  ///< Where it must end unless it ends the line.
  double sigma_m{};
  double speed_kmph{};
  std::size_t num_feet{};  ///< Sought by Fit, which is what it costs.

  /// Fits the part to its points by least squares (Levenberg-Marquardt, as in MINPACK).
  ///
  /// Residuals are the points' distances in units of sigma, with a pseudo-Huber loss that becomes
  /// linear at 2 sigma; the logarithm of each clothoid's length against its usual one, in units of
  /// 0.5; and penalties for curvatures sharper than the speed allows, for constant parts shorter
  /// than 20 m, and for clothoids of fast lines, above 160 km/h, shorter than half the usual one.
  /// Real lines have the former two where there is no room.
  /// @returns The sum of squares that is left.
  double Fit();
};

/// What PlanWindow::Fit makes small, in the form of Eigen's Levenberg-Marquardt solver: residuals
/// as a function of parameters.
///
/// Parameters are the pose of the window's beginning if it is free, the logarithms of all lengths
/// in their order along the line (which keeps these positive), and the free curvatures. Residuals
/// are the offsets of the points, then those of lengths and curvatures, then those of the ends.
class WindowResiduals {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  using QRSolver = Eigen::ColPivHouseholderQR<JacobianType>;
  // NOLINTNEXTLINE(readability-identifier-naming): names that Eigen asks for
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  explicit WindowResiduals(const PlanWindow& window);

  /// The parameters of the window's own plan.
  [[nodiscard]] Eigen::VectorXd Parameters() const;
  [[nodiscard]] PlanModel PlanOf(const Eigen::VectorXd& parameters) const;

  [[nodiscard]] const std::vector<double>& feet_m() const { return feet_m_; }
  [[nodiscard]] std::size_t num_feet() const { return num_feet_; }

  [[nodiscard]] Eigen::Index inputs() const { return num_inputs_; }
  [[nodiscard]] Eigen::Index values() const;
  int operator()(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals) const;
  /// The derivatives of all residuals in closed form, at the feet of the last evaluation: the
  /// solver makes that at the same parameters.
  ///
  /// A parameter bends or lengthens one element, or bends a plateau with the clothoids beside it.
  /// What lies behind moves as a rigid body, and what lies before it stays. Feet move along with
  /// their elements; that they slide on the track does not change an offset in the first order.
  int df(const Eigen::VectorXd& parameters, Eigen::MatrixXd& jacobian) const;

 private:
  /// Derivatives by the lengths in metres and curvatures in 1/m that parameters stand for.
  using Slopes = std::initializer_list<std::pair<Eigen::Index, double>>;
  /// Calls `add(residual, slopes)` for what lengths and curvatures cost by themselves.
  template <typename Add>
  void VisitPriors(const PlanModel& plan, const Add& add) const;
  /// Derivative of what each parameter stands for, in metres, radians and 1/m, by the parameter; 0
  /// beyond what the solver may try.
  [[nodiscard]] Eigen::VectorXd Rates(const Eigen::VectorXd& parameters) const;
  /// Parameter of the length of a plateau's constant part; the clothoid behind it has the next one.
  [[nodiscard]] Eigen::Index LengthOf(std::size_t plateau) const {
    return first_length_ + 2 * static_cast<Eigen::Index>(plateau);
  }
  [[nodiscard]] Eigen::Index num_points() const {
    return static_cast<Eigen::Index>(window_->points_m.size());
  }

  const PlanWindow* window_;
  double longest_m_;                      ///< The longest element that the solver may try.
  Eigen::Index first_length_;             ///< Parameter of the first element's length.
  std::vector<Eigen::Index> curvatures_;  ///< Parameter of each plateau's curvature; -1: fixed.
  Eigen::Index num_inputs_;
  mutable std::vector<double> feet_m_;  ///< Feet at the last evaluation: guesses for the next one.
  mutable std::size_t num_feet_ = 0;    ///< Sought so far.
};

}  // namespace railcast
