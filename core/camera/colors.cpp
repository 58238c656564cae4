#include "core/camera/colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/base/units.h"
#include "core/detect/base/weather_optics.h"

namespace railcast {
namespace {

constexpr double kFullSun_klx = 100.0;
// Light of the sky on level ground, about that of an overcast day, as a share of full sun.
constexpr double kSkyShare = 0.2;
// Share of the sunlight scattered by fog, rain or snow that reaches the ground.
constexpr double kScatteredShare = 0.5;
// Thickness of the layer of fog or precipitation above the line.
constexpr double kLayer_m = 100.0;
// Light that the ground sends up, as a share of that from the sky.
constexpr float kGroundShare = 0.2F;
// What a soaked surface reflects, relative to a dry one (WetOptics()).
constexpr float kSoakedShare = 0.6F;
// Radius of the solar disc.
constexpr double kSunRadius_deg = 0.27;

float Transmission(float extinction_per_m, float way_m) {
  if (extinction_per_m == 0.0F) return 1.0F;
  return static_cast<float>(
      std::exp(-static_cast<double>(extinction_per_m) * static_cast<double>(way_m)));
}

Radiance Between(const Radiance& a, const Radiance& b, float share_of_b) {
  return a + share_of_b * (b - a);
}

struct NamedColor {
  std::string_view material;
  double red, green, blue;
};

// Reflectances in daylight, chosen by eye: plausible, not measured.
constexpr auto kColors = std::to_array<NamedColor>({{"rail_head", 0.45, 0.45, 0.46},
                                                    {"rail_side", 0.16, 0.10, 0.07},
                                                    {"rusty_steel", 0.20, 0.10, 0.06},
                                                    {"concrete", 0.36, 0.35, 0.32},
                                                    {"wood", 0.15, 0.11, 0.08},
                                                    {"ballast", 0.21, 0.19, 0.17},
                                                    {"soil", 0.17, 0.12, 0.08},
                                                    {"grass", 0.16, 0.24, 0.07},
                                                    {"leaf", 0.10, 0.18, 0.05},
                                                    {"bark", 0.12, 0.09, 0.07},
                                                    {"copper_wire", 0.28, 0.16, 0.10},
                                                    {"bronze_wire", 0.25, 0.18, 0.10},
                                                    {"galvanised_steel", 0.42, 0.43, 0.44},
                                                    {"ceramic", 0.30, 0.16, 0.10},
                                                    {"wagon_paint", 0.24, 0.08, 0.05},
                                                    {"wheel_steel", 0.22, 0.20, 0.19},
                                                    {"tank_paint", 0.58, 0.58, 0.56},
                                                    {"skin", 0.45, 0.28, 0.20},
                                                    {"clothing", 0.06, 0.09, 0.18},
                                                    {"grey_paint", 0.30, 0.30, 0.30},
                                                    {"asphalt", 0.09, 0.09, 0.09},
                                                    {"glass", 0.05, 0.06, 0.06},
                                                    {"white_paint", 0.80, 0.80, 0.78},
                                                    {"black_rubber", 0.03, 0.03, 0.03},
                                                    {"snow", 0.90, 0.91, 0.93},
                                                    {"retro_sheeting", 0.60, 0.60, 0.60},
                                                    {"hi_vis_vest", 0.90, 0.30, 0.03},
                                                    {"hi_vis_fabric", 0.95, 0.32, 0.02},
                                                    {"hi_vis_band", 0.60, 0.60, 0.60},
                                                    {"masonry", 0.55, 0.48, 0.38},
                                                    {"red_paint", 0.55, 0.05, 0.04},
                                                    {"plastic", 0.65, 0.50, 0.10},
                                                    {"black_paint", 0.03, 0.03, 0.03},
                                                    {"roof_tile", 0.35, 0.13, 0.08},
                                                    {"car_paint", 0.10, 0.15, 0.35},
                                                    {"fur", 0.22, 0.12, 0.06},
                                                    {"horn", 0.20, 0.16, 0.12}});

}  // namespace

Daylight::Daylight(const WeatherSpec& weather, const Eigen::Matrix3d& window_from_world)
    : up_((window_from_world * Vector3::UnitZ()).cast<float>()),
      extinction_per_m_(static_cast<float>(Extinction_per_m(weather, 905))),
      wetness_(static_cast<float>(WetnessOf(weather))),
      snow_cover_(static_cast<float>(weather.snow_cover)) {
  const double azimuth_rad = RadFromDeg(weather.sun.azimuth_deg);
  const double elevation_rad = RadFromDeg(weather.sun.elevation_deg);
  const double up = std::sin(elevation_rad);
  const double level = std::cos(elevation_rad);
  const Vector3 to_sun(level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), up);
  to_sun_ = (window_from_world * to_sun).cast<float>();
  double direct = 0.0;
  double diffuse = kSkyShare;
  if (up > 0.0) {
    const double sun = weather.sun.illuminance_klx / kFullSun_klx;
    const double clear = std::exp(-static_cast<double>(extinction_per_m_) * kLayer_m / up);
    direct = sun * clear;
    diffuse += kScatteredShare * sun * (1.0 - clear) * up;
  }
  const double on_ground = direct * std::max(up, 0.0) + diffuse;
  direct_ = static_cast<float>(direct / on_ground);
  diffuse_ = static_cast<float>(diffuse / on_ground);
  // An overcast sky is uniform; a clear one is bright at the horizon and blue above.
  const float clearness = 1.0F - diffuse_;
  const Radiance overcast = 0.9F * Radiance(0.95F, 0.97F, 1.0F);
  horizon_ = diffuse_ * Between(overcast, 3.0F * Radiance(0.88F, 0.94F, 1.0F), clearness);
  zenith_ = diffuse_ * Between(overcast, 1.5F * Radiance(0.45F, 0.75F, 1.35F), clearness);
}

