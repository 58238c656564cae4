#pragma once

#include <string>
#include <utility>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/objects.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The alignment that consists of these elements.
[[nodiscard]] inline AlignmentSpec AlignmentOf(std::vector<AlignmentElement> elements) {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{std::move(elements)};
  return spec;
}

/// The world of default values along a line of these elements.
[[nodiscard]] inline WorldSpec WorldAlong(std::vector<AlignmentElement> elements) {
  WorldSpec spec;
  spec.alignment = AlignmentOf(std::move(elements));
  return spec;
}

/// An object that stands at a place of the track "main".
[[nodiscard]] inline ObjectSpec ObjectAt(std::string name,
                                         ObjectType type,
                                         double s_m,
                                         double d_m = 0.0) {
  ObjectSpec object;
  object.name = std::move(name);
  object.type = std::move(type);
  object.s_m = s_m;
  object.d_m = d_m;
  return object;
}

/// A structure along a stretch of the track "main".
template <typename Structure>
[[nodiscard]] Structure StructureAlong(std::string name, double begin_s_m, double end_s_m) {
  Structure structure;
  structure.name = std::move(name);
  structure.begin_s_m = begin_s_m;
  structure.end_s_m = end_s_m;
  return structure;
}

/// The same for structures on one side of the track.
template <typename Structure>
[[nodiscard]] Structure StructureBeside(TrackSide side,
                                        std::string name,
                                        double begin_s_m,
                                        double end_s_m) {
  auto structure = StructureAlong<Structure>(std::move(name), begin_s_m, end_s_m);
  structure.side = side;
  return structure;
}

/// A level crossing of the name "crossing".
[[nodiscard]] inline LevelCrossingSpec CrossingAt(double s_m) {
  LevelCrossingSpec crossing;
  crossing.name = "crossing";
  crossing.s_m = s_m;
  return crossing;
}

}  // namespace railcast
