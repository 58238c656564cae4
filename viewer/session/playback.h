#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "viewer/frames/live_frames.h"
#include "viewer/session/player.h"
#include "viewer/session/session.h"

namespace railcast {

/// Which frame of a session is shown when: play, pause, step, scrub. Of a live source the latest,
/// unless paused. A frame that cannot be read stays out; fault() says why until another one is
/// shown. Times are those of any steady clock.
class Playback {
 public:
  /// @param live The session's source if it is a live one, else null. Both outlive it.
  Playback(Session& session, LiveFrames* live) : session_(session), live_(live) {}

  /// From the frame that the session shows; a live source plays.
  void Begin(double now_s);
  /// Shows what is due. @returns Whether another frame is shown, or none can be.
  bool Advance(double now_s);

  void SeekTo(std::size_t place, double now_s);
  /// So many frames on, or back; pauses.
  void Step(std::ptrdiff_t num_frames, double now_s);
  void TogglePlaying(double now_s);
  void Faster(double now_s) { player_.Faster(now_s); }
  void Slower(double now_s) { player_.Slower(now_s); }

  [[nodiscard]] bool is_playing() const { return player_.is_playing(); }
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// For people: "11 of 50   playing x2   19.8 frames/s", or how a live source does.
  [[nodiscard]] std::string StatusText() const;

 private:
  bool AdvanceLive(double now_s);
  /// @returns Whether the session shows that frame now.
  bool Show(std::size_t place);
  void NoteFrame(double now_s);

  Session& session_;
  LiveFrames* live_;
  Player player_;
  std::string fault_;
  std::deque<double> shown_at_s_;  ///< When the last frames were shown, a second back.
};

}  // namespace railcast
