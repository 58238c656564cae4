#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "railcast/ray_caster.h"
#include "railcast/scenario.h"

namespace railcast {

/// What a placed model of a scene is.
enum class PlacedKind : std::uint8_t { kGround, kPiece, kTree, kGrass, kObject };

/// Kinds as bits, to choose some of them.
using KindBits = unsigned;
[[nodiscard]] constexpr KindBits BitOf(PlacedKind kind) {
  return 1U << static_cast<unsigned>(kind);
}
inline constexpr KindBits kPlants = BitOf(PlacedKind::kTree) | BitOf(PlacedKind::kGrass);
inline constexpr KindBits kEverything = ~0U;

struct PlacedModel {
  std::shared_ptr<const Model> model;
  Eigen::Affine3d window_from_model = Eigen::Affine3d::Identity();
  PlacedKind kind{};
  int chunk{};  ///< -1 for objects.
};

/// How the rays of a raster follow one another; packets are cut from that order.
enum class RayOrder : std::uint8_t { kSquares, kRows, kColumns };

/// Rays in one of these orders.
struct OrderedRays {
  std::vector<RayTile> tiles;
  std::vector<std::size_t> places;  ///< By ray: its place in the order of kSquares.

  /// Sets all ranges to the greatest one.
  void Restore(float range_max_m);
  /// In the order of kSquares.
  [[nodiscard]] std::vector<float> Ranges_m() const;
};

/// The rays of a frame as a simulator aims them, with their places in the pattern's grid.
struct FrameRays {
  std::vector<RayTile> tiles;
  std::vector<std::uint32_t> rows;
  std::vector<std::uint32_t> columns;

  [[nodiscard]] OrderedRays In(RayOrder order) const;
};

/// The models in the window of a scenario's frame 0, and the rays of that frame. Moving objects are
/// left out: they are built anew for each frame and are few.
struct LayoutScene {
  std::vector<PlacedModel> models;
  FrameRays rays;
};
[[nodiscard]] LayoutScene MakeLayoutScene(const ScenarioSpec& scenario);

/// One way of giving the models to Embree.
struct Layout {
  KindBits kinds = kEverything;  ///< Models of other kinds are left out.
  RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
  RTCSceneFlags flags = RTC_SCENE_FLAG_ROBUST;
  /// Of the plants' models, and of the scene that holds the instances.
  RTCBuildQuality plant_quality = RTC_BUILD_QUALITY_MEDIUM;
  RTCSceneFlags plant_flags = RTC_SCENE_FLAG_ROBUST;
  RTCBuildQuality top_quality = RTC_BUILD_QUALITY_MEDIUM;
  RTCSceneFlags top_flags = RTC_SCENE_FLAG_ROBUST;
  /// Models of these kinds are copied into one model for each chunk and kind.
  KindBits baked = 0;
  /// All triangles are copied into one scene without instances.
  bool is_flat = false;
};

/// An Embree scene that is laid out in one way.
class LaidOutScene {
 public:
  LaidOutScene(const std::vector<PlacedModel>& models, const Layout& layout);
  ~LaidOutScene();
  LaidOutScene(const LaidOutScene&) = delete;
  LaidOutScene& operator=(const LaidOutScene&) = delete;

  [[nodiscard]] RTCScene scene() const { return scene_; }
  [[nodiscard]] double build_s() const { return build_s_; }
  /// What Embree says that it allocated.
  [[nodiscard]] double memory_mb() const;

 private:
  [[nodiscard]] RTCScene SceneOf(const PlacedModel& placed, const Layout& layout);
  void AttachInstance(RTCScene model, const Eigen::Affine3d& window_from_model);

  struct Memory;
  std::unique_ptr<Memory> memory_;
  RTCDevice device_{};
  RTCScene scene_{};
  std::vector<std::pair<const Model*, RTCScene>> models_;
  double build_s_{};
};

/// How rays are passed to Embree.
struct CastForm {
  unsigned width = 16;  ///< Rays of a packet: 16, 8, 4 or 1.
  bool is_coherent = true;
};

/// Lowers the ranges of all rays of the tiles to those of their hits.
void CastRanges(const LaidOutScene& scene, const CastForm& form, std::vector<RayTile>& tiles);

}  // namespace railcast
