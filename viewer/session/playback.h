#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "viewer/frames/live_frames.h"
#include "viewer/session/player.h"
#include "viewer/session/session.h"

namespace railcast {

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
