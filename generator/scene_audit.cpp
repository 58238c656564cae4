#include "generator/scene_audit.h"

namespace railcast {
namespace {

void AddMaterials(const Model& model, const MaterialLibrary& library, std::set<std::string>& used) {
  for (const Part& part : model.parts) used.insert(library.materials().at(part.material).name);
}

}  // namespace

SceneAudit AuditScene(const World& world,
                      const MaterialLibrary& materials,
                      std::int64_t time_ns,
                      double range_m) {
  SceneAudit audit;
  audit.home_chunk = world.HomeChunk(time_ns);
  std::set<std::shared_ptr<const Model>> models;
  for (const int index : world.ChunksInReach(audit.home_chunk, range_m)) {
    const Chunk chunk = world.BuildChunk(index);
    ++audit.num_chunks;
    audit.ground_triangles += chunk.ground.num_triangles();
    AddMaterials(chunk.ground, materials, audit.materials);
    for (const Placement& placement : chunk.placements) {
      ++audit.num_placements;
      audit.placed_triangles += placement.model->num_triangles();
      models.insert(placement.model);
    }
  }
  for (const auto& model : models) {
    audit.model_triangles += model->num_triangles();
    AddMaterials(*model, materials, audit.materials);
  }
  audit.num_models = models.size();
  for (const SceneObject& object : world.objects()) {
    audit.object_triangles += object.model->num_triangles();
    AddMaterials(*object.model, materials, audit.materials);
  }
  return audit;
}

}  // namespace railcast
