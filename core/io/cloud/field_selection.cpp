#include "railcast/io/cloud_files.h"

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/io/cloud/track_fields.h"
#include "core/scenario/json_rules.h"
#include "railcast/frame.h"

namespace railcast {
namespace {

std::vector<std::string> TrackNames() {
  std::vector<std::string> names;
  ForEachTrackField(
      {}, [&](std::string_view name, std::string_view, const auto&) { names.emplace_back(name); });
  return names;
}

std::vector<std::string> TableNames(bool has_velocity) {
  Frame frame;
  frame.has_velocity = has_velocity;
  std::vector<std::string> names;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto&) {
    names.emplace_back(name);
  });
  return names;
}

bool IsAmong(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

FieldSelection::FieldSelection() : names_(TableNames(false)) {}

FieldSelection::FieldSelection(std::string_view list, bool has_velocity, bool has_track) {
  std::vector<std::string> valid = TableNames(has_velocity);
  if (list == "all") {
    names_ = valid;
    return;
  }
  const std::vector<std::string> of_track = TrackNames();
  if (has_track) valid.insert(valid.end(), of_track.begin(), of_track.end());
  ErrorList errors;
  std::set<std::string, std::less<>> asked;
  while (true) {
    const std::size_t comma = list.find(',');
    const std::string name(list.substr(0, comma));
    if (!IsAmong(valid, name) && IsAmong(TableNames(true), name)) {
      errors.Add(
          {"--fields", "must be a field of a sensor without lidar.velocity", '"' + name + '"'});
    } else if (!has_track && IsAmong(of_track, name)) {
      errors.Add({"--fields",
                  "must be a field of the frame itself, since only the files and bags of "
                  "sequence and dataset have those of the track",
                  '"' + name + '"'});
    } else if (!IsAmong(valid, name)) {
      errors.Add({"--fields", Unknown("field", name, valid), '"' + name + '"'});
    } else if (!asked.insert(name).second) {
      errors.Add({"--fields", "field \"" + name + "\" comes twice", ""});
    }
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
  }
  errors.ThrowIfAny();
  std::copy_if(valid.begin(), valid.end(), std::back_inserter(names_),
               [&](const auto& name) { return asked.contains(name); });
}

bool FieldSelection::Has(std::string_view name) const {
  return IsAmong(names_, name);
}

bool FieldSelection::NeedsTrack() const {
  return std::ranges::any_of(TrackNames(), [&](const auto& name) { return Has(name); });
}

std::string FieldSelection::Text() const {
  return Join(names_, ",");
}

}  // namespace railcast
