#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "viewer/frames/live_frames.h"
#include "viewer/session/session.h"

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

/// Decides which frame of a session is shown when: play, pause, step, scrub. Of a live source it is
/// the latest, unless paused. A frame that cannot be read is not shown, and fault() says why until
/// another one is shown. Times may come from any steady clock.
class Playback {
 public:
  /// @param live The session's source if that is a live one, else null. Both must outlive this
  ///   object.
  Playback(Session& session, LiveFrames* live) : session_(session), live_(live) {}

  /// Begins at the frame that the session shows; a live source plays at once.
  void Begin(double now_s);
  /// Shows the frame that is due.
  /// @returns Whether the frame changed or could not be shown.
  bool Advance(double now_s);

  void SeekTo(std::size_t place, double now_s);
  /// Steps on by `num_frames`, or back if it is negative, and pauses.
  void Step(std::ptrdiff_t num_frames, double now_s);
  void TogglePlaying(double now_s);
  void Faster(double now_s) { player_.Faster(now_s); }
  void Slower(double now_s) { player_.Slower(now_s); }

  [[nodiscard]] bool is_playing() const { return player_.is_playing(); }
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Returns a line for the status: "11 of 50   playing x2   19.8 frames/s", or the state of a live
  /// source.
  [[nodiscard]] std::string StatusText() const;

 private:
  bool AdvanceLive(double now_s);
  /// @returns Whether the session now shows that frame.
  bool Show(std::size_t place);
  void NoteFrame(double now_s);

  Session& session_;
  LiveFrames* live_;
  Player player_;
  std::string fault_;
  std::deque<double> shown_at_s_;  ///< When frames were shown within the last second.
};

}  // namespace railcast
