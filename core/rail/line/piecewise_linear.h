#pragma once

#include <cstddef>
#include <vector>

namespace railcast {

/// A section of the chainage over which a value changes linearly.
struct LinearPiece {
  double begin_s_m{};
  double begin_value{};
  double end_value{};
};

/// A function of chainage made of linear pieces, with its exact integral. Neighbouring pieces may
/// be discontinuous; at a jump, the value is that of the piece after it. Before the first piece and
/// beyond the end, the value is constant.
class PiecewiseLinear {
 public:
  /// @pre `pieces` is not empty; its chainages are strictly ascending and less than `end_s_m`.
  PiecewiseLinear(std::vector<LinearPiece> pieces, double end_s_m);

  [[nodiscard]] double Value(double s_m) const;
  /// Integral from the start of the first piece to `s_m`.
  [[nodiscard]] double Integral(double s_m) const;

  [[nodiscard]] const std::vector<LinearPiece>& pieces() const { return pieces_; }
  [[nodiscard]] double end_s_m() const { return end_s_m_; }
  [[nodiscard]] double EndOf(std::size_t piece) const;
  [[nodiscard]] double SlopeOf(std::size_t piece) const;
  [[nodiscard]] double LargestMagnitude() const;

 private:
  [[nodiscard]] std::size_t PieceAt(double s_m) const;

  std::vector<LinearPiece> pieces_;
  std::vector<double> integral_before_;  ///< Integral up to the start of each piece.
  double end_s_m_{};
};

/// A jump of a piecewise linear function, and the length over which it now changes linearly.
struct Jump {
  double s_m{};
  double before{};
  double after{};
  double length_m{};
};

struct SmoothedFunction {
  PiecewiseLinear function;
  std::vector<Jump> jumps;  ///< In order of chainage.
};

/// Replaces every jump by a linear change centred on it. The change is at most `max_length_m` long
/// and shorter where a neighbouring piece is short: two changes share the piece between them, and
/// none extends past its neighbouring pieces. Between constant pieces, the integral beyond the
/// change is preserved.
[[nodiscard]] SmoothedFunction SmoothJumps(const PiecewiseLinear& function, double max_length_m);

}  // namespace railcast
