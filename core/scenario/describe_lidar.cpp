#include "core/scenario/descriptions.h"

#include "core/scenario/ouster_metadata.h"
#include "core/scenario/shared_keys.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {

void Describe(Archive& a, RasterSpec& s) {
  a.Required("horizontal_fov_deg", s.horizontal_fov_deg, "Field of view.", PositiveUpTo(360));
  a.Required("vertical_fov_deg", s.vertical_fov_deg, "Field of view, symmetric about the horizon.",
             PositiveUpTo(180));
  a.Required("angular_resolution_deg", s.angular_resolution_deg,
             "Size of a cell; beams go through the cells' centres.", PositiveUpTo(360));
  a.Optional("order", s.order, "What fires one after the other.");
}

void Describe(Archive& a, ChannelSpec& s) {
  a.Required("elevation_deg", s.elevation_deg, "Up positive.", Within(-90, 90));
  a.Required("azimuth_deg", s.azimuth_deg,
             "Added to the rotor's azimuth; same sense as the rotation. Before prisms: left "
             "positive.",
             Within(-360, 360));
  a.Required("time_us", s.time_us, "Since the start of the firing cycle.", Within(0, 4.3e6));
}

void Describe(Archive& a, SpinningSpec& s) {
  a.Required("channels", s.channels, "In the vendor's laser order.", NonEmptyList());
  a.Required("cycle_us", s.cycle_us, "Duration of a firing cycle.", Within(1e-3, 4.3e6));
  a.Required("columns", s.columns, "Firing cycles per frame.", Within(1, 1 << 24));
  a.Optional("rotation", s.rotation, "Sense of rotation, seen from above.");
  a.Optional("start_azimuth_deg", s.start_azimuth_deg,
             "Azimuth of the rotor at a frame's first firing; 0 = forward.", Within(-360, 360));
  a.Optional("beam_origin_m", s.beam_origin_m,
             "Where the beams leave off the axis: outwards at the rotor's azimuth, up.",
             Within(-1, 1));
  a.Optional("azimuth_window_deg", s.azimuth_window_deg,
             "First and last azimuth of the rotor at which firing cycles begin, in the sense of "
             "rotation; the window crosses 0 if the first is the greater. No other cycles are "
             "fired.",
             Within(0, 360));
}

void Describe(Archive& a, PrismSpec& s) {
  a.Required("wedge_deg", s.wedge_deg, "Angle between the faces.", Within(0, 60));
  a.Required("refractive_index", s.refractive_index, "Refractive index of the glass.",
             Within(1, 4));
  a.Required("turns_hz", s.turns_hz, "Turns per second; positive from left to up.",
             Within(-10'000, 10'000));
  a.Optional("start_deg", s.start_deg,
             "Where the prism bends the beams to when the sensor's first frame begins: 0 = left, "
             "90 = up.",
             Within(-360, 360));
}

void Describe(Archive& a, RisleySpec& s) {
  a.Required("channels", s.channels, "The beams before the prisms.", NonEmptyList());
  a.Required("cycle_us", s.cycle_us, "Duration of a firing cycle.", Within(1e-3, 4.3e6));
  a.Required("columns", s.columns, "Firing cycles per frame.", Within(1, 1 << 24));
  a.Required("prisms", s.prisms,
             "1 to 4 wedges that turn on from frame to frame, in the order in which the light "
             "passes them.",
             NonEmptyList());
}

