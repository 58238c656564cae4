#include "core/scenario/descriptions.h"

#include <algorithm>
#include <string>

#include "core/detect/detector/effect_table.h"
#include "core/scenario/sensors.h"
#include "railcast/camera.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr const char* kNoUdpForRos2 =
    "must be left out with protocol ros2, whose readers find its topics by themselves";

}  // namespace

void Describe(Archive& a, DistortionSpec& s) {
  a.Optional("k1", s.k1, "Radial, of the order r^2.", Within(-10, 10));
  a.Optional("k2", s.k2, "Radial, of the order r^4.", Within(-10, 10));
  a.Optional("p1", s.p1, "Tangential.", Within(-1, 1));
  a.Optional("p2", s.p2, "Tangential.", Within(-1, 1));
  a.Optional("k3", s.k3, "Radial, of the order r^6.", Within(-10, 10));
}

void Describe(Archive& a, CameraSpec& s) {
  a.Optional("name", s.name, "Folder of its images; lower-case letters, digits and _.");
  a.Required("width_px", s.width_px, "Width of the image.", Within(1, 65'536));
  a.Required("height_px", s.height_px, "Height of the image.", Within(1, 65'536));
  a.Required("horizontal_fov_deg", s.horizontal_fov_deg,
             "Angle between the left and the right edge of the image, without distortion.",
             PositiveUpTo(170));
  a.Optional("rate_hz", s.rate_hz, "Images per second; absent = one with each frame of the sensor.",
             Within(1e-6, 1e6));
  a.Optional("mount", s.mount, "Where it is on the vehicle; absent = in the place of the sensor.");
  a.Optional("distortion", s.distortion,
             "Distortion of the lens: Brown and Conrady's model as in OpenCV.");
  a.Optional(
      "udp", s.udp,
      "host:port of each receiver of live images, [host]:port of IPv6; empty = they are not sent.",
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

void Describe(Archive& a, SensorInterface& s) {
  a.Required("sensor", s.sensor, "Name of the sensor.", NonEmptyString());
  a.Optional("protocol", s.protocol, "How its live frames are packed.");
  a.Optional("udp", s.udp,
             "host:port of each receiver, [host]:port of IPv6; empty = loopback at the protocol's "
             "own port.",
             HostAndPort());
  a.Ensure({"udp"}, AreDifferent(s.udp), "must name each receiver once");
  a.Ensure({"udp", "protocol"}, s.protocol != Protocol::kRos2 || s.udp.empty(), kNoUdpForRos2);
}

void Describe(Archive& a, Ros2Spec& s) {
  constexpr double kMaxDomain = 232;  // Ports of higher ones would be above 65535.
  a.Optional("domain", s.domain, "Absent = as ROS_DOMAIN_ID says, or 0.", Within(0, kMaxDomain));
  a.Optional("interface", s.interface,
             "Name or address of the network interface to use; empty = loopback.", OneLine());
  a.Optional("receive_buffers", s.receive_buffers,
             "large: every reader has room for whole frames, 1 MiB or more.");
  a.Optional("deceleration_mps2", s.deceleration_mps2,
             "Deceleration of the vehicle at commands of ROS 2, which name none.",
             Within(0.001, 10));
}

void Describe(Archive& a, InterfacesSpec& s) {
  a.Optional(
      "udp", s.udp,
      "host:port of each receiver of live frames, [host]:port of IPv6; empty = loopback at the "
      "protocol's own port.",
      HostAndPort());
  a.Ensure({"udp"}, AreDifferent(s.udp), "must name each receiver once");
  a.Optional("protocol", s.protocol, "How live frames are packed.");
  a.Ensure({"udp", "protocol"}, s.protocol != Protocol::kRos2 || s.udp.empty(), kNoUdpForRos2);
  a.Optional("sensors", s.sensors,
             "With lidars, instead of udp and protocol: one entry for each sensor.");
  a.Optional("ros2", s.ros2, "How frames of protocol ros2 reach ROS 2.");
}

void Describe(Archive& a, ToleranceSpec& s) {
  a.Optional("range_m", s.range_m, "Median error of the ranges of echoes, before noise.",
             Within(0, 10'000));
  a.Optional("missed_share", s.missed_share, "Missed share of the reference's echoes.",
             Within(0, 1));
  a.Optional("false_share", s.false_share, "Share of the echoes that the reference lacks.",
             Within(0, 1));
  a.Optional("thin_missed_share", s.thin_missed_share,
             "Missed share of the reference's echoes of wires.", Within(0, 1));
  a.Optional("intensity", s.intensity, "Median relative error of the echoes' intensities.",
             Within(0, 1e6));
  a.Optional("of", s.of,
             "Classes, by the names of their labels, whose echoes are compared; beams that cannot "
             "meet them have no width. Empty = all.");
}

void Describe(Archive& a, OutputSpec& s) {
  a.Optional("frame", s.frame, "Frame of reference of the points.");
  a.Optional("handedness", s.handedness, "left: y is negated, as Unreal has it.");
  a.Optional("origin_m", s.origin_m,
             "Subtracted from world coordinates, which float32 holds to 1 mm only within 8 km.",
             Within(-1e8, 1e8));
}

void Describe(Archive& a, Material& s) {
  a.Required("name", s.name, "Unique.", NonEmptyString());
  a.Required("reflectivity", s.reflectivity, "Diffuse reflectance at 905 nm; 1 = white Lambertian.",
             Within(0, 100));
  a.Optional("reflectivity_1550nm", s.reflectivity_1550nm,
             "The same at 1550 nm; absent = as at 905 nm.", Within(0, 100));
  a.Optional("facet_slope_deg", s.facet_slope_deg,
             "Oren-Nayar's sigma: roughness of the diffuse part; 0 = Lambertian.", Within(0, 60));
  a.Optional("specular_f0", s.specular_f0,
             "Reflectance of the GGX lobe at normal incidence, 905 nm.", Within(0, 1));
  a.Optional("specular_f0_1550nm", s.specular_f0_1550nm,
             "The same at 1550 nm; absent = as at 905 nm.", Within(0, 1));
  a.Optional("specular_roughness", s.specular_roughness, "GGX's alpha.", Within(0.01, 1));
  a.Optional("retroreflectance", s.retroreflectance,
             "Reflectance of a retroreflector as a multiple of a white Lambertian.",
             Within(0, 10'000));
  a.Optional("texture", s.texture,
             "Standard deviation of the logarithm of its response from cell to cell of 3 cm.",
             Within(0, 2));
  a.Optional("height_rms_um", s.height_rms_um,
             "Standard deviation of the heights of a flat surface that mirrors; absent = it does "
             "not.",
             Within(0, 100));
  a.Optional("holds_puddles", s.holds_puddles, "Whether water stands on it (puddle_share).");
  a.Ensure({"name"}, s.name != "none", "must not be \"none\": that is the material of nothing");
}

void Describe(Archive& a, Label& s) {
  a.Required("id", s.id, "Unique; 0 = nothing was hit.");
  a.Required("name", s.name, "Unique.", NonEmptyString());
  a.Required("rgb", s.rgb, "Colour, 0 to 255 each.");
  a.Required("whu_railway3d", s.whu_railway3d, "Class name in WHU-Railway3D.");
  a.Required("osdar23", s.osdar23, "Class name in OSDaR23; empty where none fits.");
  a.Required("semantic_kitti", s.semantic_kitti, "Id written to .label files.");
  a.Required("semantic_kitti_nearest", s.semantic_kitti_nearest,
             "The nearest of SemanticKITTI's own ids.");
}

void Describe(Archive& a, LabelFile& s) {
  a.Required("labels", s.labels, "What things are called.", NonEmptyList());
  a.Unique("labels", s.labels, "id", &Label::id);
  a.Unique("labels", s.labels, "name", &Label::name);
}

void Describe(Archive& a, ScenarioSpec& s) {
  a.Optional("seed", s.seed, "Seed of the sensor's and the weather's random numbers.");
  a.Optional("fidelity", s.fidelity,
             "Rung of the fidelity ladder, or auto: no more than the scene needs.");
  a.Optional("tolerance", s.tolerance, "By how much fidelity auto may differ from the reference.");
  a.Switches("effects", s.effects, "Switches this effect on or off.", EffectNames());
  const auto conflict = ConflictIn(SwitchedEffects(s));
  a.Ensure({"effects", "fidelity"}, !conflict, conflict.value_or(""));
  a.OneOfTwo("lidar", "lidars");
  const bool has_lidar = a.OptionalUnless(
      "lidar", s.lidar, {}, "The only sensor; several sensors are given as lidars instead.");
  a.Optional("lidars", s.lidars, "Several sensors, instead of lidar; each has a name of its own.",
             NonEmptyListIf{!has_lidar, "; a scenario has at least one sensor"});
  const auto has_name = [](const LidarSpec& sensor) { return !sensor.name.empty(); };
  a.Ensure({"", "lidars"}, std::all_of(s.lidars.begin(), s.lidars.end(), has_name),
           "must have a name for each of its lidars");
  a.Unique("lidars", s.lidars, "name", &LidarSpec::name);
  a.Optional("weather", s.weather, "The weather.");
  a.Optional("interfaces", s.interfaces, "Where live frames go.");
  const std::string fault =
      InterfacesFault(s.interfaces, s.lidars.empty() ? std::vector<std::string>() : SensorNames(s));
  a.Ensure({"interfaces", "lidar", "lidars"}, fault.empty(), "sensors " + fault);
  const std::string positions_fault = PositionsFault(s.interfaces);
  a.Ensure({"interfaces"}, positions_fault.empty(), positions_fault);
  a.Optional("camera", s.camera, "A camera beside the sensor.");
  a.Ensure({"camera", "lidar", "lidars"}, !s.camera || HasFramesForImages(s),
           "must have a rate_hz that is each sensor's scan rate_hz divided by a whole number");
  const std::string images_fault = s.camera ? ImagesFault(*s.camera, s.interfaces) : "";
  a.Ensure({"camera", "interfaces"}, images_fault.empty(), images_fault);
  a.Optional("motion_sensors", s.motion_sensors,
             "What measures the vehicle's own motion: IMUs, GNSS receivers and odometers.");
  a.Ensure({"motion_sensors", "lidar", "lidars"},
           !s.motion_sensors || HasFewSamplesInFrame(*s.motion_sensors, s),
           "must have rates that give at most 100000 samples in a frame");
  a.Types("models", s.models, "Types of objects and vehicles beside those that railcast has.");
  a.Required("world", s.world, "The railway and what stands on it.");
  // A recording may say itself which sensor made it.
  const bool is_sensor_known = s.world.recording && !has_lidar && s.lidars.empty();
  a.Ensure({"", "lidar", "lidars"}, is_sensor_known || has_lidar == s.lidars.empty(),
           "must have either lidar or lidars");
  a.Optional("vehicle", s.vehicle, "The sensor's own vehicle.");
  a.Optional("output", s.output, "Axes of the points.");
  a.RequiredLibrary("materials", s.materials, "What surfaces are made of.");
  a.RequiredLibrary("labels", s.labels, "What things are called.");
  a.Unique("materials", s.materials, "name", &Material::name);
  a.Unique("labels", s.labels, "id", &Label::id);
  a.Unique("labels", s.labels, "name", &Label::name);
}

}  // namespace railcast
