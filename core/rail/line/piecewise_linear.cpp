#include "core/rail/line/piecewise_linear.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

// A shorter piece between two adjoining smoothed jumps is a rounding residue and is dropped.
constexpr double kShortestPiece_m = 1e-9;

}  // namespace

PiecewiseLinear::PiecewiseLinear(std::vector<LinearPiece> pieces, double end_s_m)
    : pieces_(std::move(pieces)), end_s_m_(end_s_m) {
  Check(!pieces_.empty(), "a piecewise linear function has a piece");
  integral_before_.reserve(pieces_.size());
  double integral = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double length_m = EndOf(i) - pieces_[i].begin_s_m;
    Check(length_m > 0.0, "pieces ascend in chainage");
    integral_before_.push_back(integral);
    integral += 0.5 * (pieces_[i].begin_value + pieces_[i].end_value) * length_m;
  }
}

std::size_t PiecewiseLinear::PieceAt(double s_m) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), s_m,
                       [](double s, const LinearPiece& piece) { return s < piece.begin_s_m; });
  return after == pieces_.begin() ? 0 : static_cast<std::size_t>(after - pieces_.begin()) - 1;
}

double PiecewiseLinear::EndOf(std::size_t piece) const {
  return piece + 1 < pieces_.size() ? pieces_[piece + 1].begin_s_m : end_s_m_;
}

double PiecewiseLinear::SlopeOf(std::size_t piece) const {
  const LinearPiece& p = pieces_[piece];
  return (p.end_value - p.begin_value) / (EndOf(piece) - p.begin_s_m);
}

double PiecewiseLinear::Value(double s_m) const {
  const std::size_t i = PieceAt(s_m);
  const double inside_m = std::clamp(s_m, pieces_[i].begin_s_m, EndOf(i)) - pieces_[i].begin_s_m;
  return pieces_[i].begin_value + SlopeOf(i) * inside_m;
}

double PiecewiseLinear::Integral(double s_m) const {
  const std::size_t i = PieceAt(s_m);
  const LinearPiece& piece = pieces_[i];
  const double clamped_s_m = std::clamp(s_m, piece.begin_s_m, EndOf(i));
  const double inside_m = clamped_s_m - piece.begin_s_m;
  const double value = piece.begin_value + SlopeOf(i) * inside_m;
  return integral_before_[i] + 0.5 * (piece.begin_value + value) * inside_m +
         value * (s_m - clamped_s_m);
}

double PiecewiseLinear::LargestMagnitude() const {
  double largest = 0.0;
  for (const LinearPiece& piece : pieces_) {
    largest = std::max({largest, std::abs(piece.begin_value), std::abs(piece.end_value)});
  }
  return largest;
}

SmoothedFunction SmoothJumps(const PiecewiseLinear& function, double max_length_m) {
  const std::vector<LinearPiece>& pieces = function.pieces();
  const std::size_t count = pieces.size();
  const auto jumps_after = [&](std::size_t i) {
    return i + 1 < count && pieces[i].end_value != pieces[i + 1].begin_value;
  };
  const auto room_m = [&](std::size_t i) {
    const double length_m = function.EndOf(i) - pieces[i].begin_s_m;
    const bool is_shared = i > 0 && jumps_after(i - 1) && jumps_after(i);
    return is_shared ? 0.5 * length_m : length_m;
  };
  const auto value_in = [&](std::size_t i, double s_m) {
    return pieces[i].begin_value + function.SlopeOf(i) * (s_m - pieces[i].begin_s_m);
  };

  std::vector<LinearPiece> smooth;
  std::vector<Jump> jumps;
  double begin_s_m = pieces.front().begin_s_m;  // Start of the remainder of the current piece.
  double begin_value = pieces.front().begin_value;
  for (std::size_t i = 0; i < count; ++i) {
    const double end_s_m = function.EndOf(i);
    if (!jumps_after(i)) {
      if (end_s_m - begin_s_m > kShortestPiece_m)
        smooth.push_back({begin_s_m, begin_value, pieces[i].end_value});
      begin_s_m = end_s_m;
      begin_value = i + 1 < count ? pieces[i + 1].begin_value : 0.0;
      continue;
    }
    const double half_m = std::min({0.5 * max_length_m, room_m(i), room_m(i + 1)});
    const double from_s_m = end_s_m - half_m;
    const double from_value = value_in(i, from_s_m);
    const double to_value = value_in(i + 1, end_s_m + half_m);
    if (from_s_m - begin_s_m > kShortestPiece_m) {
      smooth.push_back({begin_s_m, begin_value, from_value});
      begin_s_m = from_s_m;
    }
    smooth.push_back({begin_s_m, from_value, to_value});
    jumps.push_back({end_s_m, pieces[i].end_value, pieces[i + 1].begin_value, 2.0 * half_m});
    begin_s_m = end_s_m + half_m;
    begin_value = to_value;
  }
  return {PiecewiseLinear(std::move(smooth), function.end_s_m()), std::move(jumps)};
}

}  // namespace railcast
