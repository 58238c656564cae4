#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/mesh.h"
#include "core/trace/ray_tile.h"

namespace railcast {

/// Owns the Embree device. Acceleration structures are built by one thread each, so that they do
/// not depend on how many threads a run has.
class TraceDevice {
 public:
  /// @param isa Instruction set to force ("sse4.2", "avx2", "avx512"); empty = the best there is.
  explicit TraceDevice(const std::string& isa = {});
  ~TraceDevice();
  TraceDevice(const TraceDevice&) = delete;
  TraceDevice& operator=(const TraceDevice&) = delete;

  struct Handle;
  [[nodiscard]] const std::shared_ptr<Handle>& handle() const { return handle_; }

 private:
  std::shared_ptr<Handle> handle_;
};

/// A model ready to be traced. Holds its own copy of the triangles; part i of the model is
/// geometry i.
class TraceModel {
 public:
  TraceModel(const TraceDevice& device, const Model& model);
  ~TraceModel();
  TraceModel(const TraceModel&) = delete;
  TraceModel& operator=(const TraceModel&) = delete;

  struct Handle;
  [[nodiscard]] const Handle& handle() const { return *handle_; }

 private:
  std::unique_ptr<Handle> handle_;
};

/// A model at a place, or moving through several places at equal steps of the frame's shutter.
struct TracePlacement {
  std::shared_ptr<const TraceModel> model;
  std::vector<Eigen::Affine3d> window_from_model;  ///< One (stands) or at least two (moves).
  std::uint32_t first_surface{};                   ///< Surface of the model's part 0.
};

/// Placed models, ready to be traced by packets of 16.
class TraceScene final : public RayCaster {
 public:
  TraceScene(const TraceDevice& device, const std::vector<TracePlacement>& placements);
  ~TraceScene() override;
  TraceScene(const TraceScene&) = delete;
  TraceScene& operator=(const TraceScene&) = delete;

  void Cast(RayTile& tile) const override;

  /// Lowers `range_m` as Cast does and leaves the rest alone: the raw trace, the yardstick of all
  /// speed figures, and all that asking "does it hit?" needs.
  void CastRanges(RayTile& tile) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace railcast
