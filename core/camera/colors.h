#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "railcast/effects.h"
#include "railcast/material.h"
#include "railcast/transform.h"

namespace railcast {

/// Radiances and reflectances in red, green and blue light, linear. 1 is the radiance of a white
/// Lambertian surface that lies level in the open, to which the exposure adapts.
using Radiance = Eigen::Vector3f;

/// The light of a scene and the air in it: what makes a camera's colours of surfaces.
///
/// Models: the sun's direct light, weakened by the haze layer above; the sky's light, which is
/// uniform on level ground and less on surfaces turned downwards; the colour of the sky from
/// horizon to zenith; extinction and airlight by fog, rain and snow (Koschmieder: the radiance at
/// range R is L exp(-alpha R) + L_horizon (1 - exp(-alpha R))).
/// Assumes: one extinction for all colours, that of core/detect/base/weather_optics.h; the figures
/// below are our own choices. Night is not modelled: without sun it is an overcast day.
class Daylight {
 public:
  /// @param window_from_world Rotation of the axes in which directions are given.
  Daylight(const WeatherSpec& weather, const Eigen::Matrix3d& window_from_world);

  [[nodiscard]] bool has_sun() const { return direct_ > 0.0F; }
  [[nodiscard]] const Eigen::Vector3f& to_sun() const { return to_sun_; }

  /// Returns the radiance of a Lambertian surface.
  /// @param reflectance Of the dry surface without snow.
  /// @param normal Of unit length, on the camera's side.
  /// @param is_lit Whether the sun is not hidden.
  [[nodiscard]] Radiance Surface(const Radiance& reflectance,
                                 const Eigen::Vector3f& normal,
                                 bool is_lit) const;
  /// Returns what is left of a radiance after `range_m` of air, with the airlight on the way.
  [[nodiscard]] Radiance ThroughAir(const Radiance& radiance, float range_m) const;
  /// Returns the radiance in a direction in which there is no surface within `reach_m`. Below the
  /// horizon it is that of far ground.
  [[nodiscard]] Radiance Background(const Eigen::Vector3f& direction, float reach_m) const;

 private:
  Eigen::Vector3f to_sun_;
  Eigen::Vector3f up_;
  float direct_ = 0.0F;  ///< Illuminance on a surface that faces the sun.
  float diffuse_ = 0.0F;
  float extinction_per_m_;
  float wetness_;
  float snow_cover_;
  Radiance horizon_;
  Radiance zenith_;
};

/// Returns the bytes of a colour by the transfer function of sRGB (IEC 61966-2-1).
[[nodiscard]] std::array<std::uint8_t, 3> SrgbBytes(const Radiance& radiance);

/// Returns the reflectance of each material in red, green and blue light, by index. Materials that
/// the table of colors in colors.cpp does not name are grey, as bright as at 905 nm.
[[nodiscard]] std::vector<Vector3> MaterialColors(const MaterialLibrary& materials);

}  // namespace railcast
