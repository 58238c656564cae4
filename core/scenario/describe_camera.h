#pragma once

#include <algorithm>
#include <string>

#include "core/scenario/describe_lidar.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/sensors.h"
#include "railcast/camera.h"
#include "railcast/scenario.h"

namespace railcast {

template <class Archive>
void Describe(Archive& a, DistortionSpec& s) {
  a.Optional("k1", s.k1, "Radial, of the order r^2.", Within(-10, 10));
  a.Optional("k2", s.k2, "Radial, of the order r^4.", Within(-10, 10));
  a.Optional("p1", s.p1, "Tangential.", Within(-1, 1));
  a.Optional("p2", s.p2, "Tangential.", Within(-1, 1));
  a.Optional("k3", s.k3, "Radial, of the order r^6.", Within(-10, 10));
}

template <class Archive>
void Describe(Archive& a, CameraSpec& s) {
  a.Optional("name", s.name, "Folder of its images; lower-case letters, digits and _.");
  a.Required("width_px", s.width_px, "Of the image.", Within(1, 65'536));
  a.Required("height_px", s.height_px, "Of the image.", Within(1, 65'536));
  a.Required("horizontal_fov_deg", s.horizontal_fov_deg,
             "Angle between the left and the right edge of the image, without distortion.",
             PositiveUpTo(170));
  a.Optional("rate_hz", s.rate_hz, "Images per second; absent = one with each frame of the sensor.",
             Within(1e-6, 1e6));
  a.Optional("mount", s.mount, "Where it is on the vehicle; absent = in the place of the sensor.");
  a.Optional("distortion", s.distortion, "Of the lens: Brown and Conrady's model as in OpenCV.");
  a.Optional("udp", s.udp, "host:port of each receiver of live images; empty = they are not sent.",
             HostAndPort());
  a.Ensure({"udp"}, AreDifferent(s.udp), "must name each receiver once");
  // The longest side that libjpeg encodes.
  constexpr std::uint32_t kLongestJpeg = 65'500;
  a.Ensure({"udp", "width_px", "height_px"},
           s.udp.empty() || std::max(s.width_px, s.height_px) <= kLongestJpeg,
           "must be left out with more than 65500 pixels on a side");
  a.Ensure({"name"}, IsCameraName(s.name),
           "must consist of 1 to 64 lower-case letters, digits and _");
  a.Ensure({"width_px", "height_px"}, std::uint64_t{s.width_px} * s.height_px <= kMostPixels,
           "must give at most 16777216 pixels with \"height_px\"");
  // What is out of limits has been reported by itself.
  const bool is_checkable = s.width_px > 0 && s.height_px > 0 && s.horizontal_fov_deg > 0.0 &&
                            s.horizontal_fov_deg <= 170.0;
  a.Ensure({"distortion", "width_px", "height_px", "horizontal_fov_deg"},
           !is_checkable || !s.distortion || IsInvertible(s),
           "must be invertible over the whole image");
}

}  // namespace railcast
