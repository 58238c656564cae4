#include "core/simulate/frame_scene.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "core/base/units.h"
#include "core/simulate/detail_choice.h"

namespace railcast {
namespace {

// Upper bound of the vehicle's speed, above that of any train: limits its travel within a frame.
constexpr double kSpeedMax_mps = 200.0;

// Look-ahead time for the next window, and its step: at 80 m/s, a step is shorter than a chunk.
constexpr std::int64_t kLookAhead_ns = 4'000'000'000;
constexpr std::int64_t kLookAheadStep_ns = 500'000'000;

// Maximum distance from the vehicle's position at the stamp to anything a beam of the frame may
// hit.
double SensorReachOf(const FrameSceneSpec& spec) {
  return spec.range_max_m + spec.vehicle_from_sensor.translation().norm() +
         kSpeedMax_mps * SecondsFromNs(spec.duration_ns);
}

// Whether an object bends so fast that its poses are closer than those of others: who walks.
bool BendsFast(const SceneObject& object) {
  return object.moves && !object.pieces.empty() && object.pose_step_ns < SceneObject{}.pose_step_ns;
}

std::vector<Eigen::Affine3d> PiecesIn(const World& world,
                                      std::size_t object,
                                      std::int64_t time_ns,
                                      const Transform& window_from_world) {
  std::vector<Eigen::Affine3d> places;
  for (const Transform& world_from_piece : world.WorldFromPieces(object, time_ns)) {
    const Transform window_from_piece = window_from_world * world_from_piece;
    places.emplace_back(window_from_piece.matrix());
  }
  return places;
}

// The box around an object in a window during a frame. What happens to it between the ends of the
// frame is not known: the margin is more than what a curve, a corner or rough ground moves it.
Eigen::AlignedBox3f BoxBetween(const Eigen::AlignedBox3d& bounds_m,
                               const Transform& begin,
                               const Transform& end) {
  constexpr double kMargin_m = 0.05;
  const double margin_m = kMargin_m + 0.5 * (end.translation() - begin.translation()).norm();
  Eigen::AlignedBox3d box_m = bounds_m.transformed(begin).merged(bounds_m.transformed(end));
  box_m.min().array() -= margin_m;
  box_m.max().array() += margin_m;
  return box_m.cast<float>();
}

}  // namespace

void LoneObjects::AddHits(const RayTile& rays,
                          std::size_t first,
                          std::vector<ObjectHits>& hits) const {
  std::vector<PlacementHits> pieces;
  scene->CastThrough(rays, first, pieces);
  const auto num_before = static_cast<std::ptrdiff_t>(hits.size());
  for (const PlacementHits& piece : pieces) {
    if (piece.placement >= objects.size()) continue;
    const std::size_t object = objects[piece.placement];
    // A ray that goes through several pieces of an object hits it once.
    const auto known = std::find_if(hits.begin() + num_before, hits.end(),
                                    [=](const ObjectHits& hit) { return hit.object == object; });
    if (known == hits.end()) {
      hits.push_back({object, piece.lanes});
    } else {
      known->lanes |= piece.lanes;
    }
  }
}

void FrameScene::Cast(RayTile& rays) const {
  window->scene->Cast(rays);
  if (moving != nullptr) moving->Cast(rays);
}

void FrameScene::CastBeam(BeamRays& beam) const {
  window->scene->CastBeam(beam);
  if (moving != nullptr) moving->CastBeam(beam);
}

bool FrameScene::NeedsWidth(const BeamRays& beam) const {
  return wide.empty() ||
         std::ranges::any_of(wide, [&](const BeamScenes& scenes) { return MayMeet(scenes, beam); });
}

void FrameScene::CastRanges(RayTile& rays) const {
  window->scene->CastRanges(rays);
  if (moving != nullptr) moving->CastRanges(rays);
}

FrameScenes::FrameScenes(std::shared_ptr<SceneStore> store, const FrameSceneSpec& spec)
    : store_(std::move(store)), spec_(spec), windows_(store_, SensorReachOf(spec), spec.detail) {
  UseWorld(store_->world());
}

void FrameScenes::UseWorld(std::shared_ptr<const World> world) {
  if (world == world_) return;
  std::map<std::uint32_t, std::size_t> known;  // Object index by instance id.
  const std::vector<SceneObject>& first = store_->world()->objects();
  for (std::size_t i = 0; i < first.size(); ++i) known.emplace(first[i].instance, i);

  std::vector<Object> objects;
  std::vector<Surface> more_surfaces;
  std::map<std::size_t, std::size_t> standing;
  for (const SceneObject& object : world->objects()) {
    const auto found = known.find(object.instance);
    if (found != known.end() && first[found->second].model == object.model) {
      const std::size_t i = found->second;
      const bool stands = !object.moves && !first[i].moves;
      if (stands) standing.emplace(i, objects.size());
      objects.push_back({windows_.object(i), windows_.object_surface(i), true, stands, {}});
      continue;
    }
    objects.push_back({store_->MakeObject(object),
                       static_cast<std::uint32_t>(more_surfaces.size()),
                       false,
                       false,
                       {}});
    const std::vector<Surface>& surfaces = objects.back().stored.surfaces;
    more_surfaces.insert(more_surfaces.end(), surfaces.begin(), surfaces.end());
  }
  std::vector<std::size_t> stored;
  for (const auto& [i, object] : standing) stored.push_back(i);
  windows_.UseStanding(std::move(stored));
  standing_ = std::move(standing);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SceneObject& object = world->objects()[i];
    if (BendsFast(object)) objects[i].figure_bounds_m = object.model->Bounds();
  }
  objects_ = std::move(objects);
  more_surfaces_ = std::move(more_surfaces);
  world_ = std::move(world);
  store_->ForgetUnusedModels();
}

