#include "core/trace/trace_scene.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/trace/beam_kernels.h"
#include "core/trace/embree.h"
#include "core/trace/trace_handles.h"
#include "railcast/lidar.h"

namespace railcast {

static_assert(kTileSize % kPacketSize == 0);

namespace {

/// Columns of a rotation, padded so that each can be loaded as one vector.
struct alignas(16) RotationColumns {
  float x[4], y[4], z[4];
};

/// Data of one instance needed to resolve hits on it.
struct InstanceRecord {
  RotationColumns rotation;         ///< window_from_model at shutter 0.
  RotationColumns rotation_change;  ///< Its change until shutter 1; 0 if stationary.
  std::uint32_t first_surface{};
  bool moves{};
};

RotationColumns ToColumns(const Eigen::Matrix3d& matrix) {
  RotationColumns columns{};
  for (int row = 0; row < 3; ++row) {
    columns.x[row] = static_cast<float>(matrix(row, 0));
    columns.y[row] = static_cast<float>(matrix(row, 1));
    columns.z[row] = static_cast<float>(matrix(row, 2));
  }
  return columns;
}

Rows RowsOf(const Eigen::Matrix<float, 3, 4>& matrix) {
  Rows rows{};
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(rows.m) = matrix;
  return rows;
}

}  // namespace

struct TraceScene::Parts {
  std::shared_ptr<TraceDevice::Handle> device;
  // Referenced by the scene; kept alive here.
  std::vector<std::shared_ptr<const TraceModel>> models;  ///< By placement.
  std::unique_ptr<const PosedFigures> figures;            ///< Null if there are none.
  std::vector<InstanceRecord> instances;  ///< Instances of figures, then of placements.
  RTCScene scene{};
  bool has_foliage = false;

  std::vector<Rows> steps;               ///< Places of all placements, one after another.
  std::vector<std::uint32_t> num_steps;  ///< By placement.

  Parts() = default;
  ~Parts() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void AttachFigures(TraceFigures those);
  void AttachInstance(const TracePlacement& placement);
  void StoreHits(const RTCRayHit16& packet, RayTile& tile, std::size_t first) const;
  /// Placed models for beams: all but wires, or wires.
  struct Beams {
    BeamTree tree;
    std::vector<BeamInstance> instances;
    std::vector<BeamBox> moving_boxes;  ///< Boxes of moving ones, at each of their steps.
    BeamScene scene;
  };
  struct BeamParts {
    Beams solid;
    Beams wires;
  };
  /// They are built, with the models' trees, when they are first needed.
  [[nodiscard]] const BeamParts& beams() const;
  /// The parts that are surfaces with these labels, also built when they are first needed.
  [[nodiscard]] const BeamParts& beams_of(const std::vector<std::uint32_t>& labels) const;

 private:
  /// A model and its places, as beams need them.
  struct BeamPlace {
    const TraceModel* model{};
    std::uint32_t first_surface{};
    const Rows* steps{};
    std::uint32_t num_steps{};
  };
  [[nodiscard]] std::vector<BeamPlace> BeamPlaces() const;
  [[nodiscard]] BeamParts BuildBeams(const LabelsOfBeams& labels) const;
  void BuildBeams(const LabelsOfBeams& labels, BeamTree BeamTrees::*tree_of, Beams& beams) const;

