#include "core/simulate/beam_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// Beams closer than this to the centre of the whole sun are blinded.
constexpr double kBlindingAngle_deg = 1.0;
// Half the mean apparent diameter.
constexpr double kDiscRadius_deg = 0.2665;

Vector3 DirectionOf(const SunSpec& sun) {
  const double azimuth_rad = RadFromDeg(sun.azimuth_deg);
  const double elevation_rad = RadFromDeg(sun.elevation_deg);
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

// Directions to points of the sun's disc. Wherever an edge hides the disc on one side of it, the
// share of the points that are visible is that of the disc to 0.1: of 16 points on two circles,
// these err least.
std::vector<Vector3> DiscAbout(const Vector3& center) {
  constexpr std::size_t kNumInner = 4;
  constexpr double kOffAxes_rad = std::numbers::pi / 24.0;
  const Vector3 right = center.unitOrthogonal();
  const Vector3 up = right.cross(center);
  const double radius = std::tan(RadFromDeg(kDiscRadius_deg));
  std::vector<Vector3> disc;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    const bool is_inner = i < kNumInner;
    const double from_center = (is_inner ? 0.3 : 0.76) * radius;
    const std::size_t num = is_inner ? kNumInner : kPacketSize - kNumInner;
    const double turn_rad =
        kOffAxes_rad + (is_inner ? std::numbers::pi / 12.0 : 0.0) +
        2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(num);
    disc.push_back((center + from_center * (std::cos(turn_rad) * right + std::sin(turn_rad) * up))
                       .normalized());
  }
  return disc;
}

}  // namespace

BeamTracer::BeamTracer(const SimulatorSpec& spec,
                       const std::vector<Material>& materials,
                       const ScanPattern& pattern)
    : is_physical_(IsPhysical(spec.detector.effects)),
      spec_(spec.detector),
      detector_(spec_,
                {.num_channels = pattern.rows,
                 .snow = OpticsAt(materials[spec.snow_material], spec_.beam.wavelength_nm)}),
      kernels_(AvailableKernels().back()),
      spray_(spec_),
      mirror_paths_(spec_, kernels_),
      texture_(spec_, materials, kernels_) {
  pointing_ = {.seed = spec_.seed,
               .sigma_rad = static_cast<float>(RadFromDeg(spec_.receiver.pointing_jitter_deg))};
  is_sun_up_ = spec_.effects.sunlight && spec_.weather.sun.illuminance_klx > 0.0;
  to_sun_world_ = DirectionOf(spec_.weather.sun);
  sun_disc_world_ = DiscAbout(to_sun_world_);
  beam_.sigma_h_rad = static_cast<float>(HorizontalSigma_rad(spec_.beam));
  beam_.sigma_v_rad = static_cast<float>(VerticalSigma_rad(spec_.beam));
  if (is_physical_) {
    optics_ = OpticsTable(materials, spec_.beam.wavelength_nm,
                          spec_.effects.surface_condition ? WetnessOf(spec_.weather) : 0.0);
    dry_optics_ = OpticsTable(materials, spec_.beam.wavelength_nm, 0.0);
  }
  if (spec_.effects.mirror_paths) mirrors_.emplace(spec_, materials);
  if (spec_.effects.cover && HasCover(spec_)) cover_.emplace(spec_, pattern);
}

BeamFrame BeamTracer::BeamFrameOf(const CastFrame& frame) const {
  BeamFrame beam = beam_;
  PoseF change{};
  const PoseF pose = frame.poses.At(0, change);
  const Vector3 vertical = frame.window_from_world.linear().col(2);
  for (int i = 0; i < 3; ++i) {
    beam.up[i] = pose.r[3 * i + 2];
    beam.vertical[i] = static_cast<float>(vertical[i]);
  }
  return beam;
}

