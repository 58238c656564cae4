#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

/// When which frame is shown: play, pause, step, speed. Times are those of any steady clock.
class Player {
 public:
  static constexpr double kLowestSpeedFactor = 1.0 / 16.0;
  static constexpr double kHighestSpeedFactor = 16.0;

  [[nodiscard]] std::size_t place() const { return place_; }
  [[nodiscard]] bool is_playing() const { return is_playing_; }
  /// Frames follow each other so many times faster than they were recorded.
  [[nodiscard]] double speed_factor() const { return speed_factor_; }

  void Play(double now_s);
  void Pause() { is_playing_ = false; }
  /// Doubles or halves it, between the lowest and the highest.
  void Faster(double now_s);
  void Slower(double now_s);
  /// Shows that frame; goes on playing from there.
  void Seek(std::size_t place, double now_s);

  /// The frame to be shown now while playing: frames whose time has passed are left out.
  /// @param period_s Of the recording's frames, > 0.
  /// @returns Whether it is another one than before.
  bool Advance(double now_s, double period_s);

 private:
  void SetSpeed(double speed_factor, double now_s);

  std::size_t place_{};
  bool is_playing_ = false;
  double speed_factor_ = 1.0;
  double shown_at_s_{};  ///< When the frame at hand was due.
};

}  // namespace railcast
