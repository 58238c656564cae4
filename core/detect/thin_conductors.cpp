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
// of which lets through whatever might be captured: the cone round a tile against balls round
// wires, the cones round its packets against what a segment looks like from there, and single beams
// against the segment itself.
// Angles are bounded by chords between unit vectors, which add up like angles.

// Outside four sigmas of the nearest point of a wire's image there is 3e-5 of the beam.
constexpr double kSieveSigmas = 4.0;
// For rounding, and for the difference of tangents, angles and chords in beams of some degrees.
constexpr double kSieveSlack = 1.05;
constexpr double kSieveSlack_rad = 2e-6;
constexpr float kSieveSlack_m = 1e-3F;  // Rounding of coordinates up to 1 km is below 1e-4 m.
constexpr float kEverywhere_m = 1e6F;
constexpr float kAnyChord = 4.0F;  // Lets everything through.

constexpr std::size_t kNumPackets = kTileSize / kPacketSize;

/// Beams as one cone from the middle of their origins.
struct Cone {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;
  float spread_m{};        ///< The farthest of the origins from their middle, and slack.
  float chord{};           ///< From the middle direction to where a beam may capture something.
  float cosine{}, sine{};  ///< Of the angle of that.

  void SetChord(float to) {
    chord = to;
    cosine = 1.0F - 0.5F * chord * chord;  // chord = 2 sin(angle / 2)
    sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
    if (cosine > 0.1F) return;
    // Beams all round: the cone that holds everything.
    direction = Eigen::Vector3f::UnitX();
    spread_m = kEverywhere_m;
    chord = kAnyChord;
    cosine = 0.0F;
    sine = 1.0F;
  }
};

/// @param reach Chord to a beam's middle within which it captures something.
Cone BoundPacket(const RayTile& rays, std::size_t first, float reach) {
  const auto origin_m = [&](std::size_t i) {
    return Eigen::Vector3f(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]);
  };
  const auto direction = [&](std::size_t i) {
    return Eigen::Vector3f(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
  };
  Eigen::Vector3f origins = Eigen::Vector3f::Zero();
  Eigen::Vector3f directions = Eigen::Vector3f::Zero();
  for (std::size_t i = first; i < first + kPacketSize; ++i) {
    origins += origin_m(i);
    directions += direction(i);
  }
  Cone cone;
  cone.origin_m = origins / static_cast<float>(kPacketSize);
  cone.direction = directions.normalized();
  float origin_square = 0.0F;
  float direction_square = 0.0F;
  for (std::size_t i = first; i < first + kPacketSize; ++i) {
    origin_square = std::max(origin_square, (origin_m(i) - cone.origin_m).squaredNorm());
    direction_square = std::max(direction_square, (direction(i) - cone.direction).squaredNorm());
  }
  cone.spread_m = std::sqrt(origin_square) + kSieveSlack_m;
  cone.SetChord(std::sqrt(direction_square) + reach);
  return cone;
}

/// A cone round others.
Cone BoundCones(const Cone* cones, std::size_t num_cones) {
  Cone all = cones[0];
  for (std::size_t i = 1; i < num_cones; ++i) {
    all.origin_m += cones[i].origin_m;
    all.direction += cones[i].direction;
  }
  all.origin_m /= static_cast<float>(num_cones);
  all.direction.normalize();
  float chord = 0.0F;
  for (std::size_t i = 0; i < num_cones; ++i) {
    const float apart_m = (cones[i].origin_m - all.origin_m).norm();
    all.spread_m = std::max(all.spread_m, apart_m + cones[i].spread_m);
    chord = std::max(chord, (cones[i].direction - all.direction).norm() + cones[i].chord);
  }
  all.SetChord(chord);
  return all;
}

/// Whether the beams may capture something in the ball. In the plane of the ball's middle and the
/// cone's axis, that middle's distance from the cone's surface is across cos - along sin.
bool MayCapture(const Cone& cone, const WireBall& ball) {
  const Eigen::Vector3f from_cone_m = ball.center_m - cone.origin_m;
  const float radius_m = ball.radius_m + cone.spread_m;
  const float along_m = from_cone_m.dot(cone.direction);
  const float across_square_m2 = from_cone_m.squaredNorm() - along_m * along_m;
  const float bound_m = radius_m + along_m * cone.sine;
  return along_m + radius_m >= 0.0F &&
         across_square_m2 * cone.cosine * cone.cosine <= bound_m * bound_m;
}

