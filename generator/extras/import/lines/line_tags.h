#pragma once

#include <optional>
#include <string_view>

#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// The gauge that a value of OpenStreetMap's key `gauge` gives, such as "760" or "1435;1000": of
/// several, 1435 mm or else the first one. Absent if it is none that a world can have.
[[nodiscard]] std::optional<double> GaugeOf_mm(std::string_view gauge);

/// The gauge of the greatest part of a line; 1435 mm where the map has none.
[[nodiscard]] double GaugeAlong_mm(const RailMap& map, const TrackLine& line);

/// The value of OpenStreetMap's key `maxspeed` in km/h: "120", "50 mph", "30 knots"; of several
/// ("120;100") the least. Absent for anything else ("none", "signals", "DE:rural") and for what is
/// not above 0 and at most 1000 km/h.
[[nodiscard]] std::optional<double> SpeedOf_kmph(std::string_view maxspeed);

/// The speed of a way, which a line has for both directions: the lesser of those of its directions.
/// One is `maxspeed:forward`, the other `maxspeed:backward`, and `maxspeed` where one of them is
/// absent. Of `maxspeed:conditional`, a value that always holds ("80 @ 24/7") takes the place of
/// `maxspeed`, and no other counts.
[[nodiscard]] std::optional<double> SpeedOf_kmph(const MapTags& tags);

/// Adds to a map's remarks the ways whose speeds are not understood, are several or differ by
/// direction, or which have others, by condition or kind of train (`maxspeed:freight`, ...), those
/// that stand for several tracks (`tracks=2`), and the values of tags of ways and things that are
/// not understood. Of lists of values, as "main;branch", the first that is understood stays, and
/// all of `electrified`, `gauge` and speeds.
void TellTags(RailMap& map);

/// Whether `electrified` says that there is no contact line: "no", "rail".
[[nodiscard]] bool HasNoContactLine(std::string_view electrified);

/// A number of metres in a tag, "0.55", "0.55 m"; absent for anything else.
[[nodiscard]] std::optional<double> MetresIn(std::string_view text);

/// Gives every track without a tag `electrified` what is usual for its kind (`railway`): trams have
/// a contact line; other kinds have one if the tag is on at least half of their length on this map,
/// and at least half of that has one. Such tracks get the tag `import:usual`, too.
/// @pre The map is projected.
void FillElectrified(RailMap& map);

/// Whether most of a line has a contact line, as far as the map says; if it says nothing, whether
/// most of it was given one by FillElectrified.
[[nodiscard]] bool HasContactLine(const RailMap& map, const TrackLine& track);

}  // namespace railcast