void FrameScenes::UseWind(const Wind& wind) {
  wind_ = wind;
  windows_.UseWind(wind.blows());
}

std::unique_ptr<FrameScenes> FrameScenes::InFullDetail() const {
  FrameSceneSpec spec = spec_;
  spec.detail = {};
  auto full = std::make_unique<FrameScenes>(store_, spec);
  full->UseWorld(world_);
  full->UseWind(wind_);
  full->has_motion_ = has_motion_;
  full->has_texture_ = has_texture_;
  full->footprint_labels_ = footprint_labels_;
  full->last_stamp_ns_ = last_stamp_ns_;
  // If two frames are made at once, the earlier one may be begun last.
  full->KeepWindows(1);
  return full;
}

BegunFrame FrameScenes::Begin(std::uint32_t index, std::int64_t stamp_ns) {
  const int home_chunk = world_->HomeChunk(stamp_ns);
  BegunFrame begun{index, stamp_ns, windows_.Get(home_chunk)};
  PrepareNextWindow(stamp_ns, home_chunk);
  return begun;
}

const FrameScene& FrameScenes::SceneOf(BegunFrame& begun) const {
  if (begun.scene == nullptr) begun.scene = MakeScene(begun);
  return *begun.scene;
}

std::unique_ptr<const FrameScene> FrameScenes::MakeScene(const BegunFrame& begun) const {
  const std::shared_ptr<const Window>& window = begun.window;
  const std::int64_t stamp_ns = begun.stamp_ns;
  auto made = std::make_unique<FrameScene>();
  FrameScene& scene = *made;
  scene.index = begun.index;
  scene.stamp_ns = stamp_ns;
  MovingThings moving = MovingObjects(stamp_ns, *window);
  scene.moving_objects = std::move(moving.objects);
  if (has_motion_) scene.motion = MotionOf(scene, *window);
  if (has_texture_) scene.textured = TexturedOf(scene, *window);
  if (!more_surfaces_.empty()) {
    scene.more_surfaces = window->surfaces;
    scene.more_surfaces.insert(scene.more_surfaces.end(), more_surfaces_.begin(),
                               more_surfaces_.end());
  }
  if (wind_.blows()) AddSwayed(scene, *window, moving.placements);
  if (!moving.placements.empty() || !moving.figures.figures.empty()) {
    scene.moving = std::make_shared<const TraceScene>(store_->device(), moving.placements,
                                                      std::move(moving.figures));
  }
  scene.poses = PosesIn(window->window_from_world, stamp_ns);
  scene.window = window;
  if (!footprint_labels_.empty()) {
    scene.wide.push_back(window->scene->OnlyLabels(footprint_labels_));
    if (scene.moving != nullptr) scene.wide.push_back(scene.moving->OnlyLabels(footprint_labels_));
  }
  return made;
}