  mutable std::once_flag beams_once_;
  mutable std::vector<Rows> figure_steps_;  ///< Places of their pieces, for beams.
  mutable std::vector<BeamPlace> beam_places_;
  mutable BeamParts beams_;
  mutable std::mutex beams_by_labels_mutex_;
  mutable std::map<std::vector<std::uint32_t>, BeamParts> beams_by_labels_;
};

void TraceScene::Parts::AttachFigures(TraceFigures those) {
  if (those.figures.empty()) return;
  figures = std::make_unique<const PosedFigures>(std::move(those));
  figures->AttachTo(device->device, scene);
  for (const TraceFigure& figure : figures->figures()) {
    instances.push_back({.rotation = ToColumns(Eigen::Matrix3d::Identity()),
                         .rotation_change = {},
                         .first_surface = figure.first_surface,
                         .moves = false});
  }
}

void TraceScene::Parts::AttachInstance(const TracePlacement& placement) {
  const auto& places = placement.window_from_model;
  Check(!places.empty(), "a placement has a place");
  const OwnedGeometry owned = NewGeometry(device->device, RTC_GEOMETRY_TYPE_INSTANCE);
  RTCGeometry geometry = owned.get();
  rtcSetGeometryInstancedScene(geometry, placement.model->handle().scene);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(places.size()));
  for (std::size_t step = 0; step < places.size(); ++step) {
    const Eigen::Matrix<float, 3, 4> matrix = places[step].matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(geometry, static_cast<unsigned>(step), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            matrix.data());
    steps.push_back(RowsOf(matrix));
  }
  num_steps.push_back(static_cast<std::uint32_t>(places.size()));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(instances.size()));

  const Eigen::Matrix3d begin = places.front().linear();
  const Eigen::Matrix3d change = places.back().linear() - begin;
  instances.push_back(InstanceRecord{.rotation = ToColumns(begin),
                                     .rotation_change = ToColumns(change),
                                     .first_surface = placement.first_surface,
                                     .moves = !change.isZero(0.0)});
  models.push_back(placement.model);
  has_foliage = has_foliage || placement.model->handle().is_foliage;
}

TraceScene::TraceScene(const TraceDevice& device,
                       const std::vector<TracePlacement>& placements,
                       TraceFigures figures) {
  auto parts = std::make_unique<Parts>();
  parts->device = device.handle();
  const auto doing = [&] {
    return "building a scene for ray tracing (" + std::to_string(placements.size()) + " places)";
  };
  BuildScene(parts->device->device, kWatertight, parts->scene, doing, [&] {
    parts->AttachFigures(std::move(figures));
    for (const TracePlacement& placement : placements) parts->AttachInstance(placement);
  });
  parts_ = std::move(parts);
}

TraceScene::~TraceScene() = default;

namespace {

// The box around a model at one of its places. Between two of them, Embree interpolates the matrix
// linearly, so that every point stays on the straight line between its ends.
Eigen::AlignedBox3f BoxOf(const Eigen::AlignedBox3f& model, const Rows& step) {
  Eigen::AlignedBox3f box;
  if (model.isEmpty()) return box;
  const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> rows(step.m);
  for (int k = 0; k < 8; ++k) {
    const auto corner = static_cast<Eigen::AlignedBox3f::CornerType>(k);
    box.extend(rows.leftCols<3>() * model.corner(corner) + rows.col(3));
  }
  constexpr float kRounding_m = 1e-3F;  // float32 is ten times as exact at 1 km.
  box.extend((box.min().array() - kRounding_m).matrix());
  box.extend((box.max().array() + kRounding_m).matrix());
  return box;
}

BeamBox ToBeamBox(const Eigen::AlignedBox3f& box) {
  return {{box.min().x(), box.min().y(), box.min().z()},
          {box.max().x(), box.max().y(), box.max().z()}};
}

// Leaning trees are not, though interpolating their matrices shortens them by some 1e-5.
bool IsStretched(const Rows& rows) {
  constexpr float kNearlyEqual = 1.01F;
  float least = std::numeric_limits<float>::infinity();
  float greatest = 0.0F;
  for (int column = 0; column < 3; ++column) {
    const float norm2 = rows.m[column] * rows.m[column] + rows.m[4 + column] * rows.m[4 + column] +
                        rows.m[8 + column] * rows.m[8 + column];
    least = std::min(least, norm2);
    greatest = std::max(greatest, norm2);
  }
  return greatest > kNearlyEqual * least;
}

Rows InverseOf(const Rows& rows) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  using Matrix = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
  transform.matrix().topRows<3>() = Eigen::Map<const Matrix>(rows.m).cast<double>();
  Rows inverse{};
  Eigen::Map<Matrix>(inverse.m) = transform.inverse().matrix().topRows<3>().cast<float>();
  return inverse;
}

}  // namespace

