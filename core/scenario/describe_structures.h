#pragma once

#include "core/scenario/describe_alignment.h"
#include "core/scenario/json_rules.h"
#include "railcast/structures.h"

namespace railcast {

template <>
inline constexpr const char* kTypeName<PlatformSpec> = "platform";

/// The keys of StretchSpec.
template <class Archive, class Structure>
void DescribeStretch(Archive& a, Structure& s) {
  a.Required("name", s.name, "Unique among the structures.", NonEmptyString());
  a.Optional("track", s.track, "The track along which it runs.");
  a.Required("begin_s_m", s.begin_s_m, "Chainage where it begins.", ChainageLimits());
  a.Required("end_s_m", s.end_s_m, "Chainage where it ends.", ChainageLimits());
  a.Ensure({"end_s_m", "begin_s_m"}, s.end_s_m > s.begin_s_m, "must be > begin_s_m");
}

/// The keys of SideStretchSpec.
template <class Archive, class Structure>
void DescribeSideStretch(Archive& a, Structure& s) {
  DescribeStretch(a, s);
  a.Required("side", s.side, "Side of the track, towards increasing chainage.");
}

template <class Archive>
void Describe(Archive& a, PlatformRoofSpec& s) {
  a.Optional("begin_s_m", s.begin_s_m, "Chainage where it begins; absent = with the platform.",
             ChainageLimits());
  a.Optional("end_s_m", s.end_s_m, "Chainage where it ends; absent = with the platform.",
             ChainageLimits());
  a.Optional("height_m", s.height_m, "Of its lower side above the platform.", Within(2.2, 10));
  a.Optional("column_spacing_m", s.column_spacing_m, "At most.", Within(2, 50));
  a.Ensure({"end_s_m", "begin_s_m"}, !s.begin_s_m || !s.end_s_m || *s.end_s_m > *s.begin_s_m,
           "must be > begin_s_m");
}

template <class Archive>
void Describe(Archive& a, PlatformSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("height_m", s.height_m, "Of its edge above top of rail.", Within(0.2, 1.3));
  a.Optional("edge_distance_m", s.edge_distance_m, "Of its edge from the track's axis.",
             Within(0.8, 10));
  a.Optional("width_m", s.width_m, "Across.", Within(0.5, 50));
  a.Optional("has_edge_strip", s.has_edge_strip,
             "Whether a white tactile strip runs along the edge.");
  a.Optional("roof", s.roof, "A roof on a row of columns; absent = none.");
}

}  // namespace railcast
