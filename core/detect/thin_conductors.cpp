#include "core/detect/thin_conductors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "core/detect/wire_in_beam.h"
#include "core/scan/scan_pattern.h"

namespace railcast {
namespace {

// Almost all beams pass almost all wires, so that most of the work is to say no. Three sieves, each
// of which lets through whatever might be captured: the tile's cone against spheres of segments,
// the cones of its packets against a segment, and single beams against that. Angles are bounded
// by chords between unit vectors, which add up like angles.

// Outside four sigmas of the nearest point of a wire's image there is 3e-5 of the beam.
constexpr double kSieveSigmas = 4.0;
// For rounding, and for the difference of tangents, angles and chords in beams of some degrees.
constexpr double kSieveSlack = 1.05;
constexpr double kSieveSlack_rad = 2e-6;
constexpr double kAnyChord = 4.0;  // Lets everything through.

constexpr std::size_t kNumPackets = kTileSize / kPacketSize;
static_assert(kNumPackets == kPacketSize, "one loop serves packets and lanes");

/// Directions, struct of arrays: the middles of packets, or the lanes of one.
struct Directions {
  const float* x;
  const float* y;
  const float* z;
};

/// A bundle of beams seen from one point.
struct TileCone {
  Eigen::Vector3d origin_m;  ///< The middle of the beams' origins ...
  double origin_spread_m{};  ///< ... and the farthest of them from there.
  Eigen::Vector3f direction;
  double chord{};  ///< Greatest distance of a direction from the middle one.
  std::size_t num_packets{};
  alignas(64) float x[kNumPackets], y[kNumPackets], z[kNumPackets];  ///< Middles of the packets.
  alignas(64) float packet_chord[kNumPackets];
};

/// The mean direction of some lanes, and the greatest distance of one from it.
double BoundDirections(const RayTile& rays,
                       std::size_t first,
                       std::size_t end,
                       Eigen::Vector3f& middle) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = first; i < end; ++i) {
    sum += Eigen::Vector3f(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
  }
  middle = sum.normalized();
  float square = 0.0F;
  for (std::size_t i = first; i < end; ++i) {
    const float x = rays.direction_x[i] - middle.x();
    const float y = rays.direction_y[i] - middle.y();
    const float z = rays.direction_z[i] - middle.z();
    square = std::max(square, x * x + y * y + z * z);
  }
  return static_cast<double>(std::sqrt(square));
}

void BoundOrigins(const RayTile& rays, TileCone& cone) {
  Eigen::Vector3f min_m(rays.origin_x[0], rays.origin_y[0], rays.origin_z[0]);
  Eigen::Vector3f max_m = min_m;
  for (std::size_t i = 1; i < rays.num_rays; ++i) {
    const Eigen::Vector3f origin_m(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]);
    min_m = min_m.cwiseMin(origin_m);
    max_m = max_m.cwiseMax(origin_m);
  }
  cone.origin_m = (0.5F * (min_m + max_m)).cast<double>();
  cone.origin_spread_m = 0.51 * static_cast<double>((max_m - min_m).norm());
}

TileCone BoundTile(const RayTile& rays) {
  TileCone cone{};
  BoundOrigins(rays, cone);
  cone.chord = BoundDirections(rays, 0, rays.num_rays, cone.direction);
  cone.num_packets = rays.num_rays / kPacketSize;
  for (std::size_t i = 0; i < cone.num_packets; ++i) {
    Eigen::Vector3f middle;
    const double chord = BoundDirections(rays, i * kPacketSize, (i + 1) * kPacketSize, middle);
    cone.x[i] = middle.x();
    cone.y[i] = middle.y();
    cone.z[i] = middle.z();
    cone.packet_chord[i] = static_cast<float>(chord);
  }
  return cone;
}

