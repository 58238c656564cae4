#include "core/scenario/descriptions.h"

#include "core/scenario/shared_keys.h"
#include "railcast/structures.h"

namespace railcast {

namespace {

/// Distance of a structure from its track's axis.
[[nodiscard]] Limits BesideTrackLimits() {
  return Within(1, 500);
}

/// The keys of StretchSpec.
template <class Structure>
void DescribeStretch(Archive& a, Structure& s) {
  DescribeNameAndTrack(a, s, "The track along which it runs.");
  a.Required("begin_s_m", s.begin_s_m, "Chainage where it begins.", ChainageLimits());
  a.Required("end_s_m", s.end_s_m, "Chainage where it ends.", ChainageLimits());
  a.Ensure({"end_s_m", "begin_s_m"}, s.end_s_m > s.begin_s_m, "must be > begin_s_m");
}

/// The keys of SideStretchSpec.
template <class Structure>
void DescribeSideStretch(Archive& a, Structure& s) {
  DescribeStretch(a, s);
  a.Required("side", s.side, "Side of the track, towards increasing chainage.");
}

}  // namespace

void Describe(Archive& a, PlatformRoofSpec& s) {
  a.Optional("begin_s_m", s.begin_s_m,
             "Chainage where it begins; absent = with the platform, or behind its ramp.",
             ChainageLimits());
  a.Optional("end_s_m", s.end_s_m,
             "Chainage where it ends; absent = with the platform, or before its ramp.",
             ChainageLimits());
  a.Optional("height_m", s.height_m, "Height of its lower side above the platform.",
             Within(2.2, 10));
  a.Optional("column_spacing_m", s.column_spacing_m, "Greatest distance between columns.",
             Within(2, 50));
  a.Ensure({"end_s_m", "begin_s_m"}, !s.begin_s_m || !s.end_s_m || *s.end_s_m > *s.begin_s_m,
           "must be > begin_s_m");
}

void Describe(Archive& a, PlatformSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("height_m", s.height_m, "Height of its edge above top of rail.", Within(0.2, 1.3));
  a.Optional("edge_distance_m", s.edge_distance_m,
             "Distance of its edge from the axis of straight track; curves add to it.",
             Within(0.8, 10));
  a.Optional("width_m", s.width_m, "Its width.", Within(0.5, 50));
  a.Optional("has_edge_strip", s.has_edge_strip,
             "Whether a white tactile strip runs along the edge.");
  a.Optional("has_ramps", s.has_ramps,
             "Whether its ends are ramps of 1:12 down to 0.08 m below top of rail.");
  a.Optional("roof", s.roof, "A roof on a row of columns; absent = none.");
}

void Describe(Archive& a, NoiseWallSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("distance_m", s.distance_m, "Distance of its face from the track's axis.",
             BesideTrackLimits());
  a.Optional("height_m", s.height_m, "Above top of rail.", Within(0.3, 15));
  a.Optional("post_spacing_m", s.post_spacing_m, "Greatest distance between posts.", Within(1, 20));
}

void Describe(Archive& a, FenceSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("distance_m", s.distance_m, "From the track's axis.", BesideTrackLimits());
  a.Optional("height_m", s.height_m, "Above the ground.", Within(0.3, 6));
  a.Optional("fence", s.fence, "What is between its posts.");
  a.Optional("post_spacing_m", s.post_spacing_m, "Greatest distance between posts.",
             Within(0.5, 20));
}

void Describe(Archive& a, RetainingWallSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("distance_m", s.distance_m,
             "Distance of its face from the track's axis, at top of rail.", BesideTrackLimits());
  a.Optional("height_m", s.height_m, "Above top of rail.", Within(-0.6, 30));
  a.Optional("depth_m", s.depth_m, "Depth of its foot below top of rail.", Within(0.8, 30));
}

void Describe(Archive& a, CableTroughSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("distance_m", s.distance_m, "Distance of its nearer side from the track's axis.",
             BesideTrackLimits());
  a.Optional("width_m", s.width_m, "Its width.", Within(0.1, 2));
}

void Describe(Archive& a, TunnelSpec& s) {
  DescribeStretch(a, s);
  a.Optional("radius_m", s.radius_m, "Radius of its vault, inside; absent = as the tracks need.",
             Within(3, 15));
  a.Optional("has_portals", s.has_portals, "Whether a wall stands about either mouth.");
  a.Optional("niche_spacing_m", s.niche_spacing_m, "On both sides, at least 5; 0 = none.",
             Within(0, 1000));
  a.Optional("has_handrail", s.has_handrail, "Along both walls.");
  a.Ensure({"niche_spacing_m"}, s.niche_spacing_m == 0.0 || s.niche_spacing_m >= 5.0,
           "must be 0 or >= 5");
}

void Describe(Archive& a, BridgeSpec& s) {
  DescribeStretch(a, s);
  a.Optional("depth_m", s.depth_m,
             "Depth of the gap below top of rail, at least 1.5 more than deck_thickness_m.",
             Within(2.5, 100));
  a.Optional("edge_distance_m", s.edge_distance_m,
             "Distance of its edges from the axes of the outermost tracks on it.", Within(2.2, 20));
  a.Optional("deck_thickness_m", s.deck_thickness_m, "Below the ballast.", Within(0.2, 10));
  a.Optional("railing_height_m", s.railing_height_m, "Above the edge beam; 0 = none.",
             Within(0, 5));
  a.Ensure({"depth_m", "deck_thickness_m"}, s.depth_m >= s.deck_thickness_m + 1.5,
           "must be at least 1.5 m more than deck_thickness_m");
}

void Describe(Archive& a, OverbridgeSpec& s) {
  DescribeStretch(a, s);
  a.Optional("clearance_m", s.clearance_m, "Height of its lower side above top of rail.",
             Within(3, 50));
  a.Optional("deck_thickness_m", s.deck_thickness_m, "Thickness of the deck.", Within(0.2, 10));
  a.Optional("left_m", s.left_m, "Extent to the left of the track's axis.", Within(2, 500));
  a.Optional("right_m", s.right_m, "Extent to the right of the track's axis.", Within(2, 500));
  a.Optional("pier_distance_m", s.pier_distance_m,
             "Distance of its abutments' faces from the axes of the outermost tracks.",
             Within(1, 200));
  a.Optional("crossing_deg", s.crossing_deg, "From the track's direction to the road's.",
             Within(30, 150));
}

void Describe(Archive& a, ThirdRailSpec& s) {
  DescribeSideStretch(a, s);
  a.Optional("contact", s.contact, "Side of the rail on which the shoes of trains run.");
  a.Optional("distance_m", s.distance_m,
             "Distance of its middle from the track's axis; absent = as usual for the contact.",
             Within(0.85, 3));
  a.Optional("height_m", s.height_m,
             "Height of its contact surface above top of rail; absent = as usual for the contact.",
             Within(0, 0.6));
  a.Optional("has_shield", s.has_shield,
             "Whether there are boards beside the rail, or a cover over it.");
}

void Describe(Archive& a, SlabTrackSpec& s) {
  DescribeStretch(a, s);
  a.Optional("width_m", s.width_m, "Its width.", Within(2.4, 6));
}

}  // namespace railcast
