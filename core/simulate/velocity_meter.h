#pragma once

#include <cstddef>

#include "core/detect/base/echo_tiles.h"
#include "core/simulate/beam_tracer.h"
#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// The velocity of an echo along its beam.
struct BeamVelocity {
  float measured_mps{};  ///< NaN without a point.
  float true_mps{};      ///< NaN where it is not known.
};

/// The velocities along the beams that an FMCW sensor measures (VelocitySpec), from the motion of
/// sensor and things at the time of the firing:
///
///   v = d . (v_thing(p) - v_sensor(o)),   measured = fold(v + sigma n), rounded to step_mps
///
/// with the beam's true direction d, its origin o, and the point p = o + true range x d of the
/// surface that the echo reports, which is the one that sends most of it: frequencies of mixed
/// echoes do not average, the strongest peak of the spectrum is taken. v is the change of the
/// path's length over time, positive = receding (as Aeva's simulator has it: FMCWLidar.cpp in
/// aevainc/carla), and shifts the light by -2 v / wavelength. fold() brings it into
/// [-max_mps, max_mps). n ~ N(0, 1); sigma is 0 without the effects `noise` and `range_noise`.
///
///   mirror images   the path's length: d.(v_M - v_o) + w.(v_Q - v_M), with the mirror M and the
///                   thing Q in the direction w behind it
///   ghosts          twice their retroreflector's, as their range
///   drops, flakes   the wind's mean velocity and a fall of 9.65 - 10.3 exp(-0.6 D / mm) m/s
///                   (Atlas, Srivastava, Sekhon 1973) with the median diameter of Marshall and
///                   Palmer's rain, D = 0.895 mm (mm/h)^-0.21 R^0.21; 1 m/s for flakes
///   fog, spray      the wind's mean velocity
///   halos           not known: NaN, measured as well
///   false alarms,   true: NaN. Measured: any velocity up to max_mps, as a peak of noise has
///   foreign pulses
///
/// Not modelled: beams that leave beside a rotor's axis move with the sensor's body, not with the
/// rotor; droplets in the wake of a train move with the undisturbed air.
class VelocityMeter {
 public:
  /// @param cast Must outlive the meter. @pre It has a motion.
  VelocityMeter(const DetectorSpec& spec, const CastFrame& cast);

  /// @param beam The echo's firing, a lane of the tile in `work`.
  [[nodiscard]] BeamVelocity Of(const EchoTiles::Place& echo,
                                std::size_t beam,
                                BeamTracer::Work& work) const;
  /// Stores what is measured of an echo, and what is true.
  void Store(const EchoTiles::Place& echo,
             std::size_t beam,
             BeamTracer::Work& work,
             std::size_t slot,
             Frame& frame) const;

 private:
  struct Ray;
  [[nodiscard]] static Ray RayOf(const RayTile& rays, std::size_t beam);
  [[nodiscard]] double TrueOf_mps(const EchoTiles::Place& echo,
                                  std::size_t beam,
                                  BeamTracer::Work& work) const;
  [[nodiscard]] double RateTo_mps(const Ray& ray, const Vector3& thing_mps) const;
  [[nodiscard]] double SurfaceRate_mps(const Ray& ray, std::uint32_t surface, double range_m) const;
  [[nodiscard]] double MirrorRate_mps(const Ray& ray,
                                      std::size_t beam,
                                      const BeamTracer::Work& work) const;
  [[nodiscard]] double GhostRate_mps(const Ray& ray,
                                     double range_m,
                                     std::size_t beam,
                                     BeamTracer::Work& work) const;
  [[nodiscard]] double Measured_mps(const EchoTiles::Place& echo, double true_mps) const;

  const FrameMotion& motion_;
  std::uint64_t seed_;
  VelocitySpec spec_;
  double sigma_mps_;
  // Velocity of the air and what falls through it, in window axes.
  Vector3 wind_mps_;
  Vector3 drops_mps_;
  Vector3 flakes_mps_;
};

}  // namespace railcast