/// A segment as an arc of directions from a cone's origin: the part of a great circle's plane (its
/// normal) between two others (their normals, pointing inwards).
struct WireArc {
  Eigen::Vector3f normal, after_begin, before_end;
  float reach{};  ///< Chord within which a beam may capture some of it.
};

// A wire and the origins of the beams take up room beside the lines that stand for them. Seen from
// kNearest times as far it is a chord of less than kAsideChord times that ratio: asin(x) < 1.02 x
// up to x = 1 / 5, and from its own origin a beam may see the wire from that much nearer.
constexpr float kNearest = 5.0F;
constexpr float kAsideChord = 1.3F;

float DistanceToOrigin_m(const Eigen::Vector3f& begin_m, const Eigen::Vector3f& run_m) {
  const float square_m2 = run_m.squaredNorm();
  const float at =
      square_m2 > 0.0F ? std::clamp(-begin_m.dot(run_m) / square_m2, 0.0F, 1.0F) : 0.0F;
  return (begin_m + at * run_m).norm();
}

/// A segment as a disc of directions from a cone's origin: much less than its ball, where it runs
/// away from the sensor.
struct WireDisc {
  Eigen::Vector3f direction;
  float chord{};
};

WireDisc BoundByDisc(const WireSegment& wire, const Cone& cone) {
  const Eigen::Vector3f begin_m = wire.begin_m - cone.origin_m;
  const Eigen::Vector3f end_m = wire.end_m - cone.origin_m;
  const float distance_m = DistanceToOrigin_m(begin_m, end_m - begin_m);
  const float aside_m = wire.radius_m + cone.spread_m;
  if (distance_m < kNearest * aside_m) return {Eigen::Vector3f::UnitX(), kAnyChord};
  const Eigen::Vector3f begin = begin_m.normalized();
  const Eigen::Vector3f end = end_m.normalized();
  const Eigen::Vector3f middle = 0.5F * (begin + end);  // Inside the sphere, all the nearer.
  return {middle, 0.5F * (end - begin).norm() + (1.0F - middle.norm()) +
                      kAsideChord * aside_m / distance_m};
}

WireArc BoundByArc(const WireSegment& wire, const Cone& cone, float beam_reach) {
  WireArc arc{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), kAnyChord};
  const Eigen::Vector3f begin_m = wire.begin_m - cone.origin_m;
  const Eigen::Vector3f end_m = wire.end_m - cone.origin_m;
  const Eigen::Vector3f run_m = wire.end_m - wire.begin_m;
  const float distance_m = DistanceToOrigin_m(begin_m, run_m);
  const float aside_m = wire.radius_m + cone.spread_m;
  if (distance_m < kNearest * aside_m) return arc;
  // Not with the end, whose product with the beginning would cancel.
  const Eigen::Vector3f normal_m2 = begin_m.cross(run_m);
  const float length_m2 = normal_m2.norm();
  // The products' rounding turns the plane by as much.
  const float rounding = 1e-6F * begin_m.norm() * run_m.norm() / length_m2;
  if (!(rounding < 1e-3F)) return arc;  // Seen almost end-on.
  arc.normal = normal_m2 / length_m2;
  arc.after_begin = arc.normal.cross(begin_m).normalized();
  arc.before_end = end_m.cross(arc.normal).normalized();
  arc.reach = beam_reach + kAsideChord * aside_m / distance_m + rounding;
  return arc;
}