std::vector<TraceScene::Parts::BeamPlace> TraceScene::Parts::BeamPlaces() const {
  std::vector<BeamPlace> places;
  const std::size_t num_figures = instances.size() - models.size();
  const Rows* next = steps.data();
  for (std::size_t i = 0; i < models.size(); ++i) {
    places.push_back(
        {models[i].get(), instances[num_figures + i].first_surface, next, num_steps[i]});
    next += num_steps[i];
  }
  if (figures == nullptr) return places;
  std::size_t num_rows = 0;
  for (const TraceFigure& figure : figures->figures()) {
    num_rows += figure.pieces->size() * figure.num_steps;
  }
  figure_steps_.clear();
  figure_steps_.reserve(num_rows);  // They are pointed to.
  for (std::size_t i = 0; i < num_figures; ++i) {
    const TraceFigure& figure = figures->figures()[i];
    for (std::size_t piece = 0; piece < figure.pieces->size(); ++piece) {
      const auto& [model, first_surface] = (*figure.pieces)[piece];
      places.push_back({model.get(), figure.first_surface + first_surface,
                        figure_steps_.data() + figure_steps_.size(), figure.num_steps});
      for (std::uint32_t step = 0; step < figure.num_steps; ++step) {
        figure_steps_.push_back(RowsOf(figures->PoseAt(i, step).pieces[piece].window_from_piece));
      }
    }
  }
  return places;
}

void TraceScene::Parts::BuildBeams(const LabelsOfBeams& labels,
                                   BeamTree BeamTrees::*tree_of,
                                   Beams& beams) const {
  std::size_t num_moving_boxes = 0;
  for (const BeamPlace& place : beam_places_) {
    num_moving_boxes += place.num_steps > 1 ? place.num_steps : 0;
  }
  beams.moving_boxes.reserve(num_moving_boxes);  // They are pointed to.
  std::vector<Eigen::AlignedBox3f> boxes;
  for (const BeamPlace& place : beam_places_) {
    const BeamTree& tree = place.model->handle().beam_trees(labels).*tree_of;
    Eigen::AlignedBox3f& box = boxes.emplace_back();
    const BeamBox* const first_box = beams.moving_boxes.data() + beams.moving_boxes.size();
    for (std::uint32_t step = 0; step < place.num_steps; ++step) {
      const Eigen::AlignedBox3f at_step = BoxOf(tree.bounds(), place.steps[step]);
      box.extend(at_step);
      if (place.num_steps > 1) beams.moving_boxes.push_back(ToBeamBox(at_step));
    }
    beams.instances.push_back({.root = tree.root(),
                               .first_surface = place.first_surface,
                               .num_steps = place.num_steps,
                               .is_stretched = IsStretched(place.steps[0]),
                               .window_from_model = place.steps,
                               .model_from_window = InverseOf(place.steps[0]),
                               .window_boxes = place.num_steps > 1 ? first_box : nullptr});
  }
  const auto doing = [this] {
    return "building a scene for tracing beams (" + std::to_string(instances.size()) + " places)";
  };
  BuildWithEmbree(device->device, doing,
                  [&] { beams.tree = BuildSceneTree(device->device, boxes); });
  beams.scene = {beams.tree.root(), beams.instances.data()};
}

TraceScene::Parts::BeamParts TraceScene::Parts::BuildBeams(const LabelsOfBeams& labels) const {
  // Isolated, so that a thread that waits here does not take up a tile of the frame that needs this
  // scene.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, beam_places_.size(), [&](std::size_t i) {
      static_cast<void>(beam_places_[i].model->handle().beam_trees(labels));
    });
  });
  BeamParts parts;
  BuildBeams(labels, &BeamTrees::solid, parts.solid);
  BuildBeams(labels, &BeamTrees::wires, parts.wires);
  return parts;
}

const TraceScene::Parts::BeamParts& TraceScene::Parts::beams() const {
  std::call_once(beams_once_, [this] {
    beam_places_ = BeamPlaces();
    beams_ = BuildBeams(std::nullopt);
  });
  return beams_;
}

