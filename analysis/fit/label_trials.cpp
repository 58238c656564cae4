#include "analysis/fit/label_trials.h"

#include <algorithm>
#include <cmath>

#include "analysis/fit/plane_trials.h"
#include "analysis/stats/plane_patches.h"

namespace railcast {
namespace {

bool HasOneLabel(const Frame& frame, const FlatPiece& piece) {
  return std::all_of(piece.slots.begin(), piece.slots.end(), [&](std::size_t slot) {
    return frame.label[slot] == frame.label[piece.slots.front()];
  });
}

Trial MakeTrial(const Frame& frame,
                std::size_t slot,
                const FlatPiece& piece,
                const SensorFacts& facts) {
  const Vector3 direction =
      Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>().normalized();
  const double along = piece.normal.dot(direction);
  const double expected_m = piece.normal.dot(piece.middle_m) / along;
  const auto num = static_cast<double>(piece.slots.size());
  const double grow = std::sqrt(num / piece.patch.degrees());
  Trial trial;
  trial.expected_m = static_cast<float>(expected_m);
  trial.cos_incidence = static_cast<float>(std::abs(along));
  trial.stretch =
      static_cast<float>(StretchOnPlane(piece.normal, expected_m, direction, facts.beam));
  trial.surface = static_cast<std::uint16_t>(frame.label[slot]);
  trial.channel = frame.ring[slot];
  trial.answer = Answer::kReturned;
  trial.residual_m =
      static_cast<float>(grow * (static_cast<double>(frame.range_m[slot]) - expected_m));
  trial.intensity = frame.intensity[slot];
  return trial;
}

}  // namespace

void ForEachLabelTrial(const RecordedFrame& recorded,
                       const SensorFacts& facts,
                       const TrialTaker& take) {
  const Frame& frame = recorded.frame;
  for (const FlatPiece& piece : FindFlatPieces(recorded, facts.scan)) {
    const std::uint32_t label = frame.label[piece.slots.front()];
    if (label == 0 || label > 0xFFFFU || !HasOneLabel(frame, piece)) continue;
    for (const std::size_t slot : piece.slots) {
      take(MakeTrial(frame, slot, piece, facts), slot);
    }
  }
}

}  // namespace railcast