/// How far inside the bounds of the arc each beam of a packet is, negative = outside.
void FindDepths(const RayTile& rays,
                std::size_t first,
                const WireArc& arc,
                float depths[kPacketSize]) {
  const float nx = arc.normal.x(), ny = arc.normal.y(), nz = arc.normal.z();
  const float bx = arc.after_begin.x(), by = arc.after_begin.y(), bz = arc.after_begin.z();
  const float ex = arc.before_end.x(), ey = arc.before_end.y(), ez = arc.before_end.z();
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    const float x = rays.direction_x[first + i];
    const float y = rays.direction_y[first + i];
    const float z = rays.direction_z[first + i];
    const float beside = -std::fabs(nx * x + ny * y + nz * z);
    const float before = bx * x + by * y + bz * z;
    const float behind = ex * x + ey * y + ez * z;
    const float end = before < behind ? before : behind;
    depths[i] = (beside < end ? beside : end) + arc.reach;
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

/// A tile of beams ready to be asked for wires.
struct Tile {
  const RayTile& rays;
  const BeamShape& shape;
  float reach{};
  Cone cone;
  Cone packets[kNumPackets];
  /// The same once more, struct of arrays.
  float packet_x[kNumPackets], packet_y[kNumPackets], packet_z[kNumPackets];
  float packet_chord[kNumPackets];
};

Tile PrepareTile(const RayTile& rays, const BeamShape& shape) {
  const double sigma_rad = std::max(shape.sigma_horizontal_rad, shape.sigma_vertical_rad);
  const double reach = kSieveSlack * kSieveSigmas * sigma_rad + kSieveSlack_rad;
  Tile tile{rays, shape, static_cast<float>(reach), {}, {}, {}, {}, {}, {}};
  const std::size_t num_packets = rays.num_rays / kPacketSize;
  for (std::size_t i = 0; i < num_packets; ++i) {
    const Cone cone = BoundPacket(rays, i * kPacketSize, tile.reach);
    tile.packets[i] = cone;
    tile.packet_x[i] = cone.direction.x();
    tile.packet_y[i] = cone.direction.y();
    tile.packet_z[i] = cone.direction.z();
    tile.packet_chord[i] = cone.chord;
  }
  tile.cone = BoundCones(tile.packets, num_packets);
  return tile;
}

/// How far inside its bounds each packet's cone reaches into the disc, negative = outside.
void FindPacketDepths(const Tile& tile, const WireDisc& disc, float depths[kNumPackets]) {
  const float dx = disc.direction.x(), dy = disc.direction.y(), dz = disc.direction.z();
  for (std::size_t i = 0; i < kNumPackets; ++i) {
    const float x = tile.packet_x[i] - dx;
    const float y = tile.packet_y[i] - dy;
    const float z = tile.packet_z[i] - dz;
    const float chord = tile.packet_chord[i] + disc.chord;
    depths[i] = chord * chord - (x * x + y * y + z * z);
  }
}

void CaptureSegment(const Tile& tile, const WireSegment& wire, std::vector<WireCapture>& captures) {
  alignas(64) float packet_depths[kNumPackets];
  FindPacketDepths(tile, BoundByDisc(wire, tile.cone), packet_depths);
  for (std::size_t packet = 0; packet < tile.rays.num_rays / kPacketSize; ++packet) {
    if (packet_depths[packet] < 0.0F) continue;
    const WireArc arc = BoundByArc(wire, tile.packets[packet], tile.reach);
    const std::size_t first = packet * kPacketSize;
    alignas(64) float depths[kPacketSize];
    FindDepths(tile.rays, first, arc, depths);
    for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
      if (depths[lane] >= 0.0F) CaptureLane(tile.rays, tile.shape, wire, first + lane, captures);
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
  const Tile tile = PrepareTile(rays, beam);
  for (const WireGroup& group : wires.groups) {
    if (!MayCapture(tile.cone, group.ball)) continue;
    for (std::uint32_t i = group.first_segment; i < group.end_segment; ++i) {
      if (!MayCapture(tile.cone, wires.balls[i])) continue;
      CaptureSegment(tile, wires.segments[i], captures);
    }
  }
  std::sort(captures.begin() + old_size, captures.end(),
            [](const WireCapture& a, const WireCapture& b) {
              return std::tie(a.lane, a.range_m, a.surface, a.share) <
                     std::tie(b.lane, b.range_m, b.surface, b.share);
            });
}

}  // namespace railcast
