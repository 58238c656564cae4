#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/beam/part_batch.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// A recorded return as a surface, which faces the beam of its firing at the recorded range.
struct Screen {
  float range_m{};        ///< From where the beam leaves.
  float intensity{};      ///< Reflectance x share of the beam, as recorded.
  bool is_power_known{};  ///< Whether the intensity is that of the recorded power.
  /// The part of the beam that the firing's returns took, as far as is known. The rest of it met
  /// nothing.
  float share = 1.0F;
  /// How far behind the recorded range rays meet it. Errors of ranges must not hide what stands
  /// close before it.
  float back_m = 0.0F;
  std::uint32_t surface{};  ///< Index in the frame's surface table; no other screen has it.
};

/// A firing's screens that share its beam, of which each takes so many sixteenths.
inline constexpr std::size_t kMostScreens = 8;
inline constexpr std::uint32_t kScreenParts = 16;
using ScreenParts = std::array<std::uint32_t, kMostScreens>;

/// Divides a beam among the recorded returns of its firing in proportion to their intensities, so
/// that all have about the same reflectance, which is the least that can be assumed. Each has a
/// sixteenth at least. What the share of the first leaves free is left over. @pre There are at most
/// kMostScreens, and no intensity is negative.
[[nodiscard]] ScreenParts PartsOf(std::span<const Screen> screens);

/// The recorded returns of a frame's firings as surfaces that only the beams of their own firing
/// meet.
///
/// A ray meets the nearest screen of its firing. Of sub-rays, every sixteenth belongs to one
/// screen, so that the parts of a beam that returned separately are spread all over it: where in
/// the beam they were is not known.
class Screens final : public FiringSurfaces {
 public:
  /// @param first By firing, the index of its first screen; one more for the end.
  Screens(std::vector<std::uint32_t> first, std::vector<Screen> screens);

  [[nodiscard]] std::span<const Screen> of(std::uint32_t firing) const {
    return {screens_.data() + first_[firing], first_[firing + 1] - first_[firing]};
  }
  [[nodiscard]] const Screen& screen(std::size_t index) const { return screens_[index]; }
  /// Index of a firing's first screen.
  [[nodiscard]] std::uint32_t first(std::uint32_t firing) const { return first_[firing]; }
  [[nodiscard]] std::size_t num_firings() const { return first_.size() - 1; }

  /// Firings that meet something before their screens are noted.
  void Meet(const std::uint32_t* firings, std::size_t num, RayTile& rays) const override;
  void Meet(std::uint32_t firing, BeamRays& beam) const override;

  /// The surface that the firing has met before or beside its screens; 0 = none.
  [[nodiscard]] std::uint32_t met(std::uint32_t firing) const { return met_[firing]; }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<Screen> screens_;
  mutable std::vector<std::uint32_t> met_;  // By firing.
};

}  // namespace railcast
