#include "viewer/session/playback.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/error.h"

namespace railcast {

void Player::Play(double now_s) {
  is_playing_ = true;
  shown_at_s_ = now_s;
}

void Player::SetSpeed(double speed_factor, double now_s) {
  speed_factor_ = std::clamp(speed_factor, kLowestSpeedFactor, kHighestSpeedFactor);
  shown_at_s_ = now_s;
}

void Player::Faster(double now_s) {
  SetSpeed(2.0 * speed_factor_, now_s);
}

void Player::Slower(double now_s) {
  SetSpeed(0.5 * speed_factor_, now_s);
}

void Player::Seek(std::size_t place, double now_s) {
  place_ = place;
  shown_at_s_ = now_s;
}

bool Player::Advance(double now_s, double period_s) {
  if (!is_playing_) return false;
  const double step_s = period_s / speed_factor_;
  const double num_due = std::floor((now_s - shown_at_s_) / step_s);
  if (num_due < 1.0) return false;
  place_ += static_cast<std::size_t>(num_due);
  shown_at_s_ += num_due * step_s;
  return true;
}

void Playback::Begin(double now_s) {
  player_.Seek(session_.place(), now_s);
  if (live_ != nullptr) player_.Play(now_s);
}

bool Playback::Show(std::size_t place) {
  try {
    if (!session_.Seek(place)) return false;
    fault_.clear();
    return true;
  } catch (const InputError& error) {
    fault_ = error.what();
    player_.Pause();
    return false;
  }
}

void Playback::NoteFrame(double now_s) {
  shown_at_s_.push_back(now_s);
  while (shown_at_s_.back() - shown_at_s_.front() > 1.0) shown_at_s_.pop_front();
}

bool Playback::AdvanceLive(double now_s) {
  // An image may come after its frame. Later ones are none of a paused view's.
  const bool may_get_picture = live_->MayGetPicture(session_.place());
  const bool has_image = live_->PollImages() && may_get_picture;
  if (!live_->Poll() || !player_.is_playing()) return has_image;
  NoteFrame(now_s);
  return Show(live_->num_known() - 1);
}

bool Playback::Advance(double now_s) {
  if (live_ != nullptr) return AdvanceLive(now_s);
  if (!player_.is_playing() || !player_.Advance(now_s, session_.Period_s())) return false;
  if (!Show(player_.place()) && fault_.empty()) {
    // At the end, playing stops and the last frame stays.
    player_.Pause();
    (void)Show(session_.LastPlace());
  }
  if (fault_.empty() && player_.place() != session_.place()) {
    player_.Seek(session_.place(), now_s);
  }
  NoteFrame(now_s);
  return true;
}

void Playback::SeekTo(std::size_t place, double now_s) {
  (void)Show(place);
  player_.Seek(session_.place(), now_s);
}

void Playback::Step(std::ptrdiff_t num_frames, double now_s) {
  player_.Pause();
  const auto first = static_cast<std::ptrdiff_t>(session_.FirstPlace());
  // Stepping on from a frame that cannot be read goes to the frame after it.
  const auto target = static_cast<std::size_t>(
      std::max(static_cast<std::ptrdiff_t>(player_.place()) + num_frames, first));
  if (!Show(target) && fault_.empty()) (void)Show(session_.LastPlace());
  player_.Seek(fault_.empty() ? session_.place() : target, now_s);
}

void Playback::TogglePlaying(double now_s) {
  if (player_.is_playing()) {
    player_.Pause();
    return;
  }
  // Playing from the last frame starts again at the first.
  const bool is_at_end = live_ == nullptr && !Show(session_.place() + 1) && fault_.empty();
  if (is_at_end) (void)Show(session_.FirstPlace());
  if (!fault_.empty()) return;
  player_.Seek(session_.place(), now_s);
  player_.Play(now_s);
}

std::string Playback::StatusText() const {
  if (live_ != nullptr) {
    std::string text = live_->StatusText();
    if (!player_.is_playing()) text += "   paused";
    return text;
  }
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%zu of %zu   %s x%g", session_.place() + 1,
                session_.LastPlace() + 1, player_.is_playing() ? "playing" : "paused",
                player_.speed_factor());
  std::string words = text.data();
  if (player_.is_playing() && shown_at_s_.size() > 1) {
    std::snprintf(
        text.data(), text.size(), "   %.1f frames/s",
        static_cast<double>(shown_at_s_.size() - 1) / (shown_at_s_.back() - shown_at_s_.front()));
    words += text.data();
  }
  return words;
}

}  // namespace railcast
