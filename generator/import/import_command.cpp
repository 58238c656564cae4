#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <filesystem>
#include <iostream>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "generator/commands.h"
#include "generator/empty_folder.h"
#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/line_files.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/map_projection.h"
#include "generator/import/map/read_map.h"

namespace railcast {
namespace {

struct ImportCommandOptions {
  std::filesystem::path map;
  std::filesystem::path out;
  std::string crs;
  double min_length_m = 1000.0;
  ImportOptions fit;
};

/// Fits all lines at once, and shows how far that is.
std::vector<ImportedLine> ImportLines(const RailMap& map,
                                      const std::vector<TrackLine>& tracks,
                                      const ImportOptions& options) {
  double all_m = 0.0;
  for (const TrackLine& track : tracks) all_m += LengthOf_m(map, track);
  const ProgressLine progress;
  std::mutex mutex;
  double done_m = 0.0;
  std::vector<ImportedLine> lines(tracks.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tracks.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          lines[i] = ImportLine(map, tracks[i], options);
          const std::scoped_lock lock(mutex);
          done_m += LengthOf_m(map, tracks[i]);
          progress.Show("fitting " + std::to_string(tracks.size()) + " lines", done_m / all_m);
        }
      },
      tbb::simple_partitioner());
  progress.End();
  return lines;
}

int RunImport(const ImportCommandOptions& options) {
  RailMap map = ReadMap(options.map);
  // Without --crs, it is the map that cannot be projected.
  const MapProjection projection = AtPlace(options.crs.empty() ? ShownPath(options.map) + ": " : "",
                                           [&] { return ProjectMap(options.crs, map); });
  const std::vector<TrackLine> tracks = FindLines(map, options.min_length_m);
  if (tracks.empty()) {
    throw InputError(ShownPath(options.map) + ": must have a line of at least --min-length " +
                     NumberText(options.min_length_m) + " m");
  }
  MakeEmptyFolder(options.out);
  // Before minutes of fitting.
  CheckCanWrite(options.out / "lines.csv");
  const std::vector<ImportedLine> lines = ImportLines(map, tracks, options.fit);
  for (const ImportedLine& line : lines) {
    WriteFileWhole(options.out / (line.name + ".alignment.json"),
                   AlignmentFileText(line, projection));
  }
  WriteFileWhole(options.out / "lines.csv", QualityCsv(lines));
  WriteFileWhole(options.out / "contradictions.csv", ContradictionsCsv(lines));
  std::cout << "projection: " << ShownLines(projection.definition) << ", minus ("
            << NumberText(projection.origin_m.x()) << ", " << NumberText(projection.origin_m.y())
            << ") m\n\n"
            << QualityTable(lines) << '\n'
            << "Wrote " << lines.size() << " alignments to " << ShownPath(options.out) << '\n';
  return kExitSuccess;
}

}  // namespace

void AddImport(CLI::App& app, ProgramCommand& command) {
  constexpr NumberRule kLength{1.0, 1e6};     // In m.
  constexpr NumberRule kSigma{0.001, 100.0};  // In m.
  constexpr NumberRule kSpeed{1.0, 1000.0};   // In km/h.
  const auto options = std::make_shared<ImportCommandOptions>();
  CLI::App* import =
      app.add_subcommand("import", "Fit the lines of a map and write them as alignments");
  import
      ->add_option("MAP", options->map,
                   "Overpass JSON, .osm, .pbf, GeoJSON, GPX or KML with tracks as lines")
      ->required()
      ->check(NonEmpty());
  import->add_option("--out", options->out, "New or empty folder to write to")
      ->required()
      ->check(NonEmpty());
  import->add_option("--crs", options->crs,
                     "Coordinate system in metres for PROJ, such as EPSG:31256; default: a "
                     "transverse Mercator about the middle of the map, without scale");
  import
      ->add_option("--min-length", options->min_length_m, "Leave out lines shorter than this, in m")
      ->capture_default_str()
      ->check(Number(kLength));
  import
      ->add_option("--sigma", options->fit.sigma_m,
                   "Standard deviation of the map's points across the track, in m")
      ->capture_default_str()
      ->check(Number(kSigma));
  import
      ->add_option("--speed", options->fit.otherwise_kmph,
                   "Speed limit in km/h of lines for which the map has none")
      ->capture_default_str()
      ->check(Number(kSpeed));
  import->callback([&command, options] {
    command = [options](const std::string&) { return RunImport(*options);
};
}  // namespace railcast
);
}

}  // namespace railcast