Radiance Daylight::Surface(const Radiance& reflectance,
                           const Eigen::Vector3f& normal,
                           bool is_lit) const {
  const float up = normal.dot(up_);
  const float from_sky = 0.5F * (1.0F + up);
  float light = diffuse_ * (from_sky + kGroundShare * (1.0F - from_sky));
  if (is_lit) light += direct_ * std::max(0.0F, normal.dot(to_sun_));
  const Radiance wet = (1.0F - wetness_ * (1.0F - kSoakedShare)) * reflectance;
  const Radiance snow(0.90F, 0.91F, 0.93F);
  return light * Between(wet, snow, snow_cover_ * std::max(0.0F, up));
}

Radiance Daylight::ThroughAir(const Radiance& radiance, float range_m) const {
  return Between(horizon_, radiance, Transmission(extinction_per_m_, range_m));
}

Radiance Daylight::Background(const Eigen::Vector3f& direction, float reach_m) const {
  const float up = direction.dot(up_);
  if (up <= 0.0F) {
    const Radiance ground(0.10F, 0.12F, 0.08F);
    return ThroughAir(Between(horizon_, ground, 0.5F), reach_m);
  }
  const float down = 1.0F - std::min(up, 1.0F);
  Radiance sky = Between(zenith_, horizon_, down * down * down);
  const auto disc = static_cast<float>(std::cos(RadFromDeg(kSunRadius_deg)));
  if (has_sun() && direction.dot(to_sun_) >= disc) sky = Radiance::Constant(direct_ * 100.0F);
  return ThroughAir(sky, static_cast<float>(kLayer_m) / up);
}

std::array<std::uint8_t, 3> SrgbBytes(const Radiance& radiance) {
  std::array<std::uint8_t, 3> bytes{};
  for (int i = 0; i < 3; ++i) {
    const double linear = std::clamp(static_cast<double>(radiance[i]), 0.0, 1.0);
    const double encoded =
        linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
  }
  return bytes;
}

std::vector<Vector3> MaterialColors(const MaterialLibrary& materials) {
  std::vector<Vector3> colors;
  for (const Material& material : materials.materials()) {
    const auto named = std::ranges::find(kColors, material.name, &NamedColor::material);
    colors.push_back(named != kColors.end()
                         ? Vector3(named->red, named->green, named->blue)
                         : Vector3::Constant(std::min(1.0, material.reflectivity)));
  }
  return colors;
}

}  // namespace railcast
