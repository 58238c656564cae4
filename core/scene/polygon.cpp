#include "core/scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace railcast {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area of a triangle; positive if it turns left.
double Turn(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double Extent(std::span<const Point> outline) {
  double extent = 0.0;
  for (const Point& point : outline) extent = std::max(extent, (point - outline[0]).norm());
  return extent;
}

double TwiceArea(std::span<const Point> outline) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    sum += Turn(outline[0], outline[i], outline[i + 1]);
  }
  return sum;
}

/// Repeatedly clips one ear off the remaining corners.
class Clipper {
 public:
  explicit Clipper(std::span<const Point> outline)
      : outline_(outline),
        left_(outline.size()),
        sign_(TwiceArea(outline) < 0.0 ? -1.0 : 1.0),
        flat_(TwiceFlatArea(Extent(outline))) {
    std::iota(left_.begin(), left_.end(), 0U);
  }

  std::vector<std::array<std::uint32_t, 3>> Clip() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    while (left_.size() >= 3) {
      const std::size_t i = NextEar();
      triangles.push_back(Corner(i));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return triangles;
  }

 private:
  [[nodiscard]] std::array<std::uint32_t, 3> Corner(std::size_t i) const {
    const std::size_t n = left_.size();
    return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
  }

  /// Index of the next corner to clip. Corners without an angle are clipped only if no ear remains:
  /// otherwise the adjacent triangles would lose them, and a crack would open towards a
  /// neighbouring polygon that has them as vertices. An outline with neither ears nor flat corners
  /// intersects itself.
  [[nodiscard]] std::size_t NextEar() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (IsEar(Corner(i))) return i;
    }
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (std::abs(TwiceAreaOf(Corner(i))) <= flat_) return i;
    }
    return 0;
  }

  [[nodiscard]] double TwiceAreaOf(const std::array<std::uint32_t, 3>& corner) const {
    return Turn(outline_[corner[0]], outline_[corner[1]], outline_[corner[2]]);
  }

  [[nodiscard]] bool IsEar(const std::array<std::uint32_t, 3>& corner) const {
    const Point& a = outline_[corner[0]];
    const Point& b = outline_[corner[1]];
    const Point& c = outline_[corner[2]];
    if (sign_ * Turn(a, b, c) <= flat_) return false;
    for (const std::uint32_t index : left_) {
      const Point& p = outline_[index];
      if (p == a || p == b || p == c) continue;
      if (sign_ * Turn(a, b, p) >= 0.0 && sign_ * Turn(b, c, p) >= 0.0 &&
          sign_ * Turn(c, a, p) >= 0.0) {
        return false;
      }
    }
    return true;
  }

  std::span<const Point> outline_;
  std::vector<std::uint32_t> left_;
  double sign_;
  double flat_;  ///< Below this, a corner counts as lying on a straight edge.
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> ClipEars(std::span<const Point> outline) {
  return Clipper(outline).Clip();
}

double TwiceFlatArea(double extent) {
  return 64.0 * std::numeric_limits<double>::epsilon() * extent * extent;
}

std::vector<std::array<std::uint32_t, 3>> TriangulatePolygon(std::span<const Point> outline) {
  std::vector<std::array<std::uint32_t, 3>> triangles = ClipEars(outline);
  const double flat = TwiceFlatArea(Extent(outline));
  std::erase_if(triangles, [&](const auto& corner) {
    return std::abs(Turn(outline[corner[0]], outline[corner[1]], outline[corner[2]])) <= flat;
  });
  return triangles;
}

}  // namespace railcast
