#include "core/simulate/velocity_meter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/wind_velocity.h"
#include "core/simulate/frame_motion.h"
#include "core/simulate/returns.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

constexpr double kNoVelocity = std::numeric_limits<double>::quiet_NaN();
constexpr double kFlakeFall_mps = 1.0;

double DropFall_mps(double rain_rate_mmph) {
  const double diameter_mm = 0.895 * std::pow(rain_rate_mmph, 0.21);
  return std::max(0.0, 9.65 - 10.3 * std::exp(-0.6 * diameter_mm));
}

const FrameMotion& MotionIn(const CastFrame& cast) {
  Check(cast.motion != nullptr, "velocities are measured where the motion is known");
  return *cast.motion;
}

Vector3 ToVector(float x, float y, float z) {
  return Eigen::Vector3f(x, y, z).cast<double>();
}

double Folded(double velocity_mps, double max_mps) {
  const double span_mps = 2.0 * max_mps;
  return velocity_mps - span_mps * std::floor((velocity_mps + max_mps) / span_mps);
}

}  // namespace

/// A beam's true ray, in the window frame.
struct VelocityMeter::Ray {
  Vector3 origin_m;
  Vector3 direction;
  double shutter{};
};

VelocityMeter::VelocityMeter(const DetectorSpec& spec, const CastFrame& cast)
    : motion_(MotionIn(cast)),
      seed_(spec.seed),
      spec_(spec.velocity.value()),
      sigma_mps_(spec.effects.noise || spec.effects.range_noise ? spec_.sigma_mps : 0.0) {
  const auto& window_from_world = cast.window_from_world.linear();
  const auto falling = [&](double fall_mps) -> Vector3 {
    return window_from_world * (WindVelocity_mps(spec.weather) - fall_mps * Vector3::UnitZ());
  };
  wind_mps_ = falling(0.0);
  drops_mps_ = falling(DropFall_mps(spec.weather.rain_rate_mmph));
  flakes_mps_ = falling(kFlakeFall_mps);
}

VelocityMeter::Ray VelocityMeter::RayOf(const RayTile& rays, std::size_t beam) {
  return {ToVector(rays.origin_x[beam], rays.origin_y[beam], rays.origin_z[beam]),
          ToVector(rays.direction_x[beam], rays.direction_y[beam], rays.direction_z[beam]),
          static_cast<double>(rays.shutter[beam])};
}

double VelocityMeter::RateTo_mps(const Ray& ray, const Vector3& thing_mps) const {
  return ray.direction.dot(thing_mps - VelocityAt_mps(motion_.sensor, ray.shutter, ray.origin_m));
}

double VelocityMeter::SurfaceRate_mps(const Ray& ray, std::uint32_t surface, double range_m) const {
  return RateTo_mps(ray, motion_.surfaces.VelocityOf_mps(surface, ray.shutter,
                                                         ray.origin_m + range_m * ray.direction));
}

double VelocityMeter::MirrorRate_mps(const Ray& ray,
                                     std::size_t beam,
                                     const BeamTracer::Work& work) const {
  const auto& hits = work.mirrors.hits;
  const auto hit = std::ranges::find(hits, beam, &MirrorHit::lane);
  Check(hit != hits.end(), "a mirror image has a mirror");
  const auto k = static_cast<std::size_t>(hit - hits.begin());
  const RayTile& bounced = work.mirrors.bounced;
  const Ray behind = RayOf(bounced, k);
  const SurfaceMotions& surfaces = motion_.surfaces;
  const Vector3 mirror_mps =
      surfaces.VelocityOf_mps(work.rays.surface[beam], ray.shutter, behind.origin_m);
  const Vector3 thing_m =
      behind.origin_m + static_cast<double>(bounced.range_m[k]) * behind.direction;
  const Vector3 thing_mps = surfaces.VelocityOf_mps(bounced.surface[k], ray.shutter, thing_m);
  return RateTo_mps(ray, mirror_mps) + behind.direction.dot(thing_mps - mirror_mps);
}

