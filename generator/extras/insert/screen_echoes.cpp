#include "generator/extras/insert/screen_echoes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/random.h"
#include "core/detect/clutter/cover.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

// An echo of a screen that something beside it moves by more than this is no recorded return.
constexpr float kMoved_m = 0.002F;
// Parts of a recorded return that differ from all of it by less than this are all of it: where an
// object takes nothing of its light, they are sums of rounded levels.
constexpr float kSame = 1e-3F;

double NormalCdfOf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

Outcome OutcomeAt(const EchoTiles::Place& echo) {
  return static_cast<Outcome>(echo.tile.outcome[echo.lane]);
}

template <typename Use>
void ForEachEcho(EchoTiles& echoes, const Use& use) {
  for (std::size_t i = 0; i < echoes.first.num_rays; ++i) use(EchoTiles::Place{echoes.first, i});
  for (std::size_t i = 0; i < echoes.num_more(); ++i) use(echoes.more(i));
}

void PutScreen(const Screen& screen, const Detector& detector, const EchoTiles::Place& place) {
  const auto& [tile, i] = place;
  tile.surface[i] = screen.surface;
  tile.true_range_m[i] = screen.range_m;
  tile.cos_incidence[i] = 1.0F;
  tile.normal_up[i] = 0.0F;
  tile.spread_m[i] = 0.0F;
  tile.share[i] = 1.0F;
  tile.peak_shift_m[i] = 0.0F;
  tile.reflectivity[i] = screen.intensity;
  tile.outcome[i] = static_cast<std::uint32_t>(Outcome::kReturned);
  tile.clutter[i] = kNoClutter;
  tile.intensity[i] = screen.intensity;
  tile.power_ratio[i] = detector.PowerRatio(screen.intensity, screen.range_m, 0.0F);
}

}  // namespace

void ScreenEchoes::Put(const Detector& detector, EchoTiles& echoes) const {
  const DetectTile& first = echoes.first;
  for (std::size_t lane = 0; lane < first.num_rays; ++lane) {
    const auto screens = screens_.of(first.firing[lane]);
    if (screens.empty()) continue;
    // What the air adds must lie before the nearest.
    const auto nearest = std::ranges::min_element(screens, {}, &Screen::range_m);
    PutScreen(*nearest, detector, {echoes.first, lane});
    std::uint32_t number = 0;
    for (const Screen& screen : screens) {
      if (&screen != &*nearest) PutScreen(screen, detector, echoes.Add(lane, ++number));
    }
  }
}

std::vector<float> ScreenEchoes::Place(EchoTiles& echoes) const {
  std::vector<float> exact;
  ForEachEcho(echoes, [&](const EchoTiles::Place& echo) {
    const auto& [tile, lane] = echo;
    exact.push_back(tile.intensity[lane]);
    const std::uint32_t screen = ScreenAt(echo);
    if (screen == kNoScreen) return;
    const float shift_m = std::exchange(tile.peak_shift_m[lane], 0.0F);
    const float moved_m = std::fabs(shift_m) > kMoved_m ? shift_m : 0.0F;
    tile.true_range_m[lane] = screens_.screen(screen).range_m + moved_m;
  });
  return exact;
}

float ScreenEchoes::PowerKept(const EchoTiles::Place& echo) const {
  if (!detector_.effects.detection) return 1.0F;
  const auto& [tile, lane] = echo;
  const Screen& screen = screens_.screen(ScreenAt(echo));
  // Only screens alone are not rounded to levels of materials.
  const bool is_met = screens_.met(tile.firing[lane]) != 0;
  const float alone = is_met ? surfaces_.alone[ScreenAt(echo)] : screen.intensity;
  const float kept = tile.power_ratio[lane] * LeastIntensity(detector_, screen.range_m) / alone;
  return is_met && std::fabs(kept - 1.0F) < kSame ? 1.0F : kept;
}

