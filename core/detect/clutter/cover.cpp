#include "core/detect/clutter/cover.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/random.h"
#include "core/detect/base/vector_math.h"

namespace railcast {
namespace {

/// What lies on a window; part of the random key.
enum class SpotKind : std::uint32_t { kDrop, kDirt, kSnow };

/// Identifies a spot. A drop that replaces another belongs to the next generation.
struct SpotKey {
  SpotKind kind{};
  std::uint32_t spot{};
  std::uint32_t generation{};
};

// A uniformly distributed point of the unit sphere (Archimedes: its height is uniform, too).
SpotLayer::Center CenterOf(std::uint64_t seed, const SpotKey& key) {
  const auto words = RandomWords(seed, RandomUse::kCover, key.generation, key.spot,
                                 2 * static_cast<std::uint32_t>(key.kind));
  const float z = 2.0F * UnitFloat(words[0]) - 1.0F;
  const float across = std::sqrt(1.0F - z * z);
  float cosine{};
  float sine{};
  baseline::CosSinTurn(UnitFloat(words[1]), cosine, sine);
  return {across * cosine, across * sine, z};
}

float DropPhase(std::uint64_t seed, std::uint32_t drop) {
  constexpr std::uint32_t kBlock = 1;
  return UnitFloat(RandomWords(seed, RandomUse::kCover, 0, drop, kBlock)[0]);
}

SpotLayer MakeLayer(const CoverSpec& cover,
                    double diameter_mm,
                    const std::vector<SpotLayer::Center>& centers) {
  return {centers, 0.5 * diameter_mm / cover.window_radius_mm,
          0.5 * cover.aperture_mm / cover.window_radius_mm};
}

SpotLayer LastingLayer(const DetectorSpec& spec,
                       SpotKind kind,
                       double coverage,
                       double diameter_mm) {
  std::vector<SpotLayer::Center> centers(NumSpots(spec.cover, coverage, diameter_mm));
  for (std::uint32_t spot = 0; spot < centers.size(); ++spot) {
    centers[spot] = CenterOf(spec.seed, {kind, spot, 0});
  }
  return MakeLayer(spec.cover, diameter_mm, centers);
}

constexpr float kPi = 3.14159265F;

// The area that a chord at the signed distance `cosine` from the centre cuts off the unit disc.
float SegmentArea(float cosine) {
  const float angle_rad = cosine < 0.0F ? kPi - baseline::Acos(-cosine) : baseline::Acos(cosine);
  return angle_rad - cosine * std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
}

}  // namespace

float CoveredShare(float apart, float disc, float cover) {
  if (apart >= disc + cover) return 0.0F;
  if (apart <= cover - disc) return 1.0F;
  const float ratio = cover / disc;
  if (apart <= disc - cover) return ratio * ratio;
  // The two circles cut each other: the covered area is a segment of each.
  const float t2 = apart * apart;
  const float a2 = disc * disc;
  const float b2 = cover * cover;
  const auto bounded = [](float cosine) { return std::clamp(cosine, -1.0F, 1.0F); };
  const float of_disc = bounded((t2 + a2 - b2) / (2.0F * apart * disc));
  const float of_cover = bounded((t2 + b2 - a2) / (2.0F * apart * cover));
  return (SegmentArea(of_disc) + ratio * ratio * SegmentArea(of_cover)) / kPi;
}

std::uint32_t NumSpots(const CoverSpec& cover, double coverage, double diameter_mm) {
  // A cap with the chord b / r between centre and rim has the share b^2 / (4 r^2) of the sphere.
  const double chord = 0.5 * diameter_mm / cover.window_radius_mm;
  const double share_of_one = 0.25 * chord * chord;
  return static_cast<std::uint32_t>(std::lround(std::log1p(-coverage) / std::log1p(-share_of_one)));
}

SpotLayer::SpotLayer(const std::vector<Center>& centers, double spot_chord, double aperture_chord)
    : spot_chord_(static_cast<float>(spot_chord)),
      aperture_chord_(static_cast<float>(aperture_chord)) {
  // A spot that touches an aperture is in the same cell as the aperture's centre or beside it.
  constexpr double kMostCells = 48.0;
  num_cells_ = static_cast<int>(
      std::clamp(std::floor(2.0 / (spot_chord + aperture_chord)), 1.0, kMostCells));
  const auto cell_of = [&](const Center& center) {
    return RowAt(CellAt(center[2]), CellAt(center[1])) +
           static_cast<std::size_t>(CellAt(center[0]));
  };
  begin_.assign(RowAt(num_cells_, 0) + 1, 0);
  for (const Center& center : centers) ++begin_[cell_of(center) + 1];
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  centers_.resize(centers.size());
  for (const Center& center : centers) centers_[next[cell_of(center)]++] = center;
}

int SpotLayer::CellAt(float coordinate) const {
  const float cell = 0.5F * (coordinate + 1.0F) * static_cast<float>(num_cells_);
  return std::clamp(static_cast<int>(cell), 0, num_cells_ - 1);
}

std::size_t SpotLayer::RowAt(int z, int y) const {
  const auto num_cells = static_cast<std::size_t>(num_cells_);
  return (static_cast<std::size_t>(z) * num_cells + static_cast<std::size_t>(y)) * num_cells;
}

float SpotLayer::FreeShare(const Center& direction) const {
  if (centers_.empty()) return 1.0F;
  const float reach = spot_chord_ + aperture_chord_;
  float free = 1.0F;
  const auto first = [&](int axis) {
    return std::max(CellAt(direction[static_cast<std::size_t>(axis)]) - 1, 0);
  };
  const auto last = [&](int axis) {
    return std::min(CellAt(direction[static_cast<std::size_t>(axis)]) + 1, num_cells_ - 1);
  };
  for (int z = first(2); z <= last(2); ++z) {
    for (int y = first(1); y <= last(1); ++y) {
      const auto row = RowAt(z, y);
      const std::uint32_t end = begin_[row + static_cast<std::size_t>(last(0)) + 1];
      for (std::uint32_t i = begin_[row + static_cast<std::size_t>(first(0))]; i < end; ++i) {
        const Center& center = centers_[i];
        const float dx = center[0] - direction[0];
        const float dy = center[1] - direction[1];
        const float dz = center[2] - direction[2];
        const float distance2 = dx * dx + dy * dy + dz * dz;
        if (distance2 >= reach * reach) continue;
        free *= 1.0F - CoveredShare(std::sqrt(distance2), aperture_chord_, spot_chord_);
      }
    }
  }
  return free;
}

Cover::Cover(const DetectorSpec& spec, const ScanPattern& pattern)
    : spec_(spec.cover), seed_(spec.seed), rate_hz_(pattern.rate_hz) {
  drop_phase_.resize(NumSpots(spec_, spec_.drop_coverage, spec_.drop_diameter_mm));
  for (std::uint32_t drop = 0; drop < drop_phase_.size(); ++drop) {
    drop_phase_[drop] = DropPhase(seed_, drop);
  }
  dirt_ = LastingLayer(spec, SpotKind::kDirt, spec_.dirt_coverage, spec_.dirt_diameter_mm);
  snow_ = LastingLayer(spec, SpotKind::kSnow, spec_.snow_coverage, spec_.snow_diameter_mm);
  if (!pattern.repeats()) return;
  lasting_.resize(pattern.num_firings());
  for (std::size_t i = 0; i < lasting_.size(); ++i) {
    lasting_[i] =
        LastingShare({pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i]});
  }
}

