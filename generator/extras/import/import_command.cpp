#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "generator/commands.h"
#include "generator/extras/empty_folder.h"
#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/divided_line.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/line_heights.h"
#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/map_account.h"
#include "generator/extras/import/structures/standing_world.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

struct ImportCommandOptions {
  std::filesystem::path map;
  std::filesystem::path out;
  std::vector<double> within_deg;  ///< Longitude and latitude twice, or empty.
  std::string crs;
  std::filesystem::path heights;
  std::string heights_crs;
  bool is_level = false;
  bool is_main_only = false;
  double min_length_m = 1000.0;
  ImportOptions fit;
};

/// Leaves out the items of a list at whose numbers there is a reason to.
template <class Item>
void EraseWhere(const std::vector<std::optional<std::string>>& reasons, std::vector<Item>& items) {
  std::vector<Item> kept;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!reasons[i]) kept.push_back(std::move(items[i]));
  }
  items = std::move(kept);
}

/// Notes the lines that cannot stand.
void LeaveOutLines(const RailMap& map,
                   const std::vector<TrackLine>& tracks,
                   const std::vector<std::optional<std::string>>& reasons,
                   std::vector<LeftOutLine>& left_out) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (reasons[i]) left_out.push_back({tracks[i], LengthOf_m(map, tracks[i]), *reasons[i]});
  }
}

/// Works on all lines at once, and shows how far that is. Lines count by their lengths.
/// @param what Such as "fitting", for the progress.
/// @param work Does it for one line, and tells how much of it is done if it knows.
void WorkOnLines(const RailMap& map,
                 const std::vector<TrackLine>& tracks,
                 const std::string& what,
                 const std::function<void(std::size_t line, const TellShare& tell)>& work) {
  std::vector<double> lengths_m;
  for (const TrackLine& track : tracks) lengths_m.push_back(LengthOf_m(map, track));
  const double all_m = std::reduce(lengths_m.begin(), lengths_m.end());
  const std::string text =
      what + " of " + std::to_string(tracks.size()) + (tracks.size() == 1 ? " line" : " lines");
  const ProgressLine progress;
  std::mutex mutex;
  std::vector<double> done_m(tracks.size());
  progress.Show(text, 0.0);
  const auto show = [&](std::size_t line, double share) {
    const std::scoped_lock lock(mutex);
    done_m[line] = share * lengths_m[line];
    progress.Show(text, std::reduce(done_m.begin(), done_m.end()) / all_m);
  };
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tracks.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          work(i, [&](double share) { show(i, share); });
          show(i, 1.0);
        }
      },
      tbb::simple_partitioner());
  progress.End();
}

/// Fits all lines at once, and shows how far that is. Lines that no alignment can have are left out
/// of both lists; those with arcs that are too sharp are cut there, and what is left of them comes
/// last.
std::vector<ImportedLine> ImportLines(const RailMap& map,
                                      const ImportCommandOptions& options,
                                      std::vector<TrackLine>& tracks,
                                      std::vector<LeftOutLine>& left_out) {
  std::vector<ImportedLine> lines;
  std::vector<TrackLine> open = std::exchange(tracks, {});
  while (!open.empty()) {
    std::vector<ImportedLine> fitted(open.size());
    std::vector<std::optional<std::string>> reasons(open.size());
    WorkOnLines(map, open, "fit", [&](std::size_t i, const TellShare& tell) {
      try {
        fitted[i] = ImportLine(map, open[i], options.fit, tell);
      } catch (const InputError& error) {
        reasons[i] = error.what();
      }
    });
    LeaveOutLines(map, open, reasons, left_out);
    EraseWhere(reasons, open);
    EraseWhere(reasons, fitted);
    std::vector<TrackLine> parts;
    for (std::size_t i = 0; i < open.size(); ++i) {
      const auto cut = CutAtSharpArcs(map, open[i], fitted[i]);
      if (!cut) {
        tracks.push_back(std::move(open[i]));
        lines.push_back(std::move(fitted[i]));
        continue;
      }
      left_out.push_back({open[i], cut->cut_m, cut->reason});
      for (const TrackLine& part : cut->parts) {
        const double length_m = LengthOf_m(map, part);
        if (length_m >= options.min_length_m) {
          parts.push_back(part);
        } else {
          left_out.push_back({part, length_m, "it is shorter than --min-length"});
        }
      }
    }
    open = std::move(parts);
  }
  return lines;
}