const TraceScene::Parts::BeamParts& TraceScene::Parts::beams_of(
    const std::vector<std::uint32_t>& labels) const {
  static_cast<void>(beams());  // Which finds the places.
  const std::scoped_lock lock(beams_by_labels_mutex_);
  const auto known = beams_by_labels_.find(labels);
  if (known != beams_by_labels_.end()) return known->second;
  return beams_by_labels_.emplace(labels, BuildBeams(labels)).first->second;
}

void TraceScene::CastBeam(BeamRays& beam) const {
  CastBeamWith(AvailableBeamKernels().back(), beam);
}

void TraceScene::CastBeamWith(const BeamKernel& kernel, BeamRays& beam) const {
  const Parts::BeamParts& beams = parts_->beams();
  if ((beam.mask & ~kWireSurfaces) != 0) kernel.trace(beams.solid.scene, beam);
  if ((beam.mask & kWireSurfaces) != 0) kernel.trace(beams.wires.scene, beam);
}

void TraceScene::PrepareBeams() const {
  static_cast<void>(parts_->beams());
}

BeamScenes TraceScene::OnlyLabels(const std::vector<std::uint32_t>& labels) const {
  const Parts::BeamParts& beams = parts_->beams_of(labels);
  return {beams.solid.scene, beams.wires.scene};
}

bool MayMeet(const BeamScenes& scenes, const BeamRays& beam) {
  const BeamKernel& kernel = AvailableBeamKernels().back();
  return ((beam.mask & ~kWireSurfaces) != 0 && kernel.may_meet(scenes.solid, beam)) ||
         ((beam.mask & kWireSurfaces) != 0 && kernel.may_meet(scenes.wires, beam));
}

void TraceScene::Parts::StoreHits(const RTCRayHit16& packet,
                                  RayTile& tile,
                                  std::size_t first) const {
  for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    const std::size_t ray = first + lane;
    const InstanceRecord& instance = instances[packet.hit.instID[0][lane]];
    // Embree returns the normal in the model's frame and not normalised.
    const float nx = packet.hit.Ng_x[lane];
    const float ny = packet.hit.Ng_y[lane];
    const float nz = packet.hit.Ng_z[lane];
    float normal[4];
    for (int i = 0; i < 4; ++i) {
      normal[i] =
          instance.rotation.x[i] * nx + instance.rotation.y[i] * ny + instance.rotation.z[i] * nz;
    }
    if (instance.moves) {
      const float shutter = tile.shutter[ray];
      for (int i = 0; i < 4; ++i) {
        normal[i] +=
            shutter * (instance.rotation_change.x[i] * nx + instance.rotation_change.y[i] * ny +
                       instance.rotation_change.z[i] * nz);
      }
    }
    tile.range_m[ray] = packet.ray.tfar[lane];
    tile.normal_x[ray] = normal[0];
    tile.normal_y[ray] = normal[1];
    tile.normal_z[ray] = normal[2];
    tile.surface[ray] = instance.first_surface + geometry;
  }
}

