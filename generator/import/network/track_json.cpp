#include "generator/import/network/track_json.h"

#include <optional>
#include <string>

#include "generator/import/fit/plan_model.h"

namespace railcast {
namespace {

using WorldJson = nlohmann::ordered_json;

WorldJson TurnoutJson(const TurnoutSpec& turnout) {
  WorldJson json = {{"track", turnout.track}};
  if (turnout.s_m) json["s_m"] = *turnout.s_m;
  json["turnout"] = std::string(NameOf(turnout.turnout));
  if (turnout.side) json["side"] = *turnout.side == TrackSide::kLeft ? "left" : "right";
  return json;
}

}  // namespace

nlohmann::ordered_json JsonOf(const TrackSpec& track) {
  WorldJson json = {{"name", track.name}};
  if (track.begin) {
    json["begin"] = TurnoutJson(*track.begin);
  } else if (track.start_s_m != 0.0) {
    json["start_s_m"] = track.start_s_m;
  }
  if (track.end) json["end"] = TurnoutJson(*track.end);
  if (track.end_s_m) json["end_s_m"] = *track.end_s_m;
  if (track.offset_m) json["offset_m"] = *track.offset_m;
  if (track.heading_deg != 0.0) json["heading_deg"] = track.heading_deg;
  for (const ChainageValue& offset : track.offsets_m) {
    json["offsets_m"].push_back({{"s_m", offset.s_m}, {"value", offset.value}});
  }
  for (const AlignmentElement& element : track.elements) {
    WorldJson item = {{"type", NameOf(element.type)}, {"length_m", element.length_m}};
    if (element.radius_m) item["radius_m"] = *element.radius_m;
    json["elements"].push_back(std::move(item));
  }
  if (!track.electrified) json["electrified"] = false;
  return json;
}

}  // namespace railcast