/// Lines as far as they have come: lists of one order.
struct LinesInWork {
  std::vector<TrackLine> tracks{};
  std::vector<ImportedLine> lines{};
  std::vector<LineWorld> worlds{};
};

std::vector<LineWorld> BuildWorlds(const RailMap& map,
                                   const std::vector<TrackLine>& tracks,
                                   const std::vector<ImportedLine>& lines,
                                   const ImportCommandOptions& options) {
  std::vector<LineWorld> worlds(lines.size());
  WorkOnLines(map, tracks, "tracks and structures", [&](std::size_t i, const TellShare& /*tell*/) {
    worlds[i] = MakeLineWorld(map, tracks[i], lines[i]);
    if (!options.is_main_only) AddSideTracks(map, tracks[i], lines[i], options.fit, worlds[i]);
    AddStructures(map, tracks[i], lines[i], worlds[i]);
  });
  return worlds;
}

/// The map, or what of it lies within the rectangle that was asked for.
RailMap ReadMapWithin(const ImportCommandOptions& options) {
  RailMap map = ReadMap(options.map);
  if (options.within_deg.empty()) return map;
  const std::vector<double>& corners = options.within_deg;
  const std::string got = NumberText(corners[0]) + "," + NumberText(corners[1]) + "," +
                          NumberText(corners[2]) + "," + NumberText(corners[3]);
  if (!(corners[0] < corners[2] && corners[1] < corners[3])) {
    throw InputError(
        "--within: must be the corner with the least longitude and latitude, then that "
        "with the greatest (got " +
        got + ")");
  }
  RailMap cropped = CropMap(
      map, {Eigen::Vector2d(corners[0], corners[1]), Eigen::Vector2d(corners[2], corners[3])});
  if (cropped.ways.empty()) {
    const RailMap exchanged = CropMap(
        map, {Eigen::Vector2d(corners[1], corners[0]), Eigen::Vector2d(corners[3], corners[2])});
    throw InputError("--within: must have a track of " + ShownPath(options.map) + " in it" +
                     (exchanged.ways.empty() ? "" : ": longitude and latitude are exchanged") +
                     " (got " + got + ")");
  }
  return cropped;
}

/// Gives heights to all lines, and writes those that stand.
/// @returns Why others do not.
std::vector<std::optional<std::string>> FinishLines(const ImportCommandOptions& options,
                                                    const RailMap& map,
                                                    const MapProjection& projection,
                                                    const ElevationMap* elevation,
                                                    LinesInWork& work) {
  const ProgressLine progress;
  const std::size_t num = work.lines.size();
  std::vector<std::optional<std::string>> reasons(num);
  for (std::size_t i = 0; i < num; ++i) {
    progress.Show("clearing line " + std::to_string(i + 1) + " of " + std::to_string(num),
                  static_cast<double>(i) / static_cast<double>(num));
    const TrackLine& track = work.tracks[i];
    ImportedLine& line = work.lines[i];
    LineWorld& world = work.worlds[i];
    if (!options.is_level) reasons[i] = SetHeights(map, track, elevation, line);
    std::optional<std::filesystem::path> elevation_file;
    if (elevation != nullptr && !reasons[i]) {
      elevation_file = options.out / (line.name + ".elevation.asc");
      WriteFileWhole(*elevation_file, ElevationGridText(*elevation, ElevationBounds(map, track)));
    }
    if (!reasons[i]) {
      SetCants(map, track, world.level, line);
      ClearStructures(line.alignment, world);
      reasons[i] = MakeStand(line.alignment, elevation_file, world);
    }
    if (!reasons[i]) {
      WriteLine(options.out, line, projection, world, elevation != nullptr);
    } else if (elevation_file) {
      std::filesystem::remove(*elevation_file);
    }
  }
  progress.End();
  return reasons;
}