/// Whether a sphere may be within a chord of the tile's cone: its middle's distance from the cone's
/// surface is measured in the plane of the cone's axis.
class SphereSieve {
 public:
  SphereSieve(const TileCone& cone, double reach)
      : origin_m_(cone.origin_m.cast<float>()),
        direction_(cone.direction),
        // Rounding of coordinates up to 1 km is below 1e-4 m.
        slack_m_(static_cast<float>(cone.origin_spread_m) + 1e-3F) {
    const double chord = cone.chord + reach;
    cosine_ = static_cast<float>(1.0 - 0.5 * chord * chord);  // chord = 2 sin(angle / 2)
    sine_ = std::sqrt(std::max(0.0F, 1.0F - cosine_ * cosine_));
  }

  [[nodiscard]] bool MayHold(const WireGroup& group) const {
    if (!(cosine_ > 0.1F)) return true;
    const Eigen::Vector3f from_origin_m = group.center_m - origin_m_;
    const float radius_m = group.radius_m + slack_m_;
    const float along_m = from_origin_m.dot(direction_);
    if (along_m < -radius_m) return false;
    const float across_m =
        std::sqrt(std::max(0.0F, from_origin_m.squaredNorm() - along_m * along_m));
    return across_m * cosine_ - along_m * sine_ <= radius_m;
  }

 private:
  Eigen::Vector3f origin_m_;
  Eigen::Vector3f direction_;
  float slack_m_;
  float cosine_{}, sine_{};
};

/// A segment as an arc of directions from the tile's middle: the part of a great circle's plane
/// (its normal) between two others (their normals, pointing inwards).
struct WireArc {
  Eigen::Vector3f normal, after_begin, before_end;
  float reach{};  ///< Chord within which a beam may capture some of it.
};

double DistanceToOrigin_m(const Vector3& begin_m, const Vector3& end_m) {
  const Vector3 run_m = end_m - begin_m;
  const double square_m2 = run_m.squaredNorm();
  const double at = square_m2 > 0.0 ? std::clamp(-begin_m.dot(run_m) / square_m2, 0.0, 1.0) : 0.0;
  return (begin_m + at * run_m).norm();
}

WireArc BoundSegment(const WireSegment& wire, const TileCone& cone, double beam_reach) {
  constexpr auto kAny = static_cast<float>(kAnyChord);
  WireArc arc{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), kAny};
  const Vector3 begin_m = wire.begin_m.cast<double>() - cone.origin_m;
  const Vector3 end_m = wire.end_m.cast<double>() - cone.origin_m;
  const double distance_m = DistanceToOrigin_m(begin_m, end_m);
  // From a beam's own origin the wire is as much nearer, and elsewhere by as much.
  const double aside_m = static_cast<double>(wire.radius_m) + cone.origin_spread_m;
  if (distance_m < 5.0 * aside_m + 0.01) return arc;
  const Vector3 normal = begin_m.cross(end_m);
  const double length = normal.norm();
  const Vector3 begin = begin_m.normalized();
  const Vector3 end = end_m.normalized();
  if (length < 1e-9 * begin_m.norm() * end_m.norm()) return arc;  // Seen end-on.
  arc.normal = (normal / length).cast<float>();
  arc.after_begin = (normal / length).cross(begin).cast<float>();
  arc.before_end = end.cross(normal / length).cast<float>();
  // asin(x) < 1.02 x up to 1 / 5, and the wire may be nearer by as much.
  arc.reach = static_cast<float>(beam_reach + 1.3 * aside_m / distance_m);
  return arc;
}

/// How far inside the bounds of the arc each direction is, negative = outside.
void FindDepths(const Directions& of, const WireArc& arc, float depth[kPacketSize]) {
  const float nx = arc.normal.x(), ny = arc.normal.y(), nz = arc.normal.z();
  const float bx = arc.after_begin.x(), by = arc.after_begin.y(), bz = arc.after_begin.z();
  const float ex = arc.before_end.x(), ey = arc.before_end.y(), ez = arc.before_end.z();
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    const float x = of.x[i];
    const float y = of.y[i];
    const float z = of.z[i];
    const float beside = -std::fabs(nx * x + ny * y + nz * z);
    const float before = bx * x + by * y + bz * z;
    const float behind = ex * x + ey * y + ez * z;
    const float end = before < behind ? before : behind;
    depth[i] = (beside < end ? beside : end) + arc.reach;
  }
}

