#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/extras/survey/survey_file.h"
#include "generator/extras/survey/driven_axis.h"
#include "generator/extras/survey/surfel_maker.h"

namespace railcast {

/// A wire as points along it, in the world.
struct FoundWire {
  std::vector<Vector3> points_m;
  std::uint16_t label{};
};

/// Finds wires above a driven way: chains of surfels along lines, each of which lies in the
/// direction of the next. Their points become a polyline through local parabolas (least squares), 2
/// m from point to point. Where none was seen over kLongestWireGap_m, the wire is interrupted.
/// @param surfels Those that have become wires are taken out, and all that are sparse.
[[nodiscard]] std::vector<FoundWire> TakeWires(const DrivenWay& way,
                                               std::vector<MadeSurfel>& surfels);

/// Puts the wires into the tiles that they pass, which are added where there is none.
void AddWires(const std::vector<FoundWire>& wires,
              std::map<std::array<std::int32_t, 2>, SurveyTile>& tiles);

}  // namespace railcast
