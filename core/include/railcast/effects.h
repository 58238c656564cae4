#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "railcast/enum_names.h"
#include "railcast/material.h"

namespace railcast {

/// How much is modelled: the rungs of the fidelity ladder, from the cheapest to the most expensive,
/// and kAuto, which stands for a choice among the effects of kFootprint.
enum class Fidelity {
  kGeometry,
  kPlausibility,
  kSurface,
  kFootprint,
  kReference,
  kAuto,  ///< kFootprint without the effects that the scene does not need (railcast/fidelity.h).
};
template <>
inline constexpr auto kEnumNames<Fidelity> =
    std::to_array<EnumName<Fidelity>>({{Fidelity::kGeometry, "geometry"},
                                       {Fidelity::kPlausibility, "plausibility"},
                                       {Fidelity::kSurface, "surface"},
                                       {Fidelity::kFootprint, "footprint"},
                                       {Fidelity::kReference, "reference"},
                                       {Fidelity::kAuto, "auto"}});

/// Which effects are on. A rung of the fidelity ladder is a named set of effects; EffectsOfRung()
/// gives it and ConflictIn() checks a set:
///
///   EffectSet effects = EffectsOfRung(Fidelity::kFootprint);
///   effects.sunlight = false;
struct EffectSet {
  // The published plausibility model.
  bool threshold = false;  ///< Threshold on reflectivity x cos x fog that rises with range.
  bool rain = false;       ///< Rain dropout.
  bool snow = false;       ///< Snow clutter.
  bool noise = false;      ///< Position noise.

  bool sensor_dropout = false;  ///< Pulses that the sensor misses at random.

  // Physics of surfaces, air and receiver.
  bool surface_response = false;   ///< Oren-Nayar, GGX and retroreflection instead of Lambert.
  bool surface_condition = false;  ///< Wet and snow-covered surfaces.
  bool texture = false;            ///< Reflectance that varies from place to place.
  bool extinction = false;         ///< Two-way extinction by fog, rain and snow.
  bool pulse_stretch = false;      ///< Oblique surfaces stretch the pulse and lower its peak.
  bool mirror_paths = false;       ///< Mirror images in puddles and smooth surfaces.
  bool detection = false;          ///< Threshold derived from the data sheet's range.
  /// Smooth detection probability instead of a hard threshold.
  bool detection_probability = false;
  bool clutter = false;   ///< Echoes of raindrops and snowflakes.
  bool fog_echo = false;  ///< Echoes of the droplets of fog near the sensor.
  bool spray = false;     ///< Water and powder snow behind moving trains.
  bool sunlight = false;  ///< Raised threshold, false alarms, and blinding by the solar disc.
  /// Range error along the beam, depending on the signal-to-noise ratio.
  bool range_noise = false;
  bool channel_bias = false;     ///< Constant range error per channel.
  bool pointing_jitter = false;  ///< Beams deviate from the direction that the sensor reports.
  bool dead_time = false;        ///< After an echo the receiver is blind for a while.

  // The sensor's window, optics and receiver.
  bool cover = false;            ///< Drops, dirt and snow on the window in front of the sensor.
  bool halo = false;             ///< Stray light of retroreflectors in the beams around them.
  bool range_walk = false;       ///< Range error that depends on the strength of the echo.
  bool interference = false;     ///< False echoes from pulses of other lidars.
  bool saturation = false;       ///< Echoes that are too strong for the receiver.
  bool ghost = false;            ///< Echoes of retroreflectors at twice their range.
  bool intensity_noise = false;  ///< Random error of the intensity of each echo.
  bool channel_gain = false;     ///< Constant error of the intensity of each channel.
  bool edge_loss = false;        ///< Losses of beams that meet two surfaces.

  // Physics of the finite beam width.
  bool footprint = false;         ///< What a beam of finite width meets, by sub-rays.
  bool thin_conductors = false;   ///< Wires by closest approach instead of by their triangles.
  bool dense_footprint = false;   ///< Hundreds of sub-rays in every beam.
  bool sampled_waveform = false;  ///< Peaks of a sampled waveform instead of closed-form echoes.

