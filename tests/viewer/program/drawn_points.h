#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/viewer/program/eye.h"
#include "tests/viewer/program/picture.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns whether a pixel is clear of text and swatches, which are drawn over the points: the
/// legend at the upper left, the status at the lower left, the scale at the right edge. Tests check
/// points only outside of these.
inline bool IsClearOfWords(const Pixel& place, const Picture& picture) {
  const bool is_in_legend = place.x < 0.35 * picture.height && place.y < 0.5 * picture.height;
  const bool is_in_status = place.y > 0.92 * picture.height;
  const bool is_in_scale = place.x > 0.85 * picture.width;
  return picture.Holds(place) && !is_in_legend && !is_in_status && !is_in_scale;
}

/// Returns the pixels of a colour that are clear of words.
inline std::vector<Pixel> PointsOf(const Rgb& rgb, const Picture& picture) {
  std::vector<Pixel> places = picture.PlacesOf(rgb);
  std::erase_if(places, [&](const Pixel& place) { return !IsClearOfWords(place, picture); });
  return places;
}

inline Pixel PixelAt(const Eigen::Vector2d& place_px) {
  return {static_cast<int>(std::floor(place_px.x())), static_cast<int>(std::floor(place_px.y()))};
}

/// A point of a frame and where it appears in the picture.
struct SeenPoint {
  std::size_t point{};
  std::uint32_t slot{};
  Eigen::Vector2d place_px;
  [[nodiscard]] Pixel pixel() const { return PixelAt(place_px); }
};

inline Vector3 PositionOf(const ShownFrame& shown, std::size_t point) {
  return Eigen::Map<const Eigen::Vector3f>(&shown.positions_m[3 * point]).cast<double>();
}

/// Returns the wanted points of a frame that are in the picture and clear of words.
template <typename Wanted>
std::vector<SeenPoint> SeenPoints(const ShownFrame& shown,
                                  const Eye& eye,
                                  const Picture& picture,
                                  Wanted&& is_wanted) {
  std::vector<SeenPoint> seen;
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    if (!is_wanted(shown.slots[i])) continue;
    const auto place_px = eye.See(PositionOf(shown, i));
    if (!place_px) continue;
    const SeenPoint point{i, shown.slots[i], *place_px};
    if (IsClearOfWords(point.pixel(), picture)) seen.push_back(point);
  }
  return seen;
}

inline std::vector<SeenPoint> SeenPoints(const ShownFrame& shown,
                                         const Eye& eye,
                                         const Picture& picture) {
  return SeenPoints(shown, eye, picture, [](std::uint32_t) { return true; });
}

/// Returns the points that are at least `apart_px` from every other, so that nothing else is drawn
/// at their pixels.
inline std::vector<SeenPoint> LonePoints(const std::vector<SeenPoint>& seen, double apart_px) {
  std::vector<SeenPoint> lone;
  for (const SeenPoint& point : seen) {
    const bool is_lone = std::ranges::none_of(seen, [&](const SeenPoint& other) {
      return &other != &point && std::abs(other.place_px.x() - point.place_px.x()) < apart_px &&
             std::abs(other.place_px.y() - point.place_px.y()) < apart_px;
    });
    if (is_lone) lone.push_back(point);
  }
  return lone;
}

/// Returns the share of a line's pixels, sampled once per pixel of its length, that have this
/// colour or a neighbour with it: a line of 1.5 px may be drawn up to 1 px off its middle. NaN if
/// less than 5 px of it are visible.
inline double ShareDrawn(const Picture& picture,
                         const Eye& eye,
                         const Vector3& from_m,
                         const Vector3& to_m,
                         const Rgb& rgb) {
  const auto from = eye.See(from_m);
  const auto to = eye.See(to_m);
  if (!from || !to) return std::nan("");
  const int num_steps = static_cast<int>(std::ceil((*to - *from).norm()));
  int num_seen = 0;
  int num_drawn = 0;
  for (int step = 0; step <= num_steps; ++step) {
    const Eigen::Vector2d place = *from + (*to - *from) * step / std::max(1, num_steps);
    const Pixel middle = PixelAt(place);
    if (!IsClearOfWords(middle, picture)) continue;
    ++num_seen;
    bool is_drawn = false;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Pixel near{middle.x + dx, middle.y + dy};
        is_drawn |= picture.Holds(near) && picture.At(near.x, near.y) == rgb;
      }
    }
    num_drawn += is_drawn ? 1 : 0;
  }
  return num_seen < 5 ? std::nan("") : static_cast<double>(num_drawn) / num_seen;
}

}  // namespace railcast
