#include "generator/import/structures/map_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <utility>
#include <variant>

#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"
#include "generator/import/network/line_world.h"
#include "generator/import/structures/line_structures.h"

namespace railcast {
namespace {

constexpr double kKmPerStep = 1e-3;

/// A structure about a track: what lies between two offsets from its axis.
struct Cover {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};
  double right_m{};
  double left_m{};
};

class Coverage {
 public:
  Coverage(const RailMap& map, const LineWorld& world) : map_(map), world_(world), core_(world) {
    for (const StructureSpec& structure : world.structures) {
      if (const auto* tunnel = std::get_if<TunnelSpec>(&structure)) {
        const TunnelShape shape = TunnelShapeOf(core_.tracks(), *tunnel);
        const double middle_m = shape.spread.middle_m();
        AddCover(*tunnel, middle_m - shape.radius_m, middle_m + shape.radius_m, tunnels_);
      } else if (const auto* bridge = std::get_if<BridgeSpec>(&structure)) {
        const TrackSpread spread = SpreadOf(core_.tracks(), *bridge, kSharedBridge_m);
        AddCover(*bridge, spread.right_m - bridge->edge_distance_m,
                 spread.left_m + bridge->edge_distance_m, bridges_);
      }
    }
  }

  /// @param tracks_km What the track itself counts as; null for the line's own.
  /// @param run Null for the line's own track.
  void Measure(std::span<const LineStretch> ways,
               const TrackRun* run,
               Covered* tracks_km,
               MapCoverage& coverage) const {
    for (const LineStretch& way : ways) {
      const MapTags& tags = map_.ways[way.way].tags;
      const bool is_tunnel = IsTunnel(tags);
      const bool is_bridge = IsBridge(tags);
      if (!is_tunnel && !is_bridge && tracks_km == nullptr) continue;
      // Steps of a metre and a shorter one.
      for (double from_m = way.begin_s_m; from_m < way.end_s_m; from_m += 1.0) {
        const double step_m = std::min(1.0, way.end_s_m - from_m);
        const double s_m = from_m + 0.5 * step_m;
        const auto track =
            run == nullptr ? std::optional<std::size_t>(0) : TrackAt(s_m, OffsetOf_m(*run, s_m));
        const auto count = [&](Covered& covered, bool is_made) {
          covered.on_map += kKmPerStep * step_m;
          if (is_made) covered.made += kKmPerStep * step_m;
        };
        if (tracks_km != nullptr) count(*tracks_km, track.has_value());
        if (is_tunnel) count(coverage.tunnels_km, track && IsIn(tunnels_, *track, s_m));
        if (is_bridge) count(coverage.bridges_km, track && IsIn(bridges_, *track, s_m));
      }
    }
  }

 private:
  void AddCover(const StretchSpec& stretch,
                double right_m,
                double left_m,
                std::vector<Cover>& covers) const {
    const auto track = TrackIndex(core_.tracks().world, stretch.track);
    covers.push_back({*track, stretch.begin_s_m, stretch.end_s_m, right_m, left_m});
  }

  /// The nearest track of the world, if it is where the map has one.
  [[nodiscard]] std::optional<std::size_t> TrackAt(double s_m, double d_m) const {
    std::optional<std::size_t> nearest;
    double least_m = 2.0;
    for (std::size_t i = 1; i < world_.tracks.size(); ++i) {
      const TrackDraft& track = world_.tracks[i].draft;
      if (!track.Has(s_m)) continue;
      const double off_m = std::abs(track.OffsetNear_m(s_m) - d_m);
      if (off_m > least_m) continue;
      least_m = off_m;
      nearest = i;
    }
    return nearest;
  }

  [[nodiscard]] bool IsIn(const std::vector<Cover>& covers, std::size_t track, double s_m) const {
    const double d_m = world_.tracks[track].draft.OffsetNear_m(s_m);
    return std::ranges::any_of(covers, [&](const Cover& cover) {
      if (s_m < cover.begin_s_m || s_m > cover.end_s_m) return false;
      const double from_axis_m = d_m - world_.tracks[cover.track].draft.OffsetNear_m(s_m);
      return from_axis_m > cover.right_m && from_axis_m < cover.left_m;
    });
  }