SpotLayer Cover::DropsAt(double time_s) const {
  std::vector<SpotLayer::Center> centers(drop_phase_.size());
  for (std::uint32_t drop = 0; drop < centers.size(); ++drop) {
    const double lives = time_s / spec_.drop_lifetime_s + static_cast<double>(drop_phase_[drop]);
    const auto generation = static_cast<std::uint32_t>(static_cast<std::uint64_t>(lives));
    centers[drop] = CenterOf(seed_, {SpotKind::kDrop, drop, generation});
  }
  return MakeLayer(spec_, spec_.drop_diameter_mm, centers);
}

void Cover::Fill(DetectTile& tile, Drops& drops) const {
  if (!drops.is_known || drops.frame != tile.frame) {
    drops = {true, tile.frame, DropsAt(static_cast<double>(tile.frame) / rate_hz_)};
  }
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const SpotLayer::Center direction{tile.direction_x[i], tile.direction_y[i],
                                      tile.direction_z[i]};
    const float lasting = lasting_.empty() ? LastingShare(direction) : lasting_[tile.firing[i]];
    const float free = lasting * drops.layer.FreeShare(direction);
    tile.cover[i] = free * free;
  }
}

bool HasCover(const DetectorSpec& spec) {
  const CoverSpec& cover = spec.cover;
  return cover.drop_coverage > 0.0 || cover.dirt_coverage > 0.0 || cover.snow_coverage > 0.0;
}

double UntouchedShare(const CoverSpec& cover) {
  const auto untouched = [&](double coverage, double diameter_mm) {
    return std::pow(1.0 - coverage, std::pow(1.0 + cover.aperture_mm / diameter_mm, 2));
  };
  return untouched(cover.drop_coverage, cover.drop_diameter_mm) *
         untouched(cover.dirt_coverage, cover.dirt_diameter_mm) *
         untouched(cover.snow_coverage, cover.snow_diameter_mm);
}

}  // namespace railcast
