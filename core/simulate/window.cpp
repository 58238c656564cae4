#include "core/simulate/window.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

// Where a sensor can be while a chunk is its home: in a chunk of less than 100 m, on a track up to
// 1 km beside the line. An object too many costs an entry of the scene, one too few is missed.
constexpr double kHomeRadius_m = 1100.0;

Eigen::Affine3d ToAffine(const Transform& transform) {
  return Eigen::Affine3d(transform.matrix());
}

Model WithoutTriangles(const Model& model) {
  Model bare{model.name, {}};
  for (const Part& part : model.parts) {
    bare.parts.push_back({{}, part.material, part.label, part.is_wire});
  }
  return bare;
}

/// Which part of the ground holds the wire's tube.
std::uint32_t PartOfWire(const Wire& wire, const Model& ground) {
  const auto part = std::find_if(ground.parts.begin(), ground.parts.end(), [&](const Part& tubes) {
    return tubes.is_wire && tubes.material == wire.material && tubes.label == wire.label;
  });
  Check(part != ground.parts.end(), "the ground holds every wire as a tube");
  return static_cast<std::uint32_t>(part - ground.parts.begin());
}

void AddWires(const std::vector<Wire>& wires,
              const Transform& window_from_chunk,
              const Model& ground,
              std::uint32_t ground_surface,
              WireSet& set) {
  for (const Wire& wire : wires) {
    std::vector<Vector3> points_m = wire.points_m;
    for (Vector3& point : points_m) point = window_from_chunk * point;
    set.Add(points_m, wire.radius_m, ground_surface + PartOfWire(wire, ground));
  }
}

}  // namespace

WindowSource::WindowSource(std::shared_ptr<const World> world,
                           const MaterialLibrary& materials,
                           double range_max_m,
                           const std::string& isa)
    : world_(std::move(world)),
      materials_(materials.materials()),
      range_max_m_(range_max_m),
      device_(isa) {
  fixed_surfaces_.emplace_back();
  for (const SceneObject& object : world_->objects()) {
    object_models_.push_back(GetModel(object.model));
    object_surfaces_.push_back(static_cast<std::uint32_t>(fixed_surfaces_.size()));
    for (const Part& part : object.model->parts) {
      fixed_surfaces_.push_back(MakeSurface(part, object.instance, object.is_ego));
    }
  }
  builder_ = std::thread([this] { BuildAhead(); });
}

WindowSource::~WindowSource() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  builder_.join();
}

Surface WindowSource::MakeSurface(const Part& part, std::uint32_t instance, bool is_ego) const {
  return {.label = part.label,
          .instance = instance,
          .reflectivity = static_cast<float>(materials_[part.material].reflectivity),
          .material = part.material,
          .is_ego = is_ego};
}

std::shared_ptr<const TraceModel> WindowSource::GetModel(
    const std::shared_ptr<const Model>& model) {
  auto& entry = models_[model.get()];
  if (entry.second == nullptr) entry = {model, std::make_shared<TraceModel>(device_, *model)};
  return entry.second;
}

std::shared_ptr<const WindowSource::BuiltChunk> WindowSource::GetChunk(int chunk) {
  if (const auto it = chunks_.find(chunk); it != chunks_.end()) return it->second;
  Chunk made = world_->BuildChunk(chunk);
  auto built = std::make_shared<BuiltChunk>();
  built->ground = std::make_shared<TraceModel>(device_, made.ground);
  built->ground_surfaces = WithoutTriangles(made.ground);
  built->placements = std::move(made.placements);
  built->wires = std::move(made.wires);
  return chunks_.emplace(chunk, std::move(built)).first->second;
}

void WindowSource::KeepOnly(const std::vector<int>& chunks) {
  std::erase_if(chunks_, [&](const auto& entry) {
    return !std::binary_search(chunks.begin(), chunks.end(), entry.first);
  });
  // What neither the world nor a chunk holds will not be asked for again.
  std::erase_if(models_, [](const auto& entry) { return entry.second.first.use_count() == 1; });
}

