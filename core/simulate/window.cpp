#include "core/simulate/window.h"

#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"
#include "core/scene/object_pieces.h"
#include "core/simulate/detail_choice.h"

namespace railcast {
namespace {

// Radius about the chunk's origin of all places a sensor can have in its home chunk: the chunk is
// less than 100 m long and the track at most 1 km beside the line. Generous, because an object too
// many costs one scene entry, whereas an object too few is missed.
constexpr double kHomeRadius_m = 1100.0;

Eigen::Affine3d ToAffine(const Transform& transform) {
  return Eigen::Affine3d(transform.matrix());
}

/// Index of the ground part that holds the wire's tube.
std::uint32_t PartOfWire(const Wire& wire, const Model& ground) {
  const auto part = std::find_if(ground.parts.begin(), ground.parts.end(), [&](const Part& tubes) {
    return tubes.is_wire && tubes.material == wire.material && tubes.label == wire.label;
  });
  Check(part != ground.parts.end(), "the ground holds every wire as a tube");
  return static_cast<std::uint32_t>(part - ground.parts.begin());
}

void AddWires(const SceneStore::BuiltChunk& chunk,
              const Transform& window_from_chunk,
              std::uint32_t ground_surface,
              WireSet& set) {
  for (const Wire& wire : chunk.bare->wires) {
    std::vector<Vector3> points_m = wire.points_m;
    for (Vector3& point : points_m) point = window_from_chunk * point;
    set.Add(points_m, wire.radius_m,
            ground_surface + PartOfWire(wire, chunk.bare->ground_surfaces));
  }
}

void AddSwayingWires(const SceneStore::BuiltChunk& chunk,
                     const Transform& world_from_chunk,
                     std::uint32_t ground_surface,
                     Window& window) {
  for (const Wire& wire : chunk.bare->wires) {
    window.swaying.AddWire(wire, world_from_chunk, window.window_from_world,
                           ground_surface + PartOfWire(wire, chunk.bare->ground_surfaces));
  }
}

/// Prepares the models of all objects, on all of the caller's TBB threads.
void PrepareObjects(SceneStore& store) {
  std::vector<std::shared_ptr<const Model>> distinct;
  std::unordered_set<const Model*> known;
  for (const SceneObject& object : store.world()->objects()) {
    for (std::size_t i = 0; i < NumPieces(object); ++i) {
      const std::shared_ptr<const Model>& piece = PieceOf(object, i);
      if (known.insert(piece.get()).second) distinct.push_back(piece);
    }
  }
  tbb::parallel_for(std::size_t{0}, distinct.size(),
                    [&](std::size_t i) { static_cast<void>(store.GetModel(distinct[i], true)); });
}

/// Thrown when a window that is built ahead is not needed any more.
struct Abandoned {};

/// Building the scene of all chunks counts as a step, too.
std::size_t NumSteps(std::size_t num_chunks) {
  return num_chunks + 1;
}

}  // namespace

std::shared_ptr<const TraceScene> Window::StandingAlone(const TraceDevice& device) const {
  std::call_once(standing_once_, [&] {
    standing_alone_ = std::make_shared<const TraceScene>(device, standing_placements);
  });
  return standing_alone_;
}

WindowSource::WindowSource(std::shared_ptr<SceneStore> store,
                           double range_max_m,
                           const DetailRule& detail)
    : store_(std::move(store)), range_max_m_(range_max_m), detail_(detail) {
  PrepareObjects(*store_);
  fixed_surfaces_.emplace_back();
  std::vector<std::size_t> standing;
  for (const SceneObject& object : store_->world()->objects()) {
    if (!object.moves) standing.push_back(objects_.size());
    objects_.push_back(store_->MakeObject(object));
    object_surfaces_.push_back(static_cast<std::uint32_t>(fixed_surfaces_.size()));
    const std::vector<Surface>& surfaces = objects_.back().surfaces;
    fixed_surfaces_.insert(fixed_surfaces_.end(), surfaces.begin(), surfaces.end());
  }
  purpose_.standing = std::make_shared<const std::vector<std::size_t>>(std::move(standing));
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

void WindowSource::UseStanding(std::vector<std::size_t> objects) {
  const std::lock_guard lock(mutex_);
  if (*purpose_.standing == objects) return;
  purpose_.standing = std::make_shared<const std::vector<std::size_t>>(std::move(objects));
  windows_.clear();
}

void WindowSource::UseWind(bool blows) {
  const std::lock_guard lock(mutex_);
  if (purpose_.wind_blows == blows) return;
  purpose_.wind_blows = blows;
  windows_.clear();
}

void WindowSource::UseKept(std::size_t num) {
  const std::lock_guard lock(mutex_);
  num_kept_ = num;
}

void WindowSource::UseProgress(WindowProgress progress) {
  const std::lock_guard lock(mutex_);
  purpose_.progress = std::move(progress);
}

void WindowSource::AddObjects(int home_chunk,
                              const std::vector<std::size_t>& standing,
                              Window& window) const {
  const World& world = *store_->world();
  const Vector3 home_world = world.WorldFromChunk(home_chunk).translation();
  std::unordered_map<const Model*, Eigen::AlignedBox3d> boxes;  // Many objects share a model.
  for (const std::size_t i : standing) {
    const Transform world_from_object = world.WorldFromObject(i, 0);
    const Model* const model = world.objects()[i].model.get();
    const auto [known, is_new] = boxes.try_emplace(model);
    if (is_new) known->second = model->Bounds();
    const Eigen::AlignedBox3d& box = known->second;
    if (box.isEmpty()) continue;
    const double distance_m = (world_from_object * box.center() - home_world).norm();
    if (distance_m > range_max_m_ + kHomeRadius_m + 0.5 * box.diagonal().norm()) continue;
    const std::vector<Transform> world_from_pieces = world.WorldFromPieces(i, 0);
    const std::vector<TracePiece>& pieces = *objects_[i].pieces;
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
      const Transform window_from_piece = window.window_from_world * world_from_pieces[piece];
      window.standing.push_back(i);
      window.standing_placements.push_back({pieces[piece].model,
                                            {ToAffine(window_from_piece)},
                                            object_surfaces_[i] + pieces[piece].first_surface});
    }
  }
}

template <typename Work>
void WindowSource::ForEach(std::size_t num, Pace pace, const Work& work) {
  if (pace == Pace::kAwaited) {
    // Isolated, so that a thread that waits here takes up no frame that needs this window.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, num, work); });
  } else {
    for (std::size_t i = 0; i < num; ++i) work(i);
  }
}

WindowSource::Models WindowSource::GetModels(int home_chunk,
                                             const Chunks& chunks,
                                             DetailChoice& choice,
                                             Pace pace) const {
  const World& world = *store_->world();
  const Transform window_from_world = world.WorldFromChunk(home_chunk).inverse();
  std::vector<std::shared_ptr<const Model>> distinct;
  std::unordered_map<const Model*, std::size_t> index_of;
  std::vector<std::size_t> indices;  // In `distinct`, of all placements.
  for (const auto& [index, chunk] : chunks) {
    const Eigen::Affine3d window_from_chunk =
        ToAffine(window_from_world * world.WorldFromChunk(index));
    for (const Placement& placement : chunk->placements) {
      const std::shared_ptr<const Model>& model = ModelAt(
          placement, choice.LevelOf(placement, window_from_chunk * placement.chunk_from_model));
      const auto [entry, is_new] = index_of.try_emplace(model.get(), distinct.size());
      if (is_new) distinct.push_back(model);
      indices.push_back(entry->second);
    }
  }
  Models made(distinct.size());
  ForEach(distinct.size(), pace, [&](std::size_t i) { made[i] = store_->GetModel(distinct[i]); });
  Models models;
  for (const std::size_t index : indices) models.push_back(made[index]);
  return models;
}

void WindowSource::AddChunks(const Chunks& chunks,
                             const Models& models,
                             bool wind_blows,
                             Window& window,
                             std::vector<TracePlacement>& placements) const {
  // Placements without an instance id share the surfaces of their model.
  std::map<std::pair<const Model*, std::uint32_t>, std::uint32_t> shared;
  const auto surfaces_of = [&](const Model& model, std::uint32_t instance) {
    const auto first = static_cast<std::uint32_t>(window.surfaces.size());
    for (const Part& part : model.parts) {
      window.surfaces.push_back(store_->MakeSurface(part, instance, false));
    }
    return first;
  };
  auto model = models.begin();
  for (const auto& [index, chunk] : chunks) {
    const Transform world_from_chunk = store_->world()->WorldFromChunk(index);
    const Transform window_from_chunk = window.window_from_world * world_from_chunk;
    const std::uint32_t ground_surface = surfaces_of(chunk->bare->ground_surfaces, 0);
    placements.push_back({chunk->bare->ground, {ToAffine(window_from_chunk)}, ground_surface});
    if (wind_blows) {
      AddSwayingWires(*chunk, world_from_chunk, ground_surface, window);
    } else {
      AddWires(*chunk, window_from_chunk, ground_surface, window.wires);
    }
    std::uint32_t number = 0;
    for (const Placement& placement : chunk->placements) {
      const auto key = std::pair(placement.model.get(), placement.instance);
      auto it = shared.find(key);
      if (it == shared.end()) {
        it = shared.emplace(key, surfaces_of(*placement.model, placement.instance)).first;
      }
      const Eigen::Affine3d window_from_model =
          ToAffine(window_from_chunk) * placement.chunk_from_model;
      TracePlacement placed{*model++, {window_from_model}, it->second};
      ++number;
      if (wind_blows && placement.sway_height_m > 0.0) {
        window.swaying.trees.push_back(
            {std::move(placed),
             static_cast<std::uint32_t>(placement.model->parts.size()),
             {.foot_world_m = world_from_chunk * placement.chunk_from_model.translation(),
              .height_m = placement.sway_height_m,
              .chunk = static_cast<std::uint32_t>(index),
              .number = number}});
      } else {
        placements.push_back(std::move(placed));
      }
    }
  }
  if (!window.swaying.wires.empty()) window.swaying.tube = store_->GetUnitTube();
}

WindowSource::Chunks WindowSource::GetChunks(int home_chunk,
                                             const Purpose& purpose,
                                             const DetailChoice& choice,
                                             Pace pace) {
  const World& world = *store_->world();
  const Transform window_from_world = world.WorldFromChunk(home_chunk).inverse();
  const std::vector<int> reach = world.ChunksInReach(home_chunk, range_max_m_);
  std::vector<std::shared_ptr<const SceneStore::BuiltChunk>> built(reach.size());
  std::atomic<std::size_t> num_done = 0;
  const auto get = [&](std::size_t i) {
    if (pace == Pace::kAhead && stopping_) throw Abandoned();
    purpose.progress(num_done, NumSteps(reach.size()));
    const std::size_t level = choice.LevelOf(world.CoarserSurfacesOf(reach[i]),
                                             window_from_world * world.WorldFromChunk(reach[i]));
    built[i] = store_->GetChunk({reach[i], !purpose.wind_blows, level});
    ++num_done;
  };
  ForEach(reach.size(), pace, get);
  Chunks chunks;
  for (std::size_t i = 0; i < reach.size(); ++i) chunks.emplace(reach[i], std::move(built[i]));
  return chunks;
}

std::shared_ptr<const Window> WindowSource::Build(int home_chunk,
                                                  const Purpose& purpose,
                                                  Pace pace) {
  const WindowProgress& progress = purpose.progress;
  auto window = std::make_shared<Window>();
  window->window_from_world = store_->world()->WorldFromChunk(home_chunk).inverse();
  window->surfaces = fixed_surfaces_;
  std::vector<TracePlacement> placements;
  AddObjects(home_chunk, *purpose.standing, *window);
  placements = window->standing_placements;
  DetailChoice choice(*store_->world(), home_chunk, detail_);
  window->may_be_coarser = choice.may_be_coarser();
  Chunks chunks = GetChunks(home_chunk, purpose, choice, pace);
  const std::size_t num_steps = NumSteps(chunks.size());
  progress(chunks.size(), num_steps);
  AddChunks(chunks, GetModels(home_chunk, chunks, choice, pace), purpose.wind_blows, *window,
            placements);
  window->scene = std::make_unique<TraceScene>(store_->device(), placements);
  for (const std::vector<std::uint32_t>& labels : store_->labels_of_beams()) {
    window->scene->PrepareBeams();
    if (!labels.empty()) static_cast<void>(window->scene->OnlyLabels(labels));
  }
  progress(num_steps, num_steps);
  KeepChunks(home_chunk, std::move(chunks));
  store_->ForgetUnusedModels();
  return window;
}

void WindowSource::KeepChunks(int home_chunk, Chunks chunks) {
  std::vector<Chunks> unwanted;  // Freed after the lock is released.
  const std::lock_guard lock(mutex_);
  if (IsWanted(home_chunk)) chunks_[home_chunk].swap(chunks);
  // Earlier chunks are dropped only now, because a window shares most chunks with its predecessor.
  for (auto it = chunks_.begin(); it != chunks_.end();) {
    if (IsWanted(it->first)) {
      ++it;
    } else {
      unwanted.push_back(std::move(it->second));
      it = chunks_.erase(it);
    }
  }
}

WindowSource::WindowTask WindowSource::Remember(int home_chunk, Pace pace) {
  WindowTask task(
      [this, home_chunk, purpose = purpose_, pace] { return Build(home_chunk, purpose, pace); });
  windows_.emplace(home_chunk, task.get_future().share());
  return task;
}

void WindowSource::ForgetOthers() {
  std::erase_if(windows_, [&](const auto& entry) { return !IsWanted(entry.first); });
}

std::shared_ptr<const Window> WindowSource::Get(int home_chunk) {
  std::optional<WindowTask> build;
  FutureWindow window;
  {
    const std::lock_guard lock(mutex_);
    if (in_use_ && in_use_ != home_chunk) kept_.insert(kept_.begin(), *in_use_);
    in_use_ = home_chunk;
    std::erase(kept_, home_chunk);
    if (kept_.size() > num_kept_) kept_.resize(num_kept_);
    ForgetOthers();
    if (!windows_.contains(home_chunk)) build = Remember(home_chunk, Pace::kAwaited);
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
  ahead_ = Remember(home_chunk, Pace::kAhead);
  changed_.notify_all();
}

void WindowSource::BuildAhead() {
  // On Linux this affects the calling thread only; frames in progress take precedence.
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);
  // Workers that TBB starts from this thread would have its priority for good, also in frames.
  tbb::task_arena alone(1);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || ahead_; });
    if (stopping_) return;
    lock.unlock();
    alone.execute([&] { (*ahead_)(); });
    lock.lock();
    ahead_.reset();
  }
}

}  // namespace railcast