namespace {

void LoadRays(const RayTile& tile, std::size_t first, RTCRayHit16& packet) {
  constexpr std::size_t kBytes = kPacketSize * sizeof(float);
  std::memcpy(packet.ray.org_x, tile.origin_x + first, kBytes);
  std::memcpy(packet.ray.org_y, tile.origin_y + first, kBytes);
  std::memcpy(packet.ray.org_z, tile.origin_z + first, kBytes);
  std::memcpy(packet.ray.dir_x, tile.direction_x + first, kBytes);
  std::memcpy(packet.ray.dir_y, tile.direction_y + first, kBytes);
  std::memcpy(packet.ray.dir_z, tile.direction_z + first, kBytes);
  std::memcpy(packet.ray.time, tile.shutter + first, kBytes);
  std::memcpy(packet.ray.tfar, tile.range_m + first, kBytes);
  std::memset(packet.ray.tnear, 0, kBytes);
  std::memset(packet.ray.flags, 0, kBytes);
  // Needed because Debian's Embree is built with ray masks.
  std::fill_n(packet.ray.mask, kPacketSize, tile.mask);
  std::memset(packet.hit.geomID, 0xFF, kBytes);
  std::memset(packet.hit.instID, 0xFF, kBytes);
}

// What Embree is told about the rays of a packet. Neighbouring rays part among leaves: there it is
// faster not to follow them through the scene together. Ranges are the same but for their last
// bits; of coplanar faces, another one may be hit.
Coherence CoherenceOf(bool has_foliage) {
  return has_foliage ? Coherence::kIncoherent : Coherence::kCoherent;
}

// Traces a tile packet by packet and passes each to `store(packet, first_ray)`.
template <typename Store>
void TracePackets(RTCScene scene, Coherence coherence, const RayTile& tile, const Store& store) {
  RayQueryContext context;
  InitContext(context);
  RayQuery query(context, coherence, nullptr);
  alignas(64) int valid[kPacketSize];
  std::fill_n(valid, kPacketSize, -1);
  for (std::size_t first = 0; first < tile.num_rays; first += kPacketSize) {
    alignas(64) RTCRayHit16 packet;
    LoadRays(tile, first, packet);
    query.Intersect16(valid, scene, packet);
    store(packet, first);
  }
}

/// Collects what a packet hits.
struct CollectingContext : RayQueryContext {
  const float* range_m;  ///< Ranges of the packet's rays.
  std::vector<PlacementHits>* hits;
};

void Collect(std::uint32_t placement, std::uint32_t lane_bit, std::vector<PlacementHits>& hits) {
  // Mostly, further triangles of the same placement.
  const auto found = std::find_if(hits.rbegin(), hits.rend(), [&](const PlacementHits& each) {
    return each.placement == placement;
  });
  if (found != hits.rend()) {
    found->lanes |= lane_bit;
  } else {
    hits.push_back({placement, lane_bit});
  }
}

// Takes note of hits and rejects them, so that the rays go on.
void CollectAndGoOn(const RTCFilterFunctionNArguments* args) {
  const auto& context =
      static_cast<const CollectingContext&>(static_cast<const RayQueryContext&>(*args->context));
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    args->valid[i] = 0;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    if (!(RTCRayN_tfar(args->ray, args->N, i) < context.range_m[lane])) continue;
    Collect(RTCHitN_instID(args->hit, args->N, i, 0), 1U << lane, *context.hits);
  }
}

}  // namespace

void TraceScene::CastThrough(const RayTile& tile,
                             std::size_t first,
                             std::vector<PlacementHits>& hits) const {
  hits.clear();
  if (parts_->instances.empty()) return;
  CollectingContext context{{}, tile.range_m + first, &hits};
  InitContext(context);
  // Few rays of a packet meet one object: this saves a third of what following them together takes.
  RayQuery query(context, Coherence::kIncoherent, &CollectAndGoOn);
  alignas(64) int valid[kPacketSize];
  std::fill_n(valid, kPacketSize, -1);
  alignas(64) RTCRayHit16 packet;
  LoadRays(tile, first, packet);
  for (unsigned lane = 0; lane < kPacketSize; ++lane) packet.ray.id[lane] = lane;
  query.Intersect16(valid, parts_->scene, packet);
}

void TraceScene::Cast(RayTile& tile) const {
  if (parts_->instances.empty()) return;
  TracePackets(parts_->scene, CoherenceOf(parts_->has_foliage), tile,
               [&](const RTCRayHit16& packet, std::size_t first) {
                 parts_->StoreHits(packet, tile, first);
               });
}

void TraceScene::CastRanges(RayTile& tile) const {
  if (parts_->instances.empty()) return;
  TracePackets(parts_->scene, CoherenceOf(parts_->has_foliage), tile,
               [&](const RTCRayHit16& packet, std::size_t first) {
                 std::memcpy(tile.range_m + first, packet.ray.tfar, kPacketSize * sizeof(float));
               });
}

}  // namespace railcast