double VelocityMeter::GhostRate_mps(const Ray& ray,
                                    double range_m,
                                    std::size_t beam,
                                    BeamTracer::Work& work) const {
  // Its retroreflector is the surface at half its range.
  const EchoTiles::Place* nearest = nullptr;
  double nearest_m = std::numeric_limits<double>::infinity();
  const std::vector<EchoTiles::Place> echoes = EchoesOf(work.echoes, beam);
  for (const EchoTiles::Place& echo : echoes) {
    if (echo.tile.clutter[echo.lane] != kNoClutter) continue;
    const double away_m =
        std::abs(static_cast<double>(echo.tile.true_range_m[echo.lane]) - 0.5 * range_m);
    if (!(away_m < nearest_m)) continue;
    nearest_m = away_m;
    nearest = &echo;
  }
  Check(nearest != nullptr, "a ghost has a retroreflector");
  return 2.0 * SurfaceRate_mps(ray, nearest->tile.surface[nearest->lane], 0.5 * range_m);
}

double VelocityMeter::TrueOf_mps(const EchoTiles::Place& echo,
                                 std::size_t beam,
                                 BeamTracer::Work& work) const {
  const auto& [tile, lane] = echo;
  const double range_m = static_cast<double>(tile.true_range_m[lane]);
  const Ray ray = RayOf(work.rays, beam);
  if (tile.clutter[lane] == kNoClutter) {
    if (tile.surface[lane] == 0) return kNoVelocity;
    return SurfaceRate_mps(ray, tile.surface[lane], range_m);
  }
  switch (tile.echo[lane]) {
    case EchoTiles::kMirrorImage:
      return MirrorRate_mps(ray, beam, work);
    case EchoTiles::kGhost:
      return GhostRate_mps(ray, range_m, beam, work);
    case EchoTiles::kHalo:
    case EchoTiles::kForeignPulse:
    case EchoTiles::kFalseAlarm:
      return kNoVelocity;
    case kFirstFogEcho:
    case kFirstFogEcho + 1:
    case EchoTiles::kSprayCloud:
      return RateTo_mps(ray, wind_mps_);
    default:
      break;
  }
  // Flakes of the published model take the place of the firing's first echo.
  const bool is_drop =
      tile.echo[lane] >= EchoTiles::kFirstDrop && tile.echo[lane] < EchoTiles::kFirstFlake;
  return RateTo_mps(ray, is_drop ? drops_mps_ : flakes_mps_);
}

double VelocityMeter::Measured_mps(const EchoTiles::Place& echo, double true_mps) const {
  const auto& [tile, lane] = echo;
  const auto words =
      RandomWords(seed_, RandomUse::kVelocity, tile.frame, tile.firing[lane], tile.echo[lane]);
  double velocity_mps = true_mps;
  if (tile.echo[lane] == EchoTiles::kFalseAlarm || tile.echo[lane] == EchoTiles::kForeignPulse) {
    velocity_mps = spec_.max_mps * (2.0 * static_cast<double>(UnitFloat(words[0])) - 1.0);
  } else if (sigma_mps_ > 0.0) {
    const auto normals = baseline::LaneNormals({words[0], words[1], words[2], words[3]});
    velocity_mps += sigma_mps_ * static_cast<double>(normals.a);
  }
  velocity_mps = Folded(velocity_mps, spec_.max_mps);
  if (spec_.step_mps > 0.0) {
    velocity_mps = spec_.step_mps * std::round(velocity_mps / spec_.step_mps);
  }
  return velocity_mps;
}

BeamVelocity VelocityMeter::Of(const EchoTiles::Place& echo,
                               std::size_t beam,
                               BeamTracer::Work& work) const {
  const double true_mps = TrueOf_mps(echo, beam, work);
  const bool has_point = HasPoint(static_cast<Outcome>(echo.tile.outcome[echo.lane]));
  return {static_cast<float>(has_point ? Measured_mps(echo, true_mps) : kNoVelocity),
          static_cast<float>(true_mps)};
}

void VelocityMeter::Store(const EchoTiles::Place& echo,
                          std::size_t beam,
                          BeamTracer::Work& work,
                          std::size_t slot,
                          Frame& frame) const {
  const BeamVelocity velocity = Of(echo, beam, work);
  frame.true_radial_velocity_mps[slot] = velocity.true_mps;
  frame.radial_velocity_mps[slot] = velocity.measured_mps;
}

}  // namespace railcast
