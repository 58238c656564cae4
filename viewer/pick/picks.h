#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/transform.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/shown_frame.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Returns a number with `num_decimals` decimals, "-2.900", or "-" for NaN. A value that rounds to
/// zero has no sign.
[[nodiscard]] inline std::string FixedText(double value, int num_decimals) {
  if (std::isnan(value)) return "-";
  std::array<char, 352> text{};  // The largest double has 309 digits.
  std::snprintf(text.data(), text.size(), "%.*f", num_decimals, value);
  std::string fixed = text.data();
  const bool is_zero = fixed.find_first_not_of("-0.") == std::string::npos;
  return is_zero && fixed.front() == '-' ? fixed.substr(1) : fixed;
}

/// Lists all that is known of one point, line by line: names and values in two columns, at most 60
/// ASCII characters wide unless the recording's own names are longer. Measurements come first, then
/// the other fields of a foreign cloud, then, after a line "truth", the ground truth. A field that
/// the recording lacks has no line; an absent value is "-".
///
///     file             frame_000003.pcd
///     position               12.345      -2.900       0.012 m
///     label            wagon (12)
///     noise            +1.6 mm
///
/// `position` is in the sensor's axes at the firing. `at the stamp` follows where motion within the
/// scan makes it differ, `in the world` where the pose is known.
/// @param info The recording that the frame is from, with the names of labels and materials.
/// @pre point < shown.num_points()
[[nodiscard]] std::vector<std::string> PointFacts(const ShownFrame& shown,
                                                  const RecordingInfo& info,
                                                  std::size_t point);

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

/// Finds the point that a click on a picture means: of the points within 5 px the one nearest to
/// the eye, else the one nearest on the screen within 12 px. Points outside the clip volume,
/// including those behind the eye, are not visible and cannot be picked.
///
/// @param positions_m x, y, z of each point in turn. Points of NaN cannot be picked.
/// @param clip_from_points From homogeneous coordinates of the points to clip coordinates, where
///   the volume is -w <= x, y, z <= w with z = -w nearest to the eye.
/// @param size_px Width and height.
/// @param x_px, y_px The click, to the right and up from the lower left corner, as VTK counts.
[[nodiscard]] std::optional<std::size_t> PointAt(std::span<const float> positions_m,
                                                 const Eigen::Matrix4d& clip_from_points,
                                                 const std::array<int, 2>& size_px,
                                                 double x_px,
                                                 double y_px);

}  // namespace railcast