/// What the heights of the lines have that is not as it should be.
void TellHeights(const std::vector<ImportedLine>& lines, std::vector<Remark>& remarks) {
  for (const ImportedLine& line : lines) {
    if (!line.height_quality || line.height_quality->num_far == 0) continue;
    remarks.push_back(
        {RemarkKind::kHeightsFar,
         "line " + line.name + " at " + NumberText(std::round(line.height_quality->far_s_m)) + " m",
         line.height_quality->num_far});
  }
}

/// Points of the map that are far from the lines that were fitted to them.
void TellFarPlaces(const std::vector<ImportedLine>& lines, std::vector<Remark>& remarks) {
  constexpr double kFar_m = 5.0;
  for (const ImportedLine& line : lines) {
    const auto is_far = [](const Contradiction& it) { return std::abs(it.offset_m) > kFar_m; };
    const auto first = std::ranges::find_if(line.contradictions, is_far);
    if (first == line.contradictions.end()) continue;
    remarks.push_back(
        {RemarkKind::kPlacesFar,
         "line " + line.name + " at " + NumberText(std::round(first->s_m)) + " m",
         static_cast<std::uint64_t>(std::ranges::count_if(line.contradictions, is_far)),
         "contradictions.csv has them"});
  }
}

int RunImport(const ImportCommandOptions& options) {
  RailMap map = ReadMapWithin(options);
  TellTags(map);
  LeftOutOfMap left_out{std::move(map.remarks), {}};
  RemarkLog log;
  const auto tell = [&](const std::filesystem::path& file, std::size_t from) {
    for (std::size_t i = from; i < left_out.remarks.size(); ++i) {
      Remark remark = left_out.remarks[i];
      remark.place = ShownPath(file) + (remark.place.empty() ? "" : ": ") + remark.place;
      log.Add(remark, i);
    }
  };
  tell(options.map, 0);
  // Without --crs, it is the map that cannot be projected.
  const MapProjection projection = AtPlace(options.crs.empty() ? ShownPath(options.map) + ": " : "",
                                           [&] { return ProjectMap(options.crs, map); });
  FillElectrified(map);
  LinesInWork work{.tracks = FindLines(map, options.min_length_m)};
  if (work.tracks.empty()) {
    throw InputError(ShownPath(options.map) + ": must have a line of at least --min-length " +
                     NumberText(options.min_length_m) + " m");
  }
  std::unique_ptr<const ElevationMap> elevation;
  if (!options.heights.empty()) {
    elevation = ReadElevation(options.heights, options.heights_crs, projection, map, work.tracks);
  }
  const std::size_t num_of_map = left_out.remarks.size();
  if (elevation && elevation->num_void() > 0) {
    left_out.remarks.push_back({RemarkKind::kHeightsVoid, "", elevation->num_void(),
                                NumberText(elevation->first_void_m()) + " m"});
  }
  const FolderLock lock = LockEmptyFolder(options.out);
  // Before minutes of fitting.
  CheckCanWrite(options.out / "lines.csv");
  work.lines = ImportLines(map, options, work.tracks, left_out.lines);
  work.worlds = BuildWorlds(map, work.tracks, work.lines, options);
  const auto reasons = FinishLines(options, map, projection, elevation.get(), work);
  TellHeights(work.lines, left_out.remarks);
  tell(options.heights.empty() ? options.map : options.heights, num_of_map);
  const std::size_t num_before_places = left_out.remarks.size();
  TellFarPlaces(work.lines, left_out.remarks);
  tell(options.map, num_before_places);
  LeaveOutLines(map, work.tracks, reasons, left_out.lines);
  EraseWhere(reasons, work.tracks);
  EraseWhere(reasons, work.lines);
  EraseWhere(reasons, work.worlds);
  const std::vector<AccountRow> account = AccountOf(
      map, {work.tracks, work.lines, work.worlds, left_out.lines,
            options.is_main_only ? "--main-only leaves out tracks beside lines" : kNearNoLine});
  WriteTables(options.out, work.lines, work.worlds, account, left_out);
  std::cout << "projection: " << ShownLines(projection.definition) << ", minus ("
            << NumberText(projection.origin_m.x()) << ", " << NumberText(projection.origin_m.y())
            << ") m; longitudes and latitudes in scenarios are right to "
            << ShortText(projection.geographic_error_m) << " m\n\n"
            << TablesText(work.lines, work.worlds, account, left_out.lines) << "Wrote "
            << Amount(work.lines.size(), "lines to ") << ShownPath(options.out) << '\n';
  if (!work.lines.empty()) return kExitSuccess;
  throw InputError(ShownPath(options.map) + ": must have a line that can be built (got " +
                   std::to_string(left_out.lines.size()) + " left out, with the reasons in " +
                   ShownPath(options.out / "left_out.csv") + ")");
}