bool ScreenEchoes::IsDetected(const EchoTiles::Place& echo) const {
  if (!detector_.effects.detection) return true;
  const auto& [tile, lane] = echo;
  const Screen& screen = screens_.screen(ScreenAt(echo));
  const double before =
      static_cast<double>(screen.intensity / LeastIntensity(detector_, screen.range_m));
  const double ratio = before * static_cast<double>(PowerKept(echo));
  if (!detector_.effects.detection_probability) return ratio >= 1.0;
  if (ratio >= before) return true;
  const auto probability = [&](double of_threshold) {
    return NormalCdfOf(detector_.receiver.snr_at_threshold * (of_threshold - 1.0));
  };
  // A recording of the same seed has been decided by the draw of kDetection.
  const auto words = RandomWords(detector_.seed, RandomUse::kRecordedDetection, tile.frame,
                                 tile.firing[lane], tile.echo[lane]);
  return static_cast<double>(UnitFloat(words[0])) * probability(before) < probability(ratio);
}

void ScreenEchoes::Judge(EchoTiles& echoes, const std::vector<float>& exact) const {
  const bool is_physical = IsPhysical(detector_.effects);
  const bool has_cover = detector_.effects.cover && HasCover(detector_);
  std::size_t num = 0;
  ForEachEcho(echoes, [&](const EchoTiles::Place& echo) {
    const std::size_t number = num++;  // Echoes that the detector added come after all others.
    if (ScreenAt(echo) == kNoScreen) return;
    const auto& [tile, lane] = echo;
    // The recorded intensity has the noise and the gain of its sensor in it.
    if (is_physical) tile.intensity[lane] = exact[number];
    Outcome outcome = OutcomeAt(echo);
    if (is_physical && !IsDetected(echo)) {
      const bool is_covered = has_cover && tile.cover[lane] < 1.0F && tile.bare_ratio[lane] >= 1.0F;
      outcome = is_covered ? Outcome::kCoverBlocked : Outcome::kBelowThreshold;
    } else if (is_physical ||
               (outcome != Outcome::kBelowThreshold && outcome != Outcome::kRainAbsorbed)) {
      outcome = Outcome::kReturned;  // What noise does, or chance, has been recorded.
    }
    tile.outcome[lane] = static_cast<std::uint32_t>(outcome);
    const float range_m = tile.true_range_m[lane];
    tile.range_m[lane] = range_m;
    tile.x[lane] = range_m * tile.direction_x[lane];
    tile.y[lane] = range_m * tile.direction_y[lane];
    tile.z[lane] = range_m * tile.direction_z[lane];
  });
}

void ScreenEchoes::TellPower(const EchoTiles::Place& echo, std::vector<float>& kept) const {
  if (ScreenAt(echo) != kNoScreen) kept[ScreenAt(echo)] = PowerKept(echo);
}

ReturnNow ScreenEchoes::Describe(const EchoTiles::Place& echo) const {
  const auto& [tile, lane] = echo;
  ReturnNow now{.screen = ScreenAt(echo)};
  if (now.screen != kNoScreen) {
    const float ratio = tile.intensity[lane] / surfaces_.alone[now.screen];
    // Weather takes no part of what an intensity says, and screens alone are not rounded to levels
    // of materials. Without a power, the ratio is NaN.
    const bool is_met = screens_.met(tile.firing[lane]) != 0;
    if (is_met && std::fabs(ratio - 1.0F) > kSame) now.intensity_ratio = ratio;
    const Screen& screen = screens_.screen(now.screen);
    if (tile.true_range_m[lane] == screen.range_m) return now;
  }
  const Surface& surface = cast_.surfaces[tile.surface[lane]];
  const bool is_clutter = tile.clutter[lane] != kNoClutter;
  const bool has_beams = IsPhysical(detector_.effects);
  const bool has_surface = now.screen == kNoScreen && (!is_clutter || has_beams);
  now.is_added = true;
  now.outcome = OutcomeAt(echo);
  now.point_m = {tile.x[lane], tile.y[lane], tile.z[lane]};
  now.range_m = tile.range_m[lane];
  now.true_range_m = tile.true_range_m[lane];
  now.intensity = tile.intensity[lane];
  now.power_ratio = tile.power_ratio[lane];
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  now.incidence_rad = is_clutter ? kNaN : tile.incidence_rad[lane];
  now.footprint_share = has_beams && tile.surface[lane] != 0 ? tile.share[lane] : kNaN;
  now.label = is_clutter ? tile.clutter[lane] : surface.label;
  now.instance = has_surface ? surface.instance : 0;
  now.material = has_surface ? surface.material : std::uint16_t{0};
  return now;
}

