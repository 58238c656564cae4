#include "core/detect/beam/thin_conductors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "core/detect/base/normal_table.h"
#include "core/detect/beam/wire_in_beam.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

// Almost all beams miss almost all wires, so that most of the work is rejection. There are three
// conservative tests: the pyramid of a tile against balls around wires, the cones of its packets
// against the disc in which a segment appears from the tile, and single beams against the arc of
// the segment.

// A beam whose axis is more than four sigmas from a wire's image has at most 3e-5 of its power on
// it.
constexpr double kSieveSigmas = 4.0;
// Slack for rounding, and for the difference between tangents, angles and chords in beams a few
// degrees wide.
constexpr double kSieveSlack = 1.05;
constexpr double kSieveSlack_rad = 2e-6;

constexpr std::size_t kNumPackets = kTileSize / kPacketSize;

/// A segment as an arc of directions from a cone's origin: the part of a great circle, given by the
/// normal of its plane, between two other planes, given by their inward normals.
struct WireArc {
  Eigen::Vector3f normal, after_begin, before_end;
  float reach{};  ///< Chord from the arc within which a beam may capture part of the segment.
};

// The wire's radius, its movement during the frame and the spread of the beams' origins displace a
// wire from the line that represents it. At a distance of at least kNearest times this
// displacement, it corresponds to a chord of less than kAsideChord times displacement over
// distance: asin(x) < 1.02 x up to x = 1 / 5, and from its own origin a beam may be nearer to the
// wire by the displacement.
constexpr float kNearest = 5.0F;
constexpr float kAsideChord = 1.3F;

float DistanceToOrigin_m(const Eigen::Vector3f& begin_m, const Eigen::Vector3f& run_m) {
  const float square_m2 = run_m.squaredNorm();
  const float at =
      square_m2 > 0.0F ? std::clamp(-begin_m.dot(run_m) / square_m2, 0.0F, 1.0F) : 0.0F;
  return (begin_m + at * run_m).norm();
}

/// A segment as a disc of directions from a tile's origin. It is much smaller than the segment's
/// ball where the wire runs away from the sensor.
struct WireDisc {
  Eigen::Vector3f direction;
  float chord{};
};

WireDisc BoundByDisc(const WireSegment& wire, const BeamPyramid& beams) {
  const Eigen::Vector3f begin_m = wire.begin_m - beams.origin_m;
  const Eigen::Vector3f end_m = wire.end_m - beams.origin_m;
  const float distance_m = DistanceToOrigin_m(begin_m, end_m - begin_m);
  const float aside_m = wire.radius_m + wire.travel_m + beams.spread_m;
  if (distance_m < kNearest * aside_m) return {Eigen::Vector3f::UnitX(), kAnyChord};
  const Eigen::Vector3f begin = begin_m.normalized();
  const Eigen::Vector3f end = end_m.normalized();
  const Eigen::Vector3f middle = 0.5F * (begin + end);  // Inside the unit sphere by 1 - norm.
  return {middle, 0.5F * (end - begin).norm() + (1.0F - middle.norm()) +
                      kAsideChord * aside_m / distance_m};
}

WireArc BoundByArc(const WireSegment& wire, const BeamCone& cone, float beam_reach) {
  WireArc arc{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), kAnyChord};
  const Eigen::Vector3f begin_m = wire.begin_m - cone.origin_m;
  const Eigen::Vector3f end_m = wire.end_m - cone.origin_m;
  const Eigen::Vector3f run_m = wire.end_m - wire.begin_m;
  const float distance_m = DistanceToOrigin_m(begin_m, run_m);
  const float aside_m = wire.radius_m + wire.travel_m + cone.spread_m;
  if (distance_m < kNearest * aside_m) return arc;
  // The product of begin_m and end_m would suffer from cancellation.
  const Eigen::Vector3f normal_m2 = begin_m.cross(run_m);
  const float length_m2 = normal_m2.norm();
  // Angle by which the rounding of the product may turn the plane.
  const float rounding = 1e-6F * begin_m.norm() * run_m.norm() / length_m2;
  if (!(rounding < 1e-3F)) return arc;  // Seen almost end-on.
  arc.normal = normal_m2 / length_m2;
  arc.after_begin = arc.normal.cross(begin_m).normalized();
  arc.before_end = end_m.cross(arc.normal).normalized();
  arc.reach = beam_reach + kAsideChord * aside_m / distance_m + rounding;
  return arc;
}