void FrameScenes::AddSwayed(FrameScene& scene,
                            const Window& window,
                            std::vector<TracePlacement>& placements) const {
  SwayedThings swayed = Swayed(scene.stamp_ns, window);
  std::ranges::move(swayed.placements, std::back_inserter(placements));
  scene.swayed_wires = std::move(swayed.wires);
  if (!scene.motion || swayed.own_surfaces.empty()) return;
  if (scene.more_surfaces.empty()) scene.more_surfaces = window.surfaces;
  for (const std::uint32_t copied : swayed.own_surfaces) {
    scene.more_surfaces.push_back(window.surfaces[copied]);
  }
  scene.motion->surfaces.Add(std::move(swayed.motions));
}

FrameMotion FrameScenes::MotionOf(const FrameScene& scene, const Window& window) const {
  // As FramePoses, whose knots are as far apart.
  constexpr std::int64_t kKnotSpacing_ns = 10'000'000;
  FrameMotion motion;
  motion.sensor =
      VelocityFieldsOf(
          [&](std::int64_t since_stamp_ns) {
            const Transform window_from_sensor =
                window.window_from_world * WorldFromSensor(scene.stamp_ns + since_stamp_ns);
            return std::vector<Eigen::Affine3d>{Eigen::Affine3d(window_from_sensor.matrix())};
          },
          spec_.duration_ns, (spec_.duration_ns + kKnotSpacing_ns - 1) / kKnotSpacing_ns)
          .front();
  std::vector<std::size_t> objects = scene.moving_objects;
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
  std::erase_if(objects, [&](std::size_t object) { return !world_->objects()[object].moves; });
  std::vector<std::vector<VelocityFields>> fields(objects.size());
  tbb::parallel_for(std::size_t{0}, objects.size(), [&](std::size_t i) {
    fields[i] = VelocityFieldsOf(
        [&](std::int64_t since_stamp_ns) {
          return PiecesAt(objects[i], scene.stamp_ns + since_stamp_ns, window);
        },
        spec_.duration_ns, NumOwnIntervals(objects[i]));
  });
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& object = objects_[objects[i]];
    const std::uint32_t first_surface = FirstSurface(object, window);
    auto end = static_cast<std::uint32_t>(object.stored.surfaces.size());
    for (std::size_t piece = fields[i].size(); piece-- > 0;) {
      const std::uint32_t begin = (*object.stored.pieces)[piece].first_surface;
      motion.surfaces.Add({.first_surface = first_surface + begin,
                           .num_surfaces = end - begin,
                           .fields = std::move(fields[i][piece])});
      end = begin;
    }
  }
  return motion;
}

TexturedThings FrameScenes::TexturedOf(const FrameScene& scene, const Window& window) const {
  std::set<std::size_t> objects(scene.moving_objects.begin(), scene.moving_objects.end());
  for (const std::size_t stored : window.standing) objects.insert(standing_.at(stored));
  TexturedThings textured;
  for (const std::size_t i : objects) {
    const Object& object = objects_[i];
    if (!store_->HasTexture(object.stored.surfaces)) continue;
    const std::vector<TracePiece>& pieces = *object.stored.pieces;
    std::vector<std::vector<CellField>> fields(pieces.size());
    const std::int64_t num_intervals = NumOwnIntervals(i);
    for (std::int64_t step = 0; step <= num_intervals; ++step) {
      const std::int64_t since_stamp_ns =
          std::int64_t{spec_.duration_ns} * step / std::max<std::int64_t>(num_intervals, 1);
      const auto places = PiecesAt(i, scene.stamp_ns + since_stamp_ns, window);
      for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        fields[piece].push_back(CellsFromWindow(places[piece].inverse()).cast<float>());
      }
    }
    auto end = static_cast<std::uint32_t>(object.stored.surfaces.size());
    for (std::size_t piece = pieces.size(); piece-- > 0;) {
      const std::uint32_t begin = pieces[piece].first_surface;
      textured.Add(FirstSurface(object, window) + begin, end - begin, fields[piece]);
      end = begin;
    }
  }
  return textured;
}

