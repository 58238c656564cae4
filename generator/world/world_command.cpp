#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "generator/commands.h"
#include "generator/world/world_export.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr NumberRule kChainage{-1e7, 1e7};  // In m.

struct WorldOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;       ///< Path ending in .ply, .glb or .obj.
  std::optional<double> from_s_m;  ///< Chainage; both are given or neither.
  std::optional<double> to_s_m;
  bool is_verbose = false;
};

int ChunkAt(double s_m) {
  return static_cast<int>(std::floor(s_m / RailWorld::kChunkLength_m));
}

std::vector<int> ChunksBetween(double from_s_m, double to_s_m, double length_m) {
  if (!(from_s_m >= 0.0 && from_s_m < to_s_m && to_s_m <= length_m)) {
    throw InputError("--from-s, --to-s: must be 0 <= from < to <= " + NumberText(length_m) +
                     " (got " + NumberText(from_s_m) + ", " + NumberText(to_s_m) + ")");
  }
  // A chunk that begins exactly where the stretch ends is not part of it.
  const int last = static_cast<int>(std::ceil(to_s_m / RailWorld::kChunkLength_m)) - 1;
  std::vector<int> chunks(static_cast<std::size_t>(last - ChunkAt(from_s_m) + 1));
  std::iota(chunks.begin(), chunks.end(), ChunkAt(from_s_m));
  return chunks;
}

std::size_t CountTriangles(const ExportedWorld& exported) {
  std::size_t count = 0;
  for (const Part& part : exported.parts) count += part.mesh.triangles.size();
  return count;
}

void SayTriangles(const ExportedWorld& exported, const LabelTable& labels) {
  for (const Part& part : exported.parts) {
    std::cerr << ShownText(labels.Find(part.label)->name) << ": " << part.mesh.triangles.size()
              << " triangles\n";
  }
}

// For example "23.4 MB".
std::string SizeText(std::size_t num_bytes) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << static_cast<double>(num_bytes) * 1e-6 << " MB";
  return text.str();
}

int RunWorld(const WorldOptions& options) {
  const std::string extension = options.out.extension().string();
  if (extension != ".ply" && extension != ".glb" && extension != ".obj") {
    throw InputError("--out: must end in .ply, .glb or .obj (got " + ShownPath(options.out) + ")");
  }
  if (options.from_s_m.has_value() != options.to_s_m.has_value()) {
    const bool has_from = options.from_s_m.has_value();
    throw InputError("--from-s, --to-s: must be given both or not at all (got only " +
                     std::string(has_from ? "--from-s " : "--to-s ") +
                     NumberText(has_from ? *options.from_s_m : *options.to_s_m) + ")");
  }
  // Fail before spending minutes on building the scene.
  CheckCanWrite(options.out);
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  const auto world = MakeWorld(scenario);
  constexpr std::int64_t kBegin_ns = 0;
  double range_max_m = 0.0;
  for (const std::string& sensor : SensorNames(scenario)) {
    range_max_m = std::max(range_max_m, PickSensor(scenario, sensor).lidar.range_max_m);
  }
  const std::vector<int> chunks =
      options.from_s_m
          ? ChunksBetween(*options.from_s_m, *options.to_s_m, world->alignment().length_m())
          : world->ChunksInReach(world->HomeChunk(kBegin_ns), range_max_m);
  const TerminalLine line;
  const ExportedWorld exported = ExportWorld(
      *world, chunks, ChunksOfObjects(*world, kBegin_ns), kBegin_ns, [&](std::size_t num_gathered) {
        line.Show("chunk " + std::to_string(num_gathered) + " of " + std::to_string(chunks.size()));
      });
  line.End();

  const LabelTable labels(scenario.labels);
  const MaterialLibrary materials(scenario.materials);
  const std::string bytes = extension == ".ply"   ? EncodePlyMesh(exported, labels)
                            : extension == ".glb" ? EncodeGlbMesh(exported, labels, materials)
                                                  : EncodeObjMesh(exported, labels, materials);
  if (options.is_verbose) SayTriangles(exported, labels);
  const std::size_t num_triangles = CountTriangles(exported);
  std::cerr << "writing " << num_triangles << " triangles, " << SizeText(bytes.size()) << "\n";
  WriteFileWhole(options.out, bytes);
  std::cout << num_triangles << " triangles of " << chunks.size() << " chunks in "
            << ShownPath(options.out) << "\n";
  return kExitSuccess;
}

}  // namespace

void AddWorld(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<WorldOptions>();
  CLI::App* world = app.add_subcommand("world", "Write the scene as a mesh of triangles");
  world->add_option("SCENARIO", options->scenario, "Scenario file")->required()->check(NonEmpty());
  world->add_option("--out", options->out, "File to write, whose name ends in .ply, .glb or .obj")
      ->required()
      ->check(NonEmpty());
  world
      ->add_option("--from-s", options->from_s_m,
                   "Chainage in m at which to begin, together with --to-s; default: all that frame "
                   "0 can see")
      ->check(Number(kChainage));
  world
      ->add_option("--to-s", options->to_s_m,
                   "Chainage in m at which to end, together with --from-s")
      ->check(Number(kChainage));
  world->callback([&app, &command, options] {
    options->is_verbose = app.count("--verbose") > 0;
    command = [options](const std::string&) { return RunWorld(*options); };
  });
}

}  // namespace railcast