/// Computes how far inside the bounds of the arc each beam of a packet is; negative = outside.
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
  const Eigen::Vector3f origin_m(rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]);
  const Vector3 direction =
      Eigen::Vector3f(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane])
          .cast<double>();
  WideBeam beam{.origin_m = origin_m.cast<double>(),
                .direction = direction.normalized(),
                .horizontal = {},
                .vertical = {},
                .sigma_horizontal_rad = shape.sigma_horizontal_rad,
                .sigma_vertical_rad = shape.sigma_vertical_rad};
  const Vector3 up = shape.up_window.cast<double>();
  const Vector3 horizontal = up.cross(beam.direction);
  // A beam along the sensor's axis has no horizontal, so that any fixed direction will do.
  beam.horizontal = horizontal.norm() > 1e-6 ? horizontal.normalized() : up.unitOrthogonal();
  beam.vertical = beam.direction.cross(beam.horizontal);
  return beam;
}

void CaptureLane(const RayTile& rays,
                 const BeamShape& shape,
                 const WireSegment& wire,
                 std::size_t lane,
                 std::vector<WireCapture>& captures) {
  const WireSegment now = wire.travel_m > 0.0F ? SegmentAt(wire, rays.shutter[lane]) : wire;
  const WireInBeam found = FindWireInBeam(BeamOfLane(rays, lane, shape), now);
  if (!(found.share > kLeastWireShare)) return;
  captures.push_back({.lane = static_cast<std::uint32_t>(lane),
                      .surface = wire.surface,
                      .range_m = static_cast<float>(found.range_m),
                      .share = static_cast<float>(found.share),
                      .spread_m = static_cast<float>(found.spread_m),
                      .sin_axis = static_cast<float>(found.sin_axis),
                      .strip = found.strip,
                      .axis = (now.end_m - now.begin_m).normalized()});
}

/// A tile of beams with its bounds, prepared for the search for wires.
struct Tile {
  const RayTile& rays;
  const BeamShape& shape;
  float reach{};
  BeamPyramid beams;
  BeamCone packets[kNumPackets];
  /// Directions and chords of `packets` as a struct of arrays.
  float packet_x[kNumPackets], packet_y[kNumPackets], packet_z[kNumPackets];
  float packet_chord[kNumPackets];
};

Tile PrepareTile(const RayTile& rays, const BeamShape& shape) {
  const double sigma_rad = std::max(shape.sigma_horizontal_rad, shape.sigma_vertical_rad);
  const double reach = kSieveSlack * kSieveSigmas * sigma_rad + kSieveSlack_rad;
  Tile tile{rays, shape, static_cast<float>(reach), {}, {}, {}, {}, {}, {}};
  const std::size_t num_packets = rays.num_rays / kPacketSize;
  for (std::size_t i = 0; i < num_packets; ++i) {
    const BeamCone cone = BoundPacket(rays, i * kPacketSize, tile.reach);
    tile.packets[i] = cone;
    tile.packet_x[i] = cone.direction.x();
    tile.packet_y[i] = cone.direction.y();
    tile.packet_z[i] = cone.direction.z();
    tile.packet_chord[i] = cone.chord;
  }
  tile.beams = BoundCones(tile.packets, num_packets);
  return tile;
}

/// Computes how far each packet's cone reaches into the disc; negative = they do not touch.
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
  FindPacketDepths(tile, BoundByDisc(wire, tile.beams), packet_depths);
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

float HiddenShare(const WireCapture& capture, std::span<const WireCapture> nearer) {
  if (nearer.empty()) return 0.0F;
  const WireStrip& strip = capture.strip;
  const double all = NormalShare(strip.begin, strip.end);
  if (!(all > 0.0)) return 0.0F;
  // Two lines stand for the width of the strip.
  const float quarter_width = 0.25F * (strip.halves[0] + strip.halves[1]);
  double hidden = 0.0;
  for (const float aside : {-quarter_width, quarter_width}) {
    std::vector<StripPart> parts;
    for (const WireCapture& other : nearer) {
      const StripPart part = CoveredPart(strip, aside, other.strip);
      if (part.begin < part.end) parts.push_back(part);
    }
    std::ranges::sort(parts, {}, &StripPart::begin);
    float end = strip.begin;
    for (const StripPart& part : parts) {
      if (part.end <= end) continue;
      hidden += 0.5 * NormalShare(std::max(part.begin, end), part.end);
      end = part.end;
    }
  }
  return static_cast<float>(std::min(1.0, hidden / all));
}

void CaptureWires(const RayTile& rays,
                  const BeamShape& beam,
                  const WireSet& wires,
                  std::vector<WireCapture>& captures) {
  if (rays.num_rays == 0 || wires.groups.empty()) return;
  const auto old_size = static_cast<std::ptrdiff_t>(captures.size());
  const Tile tile = PrepareTile(rays, beam);
  for (const WireGroup& group : wires.groups) {
    if (!MayCapture(tile.beams, group.ball)) continue;
    for (std::uint32_t i = group.first_segment; i < group.end_segment; ++i) {
      if (!MayCapture(tile.beams, wires.balls[i])) continue;
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