  const RailMap& map_;
  const LineWorld& world_;
  TracksOfLine core_;
  std::vector<Cover> tunnels_;
  std::vector<Cover> bridges_;
};

using CoverageColumn = std::pair<const char*, Covered MapCoverage::*>;
constexpr std::array<CoverageColumn, 5> kColumns = {
    {{"tunnels_km", &MapCoverage::tunnels_km},
     {"bridges_km", &MapCoverage::bridges_km},
     {"second_tracks_km", &MapCoverage::second_tracks_km},
     {"other_tracks_km", &MapCoverage::other_tracks_km},
     {"switches", &MapCoverage::switches}}};

}  // namespace

MapCoverage CoverageOf(const RailMap& map, const LineWorld& world, const SideTrackQuality& beside) {
  MapCoverage covered;
  const Coverage coverage(map, world);
  coverage.Measure(world.tracks.front().ways, nullptr, nullptr, covered);
  for (const TrackRun& run : world.runs) {
    coverage.Measure(run.ways, &run,
                     run.kind == "running" ? &covered.second_tracks_km : &covered.other_tracks_km,
                     covered);
  }
  covered.switches = {static_cast<double>(beside.num_on_map),
                      static_cast<double>(beside.made.size())};
  return covered;
}

std::string CoverageCsv(const std::vector<ImportedLine>& lines,
                        const std::vector<MapCoverage>& coverages) {
  std::ostringstream csv;
  csv << "line,what,on_map,made\n" << std::fixed << std::setprecision(3);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const auto& [name, thing] : kColumns) {
      const Covered& covered = coverages[i].*thing;
      csv << lines[i].name << ',' << name << ',' << covered.on_map << ',' << covered.made << '\n';
    }
  }
  return csv.str();
}

std::string CoverageTable(const std::vector<ImportedLine>& lines,
                          const std::vector<MapCoverage>& coverages) {
  std::ostringstream table;
  table << "| made of what the map has | tunnels km | bridges km | second tracks km | other tracks "
           "km | switches |\n|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    table << "| " << lines[i].name;
    for (const auto& [name, thing] : kColumns) {
      const Covered& covered = coverages[i].*thing;
      const int digits = thing == &MapCoverage::switches ? 0 : 2;
      table << std::fixed << std::setprecision(digits) << " | " << covered.made << " of "
            << covered.on_map;
    }
    table << " |\n";
  }
  return table.str();
}

std::string SwitchReasonsText(const std::vector<LineWorld>& worlds) {
  std::map<std::string, int> numbers;
  for (const LineWorld& world : worlds) {
    for (const LeftOut& thing : world.left_out) {
      if (thing.what == "switch") ++numbers[thing.reason];
    }
  }
  if (numbers.empty()) return "";
  std::string text = "switches without a turnout (left_out.csv):\n";
  for (const auto& [reason, number] : numbers) {
    text += "  " + std::to_string(number) + ": " + reason + "\n";
  }
  return text + "\n";
}

std::string MovedText(const std::vector<LineWorld>& worlds) {
  double length_m = 0.0;
  double most_m = 0.0;
  std::size_t num_stretches = 0;
  for (const LineWorld& world : worlds) {
    num_stretches += world.moved.size();
    for (const MovedTrack& moved : world.moved) {
      length_m += moved.end_s_m - moved.begin_s_m;
      most_m = std::max(most_m, moved.most_m);
    }
  }
  if (num_stretches == 0) return "";
  std::ostringstream text;
  text << std::fixed << std::setprecision(2)
       << "moved away from other tracks (moved.csv): " << kKmPerStep * length_m << " km in "
       << num_stretches << " stretches, by " << most_m << " m at most\n\n";
  return text.str();
}

}  // namespace railcast
