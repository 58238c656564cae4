#include "analysis/compare/pairing.h"

#include <cstdlib>

namespace railcast {
namespace {

std::int64_t Apart_ns(const RecordedFrame& a, const RecordedFrame& b) {
  return std::abs(a.frame.stamp_ns - b.frame.stamp_ns);
}

}  // namespace

void FramePairs::Side::Fill() {
  while (frames.size() < 2) {
    const std::optional<Recording::FrameReader> read = recording.Next();
    if (!read) return;
    frames.push_back((*read)());
  }
}

RecordedFrame FramePairs::Side::Take() {
  RecordedFrame frame = std::move(frames.front());
  frames.pop_front();
  return frame;
}

void FramePairs::Side::Drop() {
  frames.pop_front();
  ++num_dropped;
}

void FramePairs::Side::DropRest() {
  num_dropped += frames.size();
  frames.clear();
  // The remaining frames are counted without being decoded.
  while (recording.Next()) ++num_dropped;
}

std::optional<std::int64_t> FramePairs::Side::Spacing_ns() const {
  if (frames.size() < 2) return std::nullopt;
  const std::int64_t spacing_ns = frames[1].frame.stamp_ns - frames[0].frame.stamp_ns;
  return spacing_ns > 0 ? std::optional(spacing_ns) : std::nullopt;
}

FramePairs::FramePairs(Recording& a, Recording& b, std::optional<Pairing> pairing)
    : a_{a, {}, 0}, b_{b, {}, 0} {
  a_.Fill();
  b_.Fill();
  const bool has_stamps = a_.Spacing_ns() && b_.Spacing_ns();
  pairing_ = pairing.value_or(has_stamps ? Pairing::kStamp : Pairing::kIndex);
}

std::optional<FramePair> FramePairs::Next() {
  a_.Fill();
  b_.Fill();
  std::optional<FramePair> pair = pairing_ == Pairing::kIndex ? NextByIndex() : NextByStamp();
  if (!pair) {
    a_.DropRest();
    b_.DropRest();
  }
  return pair;
}

std::optional<FramePair> FramePairs::NextByIndex() {
  if (a_.frames.empty() || b_.frames.empty()) return std::nullopt;
  FramePair pair;
  pair.a = a_.Take();
  pair.b = b_.Take();
  return pair;
}

std::optional<FramePair> FramePairs::NextByStamp() {
  while (!a_.frames.empty() && !b_.frames.empty()) {
    // The last frame of A has no successor: it is assumed to last as long as the one before.
    if (const auto spacing_ns = a_.Spacing_ns()) tolerance_ns_ = *spacing_ns / 2;
    const RecordedFrame& a = a_.frames.front();
    const RecordedFrame& b = b_.frames.front();
    const bool next_b_is_nearer =
        b_.frames.size() > 1 && Apart_ns(a, b_.frames[1]) < Apart_ns(a, b);
    const bool next_a_is_nearer =
        a_.frames.size() > 1 && Apart_ns(a_.frames[1], b) < Apart_ns(a, b);
    if (Apart_ns(a, b) <= tolerance_ns_ && !next_a_is_nearer && !next_b_is_nearer) {
      return NextByIndex();
    }
    // The earlier frame has no partner.
    Side& earlier = b.frame.stamp_ns < a.frame.stamp_ns ? b_ : a_;
    earlier.Drop();
    a_.Fill();
    b_.Fill();
  }
  return std::nullopt;
}

std::string PairingName(Pairing pairing) {
  return pairing == Pairing::kIndex ? "index" : "stamp";
}

}  // namespace railcast