void BeamTracer::AimCenters(const CastFrame& frame,
                            const FiringTiles& tiles,
                            std::size_t tile,
                            Work& work) const {
  RayTile& rays = work.rays;
  DetectTile& first = work.echoes.first;
  tiles.Aim(tile, frame.poses, range_max_m(), rays);
  first.frame = frame.index;
  tiles.Describe(tile, first);
  if (has_wide_beams()) kernels_.pattern_turns(first, spec_.seed, work.turns);
  if (spec_.effects.pointing_jitter && pointing_.sigma_rad > 0.0F) {
    kernels_.pointing(rays, first, BeamFrameOf(frame), pointing_);
  }
  rays.mask = spec_.effects.thin_conductors ? kAllButWires : kAllSurfaces;
}

void BeamTracer::AimSubRays(const Work& work,
                            const BeamFrame& frame,
                            std::size_t lane,
                            BeamRays& beam) const {
  kernels_.aim_sub_rays(work.rays, lane, frame, AimOfFiring(SubRaysOfCrowd(), work.turns, lane),
                        beam);
}

void BeamTracer::CastCenters(const WideBeams& beams, bool are_all_needed, Work& work) const {
  RayTile& rays = work.rays;
  constexpr float kNoRay_m = -1.0F;
  for (std::size_t i = 0; i < work.echoes.first.num_rays && !are_all_needed; ++i) {
    if (!work.footprint.NeedsCenter(beams, i)) rays.range_m[i] = kNoRay_m;
  }
  beams.caster.Cast(rays);
  if (beams.besides != nullptr) {
    beams.besides->Meet(work.echoes.first.firing, work.echoes.first.num_rays, rays);
  }
  for (float& range_m : rays.range_m) range_m = range_m < 0.0F ? range_max_m() : range_m;
}

double BeamTracer::VisibleSun(const CastFrame& frame, std::size_t lane, Work& work) const {
  RayTile& disc = work.to_sun;
  disc.num_rays = kPacketSize;
  disc.mask = kAllButWires;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    const Eigen::Vector3f direction =
        (frame.window_from_world.linear() * sun_disc_world_[i]).cast<float>();
    disc.origin_x[i] = work.rays.origin_x[lane];
    disc.origin_y[i] = work.rays.origin_y[lane];
    disc.origin_z[i] = work.rays.origin_z[lane];
    disc.direction_x[i] = direction.x();
    disc.direction_y[i] = direction.y();
    disc.direction_z[i] = direction.z();
    disc.shutter[i] = work.rays.shutter[lane];
    disc.range_m[i] = range_max_m();
    disc.surface[i] = 0;
    disc.normal_x[i] = disc.normal_y[i] = disc.normal_z[i] = 0.0F;
  }
  if (frame.besides != nullptr) {
    // First, so that things before them do not count as met by the firing.
    std::array<std::uint32_t, kPacketSize> firings{};
    firings.fill(work.echoes.first.firing[lane]);
    frame.besides->Meet(firings.data(), firings.size(), disc);
  }
  frame.caster.Cast(disc);
  std::size_t num_visible = 0;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    if (disc.surface[i] == 0 && sun_disc_world_[i].z() > 0.0) ++num_visible;
  }
  return static_cast<double>(num_visible) / double{kPacketSize};
}

void BeamTracer::Blind(const CastFrame& frame, Work& work) const {
  const Eigen::Vector3f to_sun = (frame.window_from_world.linear() * to_sun_world_).cast<float>();
  const double below_one = 1.0 - std::cos(RadFromDeg(kBlindingAngle_deg));
  const RayTile& rays = work.rays;
  EchoTiles& echoes = work.echoes;
  std::array<bool, kTileSize> is_blind{};
  for (std::size_t i = 0; i < echoes.first.num_rays; ++i) {
    const float cosine = rays.direction_x[i] * to_sun.x() + rays.direction_y[i] * to_sun.y() +
                         rays.direction_z[i] * to_sun.z();
    // Glare is in proportion to the visible part of the disc and to 1 / angle^2, which is
    // 2 (1 - cosine) for so small an angle.
    const auto is_within = [&](double share) {
      // Products of unit vectors in float32 may exceed 1.
      return share > 0.0 && cosine > static_cast<float>(1.0 - share * below_one);
    };
    is_blind[i] = is_within(1.0) && is_within(VisibleSun(frame, i, work));
    if (is_blind[i]) echoes.first.power_ratio[i] = 0.0F;
  }
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    const auto [tile, lane] = echoes.more(i);
    if (is_blind[echoes.beam_of(i)]) tile.power_ratio[lane] = 0.0F;
  }
}

