#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/recording/recording.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/drawing.h"
#include "viewer/pick/measure.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// The points that were picked: what is known of the last, and how far it is from the one before.
class Picks {
 public:
  /// @param measures Keeps the pick before, to measure from it.
  void Add(const ShownFrame& shown, std::size_t point, const RecordingInfo& info, bool measures);
  void Clear();
  [[nodiscard]] bool is_empty() const { return picks_.empty(); }

  /// All that is known of the last pick, and the distance; empty without one.
  [[nodiscard]] const std::string& facts() const { return facts_; }
  [[nodiscard]] std::optional<std::uint32_t> label() const;
  /// Of the last pick. @pre !is_empty()
  [[nodiscard]] const std::shared_ptr<const RecordedFrame>& recorded() const {
    return picks_.back().recorded;
  }
  [[nodiscard]] std::uint32_t slot() const { return slot_; }

  /// Where the last pick is in the axes of a scene; nothing where MarksIn() leaves it out.
  [[nodiscard]] std::optional<Eigen::Vector3f> PlaceIn(const Scene& scene) const;

  /// Crosses at the picks and the line between two, in the axes of a scene. What was picked in
  /// another frame is where it was in the world; left out where that is not known.
  [[nodiscard]] Drawing MarksIn(const Scene& scene) const;

 private:
  std::vector<Pick> picks_;  ///< One or two.
  std::uint32_t slot_{};
  std::string facts_;
};

}  // namespace railcast
