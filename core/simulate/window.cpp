#include "core/simulate/window.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace railcast {
namespace {

// Where the vehicle can be while a chunk is its home: chunks are this long at most, see World.
constexpr double kHomeRadius_m = 60.0;

Eigen::Affine3d ToAffine(const Transform& transform) {
  return Eigen::Affine3d(transform.matrix());
}

Model WithoutTriangles(const Model& model) {
  Model bare{model.name, {}};
  for (const Part& part : model.parts) bare.parts.push_back({{}, part.material, part.label});
  return bare;
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
  auto& built = chunks_[chunk];
  if (built == nullptr) {
    Chunk made = world_->BuildChunk(chunk);
    auto fresh = std::make_shared<BuiltChunk>();
    fresh->ground = std::make_shared<TraceModel>(device_, made.ground);
    fresh->ground_surfaces = WithoutTriangles(made.ground);
    fresh->placements = std::move(made.placements);
    built = std::move(fresh);
  }
  return built;
}

void WindowSource::AddObjects(int home_chunk,
                              Window& window,
                              std::vector<TracePlacement>& placements) const {
  const Vector3 home_world = world_->WorldFromChunk(home_chunk).translation();
  const auto& objects = world_->objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].moves) continue;
    const Transform world_from_object = world_->WorldFromObject(i, 0);
    const double radius_m = objects[i].model->Bounds().diagonal().norm();
    const double distance_m = (world_from_object.translation() - home_world).norm();
    if (distance_m > range_max_m_ + kHomeRadius_m + radius_m) continue;
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
  for (const int index : chunks) {
    const auto chunk = GetChunk(index);
    const Transform window_from_chunk = window->window_from_world * world_->WorldFromChunk(index);
    placements.push_back(
        {chunk->ground, {ToAffine(window_from_chunk)}, surfaces_of(chunk->ground_surfaces, 0)});
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
  std::erase_if(chunks_, [&](const auto& entry) {
    return !std::binary_search(chunks.begin(), chunks.end(), entry.first);
  });
  return window;
}

std::shared_ptr<const Window> WindowSource::Get(int home_chunk) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(
        lock, [&] { return wanted_ != home_chunk || windows_.contains(home_chunk) || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    if (const auto it = windows_.find(home_chunk); it != windows_.end()) {
      auto window = it->second;
      std::erase_if(windows_, [&](const auto& entry) {
        return entry.first != home_chunk && entry.first != wanted_;
      });
      return window;
    }
  }
  const std::lock_guard building(build_mutex_);
  auto window = Build(home_chunk);
  const std::lock_guard lock(mutex_);
  windows_ = {{home_chunk, window}};
  return window;
}

void WindowSource::Prepare(int home_chunk) {
  const std::lock_guard lock(mutex_);
  if (windows_.contains(home_chunk) || wanted_) return;
  wanted_ = home_chunk;
  changed_.notify_all();
}

void WindowSource::BuildAhead() {
  // On Linux this lowers the calling thread alone: frames in progress come first.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || wanted_; });
    if (stopping_) return;
    const int home_chunk = *wanted_;
    std::shared_ptr<const Window> window;
    std::exception_ptr failure;
    lock.unlock();
    try {
      const std::lock_guard building(build_mutex_);
      window = Build(home_chunk);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (window != nullptr) windows_.emplace(home_chunk, std::move(window));
    failure_ = failure;
    wanted_.reset();
    changed_.notify_all();
  }
}

}  // namespace railcast