void Describe(Archive& a, FiringTableSpec& s) {
  a.Required("file", s.file,
             "CSV with the header azimuth_deg,elevation_deg,time_us, or these and ring; or the "
             "correction file of an AT128, which lasts 3 frames.",
             ExistingFile());
  a.Optional("frames", s.frames, "Frames that the table lasts before it begins again.",
             Within(1, 100'000));
}

void Describe(Archive& a, ScanSpec& s) {
  a.Required("rate_hz", s.rate_hz, "Frames per second.", Within(0.01, 1e6));
  a.Required("pattern", s.pattern, "Where the beams of a frame go, and when.");
}

void Describe(Archive& a, MountSpec& s) {
  a.Optional("position_m", s.position_m, "In the vehicle frame: forward, left, up.",
             Within(-50, 50));
  a.Optional("yaw_deg", s.yaw_deg, "Left positive.", Within(-360, 360));
  a.Optional("pitch_deg", s.pitch_deg, "Nose down positive.", Within(-360, 360));
  a.Optional("roll_deg", s.roll_deg, "Right side down positive.", Within(-360, 360));
}

void Describe(Archive& a, MountErrorSpec& s) {
  a.Optional("position_m", s.position_m, "In the axes of the nominal sensor: forward, left, up.",
             Within(-1, 1));
  a.Optional("yaw_deg", s.yaw_deg, "Left positive.", Within(-30, 30));
  a.Optional("pitch_deg", s.pitch_deg, "Nose down positive.", Within(-30, 30));
  a.Optional("roll_deg", s.roll_deg, "Right side down positive.", Within(-30, 30));
}

void Describe(Archive& a, PlausibilitySpec& s) {
  a.Optional("reference_threshold", s.reference_threshold,
             "Least detectable reflectivity x cos x fog at the reference range.", Within(0, 1e6));
  a.Optional("reference_range_m", s.reference_range_m,
             "Range at which reference_threshold applies; the threshold grows with range squared.",
             Within(0.1, 10'000));
  a.Optional("noise_sigma0_m", s.noise_sigma0_m, "Standard deviation of the noise at range 0.",
             Within(0, 10));
  a.Optional("noise_sigma1", s.noise_sigma1,
             "Growth of the noise's standard deviation per metre of range.", Within(0, 1));
  a.Optional("noise_shape", s.noise_shape, "Equally in all directions, or along the beam.");
  a.Optional("dropout_probability", s.dropout_probability,
             "Probability that a firing is lost, whatever it hit.", Within(0, 1));
  a.Optional("dropout_per_m", s.dropout_per_m,
             "Growth of the losses: exp(-this x range) of the firings survive.", Within(0, 1));
  a.Optional("dark_dropout_probability", s.dark_dropout_probability,
             "Further losses on dark surfaces: the probability as the intensity approaches 0.",
             Within(0, 1));
  a.Optional("dark_dropout_intensity", s.dark_dropout_intensity,
             "Intensity at which the losses on dark surfaces have fallen to 1 / e.",
             PositiveUpTo(1));
}

void Describe(Archive& a, BeamSpec& s) {
  a.Optional("wavelength_nm", s.wavelength_nm, "905 also represents 850 to 950.",
             OneNumberOf({905, 1550}));
  // 1 degree is 17.453 mrad.
  a.Optional("divergence_mrad", s.divergence_mrad,
             "Full angle between the 1/e^2 points of the Gaussian profile: horizontal, vertical. "
             "0 = a ray.",
             Within(0, 17.5));
  a.Optional("pulse_length_ns", s.pulse_length_ns,
             "Full width at half maximum of the received pulse.", Within(0.1, 100));
  a.Optional("reference_rays", s.reference_rays, "Sub-rays per beam of effect dense_footprint.",
             Within(1, 4096));
  a.Optional(
      "footprint_rays", s.footprint_rays,
      "Sub-rays per beam of effect footprint. For fidelity auto, the most that it may choose.",
      OneNumberOf({16, 64}));
  a.Optional("footprint_of", s.footprint_of,
             "With effect footprint, only beams that may meet these classes have a width; each is "
             "the name of a label. Empty = every beam has one.");
}

void Describe(Archive& a, ReceiverSpec& s) {
  a.Optional("range_at_10_percent_m", s.range_at_10_percent_m,
             "The data sheet's detection range on a Lambertian target of 10 % at normal incidence.",
             PositiveUpTo(10'000));
  a.Optional("snr_at_threshold", s.snr_at_threshold,
             "Amplitude signal-to-noise ratio at the detection threshold.", PositiveUpTo(100));
  a.Optional("signal", s.signal,
             "What of an echo is compared with the threshold: its peak, or its energy.");
  a.Optional("return_mode", s.return_mode, "Which echoes of a beam are reported.");
  a.Optional("range_noise_floor_m", s.range_noise_floor_m,
             "Standard deviation of the range where the signal is strong.", Within(0, 10));
  a.Optional("range_noise_scale_m", s.range_noise_scale_m,
             "sigma = hypot(floor, this / sqrt(2 SNR)).", Within(0, 10));
  a.Optional("channel_bias_sigma_m", s.channel_bias_sigma_m,
             "Standard deviation of the channels' constant range errors.", Within(0, 10));
  a.Optional("intensity_noise", s.intensity_noise,
             "Relative standard deviation of the intensity from echo to echo.", Within(0, 1));
  a.Optional("channel_gain", s.channel_gain,
             "Relative standard deviation of the intensity from channel to channel.", Within(0, 1));
  a.Optional("channel_gain_variation", s.channel_gain_variation,
             "The same of a factor that changes with the range.", Within(0, 1));
  a.Optional("pointing_jitter_deg", s.pointing_jitter_deg,
             "Standard deviation of a beam's direction, in each of two directions.", Within(0, 1));
  a.Optional("clutter_gain", s.clutter_gain,
             "Multiplies the mean number of echoes of drops and flakes.", Within(0, 10));
  a.Optional("near_range_m", s.near_range_m,
             "Range at which the receiver has a quarter of its gain for the echoes of fog. Left "
             "out: 0.045 range_at_10_percent_m.",
             PositiveUpTo(100));
  a.Optional("fog_gain", s.fog_gain, "Multiplies the power of the echoes of fog.", Within(0, 10));
  a.Optional("dead_time_ns", s.dead_time_ns,
             "How long the receiver is blind after an echo; 0 = not at all.", Within(0, 1000));
  a.Optional("edge_loss", s.edge_loss,
             "Probability that a beam is lost of which two surfaces far apart have a half each.",
             Within(0, 1));
  a.Optional("halo_share_at_1_deg", s.halo_share_at_1_deg,
             "Share of a retroreflector's power that a beam receives which points 1 deg beside it.",
             Within(0, 0.1));
  a.Optional("range_walk_m", s.range_walk_m,
             "By how much an echo at the threshold is measured farther than a strong one.",
             Within(0, 10));
  a.Optional("foreign_pulses_hz", s.foreign_pulses_hz,
             "Pulses of other lidars per second that it can detect.", Within(0, 1e6));
  a.Optional("saturation_power_ratio", s.saturation_power_ratio,
             "Power over the detection threshold at which the receiver saturates. Left out: never.",
             Within(2, 1e9));
  a.Optional("ghost_reflectance", s.ghost_reflectance,
             "Share of the light entering the aperture that goes back the way it came.",
             Within(0, 1));
}

namespace {

/// Limits of the diameter of what lies on a sensor's window.
[[nodiscard]] Limits SpotLimits() {
  return Within(1, 20);
}

}  // namespace

void Describe(Archive& a, CoverSpec& s) {
  a.Optional("window_radius_mm", s.window_radius_mm,
             "Distance of the window from the sensor's origin.", Within(20, 150));
  a.Optional("aperture_mm", s.aperture_mm, "Diameter of a beam at the window.", Within(1, 30));
  a.Optional("drop_coverage", s.drop_coverage, "Share of the window under drops.", Within(0, 0.9));
  a.Optional("drop_diameter_mm", s.drop_diameter_mm, "Diameter of a drop.", SpotLimits());
  a.Optional("drop_lifetime_s", s.drop_lifetime_s,
             "Time after which a drop is replaced by one elsewhere.", Within(0.1, 1e6));
  a.Optional("dirt_coverage", s.dirt_coverage, "Share of the window under dirt.", Within(0, 0.9));
  a.Optional("dirt_diameter_mm", s.dirt_diameter_mm, "Diameter of a spot of dirt.", SpotLimits());
  a.Optional("snow_coverage", s.snow_coverage, "Share of the window under snow.", Within(0, 0.9));
  a.Optional("snow_diameter_mm", s.snow_diameter_mm, "Diameter of a spot of snow.", SpotLimits());
}

void Describe(Archive& a, VelocitySpec& s) {
  a.Required("sigma_mps", s.sigma_mps,
             "Standard deviation; none on rung geometry, as of the range.", Within(0, 100));
  a.Required("max_mps", s.max_mps,
             "The unambiguous velocity; faster ones are folded into -max_mps to max_mps.",
             PositiveUpTo(1000));
  a.Optional("step_mps", s.step_mps, "Velocities are multiples of it; 0 = any.", Within(0, 10));
}

void Describe(Archive& a, LidarSpec& s) {
  a.Optional("name", s.name, "Name of the sensor.", OneLine());
  a.OneOfTwo("scan", "ouster_metadata");
  a.Preset("ouster_metadata", s.ouster_metadata,
           "Metadata of an Ouster sensor, instead of scan: its beams, columns, window, rate and "
           "returns; range and divergence of its product line.",
           {"scan", [&s](const std::string& text) { UseOusterMetadata(text, s); }});
  if (s.ouster_metadata) {
    std::optional<ScanSpec> none;
    a.Optional("scan", none, "None, as the metadata say how it scans.");
    a.Ensure({"scan", "ouster_metadata"}, !none, "must be left out with ouster_metadata");
  } else {
    a.Required("scan", s.scan, "The firings of a frame; required without ouster_metadata.");
  }
  a.Optional("phase_s", s.scan.phase_s,
             "When the sensor's first frame begins, for sensors that take turns.", Within(0, 100));
  DescribeRange(a, s);
  a.Optional("mount", s.mount, "Where the sensor sits on the vehicle.");
  a.Optional("mount_error", s.mount_error,
             "Error of calibration, by which the sensor's true pose differs from mount: rays leave "
             "from the true pose, and all reports use mount.");
  a.Optional("plausibility", s.plausibility, "Parameters of the published model.");
  a.Optional("beam", s.beam, "The laser beam of the physical rungs.");
  a.Optional("receiver", s.receiver, "The receiver of the physical rungs.");
  a.Optional("cover", s.cover, "What lies on the sensor's window, on the physical rungs.");
  a.Optional("velocity", s.velocity,
             "The sensor measures velocities along its beams (FMCW). Left out: it does not.");
  a.Ensure({"phase_s", "scan"}, s.scan.phase_s * s.scan.rate_hz < 1.0, "must be < 1 / rate_hz");
}

}  // namespace railcast
