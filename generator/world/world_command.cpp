#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/join.h"
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
  std::uint64_t max_size_mb = 250;  ///< Size of the file, in 1e6 bytes.
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

/// A format of the file, and how many bytes triangles take in it.
struct MeshFormat {
  std::string_view extension;
  std::size_t vertex_bytes;
  std::size_t triangle_bytes;
  std::string (*encode)(const ExportedWorld&, const LabelTable&, const MaterialLibrary&);
};

// OBJ is text: its numbers are those of minimal.json, where they give the size within 2 %.
constexpr std::array<MeshFormat, 3> kFormats = {{
    {".ply", 12, 24,
     [](const ExportedWorld& exported, const LabelTable& labels, const MaterialLibrary&) {
       return EncodePlyMesh(exported, labels);
     }},
    {".glb", 20, 12, EncodeGlbMesh},
    {".obj", 30, 27, EncodeObjMesh},
}};

const MeshFormat& FormatOf(const std::filesystem::path& out) {
  const auto* const found =
      std::ranges::find(kFormats, out.extension().string(), &MeshFormat::extension);
  if (found == kFormats.end()) {
    throw InputError("--out: must end in .ply, .glb or .obj (got " + ShownPath(out) + ")");
  }
  return *found;
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

/// Shows how far the gathering is, and ends it when the file would be too large.
struct GatheredSize {
  const WorldOptions& options;
  std::size_t num_chunks;  ///< Chunks of the whole export.
  MeshSize gathered{};
  TerminalLine line{};

  void operator()(std::size_t num_gathered, const MeshSize& size) {
    gathered = size;
    const std::string chunks =
        "chunk " + std::to_string(num_gathered) + " of " + std::to_string(num_chunks);
    line.Show(chunks);
    const MeshFormat& format = FormatOf(options.out);
    const std::size_t num_bytes =
        size.num_vertices * format.vertex_bytes + size.num_triangles * format.triangle_bytes;
    if (num_bytes <= options.max_size_mb * 1'000'000) return;
    line.Clear();
    throw InputError("--max-mb: the file must have at most " + std::to_string(options.max_size_mb) +
                     " MB (got " + std::to_string(size.num_triangles) + " triangles, " +
                     SizeText(num_bytes) + ", by " + chunks +
                     "); choose a shorter stretch by --from-s and --to-s, or more by --max-mb");
  }
};

int RunWorld(const WorldOptions& options) {
  const MeshFormat& format = FormatOf(options.out);
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
  GatheredSize size{options, chunks.size()};
  const ExportedWorld exported =
      ExportWorld(*world, chunks, ChunksOfObjects(*world, kBegin_ns), kBegin_ns, std::ref(size));
  size.line.End();

  const LabelTable labels(scenario.labels);
  const MaterialLibrary materials(scenario.materials);
  const std::string bytes = format.encode(exported, labels, materials);
  if (options.is_verbose) SayTriangles(exported, labels);
  const std::size_t num_triangles = size.gathered.num_triangles;
  std::cerr << "writing " << Amount(num_triangles, "triangles, ") << SizeText(bytes.size()) << "\n";
  WriteNamedFile(options.out, bytes);
  std::cout << Amount(num_triangles, "triangles of ") << Amount(chunks.size(), "chunks in ")
            << ShownPath(options.out) << "\n";
  return kExitSuccess;
}

}  // namespace

void AddWorld(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<WorldOptions>();
  ProgramOptions world = app.AddCommand("world", "Write the scene as a mesh of triangles");
  world.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  world.AddOption("--out", options->out, "File to write, whose name ends in .ply, .glb or .obj")
      .Required()
      .Check(NonEmpty());
  world
      .AddOption("--from-s", options->from_s_m,
                 "Chainage in m at which to begin, together with --to-s; default: all that frame "
                 "0 can see")
      .Check(Number(kChainage));
  world
      .AddOption("--to-s", options->to_s_m, "Chainage in m at which to end, together with --from-s")
      .Check(Number(kChainage));
  world
      .AddOption("--max-mb", options->max_size_mb,
                 "Most MB that the file may have; a larger one is refused before it is written")
      .ShowDefault()
      .Check(Whole({1, 1'000'000}));
  world.AddFlag("-v,--verbose", options->is_verbose, "Print details of each step");
  world.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunWorld(*options); };
  });
}

}  // namespace railcast