  bool operator==(const EffectSet&) const = default;
};

/// The directions in which the published model's noise displaces a point.
enum class NoiseShape {
  kIsotropic,  ///< Equal in all directions, as published.
  kBeam,       ///< Along the beam only.
};
template <>
inline constexpr auto kEnumNames<NoiseShape> = std::to_array<EnumName<NoiseShape>>(
    {{NoiseShape::kIsotropic, "isotropic"}, {NoiseShape::kBeam, "beam"}});

/// The parameters of the published plausibility model (Vir2Rail, README.md). The formulas stand in
/// the headers of the effects (core/detect/kernels/published.h, echo_power.h, measurement.h).
struct PlausibilitySpec {
  /// Least detectable reflectivity x cos(incidence) x fog transmission at reference_range_m. The
  /// threshold grows with the square of the range.
  double reference_threshold = 0.1;
  double reference_range_m = 200.0;  ///< Range at which reference_threshold applies.
  double noise_sigma0_m = 0.01;      ///< Standard deviation of the noise at range 0.
  double noise_sigma1 = 1e-4;        ///< Increase of the standard deviation per metre of range.
  NoiseShape noise_shape = NoiseShape::kIsotropic;
  double dropout_probability = 0.0;  ///< Probability that a firing is lost, whatever it hit.
  /// Growth of the losses: a firing whose surface is at range R survives with probability
  /// (1 - dropout_probability) exp(-dropout_per_m R).
  double dropout_per_m = 0.0;
  /// Further losses on dark surfaces: a firing whose echo has intensity I is lost with probability
  /// dark_dropout_probability exp(-I / dark_dropout_intensity).
  double dark_dropout_probability = 0.0;
  double dark_dropout_intensity = 0.02;

  bool operator==(const PlausibilitySpec&) const = default;
};

/// The laser beam: a Gaussian profile in the far field.
struct BeamSpec {
  int wavelength_nm = 905;  ///< 905 (stands for 850 to 950) or 1550.
  /// Beam divergence, horizontal and vertical: the full angle between the 1/e^2 points of the
  /// profile. 0 = a ray without width.
  std::array<double, 2> divergence_mrad{3.0, 1.5};
  double pulse_length_ns = 5.0;  ///< Full width at half maximum of the received pulse.
  int reference_rays = 256;      ///< Sub-rays per beam of effect dense_footprint.
  /// Sub-rays per beam of effect footprint: kNumSubRays or kNumCrowdedSubRays (ray_caster.h).
  int footprint_rays = 64;
  /// Classes, by the names of their labels. With effect footprint, a beam has a width only if it
  /// may meet a surface of one of these classes; empty = every beam has a width.
  std::vector<std::string> footprint_of{};

  bool operator==(const BeamSpec&) const = default;
};

/// What lies on the window in front of the sensor. The window is a sphere about the sensor's
/// origin; the spots on it are opaque discs that lie at random and may overlap
/// (core/detect/clutter/cover.h).
struct CoverSpec {
  double window_radius_mm = 50.0;  ///< Distance of the window from the sensor's origin.
  /// Diameter of the beam at the window, for outgoing and incoming light alike.
  double aperture_mm = 10.0;
  double drop_coverage = 0.0;     ///< Share of the window under drops, 0 to 0.9.
  double drop_diameter_mm = 3.0;  ///< About the capillary length of water; larger drops run off.
  double drop_lifetime_s = 5.0;   ///< Time after which a drop has been replaced by one elsewhere.
  double dirt_coverage = 0.0;     ///< Share of the window under dirt, 0 to 0.9.
  double dirt_diameter_mm = 2.0;
  double snow_coverage = 0.0;  ///< Share of the window under snow, 0 to 0.9.
  double snow_diameter_mm = 15.0;

