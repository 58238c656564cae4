#include "core/fidelity/echoes_by_range.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

using Sums = EchoesByRange::Sums;

constexpr double kNormal95Percent = 1.96;

RelativeChange ChangeWithin(double ratio, const std::vector<double>& deviations) {
  double squares = 0.0;
  for (const double deviation : deviations) squares += deviation * deviation;
  return {ratio - 1.0, kNormal95Percent * ratio * std::sqrt(squares)};
}

}  // namespace

int EchoesByRange::BinOf(float range_m) const {
  return static_cast<int>(static_cast<double>(range_m) / bin_m_);
}

double TotalOf(const std::vector<Sums>& sums, double Sums::*of) {
  double total = 0.0;
  for (const Sums& frame : sums) total += frame.*of;
  return total;
}

void EchoesByRange::AddFrame(const Frame& frame) {
  ++num_frames_;
  for (auto& [place, sums] : sums_) sums.resize(num_frames_);
  for (std::size_t begin = 0; begin < frame.num_slots(); begin += frame.returns) {
    std::vector<std::size_t> echoes;
    for (std::size_t slot = begin; slot < begin + frame.returns; ++slot) {
      if (frame.outcome[slot] == Outcome::kReturned) echoes.push_back(slot);
    }
    std::ranges::sort(echoes, {}, [&](std::size_t slot) { return frame.true_range_m[slot]; });
    for (const std::size_t slot : echoes) {
      std::vector<Sums>& of_place = sums_[{frame.label[slot], BinOf(frame.true_range_m[slot])}];
      of_place.resize(num_frames_);
      if (slot != echoes.front()) {
        of_place.back().further += 1.0;
        continue;
      }
      of_place.back().first += 1.0;
      of_place.back().intensity += static_cast<double>(frame.intensity[slot]);
      if (height_above_) AddHeight(frame, slot, of_place.back());
    }
  }
  AddNeighbours(frame);
}

void EchoesByRange::AddHeight(const Frame& frame, std::size_t slot, Sums& sums) const {
  const std::optional<double> height_m = height_above_(frame, slot);
  if (!height_m) return;
  sums.num_surveyed += 1.0;
  sums.height_m += *height_m;
  sums.square_height_m2 += *height_m * *height_m;
}

void EchoesByRange::AddNeighbours(const Frame& frame) {
  constexpr float kNear_m = 0.1F;
  for (std::size_t slot = 0; slot + frame.returns < frame.num_slots(); slot += frame.returns) {
    const std::size_t next = slot + frame.returns;
    const auto is_last_column = next % frame.width() == 0;
    if (is_last_column || frame.label[slot] != frame.label[next] ||
        frame.outcome[slot] != Outcome::kReturned || frame.outcome[next] != Outcome::kReturned) {
      continue;
    }
    Sums& sums = sums_.at({frame.label[slot], BinOf(frame.true_range_m[slot])}).back();
    sums.neighbours += 1.0;
    if (std::abs(frame.true_range_m[slot] - frame.true_range_m[next]) < kNear_m) {
      sums.near_neighbours += 1.0;
    }
  }
}

const std::vector<EchoesByRange::Sums>& EchoesByRange::Of(std::uint32_t label, int bin) const {
  static const std::vector<Sums> nothing;
  const auto found = sums_.find({label, bin});
  return found == sums_.end() ? nothing : found->second;
}

std::vector<EchoesByRange::Place> EchoesByRange::Places() const {
  std::vector<Place> places;
  for (const auto& [place, sums] : sums_) places.push_back(place);
  return places;
}

RelativeChange ChangeOfSum(const std::vector<Sums>& from,
                           const std::vector<Sums>& to,
                           double Sums::*of) {
  const double from_total = TotalOf(from, of);
  const double to_total = TotalOf(to, of);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < from.size(); ++i) {
    deviations.push_back(to[i].*of / to_total - from[i].*of / from_total);
  }
  return ChangeWithin(to_total / from_total, deviations);
}

RelativeChange ChangeOfIntensity(const std::vector<Sums>& from, const std::vector<Sums>& to) {
  const auto mean = [](const std::vector<Sums>& sums) {
    return TotalOf(sums, &Sums::intensity) / TotalOf(sums, &Sums::first);
  };
  const auto deviation = [&](const std::vector<Sums>& sums, std::size_t frame) {
    return (sums[frame].intensity - mean(sums) * sums[frame].first) /
           TotalOf(sums, &Sums::intensity);
  };
  std::vector<double> deviations;
  for (std::size_t i = 0; i < from.size(); ++i) {
    deviations.push_back(deviation(to, i) - deviation(from, i));
  }
  return ChangeWithin(mean(to) / mean(from), deviations);
}

RelativeChange ChangeOfHeights(const std::vector<Sums>& from, const std::vector<Sums>& to) {
  const auto mean_m = [](const std::vector<Sums>& sums) {
    return TotalOf(sums, &Sums::height_m) / TotalOf(sums, &Sums::num_surveyed);
  };
  const auto variance_m2 = [&](const std::vector<Sums>& sums) {
    return TotalOf(sums, &Sums::square_height_m2) / TotalOf(sums, &Sums::num_surveyed) -
           mean_m(sums) * mean_m(sums);
  };
  // What one frame adds to half the logarithm of the variance.
  const auto deviation = [&](const std::vector<Sums>& sums, std::size_t i) {
    const Sums& frame = sums[i];
    const double squares_m2 = frame.square_height_m2 - 2.0 * mean_m(sums) * frame.height_m +
                              frame.num_surveyed * mean_m(sums) * mean_m(sums);
    const double variance = variance_m2(sums);
    return 0.5 * (squares_m2 - frame.num_surveyed * variance) /
           (TotalOf(sums, &Sums::num_surveyed) * variance);
  };
  std::vector<double> deviations;
  for (std::size_t i = 0; i < from.size(); ++i) {
    deviations.push_back(deviation(to, i) - deviation(from, i));
  }
  return ChangeWithin(std::sqrt(variance_m2(to) / variance_m2(from)), deviations);
}

}  // namespace railcast