FramePoses FrameScenes::PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const {
  return FramePoses(spec_.duration_ns, [&](std::uint32_t time_ns) {
    return window_from_world * WorldFromSensor(stamp_ns + time_ns);
  });
}

std::vector<TracePlacement> FrameScenes::Place(std::size_t object,
                                               std::int64_t stamp_ns,
                                               const Window& window) const {
  const std::uint32_t first_surface = FirstSurface(objects_[object], window);
  std::vector<TracePlacement> placements;
  for (const TracePiece& piece : *objects_[object].stored.pieces) {
    placements.push_back({piece.model, {}, first_surface + piece.first_surface});
  }
  const std::int64_t duration_ns = spec_.duration_ns;
  const std::int64_t num_intervals = NumOwnIntervals(object);
  for (std::int64_t step = 0; step <= num_intervals; ++step) {
    const std::int64_t since_stamp_ns = num_intervals > 0 ? duration_ns * step / num_intervals : 0;
    const std::vector<Eigen::Affine3d> places = PiecesAt(object, stamp_ns + since_stamp_ns, window);
    for (std::size_t i = 0; i < placements.size(); ++i) {
      placements[i].window_from_model.push_back(places[i]);
    }
  }
  return placements;
}

std::vector<Eigen::Affine3d> FrameScenes::PiecesAt(std::size_t object,
                                                   std::int64_t time_ns,
                                                   const Window& window) const {
  return PiecesIn(*world_, object, time_ns, window.window_from_world);
}

std::int64_t FrameScenes::NumPoseIntervals(std::int64_t pose_step_ns) const {
  return std::max<std::int64_t>(1, (spec_.duration_ns + pose_step_ns - 1) / pose_step_ns);
}

std::int64_t FrameScenes::NumOwnIntervals(std::size_t object) const {
  const SceneObject& its = world_->objects()[object];
  return its.moves ? NumPoseIntervals(its.pose_step_ns) : 0;
}

bool FrameScenes::IsInReach(std::size_t object, const Ends& ends, const Moment& moment) const {
  const double travel_m =
      (ends.end_m - ends.begin_m).norm() + kSpeedMax_mps * SecondsFromNs(spec_.duration_ns);
  // The first piece's origin may be up to the object's radius away from the object's own.
  return (ends.begin_m - moment.sensor.begin_m).norm() <=
         spec_.range_max_m + 2.0 * objects_[object].stored.radius_m + travel_m;
}

FrameScenes::PlacedObject FrameScenes::PlaceInReach(std::size_t object,
                                                    const Moment& moment) const {
  if (objects_[object].is_in_windows) return {};
  if (moment.window.may_be_coarser && objects_[object].figure_bounds_m) {
    return PlaceFigure(object, moment);
  }
  PlacedObject placed{{}, Place(object, moment.stamp_ns, moment.window)};
  const auto& steps = placed.pieces.front().window_from_model;
  const Ends ends{steps.front().translation(), steps.back().translation()};
  return IsInReach(object, ends, moment) ? placed : PlacedObject{};
}