  bool operator==(const CoverSpec&) const = default;
};

/// What of an echo the receiver compares with the detection threshold.
enum class EchoSignal {
  kPeak,    ///< The peak of the received pulse, which an oblique surface lowers.
  kEnergy,  ///< The energy of the pulse, which stretching does not change.
};
template <>
inline constexpr auto kEnumNames<EchoSignal> = std::to_array<EnumName<EchoSignal>>(
    {{EchoSignal::kPeak, "peak"}, {EchoSignal::kEnergy, "energy"}});

/// Which of a firing's detected echoes a sensor reports as returns, in the order of its slots.
enum class ReturnMode {
  kStrongest,
  kFirst,
  kLast,
  kDual,    ///< Strongest and last; if these coincide, strongest and second strongest.
  kTriple,  ///< Strongest, last and first; a duplicate is replaced by the next strongest.
};
template <>
inline constexpr auto kEnumNames<ReturnMode> =
    std::to_array<EnumName<ReturnMode>>({{ReturnMode::kStrongest, "strongest"},
                                         {ReturnMode::kFirst, "first"},
                                         {ReturnMode::kLast, "last"},
                                         {ReturnMode::kDual, "dual"},
                                         {ReturnMode::kTriple, "triple"}});

/// Correlation length, in ln(range), of the gain by which a channel's intensities depend on range.
/// Over channels, the gains at two ranges whose logarithms differ by D have the correlation
/// exp(-(D / kGainLogRange)^2 / 2). Measured (docs/results/validation.md).
inline constexpr double kGainLogRange = 0.45;

/// The receiver: sensitivity, return mode and measurement errors.
struct ReceiverSpec {
  /// The data sheet's detection range on a Lambertian target of 10 % at normal incidence.
  double range_at_10_percent_m = 200.0;
  double snr_at_threshold = 5.0;  ///< Amplitude signal-to-noise ratio at that range.
  EchoSignal signal = EchoSignal::kPeak;
  ReturnMode return_mode = ReturnMode::kStrongest;
  double range_noise_floor_m = 0.015;  ///< Standard deviation of the range noise at high signal.
  double range_noise_scale_m = 0.1;    ///< sigma = hypot(floor, scale / sqrt(2 SNR)).
  /// Standard deviation of the constant range errors of the channels.
  double channel_bias_sigma_m = 0.01;
  /// Standard deviation of the random factor, with mean 1, on the intensity of each single echo.
  double intensity_noise = 0.0;
  double channel_gain = 0.0;  ///< The same for a factor that is constant for each channel.
  double channel_gain_variation = 0.0;  ///< The same for one varying with range (kGainLogRange).
  double pointing_jitter_deg = 0.01;    ///< Standard deviation in each of two directions.
  double clutter_gain = 0.2;  ///< Factor for the mean number of raindrop and snowflake echoes.
  /// Range at which the receiver has a quarter of its gain for echoes of fog; nearer, the gain
  /// falls with the fourth power of the range. Absent: NearRange_m()
  /// (core/detect/clutter/fog_profile.h).
  std::optional<double> near_range_m{};
  double fog_gain = 1.0;  ///< Factor for the power of fog's echoes.
  /// How long the receiver is blind after an echo that it has detected: an echo less than
  /// c x dead_time_ns / 2 behind it does not become a return.
  double dead_time_ns = 0.0;
  /// Probability that a beam is lost if two surfaces far apart in range each take half of it.
  double edge_loss = 0.0;
  /// Share of a retroreflector's power that a beam pointing 1 deg beside it still receives.
  double halo_share_at_1_deg = 0.0;
  /// By how much an echo at the detection threshold is measured farther than a strong one.
  double range_walk_m = 0.0;
  double foreign_pulses_hz = 0.0;  ///< Detectable pulses of other lidars per second.
  /// Power over the detection threshold at which the receiver saturates; absent: never.
  std::optional<double> saturation_power_ratio{};
  /// Share of the light entering the aperture that the sensor sends back the way it came.
  double ghost_reflectance = 0.0;

  bool operator==(const ReceiverSpec&) const = default;
};

/// How a sensor measures velocities along its beams (FMCW): what sends an echo shifts the frequency
/// of the light by -2 v / wavelength.
struct VelocitySpec {
  double sigma_mps{};  ///< Standard deviation; applies with effect noise or range_noise.
  /// The unambiguous velocity: what is faster is measured as if it were slower by whole multiples
  /// of 2 max_mps.
  double max_mps{};
  double step_mps = 0.0;  ///< Measured velocities are multiples of this; 0 = not rounded.

  bool operator==(const VelocitySpec&) const = default;
};

/// The sun as seen from the sensor.
struct SunSpec {
  double illuminance_klx = 0.0;  ///< 100 = full sun.
  double azimuth_deg = 180.0;    ///< In the world frame: from +x (east) towards +y (north).
  double elevation_deg = 35.0;

  bool operator==(const SunSpec&) const = default;
};

/// Drop-size distribution of rain: Marshall and Palmer's, or one with more small drops (drizzle) or
/// more large drops (thunderstorm).
enum class RainDrops { kMarshallPalmer, kDrizzle, kThunderstorm };
template <>
inline constexpr auto kEnumNames<RainDrops> =
    std::to_array<EnumName<RainDrops>>({{RainDrops::kMarshallPalmer, "marshall_palmer"},
                                        {RainDrops::kDrizzle, "drizzle"},
                                        {RainDrops::kThunderstorm, "thunderstorm"}});

/// The type of snow, which decides its extinction (ITU-R P.1814).
enum class SnowType { kDry, kWet };
template <>
inline constexpr auto kEnumNames<SnowType> =
    std::to_array<EnumName<SnowType>>({{SnowType::kDry, "dry"}, {SnowType::kWet, "wet"}});

/// Section `weather`: the air, the precipitation, the state of surfaces and the sun.
struct WeatherSpec {
  double fog_density_per_m = 0.0;  ///< Extinction; the published model applies it one way.
  /// Alternative to fog_density_per_m: extinction = ln 20 / visibility (5 % contrast).
  std::optional<double> visibility_m;
  /// Standard deviation of the logarithm of the density of fog's droplets, which varies in space.
  double fog_variation = 0.2;
  double rain_rate_mmph = 0.0;
  RainDrops rain_drop_sizes = RainDrops::kMarshallPalmer;
  double rain_dropout_per_m = 3.65e-4;  ///< Rain dropout rate at 1 mm/h.
  double rain_dropout_exponent = 0.63;  ///< Exponent of the rain rate.
  double snow_rate_mmph = 0.0;
  SnowType snow_type = SnowType::kDry;
  double snow_echoes_per_mmph = 0.02;  ///< Mean detectable flakes per beam at 1 mm/h.
  double snow_range_scale_m = 5.0;     ///< Maxwell scale of flake ranges (median 1.538 x this).
  double snow_intensity = 0.02;        ///< Effective reflectance of a flake.
  /// Wetness of surfaces: 0 = dry, 1 = soaked. Absent: follows from the rain rate; see
  /// WetnessOf().
  std::optional<double> wetness;
  double snow_cover = 0.0;    ///< Share of each upward-facing surface that is covered by snow.
  double puddle_share = 0.0;  ///< Share of level ground that holds puddles under standing water.
  /// Extinction of the spray at a train of 100 km/h on soaked or snow-covered ground; 0 = no spray.
  double spray_extinction_per_m = 0.0;
  SunSpec sun;
  double wind_speed_mps = 0.0;        ///< 10-minute mean at 10 m height; 0 = no wind.
  double wind_direction_deg = 180.0;  ///< Where it blows from: from +x (east) towards +y (north).

