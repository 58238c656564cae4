#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "railcast/ray_caster.h"
#include "railcast/scene.h"

namespace railcast {

struct BeamKernel;
struct BeamScenes;

/// Owns the Embree device. Each acceleration structure is built by a single thread, so that it does
/// not depend on the number of threads of a run.
class TraceDevice {
 public:
  /// @param isa Instruction set to force ("sse4.2", "avx2", "avx512"); empty = the best available.
  /// @throws InputError if this machine lacks the instruction set.
  explicit TraceDevice(const std::string& isa = {});
  ~TraceDevice();
  TraceDevice(const TraceDevice&) = delete;
  TraceDevice& operator=(const TraceDevice&) = delete;

  struct Handle;
  [[nodiscard]] const std::shared_ptr<Handle>& handle() const { return handle_; }

 private:
  std::shared_ptr<Handle> handle_;
};

/// A model prepared for tracing. It holds its own copy of the triangles; part i of the model
/// becomes geometry i.
class TraceModel {
 public:
  /// @param is_passable Whether TraceScene::CastThrough() may be used on it.
  TraceModel(const TraceDevice& device, const Model& model, bool is_passable = false);
  ~TraceModel();
  TraceModel(const TraceModel&) = delete;
  TraceModel& operator=(const TraceModel&) = delete;

  struct Handle;
  [[nodiscard]] const Handle& handle() const { return *handle_; }

 private:
  std::unique_ptr<Handle> handle_;
};

/// A model at a fixed place, or moving through several places at equal time steps of the shutter.
struct TracePlacement {
  std::shared_ptr<const TraceModel> model;
  std::vector<Eigen::Affine3d> window_from_model;  ///< One (stationary), or two or more (moving).
  std::uint32_t first_surface{};                   ///< Surface index of the model's part 0.
};

/// A rigid piece of something that bends.
struct TracePiece {
  std::shared_ptr<const TraceModel> model;
  std::uint32_t first_surface{};  ///< For part 0; counts from the first surface of the whole.
};

/// Something that bends, such as a person who walks.
struct TraceFigure {
  std::shared_ptr<const std::vector<TracePiece>> pieces;
  Eigen::AlignedBox3f window_box_m;  ///< Contains the pieces as long as the shutter is open.
  std::uint32_t num_steps{};         ///< Number of its poses, at equal time steps: two or more.
  std::uint32_t first_surface{};
};

/// Figures, which are posed when a ray first comes near them: most of a crowd are hidden, and the
/// rays that meet one figure come at nearly the same time.
struct TraceFigures {
  std::vector<TraceFigure> figures;
  /// The places of a figure's pieces at one of its `num_steps`, without any scale. Thread-safe.
  std::function<std::vector<Eigen::Affine3d>(
      std::size_t figure, std::uint32_t step, std::uint32_t num_steps)>
      window_from_pieces;
};

/// A placement that rays of a packet hit.
struct PlacementHits {
  std::uint32_t placement{};  ///< Its index: figures count first, each as one placement.
  std::uint32_t lanes{};      ///< Bit i: the packet's ray i hits it.
};

/// Placed models, prepared for tracing in packets of 16.
class TraceScene final : public RayCaster {
 public:
  TraceScene(const TraceDevice& device,
             const std::vector<TracePlacement>& placements,
             TraceFigures figures = {});
  ~TraceScene() override;
  TraceScene(const TraceScene&) = delete;
  TraceScene& operator=(const TraceScene&) = delete;

  void Cast(RayTile& tile) const override;

  /// Traces the sub-rays together through trees of our own (trace_beam.h), which are built on the
  /// first call: hits are those of Cast(), except within rounding of a triangle's edge.
  void CastBeam(BeamRays& beam) const override;
  /// CastBeam() with the kernel of a certain instruction set; the result is the same.
  void CastBeamWith(const BeamKernel& kernel, BeamRays& beam) const;
  /// Builds what the first CastBeam() would build.
  void PrepareBeams() const;
  /// What MayMeet() looks at: the surfaces with these labels. Built on the first call with them;
  /// lasts as long as the scene. Thread-safe.
  [[nodiscard]] BeamScenes OnlyLabels(const std::vector<std::uint32_t>& labels) const;

  /// Finds all placements that rays of the packet beginning at `first` hit within range, whatever
  /// stands before them. Replaces `hits`, whose order says nothing.
  /// @pre All models are passable.
  void CastThrough(const RayTile& tile, std::size_t first, std::vector<PlacementHits>& hits) const;

  /// Lowers `range_m` as Cast() does but leaves the other fields unchanged. This is the raw trace,
  /// the baseline of all speed figures, and it is sufficient for testing whether a ray hits.
  void CastRanges(RayTile& tile) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// Whether a surface that the beam's mask leaves in may lie within the ellipse of its sub-rays,
/// whatever stands before it, nearer than the `range_m` of the first one. False only if no ray in
/// the ellipse can meet any. No directions of sub-rays are needed.
[[nodiscard]] bool MayMeet(const BeamScenes& scenes, const BeamRays& beam);

}  // namespace railcast