WideBeam BeamOfLane(const RayTile& rays, std::size_t lane, const BeamShape& shape) {
  WideBeam beam{
      .origin_m = Vector3(rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]),
      .direction = Vector3(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane])
                       .normalized(),
      .horizontal = {},
      .vertical = {},
      .sigma_horizontal_rad = shape.sigma_horizontal_rad,
      .sigma_vertical_rad = shape.sigma_vertical_rad};
  const Vector3 up = shape.up_window.cast<double>();
  const Vector3 horizontal = up.cross(beam.direction);
  // A beam along the sensor's axis has no horizontal: any will do, always the same.
  beam.horizontal = horizontal.norm() > 1e-6 ? horizontal.normalized() : up.unitOrthogonal();
  beam.vertical = beam.direction.cross(beam.horizontal);
  return beam;
}

void CaptureLane(const RayTile& rays,
                 const BeamShape& shape,
                 const WireSegment& wire,
                 std::size_t lane,
                 std::vector<WireCapture>& captures) {
  const WireInBeam found = FindWireInBeam(BeamOfLane(rays, lane, shape), wire);
  if (!(found.share > kLeastWireShare)) return;
  captures.push_back({.lane = static_cast<std::uint32_t>(lane),
                      .surface = wire.surface,
                      .range_m = static_cast<float>(found.range_m),
                      .share = static_cast<float>(found.share),
                      .spread_m = static_cast<float>(found.spread_m),
                      .sin_axis = static_cast<float>(found.sin_axis)});
}

void CaptureSegment(const RayTile& rays,
                    const BeamShape& shape,
                    const WireSegment& wire,
                    const TileCone& cone,
                    const WireArc& arc,
                    std::vector<WireCapture>& captures) {
  alignas(64) float packet_depth[kNumPackets];
  FindDepths({cone.x, cone.y, cone.z}, arc, packet_depth);
  for (std::size_t packet = 0; packet < cone.num_packets; ++packet) {
    if (packet_depth[packet] + cone.packet_chord[packet] < 0.0F) continue;
    const std::size_t first = packet * kPacketSize;
    alignas(64) float depth[kPacketSize];
    FindDepths({rays.direction_x + first, rays.direction_y + first, rays.direction_z + first}, arc,
               depth);
    for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
      if (depth[lane] >= 0.0F) CaptureLane(rays, shape, wire, first + lane, captures);
    }
  }
}

}  // namespace

void CaptureWires(const RayTile& rays,
                  const BeamShape& beam,
                  const WireSet& wires,
                  std::vector<WireCapture>& captures) {
  if (rays.num_rays == 0 || wires.groups.empty()) return;
  const auto old_size = static_cast<std::ptrdiff_t>(captures.size());
  const double sigma_rad = std::max(beam.sigma_horizontal_rad, beam.sigma_vertical_rad);
  const double reach = kSieveSlack * kSieveSigmas * sigma_rad + kSieveSlack_rad;
  const TileCone cone = BoundTile(rays);
  const SphereSieve spheres(cone, reach);
  for (const WireGroup& group : wires.groups) {
    if (!spheres.MayHold(group)) continue;
    for (std::uint32_t i = 0; i < group.num_segments; ++i) {
      const WireSegment& wire = wires.segments[group.first_segment + i];
      CaptureSegment(rays, beam, wire, cone, BoundSegment(wire, cone, reach), captures);
    }
  }
  std::sort(captures.begin() + old_size, captures.end(),
            [](const WireCapture& a, const WireCapture& b) {
              return std::tie(a.lane, a.range_m, a.surface, a.share) <
                     std::tie(b.lane, b.range_m, b.surface, b.share);
            });
}

}  // namespace railcast
