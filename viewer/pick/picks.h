#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/transform.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// A picked point. It does not change when other frames are shown.
struct Pick {
  std::shared_ptr<const RecordedFrame> recorded;
  Vector3 at_stamp_m;  ///< In the sensor's axes at the frame's stamp.
};

/// @pre point < shown.num_points()
[[nodiscard]] Pick PickOf(const ShownFrame& shown, std::size_t point);

/// Returns whether both are the same frame of the same recording, which may have been read twice.
[[nodiscard]] bool AreOfOneFrame(const RecordedFrame& a, const RecordedFrame& b);

/// Returns the distance from one pick to another.
///
/// Within one frame it is given along the sensor's axes at the stamp: "12.345 m (dx 12.000, dy
/// 2.900, dz 0.012; level 12.345 m)". Between two frames, of one recording or of two, it is given
/// along the axes of the world: "12.345 m (east 12.000, north 2.900, up 0.012; level 12.345 m)";
/// empty unless both have poses. Level is the distance without dz or up.
[[nodiscard]] std::optional<std::string> DistanceText(const Pick& from, const Pick& to);

/// The picked points: what is known of the last, and its distance from the one before.
class Picks {
 public:
  /// @param measures Keeps the previous pick, to measure from it.
  void Add(const ShownFrame& shown, std::size_t point, const RecordingInfo& info, bool measures);
  void Clear();
  [[nodiscard]] bool is_empty() const { return picks_.empty(); }

  /// All that is known of the last pick, and the distance; empty if nothing is picked.
  [[nodiscard]] const std::string& facts() const { return facts_; }
  [[nodiscard]] std::optional<std::uint32_t> label() const;
  /// Frame of the last pick.
  /// @pre !is_empty()
  [[nodiscard]] const std::shared_ptr<const RecordedFrame>& recorded() const {
    return picks_.back().recorded;
  }
  [[nodiscard]] std::uint32_t slot() const { return slot_; }

  /// Returns the position of the last pick in the axes of a composition; empty where MarksIn()
  /// leaves it out.
  [[nodiscard]] std::optional<Eigen::Vector3f> PlaceIn(const Composition& composition) const;

  /// Draws crosses at the picks and the line between two, in the axes of a composition. A pick in
  /// another frame is drawn where it was in the world, or left out where that is not known.
  [[nodiscard]] Overlay MarksIn(const Composition& composition) const;

 private:
  std::vector<Pick> picks_;  ///< One or two.
  std::uint32_t slot_{};
  std::string facts_;
};

}  // namespace railcast
