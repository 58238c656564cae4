#include "core/simulate/scene_store.h"

#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/scene/object_pieces.h"
#include "core/simulate/swaying.h"
#include "railcast/rail_world.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

Model WithoutTriangles(const Model& model) {
  Model bare{model.name, {}};
  for (const Part& part : model.parts) {
    bare.parts.push_back({{}, part.material, part.label, part.is_wire});
  }
  return bare;
}

double RadiusAboutOrigin(const Model& model) {
  double radius_m = 0.0;
  for (const Part& part : model.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      radius_m = std::max(radius_m, vertex.cast<double>().norm());
    }
  }
  return radius_m;
}

}  // namespace

std::shared_ptr<const TraceStock::BareChunk> TraceStock::GetChunk(const RailWorld& world,
                                                                  const ChunkForm& form) {
  const auto build = [&] { return Prepare(world.BuildBareChunk(form.chunk, form.level), form); };
  const std::shared_ptr<const void> line = world.bare_line();
  if (line == nullptr) return build();
  return chunks_.Get(std::pair(line, form), build,
                     [](const BareChunk& chunk) { return chunk.num_triangles; });
}

std::shared_ptr<const TraceStock::BareChunk> TraceStock::Prepare(Chunk made,
                                                                 const ChunkForm& form) const {
  if (!form.has_tubes) {
    for (Part& part : made.ground.parts) {
      if (part.is_wire) part.mesh = {};
    }
  }
  auto built = std::make_shared<BareChunk>();
  built->ground = std::make_shared<TraceModel>(device_, made.ground);
  built->ground_surfaces = WithoutTriangles(made.ground);
  built->placements = std::move(made.placements);
  built->wires = std::move(made.wires);
  built->num_triangles = made.ground.num_triangles();
  return built;
}

std::shared_ptr<const TraceModel> TraceStock::GetModel(const std::shared_ptr<const Model>& model,
                                                       bool is_object) {
  const auto key = std::pair(model.get(), is_object);
  {
    const std::lock_guard lock(models_mutex_);
    const auto found = models_.find(key);
    if (found != models_.end()) return found->second.second;
  }
  // Built without holding the lock, so that other models are not delayed. Two threads that need the
  // same model at the same time may both build it.
  auto built = std::make_shared<const TraceModel>(device_, *model, is_object);
  const std::lock_guard lock(models_mutex_);
  return models_.try_emplace(key, model, std::move(built)).first->second.second;
}

void TraceStock::ForgetUnusedModels() {
  const std::lock_guard lock(models_mutex_);
  std::erase_if(models_, [](const auto& entry) { return entry.second.first.use_count() == 1; });
}

SceneStore::SceneStore(std::shared_ptr<const World> world,
                       const MaterialLibrary& materials,
                       std::shared_ptr<TraceStock> stock)
    : world_(std::move(world)),
      rail_world_(std::dynamic_pointer_cast<const RailWorld>(world_)),
      materials_(materials.materials()),
      unit_tube_(std::make_shared<const Model>(UnitTube())),
      stock_(std::move(stock)) {}

std::shared_ptr<const SceneStore::BuiltChunk> SceneStore::GetChunk(const ChunkForm& form) {
  std::packaged_task<std::shared_ptr<const BuiltChunk>()> build;
  std::shared_future<std::shared_ptr<const BuiltChunk>> result;
  {
    const std::lock_guard lock(chunks_mutex_);
    ChunkEntry& entry = chunks_[form];
    if (auto built = entry.built.lock()) return built;
    if (!entry.being_built.valid()) {
      build =
          std::packaged_task<std::shared_ptr<const BuiltChunk>()>([&] { return BuildChunk(form); });
      entry.being_built = build.get_future().share();
    }
    result = entry.being_built;
  }
  if (!build.valid()) return result.get();
  build();
  const std::lock_guard lock(chunks_mutex_);
  ChunkEntry& entry = chunks_[form];
  entry.being_built = {};
  const std::shared_ptr<const BuiltChunk> built = result.get();
  entry.built = built;
  return built;
}

std::shared_ptr<const SceneStore::BuiltChunk> SceneStore::BuildChunk(const ChunkForm& form) const {
  auto built = std::make_shared<BuiltChunk>();
  if (rail_world_ == nullptr) {
    Chunk made = form.level > 0 ? world_->BuildCoarserChunk(form.chunk, form.level)
                                : world_->BuildChunk(form.chunk);
    built->bare = stock_->Prepare(std::move(made), form);
    built->placements = built->bare->placements;
    return built;
  }
  built->bare = stock_->GetChunk(*rail_world_, form);
  built->placements = built->bare->placements;
  std::ranges::move(rail_world_->PlantsOf(form.chunk), std::back_inserter(built->placements));
  return built;
}

void SceneStore::UseBeams(const std::vector<std::uint32_t>& labels) {
  const std::scoped_lock lock(labels_of_beams_mutex_);
  labels_of_beams_.insert(labels);
}

std::set<std::vector<std::uint32_t>> SceneStore::labels_of_beams() const {
  const std::scoped_lock lock(labels_of_beams_mutex_);
  return labels_of_beams_;
}

SceneStore::StoredObject SceneStore::MakeObject(const SceneObject& object) {
  StoredObject stored{{}, {}, RadiusAboutOrigin(*object.model)};
  std::vector<TracePiece> pieces;
  for (std::size_t i = 0; i < NumPieces(object); ++i) {
    const std::shared_ptr<const Model>& piece = PieceOf(object, i);
    pieces.push_back({GetModel(piece, true), static_cast<std::uint32_t>(stored.surfaces.size())});
    for (const Part& part : piece->parts) {
      stored.surfaces.push_back(MakeSurface(part, object.instance, object.is_ego));
    }
  }
  stored.pieces = std::make_shared<const std::vector<TracePiece>>(std::move(pieces));
  return stored;
}

Surface SceneStore::MakeSurface(const Part& part, std::uint32_t instance, bool is_ego) const {
  Check(part.material < materials_.size(), "a simulator has all materials of its world");
  return {.label = part.label,
          .instance = instance,
          .reflectivity = static_cast<float>(materials_[part.material].reflectivity),
          .material = part.material,
          .is_ego = is_ego};
}

bool SceneStore::HasTexture(const std::vector<Surface>& surfaces) const {
  return std::ranges::any_of(
      surfaces, [&](const Surface& surface) { return materials_[surface.material].texture > 0.0; });
}

std::shared_ptr<SceneStore> MakeSceneStore(std::shared_ptr<const World> world,
                                           const MaterialLibrary& materials,
                                           const std::string& isa) {
  return std::make_shared<SceneStore>(std::move(world), materials,
                                      std::make_shared<TraceStock>(isa));
}

}  // namespace railcast
