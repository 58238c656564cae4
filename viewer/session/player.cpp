#include "viewer/session/player.h"

#include <algorithm>
#include <cmath>

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

}  // namespace railcast