void BeamTracer::MakeEchoes(const CastFrame& frame,
                            const FiringTiles& tiles,
                            std::size_t tile,
                            Work& work,
                            const EffectObserver& observer) const {
  AimCenters(frame, tiles, tile, work);
  const RayTile& rays = work.rays;
  EchoTiles& echoes = work.echoes;
  DetectTile& first = echoes.first;
  echoes.ClearMore();
  if (cover_) cover_->Fill(first, work.drops);
  const SurfaceTable table{frame.surfaces, optics_};
  const BeamFrame beam = BeamFrameOf(frame);
  TextureScene textures{};
  if (texture_.is_on()) textures = Texture::SceneOf(frame.window_from_world, frame.textured);
  const WideBeams beams{.rays = rays,
                        .frame = beam,
                        .turns = work.turns,
                        .caster = frame.caster,
                        .table = table,
                        .detector = detector_,
                        .mirrors = frame.mirrors ? &*frame.mirrors : nullptr,
                        .besides = frame.besides,
                        .texture = texture_.is_on() ? &texture_ : nullptr,
                        .textures = &textures};
  const bool is_wide = !casts_all_centers();
  if (is_wide) {
    work.footprint.Trace(beams, spec_.effects.thin_conductors ? frame.wires : nullptr, first);
  }
  // Mirrors continue the central rays, and observers see their effects.
  CastCenters(beams, !is_wide || !frame.takes_no_rays || frame.mirrors || observer, work);
  ResolveHits(rays, table, first);
  kernels_.incidence(rays, first);
  if (!is_physical_) return;
  kernels_.spread(rays, beam, first);
  if (observer && ShowsSurfaceCondition(spec_)) {
    // Let the story show the response of the dry, bare surfaces first; then restore the actual one.
    ResolveHits(rays, {frame.surfaces, dry_optics_}, first);
    detector_.RespondBare(first, observer);
    ResolveHits(rays, table, first);
  }
  work.mirrors.hits.clear();
  if (frame.mirrors) DimMirrors(*frame.mirrors, rays, first, &work.mirrors.hits);
  detector_.Respond(first, observer);
  if (texture_.is_on()) {
    texture_.Apply(textures, frame.surfaces, rays, first);
    if (observer) observer("texture");
  }
  std::fill_n(echoes.mixed_share, first.num_rays, 0.0F);
  if (is_wide) {
    work.footprint.Resolve(beams, echoes);
    if (observer) observer(HasFootprint(spec_) ? "footprint" : "thin_conductors");
  }
  if (frame.mirrors) {
    mirror_paths_.AddEchoes(beams, work.mirrors, echoes);
    if (observer) observer("mirror_paths");
  }
  PassAir(frame, work, observer);
}

void BeamTracer::PassAir(const CastFrame& frame, Work& work, const EffectObserver& observer) const {
  if (!frame.spray.empty()) {
    spray_.Apply(work.rays, frame.spray, detector_, work.echoes);
    if (observer) observer("spray");
  }
  if (is_sun_up_) {
    Blind(frame, work);
    if (observer) observer("the sun's disc");
  }
}

void BeamTracer::MakeKnownEchoes(const CastFrame& frame,
                                 const FiringTiles& tiles,
                                 std::size_t tile,
                                 Work& work,
                                 const std::function<void(EchoTiles&)>& put) const {
  AimCenters(frame, tiles, tile, work);
  EchoTiles& echoes = work.echoes;
  DetectTile& first = echoes.first;
  echoes.ClearMore();
  if (cover_) cover_->Fill(first, work.drops);
  // No ray has met anything yet, so that this marks all firings as empty.
  ResolveHits(work.rays, {frame.surfaces, optics_}, first);
  kernels_.incidence(work.rays, first);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::fill_n(echoes.mixed_share, first.num_rays, 0.0F);
  for (float* unknown : {first.intensity, first.power_ratio}) std::fill_n(unknown, kTileSize, kNaN);
  put(echoes);
  if (is_physical_) PassAir(frame, work, {});
}

}  // namespace railcast
