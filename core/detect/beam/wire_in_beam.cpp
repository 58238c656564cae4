#include "core/detect/beam/wire_in_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/detect/base/normal_table.h"

namespace railcast {
namespace {

constexpr double kNear_m = 0.01;
constexpr double kNoticedSigmas = 4.0;
constexpr double kLeastSigma_rad = 1e-7;
constexpr double kLeastShare = 1e-12;  // Share of a part that is below the error of the tables.
constexpr double kRangeStep = 1.2;     // Linearisation errs by a few per cent up to this ratio.

// Mean depth of the lit half of a cylinder's section over its radius: sqrt(1 - u^2), u uniform in
// (-1, 1), weighted with itself, since a Lambertian surface responds with that cosine.
constexpr double kMeanDepth = 8.0 / (3.0 * std::numbers::pi);
constexpr double kDepthVariance = 0.75 - kMeanDepth * kMeanDepth;

/// A point of the wire's axis in the beam.
struct Sight {
  double across{};  ///< Coordinate along the wire's image, in sigmas from the beam's middle.
  double inverse_depth_per_m{};
};

/// The image of a wire's axis in the plane across the beam, in units of the beam's sigmas.
struct Image {
  Sight begin, end;             ///< begin.across < end.across.
  double distance{};            ///< Signed distance of the line from the beam's middle.
  double direction[2]{};        ///< Unit direction of the line: horizontal, vertical.
  double sigma_h{}, sigma_v{};  ///< Standard deviations of the beam, rad.
  Vector3 axis;                 ///< Unit direction of the wire: horizontal, vertical, along beam.

  [[nodiscard]] double InverseDepthAt_per_m(double across) const {
    const double slope_per_m =
        (end.inverse_depth_per_m - begin.inverse_depth_per_m) / (end.across - begin.across);
    return begin.inverse_depth_per_m + slope_per_m * (across - begin.across);
  }
};

/// Mean and variance of a standard normal variable restricted to [begin, end], and the probability
/// of that interval.
struct TruncatedNormal {
  double share{}, mean{}, variance{};
};

TruncatedNormal TruncateNormal(double begin, double end) {
  const double share = NormalShare(begin, end);
  const double middle = 0.5 * (begin + end);
  const double width = end - begin;
  // Differences of table values are inaccurate in a narrow interval; assume a uniform density.
  if (width < 0.02) return {share, middle, width * width / 12.0};
  if (share < kLeastShare) return {};
  const double at_begin = NormalDensity(begin);
  const double at_end = NormalDensity(end);
  const double mean = (at_begin - at_end) / share;
  const double variance = 1.0 + (begin * at_begin - end * at_end) / share - mean * mean;
  return {share, std::clamp(mean, begin, end), std::max(variance, 0.0)};
}

/// The beam's sigma across the wire in radians. Scaling by the sigmas does not preserve angles, so
/// it is not the sigma along the normal of the scaled image.
double SigmaAcross_rad(const Image& image) {
  const double run_x = image.sigma_h * image.direction[0];
  const double run_y = image.sigma_v * image.direction[1];
  return image.sigma_h * image.sigma_v / std::sqrt(run_x * run_x + run_y * run_y);
}

/// The wire's share, range and spread between two points of its image, linearised; the points must
/// be close to each other.
WireInBeam FindPart(const Image& image, const Sight& begin, const Sight& end, double radius_m) {
  const TruncatedNormal along = TruncateNormal(begin.across, end.across);
  if (along.share < kLeastShare) return {};
  const double x =
      image.sigma_h * (image.direction[0] * along.mean - image.direction[1] * image.distance);
  const double y =
      image.sigma_v * (image.direction[1] * along.mean + image.direction[0] * image.distance);
  const double inverse_depth_per_m = image.InverseDepthAt_per_m(along.mean);
  const Vector3 sight(x, y, 1.0);
  const double axis_m = sight.norm() / inverse_depth_per_m;
  const double sin_axis = std::min(1.0, sight.normalized().cross(image.axis).norm());

  const double half_width = radius_m / axis_m / SigmaAcross_rad(image);
  const double share =
      NormalShare(image.distance - half_width, image.distance + half_width) * along.share;

  // Limited to the distance of the axis for a sensor almost inside the wire.
  const double depth_m = std::min(radius_m / std::max(sin_axis, 1e-12), axis_m);
  const double change = std::fabs(end.inverse_depth_per_m - begin.inverse_depth_per_m) /
                        (end.across - begin.across) / inverse_depth_per_m;
  const double slope_variance_m2 = axis_m * axis_m * change * change * along.variance;
  return {.share = share,
          .range_m = axis_m - kMeanDepth * depth_m,
          .spread_m = std::sqrt(slope_variance_m2 + kDepthVariance * depth_m * depth_m),
          .sin_axis = sin_axis};
}

/// Adds parts: their moments, weighted by their shares.
class PartSum {
 public:
  void Add(const WireInBeam& part) {
    share_ += part.share;
    range_m_ += part.share * part.range_m;
    sin_axis_ += part.share * part.sin_axis;
    const double second_m2 = part.range_m * part.range_m + part.spread_m * part.spread_m;
    range_square_m2_ += part.share * second_m2;
  }
  [[nodiscard]] WireInBeam Mean() const {
    if (!(share_ > 0.0)) return {};
    const double range_m = range_m_ / share_;
    const double variance_m2 = range_square_m2_ / share_ - range_m * range_m;
    return {.share = std::min(share_, 1.0),  // Rounding may exceed 1.
            .range_m = range_m,
            .spread_m = std::sqrt(std::max(variance_m2, 0.0)),
            .sin_axis = sin_axis_ / share_};
  }