void WindowSource::AddObjects(int home_chunk,
                              Window& window,
                              std::vector<TracePlacement>& placements) const {
  const Vector3 home_world = world_->WorldFromChunk(home_chunk).translation();
  const auto& objects = world_->objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].moves) continue;
    const Transform world_from_object = world_->WorldFromObject(i, 0);
    const Eigen::AlignedBox3d box = objects[i].model->Bounds();
    if (box.isEmpty()) continue;
    const double distance_m = (world_from_object * box.center() - home_world).norm();
    if (distance_m > range_max_m_ + kHomeRadius_m + 0.5 * box.diagonal().norm()) continue;
    placements.push_back({object_models_[i],
                          {ToAffine(window.window_from_world * world_from_object)},
                          object_surfaces_[i]});
  }
}

std::shared_ptr<const Window> WindowSource::Build(int home_chunk) {
  auto window = std::make_shared<Window>();
  window->window_from_world = world_->WorldFromChunk(home_chunk).inverse();
  window->surfaces = fixed_surfaces_;
  std::vector<TracePlacement> placements;
  AddObjects(home_chunk, *window, placements);

  // Things without an instance id of their own share their model's surfaces.
  std::map<std::pair<const Model*, std::uint32_t>, std::uint32_t> shared;
  const auto surfaces_of = [&](const Model& model, std::uint32_t instance) {
    const auto first = static_cast<std::uint32_t>(window->surfaces.size());
    for (const Part& part : model.parts) {
      window->surfaces.push_back(MakeSurface(part, instance, false));
    }
    return first;
  };
  const std::vector<int> chunks = world_->ChunksInReach(home_chunk, range_max_m_);
  KeepOnly(chunks);
  for (const int index : chunks) {
    const auto chunk = GetChunk(index);
    const Transform window_from_chunk = window->window_from_world * world_->WorldFromChunk(index);
    const std::uint32_t ground_surface = surfaces_of(chunk->ground_surfaces, 0);
    placements.push_back({chunk->ground, {ToAffine(window_from_chunk)}, ground_surface});
    AddWires(chunk->wires, window_from_chunk, chunk->ground_surfaces, ground_surface,
             window->wires);
    for (const Placement& placement : chunk->placements) {
      const auto key = std::pair(placement.model.get(), placement.instance);
      auto it = shared.find(key);
      if (it == shared.end()) {
        it = shared.emplace(key, surfaces_of(*placement.model, placement.instance)).first;
      }
      placements.push_back({GetModel(placement.model),
                            {ToAffine(window_from_chunk) * placement.chunk_from_model},
                            it->second});
    }
  }
  window->scene = std::make_unique<TraceScene>(device_, placements);
  return window;
}

WindowSource::WindowTask WindowSource::Remember(int home_chunk) {
  WindowTask task([this, home_chunk] {
    const std::lock_guard building(build_mutex_);
    return Build(home_chunk);
  });
  windows_.emplace(home_chunk, task.get_future().share());
  return task;
}

void WindowSource::ForgetOthers() {
  std::erase_if(windows_, [&](const auto& entry) {
    return entry.first != in_use_ && entry.first != prepared_;
  });
}

std::shared_ptr<const Window> WindowSource::Get(int home_chunk) {
  std::optional<WindowTask> build;
  FutureWindow window;
  {
    const std::lock_guard lock(mutex_);
    in_use_ = home_chunk;
    ForgetOthers();
    if (!windows_.contains(home_chunk)) build = Remember(home_chunk);
    window = windows_.at(home_chunk);
  }
  if (build) (*build)();
  try {
    return window.get();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    windows_.erase(home_chunk);
    throw;
  }
}

void WindowSource::Prepare(int home_chunk) {
  const std::lock_guard lock(mutex_);
  if (ahead_ || windows_.contains(home_chunk)) return;
  prepared_ = home_chunk;
  ForgetOthers();
  ahead_ = Remember(home_chunk);
  changed_.notify_all();
}

void WindowSource::BuildAhead() {
  // On Linux this lowers the calling thread alone: frames in progress come first.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || ahead_; });
    if (stopping_) return;
    lock.unlock();
    (*ahead_)();
    lock.lock();
    ahead_.reset();
  }
}

}  // namespace railcast
