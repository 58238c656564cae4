#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

/// Computes which frame is due when: play, pause, step, speed. Times may come from any steady
/// clock.
class Player {
 public:
  static constexpr double kLowestSpeedFactor = 1.0 / 16.0;
  static constexpr double kHighestSpeedFactor = 16.0;

  [[nodiscard]] std::size_t place() const { return place_; }
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  /// Factor by which frames follow each other faster than they were recorded.
  [[nodiscard]] double speed_factor() const { return speed_factor_; }

  void Play(double now_s);
  void Pause() { is_playing_ = false; }
  /// Doubles or halves the speed, between the lowest and the highest.
  void Faster(double now_s);
  void Slower(double now_s);
  /// Jumps to a frame; if playing, goes on from there.
  void Seek(std::size_t place, double now_s);

  /// While playing, moves on to the frame that is due; frames whose time has passed are skipped.
  /// @param period_s Period of the recording's frames, > 0.
  /// @returns Whether the frame changed.
  bool Advance(double now_s, double period_s);

 private:
  void SetSpeed(double speed_factor, double now_s);

  std::size_t place_{};
  bool is_playing_ = false;
  double speed_factor_ = 1.0;
  double shown_at_s_{};  ///< When the current frame was due.
};

}  // namespace railcast
