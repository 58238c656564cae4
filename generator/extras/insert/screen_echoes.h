#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/simulate/beam_tracer.h"
#include "core/simulate/returns.h"
#include "core/simulate/velocity_meter.h"
#include "generator/extras/insert/screen_surfaces.h"
#include "railcast/effects.h"
#include "railcast/outcome.h"

namespace railcast {

/// In place of the index of a recorded return.
inline constexpr std::uint32_t kNoScreen = std::numeric_limits<std::uint32_t>::max();

/// A return of a firing as it is now.
struct ReturnNow {
  std::uint32_t screen = kNoScreen;  ///< The recorded return that it is, or which sends most of it.
  /// Whether it was not recorded as it is. Otherwise the rest, but for `intensity_ratio`, is unset.
  bool is_added = false;
  float intensity_ratio = 1.0F;  ///< Intensity over the recorded one.
  Outcome outcome = Outcome::kReturned;
  Eigen::Vector3f point_m = Eigen::Vector3f::Zero();  ///< In the sensor's axes at the firing.
  float range_m{}, true_range_m{};
  float intensity{};
  float power_ratio{}, incidence_rad{}, footprint_share{};
  std::uint32_t label{}, instance{};
  std::uint16_t material{};
  /// NaN if the sensor measures none.
  BeamVelocity velocity{std::numeric_limits<float>::quiet_NaN(),
                        std::numeric_limits<float>::quiet_NaN()};
};

/// A recorded return that is none any more.
struct LostReturn {
  std::uint32_t screen{};
  Outcome outcome{};
  std::uint32_t instance{};  ///< The object that has hidden it; 0 = none.
};

/// A firing that returns something else than was recorded.
struct ChangedFiring {
  std::uint32_t firing{};
  Outcome outcome{};  ///< Outcome of the firing, if it has no returns.
  float mixed_share{};
  std::vector<ReturnNow> returns{};  ///< In the order of the slots.
  std::vector<LostReturn> lost{};
};

/// Says the velocity of an echo; may be empty.
using VelocityOfEcho = std::function<BeamVelocity(const EchoTiles::Place& echo)>;

/// Turns the echoes of firings with screens into what has changed. Immutable; thread-safe.
class ScreenEchoes {
 public:
  /// @param cast With these screens. It must outlive this, as must the others.
  ScreenEchoes(const DetectorSpec& detector,
               const ReturnRule& rule,
               const CastFrame& cast,
               const Screens& screens,
               const ScreenSurfaces& surfaces)
      : detector_(detector), rule_(rule), cast_(cast), screens_(screens), surfaces_(surfaces) {}

  /// For BeamTracer::MakeKnownEchoes(): the echoes of firings that meet nothing but their screens,
  /// each of which sends an echo of its own.
  void Put(const Detector& detector, EchoTiles& echoes) const;

  /// Before Detector::Detect(): puts the echoes of screens where these are, unless other light in
  /// them moves their peaks.
  /// @returns The intensities of all echoes, in which the receiver has not erred yet.
  [[nodiscard]] std::vector<float> Place(EchoTiles& echoes) const;
  /// After it: decides anew which echoes of screens are detected, and undoes what noise and chance
  /// have done to them.
  /// @param exact As Place() returned them.
  void Judge(EchoTiles& echoes, const std::vector<float>& exact) const;
  /// After it: notes of the echo of a screen which part it has of the recorded power.
  /// @param kept By screen.
  void TellPower(const EchoTiles::Place& echo, std::vector<float>& kept) const;
  /// Whether an echo is a lost return or an added one.
  [[nodiscard]] bool IsNews(const EchoTiles::Place& echo) const;
  /// @param lane Of the firing in `echoes.first`.
  [[nodiscard]] ChangedFiring Compose(EchoTiles& echoes,
                                      std::size_t lane,
                                      const VelocityOfEcho& velocity_of) const;
  /// Whether a firing returns anything else than was recorded.
  [[nodiscard]] bool IsChanged(const ChangedFiring& firing) const;

 private:
  /// The screen whose echo this is; kNoScreen if it is something else's.
  [[nodiscard]] std::uint32_t ScreenAt(const EchoTiles::Place& echo) const {
    const std::uint32_t surface = echo.tile.surface[echo.lane];
    const bool is_screen = surface >= surfaces_.first && echo.tile.clutter[echo.lane] == kNoClutter;
    return is_screen ? surface - surfaces_.first : kNoScreen;
  }
  /// The part that the echo of a screen has of its recorded power; 1 without effect `detection`.
  [[nodiscard]] float PowerKept(const EchoTiles::Place& echo) const;
  [[nodiscard]] bool IsDetected(const EchoTiles::Place& echo) const;
  [[nodiscard]] ReturnNow Describe(const EchoTiles::Place& echo) const;

  const DetectorSpec& detector_;
  const ReturnRule& rule_;
  const CastFrame& cast_;
  const Screens& screens_;
  const ScreenSurfaces& surfaces_;
};

}  // namespace railcast