 private:
  double share_{}, range_m_{}, range_square_m2_{}, sin_axis_{};
};

/// Cuts the visible piece wherever the range has changed by a factor of kRangeStep, and adds the
/// parts.
WireInBeam AddParts(const Image& image, const Sight& begin, const Sight& end, double radius_m) {
  const bool comes_nearer = end.inverse_depth_per_m > begin.inverse_depth_per_m;
  const double step = comes_nearer ? kRangeStep : 1.0 / kRangeStep;
  PartSum sum;
  Sight from = begin;
  while (from.across < end.across) {
    Sight to = end;
    const double next_per_m = from.inverse_depth_per_m * step;
    if (comes_nearer ? next_per_m < end.inverse_depth_per_m
                     : next_per_m > end.inverse_depth_per_m) {
      const double fraction = (next_per_m - begin.inverse_depth_per_m) /
                              (end.inverse_depth_per_m - begin.inverse_depth_per_m);
      to = {begin.across + fraction * (end.across - begin.across), next_per_m};
    }
    sum.Add(FindPart(image, from, to, radius_m));
    from = to;
  }
  return sum.Mean();
}

/// Coordinates of a point in the beam's frame: horizontal, vertical, along the beam.
Vector3 InBeam(const WideBeam& beam, const Eigen::Vector3f& point_m) {
  const Vector3 from_origin_m = point_m.cast<double>() - beam.origin_m;
  return {from_origin_m.dot(beam.horizontal), from_origin_m.dot(beam.vertical),
          from_origin_m.dot(beam.direction)};
}

}  // namespace

WireInBeam FindWireInBeam(const WideBeam& beam, const WireSegment& wire) {
  Vector3 begin_m = InBeam(beam, wire.begin_m);
  Vector3 end_m = InBeam(beam, wire.end_m);
  if (begin_m.z() > end_m.z()) std::swap(begin_m, end_m);
  if (!(end_m.z() > kNear_m)) return {};
  const Vector3 run_m = end_m - begin_m;
  if (begin_m.z() < kNear_m) begin_m += (kNear_m - begin_m.z()) / run_m.z() * run_m;

  Image image;
  image.axis = run_m.normalized();
  image.sigma_h = std::max(beam.sigma_horizontal_rad, kLeastSigma_rad);
  image.sigma_v = std::max(beam.sigma_vertical_rad, kLeastSigma_rad);
  const Eigen::Vector2d sigmas(image.sigma_h, image.sigma_v);
  const Eigen::Vector2d first = (begin_m.head<2>() / begin_m.z()).cwiseQuotient(sigmas);
  const Eigen::Vector2d last = (end_m.head<2>() / end_m.z()).cwiseQuotient(sigmas);
  const double length = (last - first).norm();
  if (!(length > 1e-12)) return {};  // Seen end-on.
  const Eigen::Vector2d direction = (last - first) / length;
  image.direction[0] = direction.x();
  image.direction[1] = direction.y();
  image.distance = direction.x() * first.y() - direction.y() * first.x();
  image.begin = {direction.dot(first), 1.0 / begin_m.z()};
  image.end = {direction.dot(first) + length, 1.0 / end_m.z()};

  if (image.begin.across > kNormalReach || image.end.across < -kNormalReach) return {};
  const auto radius_m = static_cast<double>(wire.radius_m);
  const double nearest_per_m =
      std::max(image.begin.inverse_depth_per_m, image.end.inverse_depth_per_m);
  const double half_width_max = radius_m * nearest_per_m / sigmas.minCoeff();
  if (std::fabs(image.distance) > kNoticedSigmas + half_width_max) return {};
  Sight from = image.begin;
  Sight to = image.end;
  if (from.across < -kNormalReach)
    from = {-kNormalReach, image.InverseDepthAt_per_m(-kNormalReach)};
  if (to.across > kNormalReach) to = {kNormalReach, image.InverseDepthAt_per_m(kNormalReach)};
  WireInBeam found = AddParts(image, from, to, radius_m);
  const auto half_width = [&](const Sight& sight) {
    return static_cast<float>(radius_m * sight.inverse_depth_per_m / SigmaAcross_rad(image));
  };
  found.strip = {{static_cast<float>(image.direction[0]), static_cast<float>(image.direction[1])},
                 static_cast<float>(image.distance),
                 static_cast<float>(from.across),
                 static_cast<float>(to.across),
                 {half_width(from), half_width(to)}};
  return found;
}

namespace {

/// Shortens a part to where constant + slope * position >= 0.
void Clip(float constant, float slope, StripPart& part) {
  if (slope > 0.0F) {
    part.begin = std::max(part.begin, -constant / slope);
  } else if (slope < 0.0F) {
    part.end = std::min(part.end, -constant / slope);
  } else if (constant < 0.0F) {
    part.end = part.begin;
  }
}

}  // namespace

StripPart CoveredPart(const WireStrip& strip, float aside, const WireStrip& other) {
  if (!(other.begin < other.end)) return {};
  // Positions along the other strip and across it are linear in the position t along the line.
  const float across = strip.offset + aside;
  const float cosine =
      strip.direction[0] * other.direction[0] + strip.direction[1] * other.direction[1];
  const float sine =
      strip.direction[1] * other.direction[0] - strip.direction[0] * other.direction[1];
  const float along_0 = -sine * across;
  const float across_0 = cosine * across - other.offset;
  const float half_slope = (other.halves[1] - other.halves[0]) / (other.end - other.begin);
  const float half_0 = other.halves[0] + half_slope * (along_0 - other.begin);
  StripPart part{strip.begin, strip.end};
  Clip(along_0 - other.begin, cosine, part);
  Clip(other.end - along_0, -cosine, part);
  Clip(half_0 - across_0, half_slope * cosine - sine, part);
  Clip(half_0 + across_0, half_slope * cosine + sine, part);
  return part;
}

}  // namespace railcast
