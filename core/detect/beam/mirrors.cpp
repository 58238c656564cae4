#include "core/detect/beam/mirrors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/detect/base/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// The value that a standard normal deviate exceeds with this probability, by bisection.
double UpperQuantile(double probability) {
  if (probability <= 0.0) return std::numeric_limits<double>::infinity();
  if (probability >= 1.0) return -std::numeric_limits<double>::infinity();
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const double above = 0.5 * std::erfc(middle / std::numbers::sqrt2);
    (above > probability ? low : high) = middle;
  }
  return low;
}

constexpr float kWaterIndex = 1.33F;
constexpr float kCosLevel = 0.98480775F;  // 10 deg: the steepest ground on which water stands.
constexpr float kCos45 = 0.70710678F;     // Snow lies on faces less steep than 45 deg.
constexpr float kLeastReflected = 1e-5F;  // Weaker images of white surfaces are out of reach.

float AlongVector(const float (&a)[3], const float (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Fresnel's reflectance at a cosine of incidence, from that at normal incidence (Schlick 1994).
float SchlickReflectance(float f0, float cosine) {
  const float rest = 1.0F - cosine;
  const float rest2 = rest * rest;
  return f0 + (1.0F - f0) * rest2 * rest2 * rest;
}

// Fresnel's equations for water: the mean of both polarisations.
float WaterReflectance(float cosine) {
  const float below = std::sqrt(kWaterIndex * kWaterIndex - 1.0F + cosine * cosine);  // n cos'
  const float across = (cosine - below) / (cosine + below);
  const float n2 = kWaterIndex * kWaterIndex;
  const float along = (n2 * cosine - below) / (n2 * cosine + below);
  return 0.5F * (across * across + along * along);
}

/// A lane of a tile that meets a mirror.
struct Met {
  const MirrorOptics& optics;
  float direction[3];
  float normal[3];
  float place_m[3];
  float range_m;
};

Met MeetAt(const MirrorOptics& optics, const RayTile& rays, std::size_t i) {
  Met met{.optics = optics,
          .direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
          .normal = {rays.normal_x[i], rays.normal_y[i], rays.normal_z[i]},
          .place_m = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          .range_m = rays.range_m[i]};
  const float along = AlongVector(met.normal, met.direction);
  const float scale = std::copysign(1.0F / std::sqrt(AlongVector(met.normal, met.normal)), -along);
  for (int k = 0; k < 3; ++k) {
    met.normal[k] *= scale;
    met.place_m[k] += met.range_m * met.direction[k];
  }
  return met;
}

bool IsPuddle(const MirrorScene& scene, const Met& met) {
  return met.optics.holds_puddles && AlongVector(met.normal, scene.up) >= kCosLevel &&
         AlongVector(met.direction, scene.up) < 0.0F && IsUnderWater(scene.puddles, met.place_m);
}

// The surface of the water is level, whatever the ground below it.
MirrorHit Flood(const MirrorScene& scene, const Met& met, std::size_t i, DetectTile& tile) {
  const float cosine = std::min(-AlongVector(met.direction, scene.up), 1.0F);
  const float fresnel = WaterReflectance(cosine);
  const float enters = 1.0F - fresnel;
  tile.cos_incidence[i] = cosine;
  tile.reflectivity[i] = met.optics.soaked_diffuse * enters * enters;
  tile.diffuse_a[i] = tile.reflectivity[i];
  tile.diffuse_b[i] = 0.0F;
  tile.specular_f0[i] = 0.0F;
  tile.retro[i] = 0.0F;
  // The reflected ray meets the water's surface, which is above the ground; on from the mirror
  // image of the place on the ground, it has travelled as far as the beam has to the ground.
  return {.lane = i,
          .there_and_back = fresnel,
          .normal = {scene.up[0], scene.up[1], scene.up[2]},
          .lift_m = 2.0F * Mirrors::kPuddleDepth_m};
}

MirrorHit Polish(const Met& met, std::size_t i, DetectTile& tile) {
  const float cosine = tile.cos_incidence[i];
  const float f0 = tile.specular_f0[i];
  const float fresnel = SchlickReflectance(f0, cosine);
  const float phase_rad = met.optics.phase_rad * cosine;
  const float share = baseline::Exp(-phase_rad * phase_rad);
  const float enters = f0 < 1.0F ? (1.0F - fresnel) / (1.0F - f0) : 0.0F;
  const float diffuse = 1.0F - share * (1.0F - enters * enters);
  tile.reflectivity[i] *= diffuse;
  tile.diffuse_a[i] *= diffuse;
  tile.diffuse_b[i] *= diffuse;
  tile.specular_f0[i] *= 1.0F - share;
  // Off the surface by more than the rounding of its place.
  constexpr float kMostAhead_m = 0.05F;
  const float off_m = 3e-4F + 2e-6F * met.range_m;
  return {.lane = i,
          .there_and_back = share * fresnel,
          .normal = {met.normal[0], met.normal[1], met.normal[2]},
          .ahead_m = off_m < kMostAhead_m * cosine ? off_m / cosine : kMostAhead_m};
}

}  // namespace

Puddles::Puddles(std::uint64_t seed, double share)
    : least_(static_cast<float>(UpperQuantile(share))) {
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const auto words = RandomWords(seed, RandomUse::kPuddles, 0, static_cast<std::uint32_t>(i));
    const double azimuth_rad = 2.0 * std::numbers::pi * static_cast<double>(UnitFloat(words[0]));
    const double step = static_cast<double>(i) / static_cast<double>(kNumPuddleWaves - 1);
    const double wavelength_m = kShortest_m * std::pow(kLongest_m / kShortest_m, step);
    waves_[i] = {Vector3(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0) / wavelength_m,
                 static_cast<double>(UnitFloat(words[1]))};
  }
}