ChangedFiring ScreenEchoes::Compose(EchoTiles& echoes,
                                    std::size_t lane,
                                    const VelocityOfEcho& velocity_of) const {
  ChangedFiring changed{.firing = echoes.first.firing[lane],
                        .mixed_share = echoes.mixed_share[lane]};
  const std::uint32_t first = screens_.first(changed.firing);
  std::vector<std::optional<EchoTiles::Place>> of_screen;
  for (std::size_t k = 0; k < screens_.of(changed.firing).size(); ++k) of_screen.emplace_back();
  bool has_added = false;
  for (const EchoTiles::Place& echo : EchoesOf(echoes, lane)) {
    const std::uint32_t screen = ScreenAt(echo);
    if (screen == kNoScreen) {
      has_added = has_added || HasPoint(OutcomeAt(echo));
    } else {
      of_screen[screen - first].emplace(echo);
    }
  }
  if (has_added) {
    for (const EchoTiles::Place& echo : ReturnsOf(rule_, echoes, lane)) {
      ReturnNow& now = changed.returns.emplace_back(Describe(echo));
      if (now.is_added && velocity_of) now.velocity = velocity_of(echo);
    }
  } else {
    // The sensor has chosen among them already.
    for (const auto& echo : of_screen) {
      if (echo && HasPoint(OutcomeAt(*echo))) changed.returns.push_back(Describe(*echo));
    }
  }
  const std::uint32_t hidden_by = cast_.surfaces[screens_.met(changed.firing)].instance;
  for (std::uint32_t k = 0; k < of_screen.size(); ++k) {
    const bool is_there = std::ranges::any_of(changed.returns, [&](const ReturnNow& now) {
      return now.screen == first + k && !now.is_added;
    });
    if (is_there) continue;
    // Without an object, a flake has taken its place (effect `snow`).
    const bool is_hidden = screens_.met(changed.firing) != 0;
    Outcome outcome = is_hidden ? Outcome::kBelowThreshold : Outcome::kNoFurtherEcho;
    if (of_screen[k]) outcome = OutcomeAt(*of_screen[k]);
    if (HasPoint(outcome)) outcome = Outcome::kNoFurtherEcho;
    const bool is_weather = outcome == Outcome::kRainAbsorbed || outcome == Outcome::kCoverBlocked;
    changed.lost.push_back({first + k, outcome, is_weather ? 0 : hidden_by});
  }
  changed.outcome =
      changed.lost.empty() ? OutcomeAt({echoes.first, lane}) : changed.lost[0].outcome;
  return changed;
}

bool ScreenEchoes::IsNews(const EchoTiles::Place& echo) const {
  return (ScreenAt(echo) != kNoScreen) != HasPoint(OutcomeAt(echo));
}

bool ScreenEchoes::IsChanged(const ChangedFiring& firing) const {
  if (!firing.lost.empty()) return true;
  std::uint32_t next = screens_.first(firing.firing);
  return std::ranges::any_of(firing.returns, [&](const ReturnNow& now) {
    return now.is_added || now.intensity_ratio != 1.0F || now.screen != next++;
  });
}

}  // namespace railcast