  bool operator==(const WeatherSpec&) const = default;
};

/// The rain rate from which on surfaces are soaked, unless the weather says how wet they are. An
/// assumption: light rain of 1 mm/h wets a quarter of the film that heavy rain leaves.
inline constexpr double kSoakingRain_mmph = 4.0;

/// The wetness of surfaces, from 0 to 1: as the weather states it, else in proportion to the rain
/// rate up to kSoakingRain_mmph.
[[nodiscard]] double WetnessOf(const WeatherSpec& weather);

/// Label identifiers of echoes that no surface sends.
struct ClutterLabels {
  std::uint32_t rain{};
  std::uint32_t snow{};
  std::uint32_t fog{};
  std::uint32_t false_alarm{};
  std::uint32_t halo{};
  std::uint32_t spray{};
  std::uint32_t mirror_image{};
  std::uint32_t ghost{};
};

/// Everything that detection depends on besides the scene: the sensor, the weather and the chosen
/// effects. CheckDetectorSpec() checks it.
struct DetectorSpec {
  std::uint64_t seed = 1;  ///< Key of the sensor's own draws (SensorSeed()).
  /// Key of patches of fog and gusts, the same for all sensors.
  std::uint64_t air_seed = 1;
  std::uint64_t ground_seed = 1;  ///< Key of the puddles, which are part of the world.
  /// Whether anything in the world may be of a material with `height_rms_um`; false = known not to.
  bool has_mirrors = true;
  /// Whether any material has a `texture`; false = known not to.
  bool has_texture = true;
  double range_min_m = 0.5;
  double range_max_m = 300.0;
  EffectSet effects{};
  PlausibilitySpec plausibility{};
  BeamSpec beam{};
  ReceiverSpec receiver{};
  CoverSpec cover{};
  std::optional<VelocitySpec> velocity{};  ///< Absent: the sensor measures none.
  WeatherSpec weather{};
  ClutterLabels clutter_labels{};
  std::vector<std::uint32_t> footprint_labels{};  ///< Ids of BeamSpec::footprint_of, ascending.
};

/// Input of a Detector from the scan pattern and from the materials.
struct DetectorSetting {
  std::uint32_t num_channels = 1;
  SurfaceOptics snow{};  ///< Optics of the snow on covered surfaces.
};

/// Checks that every number of the spec is within the limits that scenario files have for it.
/// @throws InputError with a line for every number that is not:
///   "/beam/wavelength_nm: must be 905 or 1550 (got 1064)".
void CheckDetectorSpec(const DetectorSpec& spec);

/// The rungs of the fidelity ladder, from the cheapest to the most expensive.
inline constexpr Fidelity kRungs[] = {Fidelity::kGeometry, Fidelity::kPlausibility,
                                      Fidelity::kSurface, Fidelity::kFootprint,
                                      Fidelity::kReference};

/// The effects that a rung stands for.
/// @throws InputError if `rung` is not one of kRungs; kAuto is not.
[[nodiscard]] EffectSet EffectsOfRung(Fidelity rung);

/// Checks whether the effects of a set may be on together. Returns a message that names two
/// conflicting effects, or nothing if the set is sound.
///
/// The published model and the physical one describe the same phenomena, so effects of only one of
/// them may be on; `sensor_dropout` belongs to both. `dense_footprint` requires `footprint`, and
/// excludes `thin_conductors`: it samples the wires' triangles, so that wires would count twice.
[[nodiscard]] std::optional<std::string> ConflictIn(const EffectSet& effects);

}  // namespace railcast