void AddHeightOptions(ProgramOptions& subcommand,
                      const std::shared_ptr<ImportCommandOptions>& options) {
  constexpr NumberRule kSigma{0.001, 100.0};  // In m.
  const Option heights =
      subcommand
          .AddOption("--heights", options->heights,
                     "Elevation model: GeoTIFF, ESRI ASCII grid or another raster that GDAL reads; "
                     "default: the heights of the map's points, where it has any")
          .Check(NonEmpty());
  subcommand
      .AddOption("--heights-crs", options->heights_crs,
                 "Coordinate system of an elevation model that names none, such as EPSG:4326")
      .Needs(heights);
  subcommand
      .AddOption("--height-sigma", options->fit.height_sigma_m,
                 "Standard deviation of the heights, in m")
      .ShowDefault()
      .Check(Number(kSigma));
  subcommand.AddFlag("--level", options->is_level, "Leave out the heights of the map's points")
      .Excludes(heights);
}

void AddImport(ProgramOptions& app, ProgramCommand& command) {
  constexpr NumberRule kLength{1.0, 1e6};     // In m.
  constexpr NumberRule kSigma{0.001, 100.0};  // In m.
  constexpr NumberRule kSpeed{1.0, 1000.0};   // In km/h.
  constexpr NumberRule kDegrees{-180.0, 180.0};
  const auto options = std::make_shared<ImportCommandOptions>();
  ProgramOptions subcommand = app.AddCommand("import", OwnProgramOf("import").description);
  subcommand
      .AddOption(
          "MAP", options->map,
          "Overpass JSON, .osm, .pbf, GeoJSON, GPX, KML or railML 3 with tracks as lines, also "
          "packed as .gz or .bz2")
      .Required()
      .Check(NonEmpty());
  subcommand.AddOption("--out", options->out, "New or empty folder to write to")
      .Required()
      .Check(NonEmpty());
  subcommand
      .AddOption("--within", options->within_deg,
                 "Cut the map to a rectangle: LONGITUDE,LATITUDE of its south-western and of its "
                 "north-eastern corner, in degrees")
      .NumValues(4)
      .SeparatedBy(',')
      .TakesOneWord()
      .Check(Number(kDegrees));
  subcommand.AddOption("--crs", options->crs,
                       "Coordinate system in metres for PROJ, such as EPSG:31256; default: a "
                       "transverse Mercator about the middle of the map with scale 1");
  subcommand
      .AddOption("--min-length", options->min_length_m, "Leave out lines shorter than this, in m")
      .ShowDefault()
      .Check(Number(kLength));
  subcommand
      .AddOption("--sigma", options->fit.sigma_m,
                 "Standard deviation of the map's points across the track, in m")
      .ShowDefault()
      .Check(Number(kSigma));
  subcommand
      .AddOption("--speed", options->fit.otherwise_kmph,
                 "Speed limit in km/h of running tracks for which the map has none")
      .ShowDefault()
      .Check(Number(kSpeed));
  subcommand.AddFlag("--main-only", options->is_main_only, "Leave out the tracks beside each line");
  AddHeightOptions(subcommand, options);
  subcommand.WhenParsed([&command, options] {
    command = [options](const std::string& /*all*/) { return RunImport(*options); };
  });
}

void AddCommand(ProgramOptions& app, ProgramCommand& command) {
  app.RequireCommand();
  AddImport(app, command);
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::ProgramMain({.name = "railcast-generate",
                                .description = "Makes railcast's alignments and worlds from maps.",
                                .footer = railcast::kExitStatusText,
                                .add = railcast::AddCommand},
                               argc, argv);
}