FrameScenes::PlacedObject FrameScenes::PlaceFigure(std::size_t object, const Moment& moment) const {
  const Object& its = objects_[object];
  const auto place = [&](std::int64_t time_ns) -> Transform {
    return moment.window.window_from_world * world_->WorldFromObject(object, time_ns);
  };
  const Transform begin = place(moment.stamp_ns);
  const Transform end = place(moment.stamp_ns + spec_.duration_ns);
  const Ends ends{begin.translation(), end.translation()};
  if (!IsInReach(object, ends, moment)) return {};
  const double distance_m = std::min((ends.begin_m - moment.sensor.begin_m).norm(),
                                     (ends.end_m - moment.sensor.end_m).norm()) -
                            its.stored.radius_m;
  const std::int64_t num_intervals = NumPoseIntervals(
      CoarserPoseStep_ns(spec_.detail, distance_m, world_->objects()[object].pose_step_ns));
  if (num_intervals == NumOwnIntervals(object)) {
    return {{}, Place(object, moment.stamp_ns, moment.window)};
  }
  return {TraceFigure{.pieces = its.stored.pieces,
                      .window_box_m = BoxBetween(*its.figure_bounds_m, begin, end),
                      .num_steps = static_cast<std::uint32_t>(num_intervals + 1),
                      .first_surface = FirstSurface(its, moment.window)},
          {}};
}

FrameScenes::MovingThings FrameScenes::MovingObjects(std::int64_t stamp_ns,
                                                     const Window& window) const {
  const Moment moment{
      stamp_ns,
      window,
      {SensorInWindow(stamp_ns, window), SensorInWindow(stamp_ns + spec_.duration_ns, window)}};
  std::vector<PlacedObject> placed(objects_.size());
  constexpr std::size_t kGrain = 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, objects_.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& some) {
                      for (std::size_t i = some.begin(); i < some.end(); ++i) {
                        placed[i] = PlaceInReach(i, moment);
                      }
                    });
  MovingThings moving;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i].figure) continue;
    moving.figures.figures.push_back(std::move(*placed[i].figure));
    moving.objects.push_back(i);
  }
  // It lasts as long as the scene, and longer than the world may be in use here.
  moving.figures.window_from_pieces =
      [world = world_, objects = moving.objects, stamp_ns,
       duration_ns = std::int64_t{spec_.duration_ns}, window_from_world = window.window_from_world](
          std::size_t figure, std::int64_t step, std::int64_t num_steps) {
        return PiecesIn(*world, objects[figure], stamp_ns + duration_ns * step / (num_steps - 1),
                        window_from_world);
      };
  for (std::size_t i = 0; i < placed.size(); ++i) {
    moving.objects.insert(moving.objects.end(), placed[i].pieces.size(), i);
    std::ranges::move(placed[i].pieces, std::back_inserter(moving.placements));
  }
  return moving;
}

SwayedThings FrameScenes::Swayed(std::int64_t stamp_ns, const Window& window) const {
  const double duration_s = SecondsFromNs(spec_.duration_ns);
  return Sway(window.swaying, wind_,
              {.stamp_s = SecondsFromNs(stamp_ns),
               .duration_s = duration_s,
               .window_from_world = window.window_from_world,
               .sensor_window_m = SensorInWindow(stamp_ns, window),
               .reach_m = spec_.range_max_m + kSpeedMax_mps * duration_s,
               .first_own_surface = FirstOwnSurface(window)});
}

std::vector<LoneObjects> FrameScenes::ObjectsAlone(const FrameScene& frame) const {
  std::vector<LoneObjects> alone;
  const Window& window = *frame.window;
  if (!window.standing.empty()) {
    alone.push_back({window.StandingAlone(store_->device()), {}});
    for (const std::size_t stored : window.standing) {
      alone.back().objects.push_back(standing_.at(stored));
    }
  }
  if (frame.moving_objects.empty()) return alone;
  alone.push_back({frame.moving, frame.moving_objects});
  if (wind_.blows()) {
    // Rays would go through all leaves that sway.
    MovingThings moving = MovingObjects(frame.stamp_ns, window);
    alone.back().scene = std::make_shared<const TraceScene>(store_->device(), moving.placements,
                                                            std::move(moving.figures));
  }
  return alone;
}

void FrameScenes::PrepareNextWindow(std::int64_t stamp_ns, int home_chunk) {
  for (std::int64_t ahead_ns = kLookAheadStep_ns; ahead_ns <= kLookAhead_ns;
       ahead_ns += kLookAheadStep_ns) {
    const int next = world_->HomeChunk(std::min(stamp_ns + ahead_ns, last_stamp_ns_));
    if (next == home_chunk) continue;
    windows_.Prepare(next);
    return;
  }
}

}  // namespace railcast
