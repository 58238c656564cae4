#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// The size of a picture's place in a grid, without its title; rows may be lower.
inline constexpr int kPlaceWidth_px = 480;
inline constexpr int kPlaceHeight_px = 290;

/// What is drawn in one place of a grid.
struct GridPicture {
  std::string script{};             ///< gnuplot commands.
  int height_px = kPlaceHeight_px;  ///< What it needs of its place.
};

/// An image.
[[nodiscard]] GridPicture ImagePicture(const std::string& title, const std::filesystem::path& png);

/// Nothing but a title.
[[nodiscard]] GridPicture EmptyPicture(const std::string& title);

/// A picture of pictures in rows, each as high as its highest.
/// @pre There is a row, and each has a picture.
[[nodiscard]] Picture GridOf(const std::vector<std::vector<GridPicture>>& rows);

/// A direction in the sensor's axes: azimuth to the left of x, elevation above the x-y plane.
struct SeenDirection {
  double azimuth_deg{};
  double elevation_deg{};
};

/// A part of what the sensor sees.
struct SeenWindow {
  SeenDirection middle{};
  double half_width_deg{};
  double half_height_deg{};
};

/// A line drawn over a cloud.
using SeenLine = std::vector<SeenDirection>;

/// How a cloud is shown in one place of a grid of pictures.
struct CloudView {
  std::string title{};
  /// Nothing: all points up to 60 deg to either side of the x axis or, if there are none, all.
  std::optional<SeenWindow> window{};
  std::vector<SeenLine> lines{};
};

/// A frame of a recording, by its place there.
struct PlacedFrame {
  std::filesystem::path recording;
  std::size_t place{};  ///< From 0.
};

/// Reads a frame, and what is known of its recording.
/// @returns nothing if the recording ends before that frame.
/// @throws InputError if it cannot be read.
[[nodiscard]] std::optional<RecordedFrame> ReadFrameAt(const PlacedFrame& placed,
                                                       RecordingInfo& info);

/// A frame's points as seen from the sensor, in the colours of their labels or, where these are not
/// known, by range. Motion during the scan is undone as far as it is known.
[[nodiscard]] GridPicture CloudPicture(const RecordedFrame& recorded,
                                       const RecordingInfo& info,
                                       const CloudView& view);

/// The window about a box, with at least the given half height, in the shape of a picture's place.
[[nodiscard]] SeenWindow WindowAbout(const Transform& sensor_from_box,
                                     const Vector3& size_m,
                                     double min_half_height_deg);

/// The edges of a box as seen from the sensor.
[[nodiscard]] std::vector<SeenLine> LinesOf(const Transform& sensor_from_box,
                                            const Vector3& size_m);

/// The frame of a window.
[[nodiscard]] SeenLine LineOf(const SeenWindow& window);

}  // namespace railcast
