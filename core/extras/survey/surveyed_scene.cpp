#include "core/rail/survey/surveyed_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/survey/survey_file.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// The two triangles of a surfel.
void AppendSurfel(const Surfel& surfel, const Eigen::Isometry3d& mesh_from_tile, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto corner = [&](float u, float v) {
    const Eigen::Vector3f tile_m = surfel.center_m + u * surfel.half_u_m + v * surfel.half_v_m;
    mesh.vertices.emplace_back((mesh_from_tile * tile_m.cast<double>()).cast<float>());
  };
  corner(-1.0F, -1.0F);
  corner(1.0F, -1.0F);
  corner(1.0F, 1.0F);
  corner(-1.0F, 1.0F);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

constexpr int kSurveyedWireSides = 16;

/// The scene of a file of tiles.
class TiledScene : public SurveyedScene {
 public:
  /// @throws InputError as WorldExtras::open_survey().
  TiledScene(const std::filesystem::path& file,
             const LabelTable& labels,
             const MaterialLibrary& materials);

  [[nodiscard]] TilesOfChunks AssignTiles(const Alignment& alignment,
                                          const ChunkGrid& grid) const override;
  void Add(const std::vector<std::size_t>& tiles,
           const Transform& chunk_from_world,
           Chunk& chunk) const override;
  [[nodiscard]] std::optional<double> GroundHeight_m(const Eigen::Vector2d& place_m) const override;

 private:
  SurveyFile file_;
  std::map<std::array<std::int32_t, 2>, std::size_t> tile_of_cell_;
  std::vector<std::uint32_t> labels_;
  std::vector<std::uint16_t> materials_;
};

TiledScene::TiledScene(const std::filesystem::path& file,
                       const LabelTable& labels,
                       const MaterialLibrary& materials)
    : file_(file) {
  ErrorList errors;
  for (const std::string& name : file_.labels()) {
    const Label* const label = labels.Find(name);
    if (label == nullptr) {
      errors.Add(
          {ShownPath(file.filename()), "must have labels of the scenario's table", Quoted(name)});
    }
    labels_.push_back(label == nullptr ? 0 : label->id);
  }
  for (std::uint8_t level = 0; level < kNumSurveyLevels; ++level) {
    if (const auto index =
            Attempt("", errors, [&] { return materials.Index(MaterialOfLevel(level).name); })) {
      materials_.push_back(*index);
    }
  }
  errors.ThrowIfAny();
  for (std::size_t i = 0; i < file_.tiles().size(); ++i) tile_of_cell_[file_.tiles()[i].cell] = i;
}

void TiledScene::Add(const std::vector<std::size_t>& tiles,
                     const Transform& chunk_from_world,
                     Chunk& chunk) const {
  // Looked up once for each surface, not for each surfel.
  std::map<SurveySurface, std::vector<std::pair<std::size_t, std::size_t>>> surfels;
  std::vector<SurveyTile> read;
  for (const std::size_t tile : tiles) {
    read.push_back(file_.Read(tile));
    for (std::size_t i = 0; i < read.back().surfels.size(); ++i) {
      surfels[read.back().surfels[i].surface].emplace_back(read.size() - 1, i);
    }
  }
  std::vector<Transform> chunk_from_tile;
  for (const SurveyTile& tile : read) {
    chunk_from_tile.push_back(chunk_from_world * Eigen::Translation3d(tile.Origin_m()));
  }
  for (const auto& [surface, places] : surfels) {
    Mesh& mesh = MeshOf({materials_[surface.level], labels_[surface.label]}, chunk.ground);
    mesh.vertices.reserve(4 * places.size());
    mesh.triangles.reserve(2 * places.size());
    for (const auto& [tile, index] : places) {
      AppendSurfel(read[tile].surfels[index], chunk_from_tile[tile], mesh);
    }
  }
  for (std::size_t t = 0; t < read.size(); ++t) {
    for (const SurveyedWire& wire : read[t].wires) {
      Wire& added = chunk.wires.emplace_back();
      added.material = materials_[wire.surface.level];
      added.label = labels_[wire.surface.label];
      added.radius_m = wire.radius_m;
      for (const Eigen::Vector3f& point_m : wire.points_m) {
        added.points_m.push_back(chunk_from_tile[t] * point_m.cast<double>());
      }
      added.span = {.begin_m = added.points_m.front(), .end_m = added.points_m.back()};
      Part& part = chunk.ground.parts.emplace_back();
      part.material = added.material;
      part.label = added.label;
      part.is_wire = true;
      part.mesh = MakeTube(added.points_m, added.radius_m, kSurveyedWireSides);
    }
  }
}

std::optional<double> TiledScene::GroundHeight_m(const Eigen::Vector2d& place_m) const {
  const auto found = tile_of_cell_.find(SurveyCellAt(place_m));
  if (found == tile_of_cell_.end()) return std::nullopt;
  return railcast::GroundHeight_m(file_.tiles()[found->second], place_m);
}

TilesOfChunks TiledScene::AssignTiles(const Alignment& alignment, const ChunkGrid& grid) const {
  const std::vector<SurveyTile>& tiles = file_.tiles();
  constexpr double kMostSamples = 20'000.0;
  const double step_m = std::max(5.0, alignment.length_m() / kMostSamples);
  std::vector<std::pair<Eigen::Vector2d, int>> axis;
  for (double s_m = 0.0; s_m <= alignment.length_m(); s_m += step_m) {
    axis.emplace_back(alignment.At(s_m).position_m.head<2>(), grid.ChunkAt(s_m));
  }
  const double half_diagonal_m = 0.5 * kSurveyTile_m * std::numbers::sqrt2;
  TilesOfChunks assigned;
  assigned.tiles.resize(static_cast<std::size_t>(grid.num_chunks()));
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const Eigen::Vector2d middle_m =
        tiles[t].Origin_m().head<2>() + Eigen::Vector2d::Constant(0.5 * kSurveyTile_m);
    const auto squared_m2 = [&](const auto& sample) {
      return (sample.first - middle_m).squaredNorm();
    };
    const auto nearest = std::ranges::min_element(axis, {}, squared_m2);
    assigned.tiles[static_cast<std::size_t>(nearest->second)].push_back(t);
    assigned.half_width_m =
        std::max(assigned.half_width_m, std::sqrt(squared_m2(*nearest)) + half_diagonal_m);
  }
  return assigned;
}

}  // namespace

void AddSurvey(WorldExtras& extras) {
  extras.open_survey = [](const std::filesystem::path& file, const LabelTable& labels,
                          const MaterialLibrary& materials) {
    return std::shared_ptr<const SurveyedScene>(
        std::make_shared<TiledScene>(file, labels, materials));
  };
  extras.survey_materials = [] {
    std::vector<Material> materials;
    for (std::uint8_t level = 0; level < kNumSurveyLevels; ++level) {
      materials.push_back(MaterialOfLevel(level));
    }
    return materials;
  };
}

}  // namespace railcast
