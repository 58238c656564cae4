#include "generator/extras/import/map/rail_map.h"

#include <array>

#include "core/base/text.h"
#include "core/base/text_encoding.h"

namespace railcast {

std::string UnreadTrackTag(const MapTags& tags) {
  constexpr std::string_view kOthers =
      " platform platform_edge station halt tram_stop stop signal_box crossing level_crossing "
      "crossing_box yard depot workshop wash roundhouse engine_shed site facility museum fuel "
      "loading_ramp service_station abandoned razed dismantled historic proposed planned ";
  for (const auto& [key, value] : tags) {
    if (value.empty() || LowerCase(key) != "railway") continue;
    if (kOthers.find(" " + LowerCase(value) + " ") == std::string_view::npos) {
      return ShownText(key) + "=" + ShownText(value);
    }
  }
  return {};
}

bool IsPlatform(const MapTags& tags) {
  if (HasOneOf(TagOf(tags, "railway"), {"platform"})) return true;
  if (TagOf(tags, "public_transport") != "platform" || !TagOf(tags, "highway").empty())
    return false;
  constexpr auto kOthers =
      std::to_array<std::string_view>({"bus", "trolleybus", "ferry", "aerialway", "share_taxi"});
  return std::ranges::none_of(kOthers,
                              [&](std::string_view key) { return TagOf(tags, key) == "yes"; });
}

bool IsThing(const MapTags& tags) {
  return IsPlatform(tags) ||
         HasOneOf(TagOf(tags, "railway"),
                  {"level_crossing", "crossing", "buffer_stop", "signal", "milestone", "derail"});
}

bool IsThere(std::string_view value) {
  constexpr auto kNo = std::to_array<std::string_view>({"", "no", "false", "F", "0"});
  return std::ranges::find(kNo, value) == kNo.end();
}

bool IsTunnel(const MapTags& tags) {
  return IsThere(TagOf(tags, "tunnel")) && TagOf(tags, "tunnel") != "building_passage";
}

bool IsBridge(const MapTags& tags) {
  return IsThere(TagOf(tags, "bridge")) && !IsTunnel(tags);
}

}  // namespace railcast