PuddleWaves Puddles::WavesAt(const Transform& world_from_window) const {
  PuddleWaves waves;
  waves.least = least_;
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const Vector3 here = world_from_window.linear().transpose() * waves_[i].turns_per_m;
    waves.x[i] = static_cast<float>(here.x());
    waves.y[i] = static_cast<float>(here.y());
    waves.z[i] = static_cast<float>(here.z());
    // World coordinates are large: only the fraction of a turn fits into float32.
    const double phase =
        waves_[i].turns_per_m.dot(world_from_window.translation()) + waves_[i].phase_turns;
    waves.phase[i] = static_cast<float>(phase - std::floor(phase));
  }
  return waves;
}

bool IsUnderWater(const PuddleWaves& waves, const float (&place_m)[3]) {
  constexpr float kAmplitude = 0.35355339F;  // sqrt(2 / 16)
  float sum = 0.0F;
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const float turns = waves.x[i] * place_m[0] + waves.y[i] * place_m[1] +
                        waves.z[i] * place_m[2] + waves.phase[i];
    float cosine{};
    float sine{};
    baseline::CosSinTurn(baseline::WithinHalfATurn(turns), cosine, sine);
    sum += kAmplitude * cosine;
  }
  return sum > waves.least;
}

Mirrors::Mirrors(const DetectorSpec& spec, const std::vector<Material>& materials)
    : snow_cover_(spec.effects.surface_condition ? static_cast<float>(spec.weather.snow_cover)
                                                 : 0.0F) {
  const int wavelength_nm = spec.beam.wavelength_nm;
  if (spec.weather.puddle_share > 0.0) {
    puddles_.emplace(spec.ground_seed, spec.weather.puddle_share);
  }
  for (const Material& material : materials) {
    const double turns = 2000.0 * material.height_rms_um.value_or(0.0) / wavelength_nm;
    const SurfaceOptics soaked = WetOptics(OpticsAt(material, wavelength_nm), 1.0, wavelength_nm);
    optics_.push_back({.is_smooth = material.height_rms_um.has_value(),
                       .phase_rad = static_cast<float>(2.0 * std::numbers::pi * turns),
                       .holds_puddles = material.holds_puddles && puddles_.has_value(),
                       .soaked_diffuse = soaked.diffuse});
  }
}

std::optional<MirrorScene> Mirrors::Among(const std::vector<Surface>& surfaces,
                                          const Transform& window_from_world) const {
  // Where no material mirrors, the surfaces' materials need not be known.
  const bool may_mirror = std::ranges::any_of(
      optics_, [](const MirrorOptics& optics) { return optics.is_smooth || optics.holds_puddles; });
  if (!may_mirror) return std::nullopt;
  const bool any = std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& surface) {
    const MirrorOptics& optics = optics_[surface.material];
    return optics.is_smooth || optics.holds_puddles;
  });
  if (!any) return std::nullopt;
  MirrorScene scene{&optics_, &surfaces, {}, {}, snow_cover_};
  if (puddles_) scene.puddles = puddles_->WavesAt(window_from_world.inverse());
  const Vector3 up = window_from_world.linear().col(2);
  for (int k = 0; k < 3; ++k) scene.up[k] = static_cast<float>(up[k]);
  return scene;
}

void DimMirrors(const MirrorScene& scene,
                const RayTile& rays,
                DetectTile& tile,
                std::vector<MirrorHit>* hits) {
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const MirrorOptics& optics = (*scene.optics)[(*scene.surfaces)[rays.surface[i]].material];
    if (rays.surface[i] == 0 || !(optics.is_smooth || optics.holds_puddles)) continue;
    const Met met = MeetAt(optics, rays, i);
    const bool is_puddle = IsPuddle(scene, met);
    if (!is_puddle && !optics.is_smooth) continue;
    MirrorHit hit = is_puddle ? Flood(scene, met, i, tile) : Polish(met, i, tile);
    if (hits == nullptr) continue;
    const float bare = tile.normal_up[i] >= kCos45 ? 1.0F - scene.snow_cover : 1.0F;
    hit.there_and_back *= bare;
    hit.there_and_back *= hit.there_and_back;
    const bool goes_on = tile.outcome[i] == static_cast<std::uint32_t>(Outcome::kReturned);
    if (goes_on && hit.there_and_back >= kLeastReflected) hits->push_back(hit);
  }
}

}  // namespace railcast
