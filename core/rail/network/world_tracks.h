#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "railcast/rail_world.h"

namespace railcast {

/// A world's tracks with their courses, in the same order. Both must outlive it.
struct WorldTracks {
  const WorldSpec& world;
  std::span<const TrackCourse> courses;

  /// The course of the track of that name; null if there is none.
  [[nodiscard]] const TrackCourse* CourseOf(const std::string& name) const {
    const std::optional<std::size_t> index = TrackIndex(world, name);
    return index ? &courses[*index] : nullptr;
  }
};

[[nodiscard]] inline WorldTracks TracksOf(const ChunkContext& context) {
  return {context.spec, context.tracks};
}

}  // namespace railcast
