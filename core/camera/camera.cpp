#include "railcast/camera.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/camera/colors.h"
#include "core/camera/lens.h"
#include "core/camera/wires_in_pixels.h"
#include "core/simulate/frame_scene.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

// A tile of rays is a square of pixels, and each packet a square within it.
constexpr std::uint32_t kBlock = 16;
constexpr std::uint32_t kPacketBlock = 4;
static_assert(std::size_t{kBlock} * kBlock == kTileSize &&
              std::size_t{kPacketBlock} * kPacketBlock == kPacketSize);

struct Pixel {
  std::uint32_t column, row;
};

// The place of a tile's ray in its block.
Pixel PlaceInBlock(std::size_t ray) {
  constexpr std::uint32_t kPacketsAcross = kBlock / kPacketBlock;
  const auto packet = static_cast<std::uint32_t>(ray / kPacketSize);
  const auto lane = static_cast<std::uint32_t>(ray % kPacketSize);
  return {packet % kPacketsAcross * kPacketBlock + lane % kPacketBlock,
          packet / kPacketsAcross * kPacketBlock + lane / kPacketBlock};
}

/// Everything that the blocks of one image are rendered with.
struct Shot {
  const CameraSpec& spec;
  const std::vector<Vector3>& colors;
  const SceneOfFrame& scene;
  float reach_m;
  Lens lens;
  Transform window_from_camera;
  Daylight daylight;
};

/// Working memory of one block.
struct BlockWork {
  RayTile rays;
  /// The same rays without wires, where there are any: what the colours are of, behind the wires.
  RayTile bare;
  RayTile to_sun;
  WiresInPixels wires;
  float z_per_range[kTileSize];     ///< Depth of a point, as a share of its range.
  std::uint32_t shaded[kTileSize];  ///< The ray that each ray of `to_sun` belongs to.
  bool is_lit[kTileSize];
};

Eigen::Vector3f VectorAt(const float* x, const float* y, const float* z, std::size_t i) {
  return {x[i], y[i], z[i]};
}

// Pixels beyond the edge of the image repeat those at the edge.
Pixel PixelOf(const Shot& shot, const Pixel& corner, std::size_t ray) {
  const Pixel place = PlaceInBlock(ray);
  return {std::min(corner.column + place.column, shot.spec.width_px - 1),
          std::min(corner.row + place.row, shot.spec.height_px - 1)};
}

void AimBlock(const Shot& shot, const Pixel& corner, BlockWork& work) {
  const Eigen::Vector3f origin = shot.window_from_camera.translation().cast<float>();
  work.rays.num_rays = kTileSize;
  for (std::size_t ray = 0; ray < kTileSize; ++ray) {
    const Pixel pixel = PixelOf(shot, corner, ray);
    const auto seen = shot.lens.DirectionAt(pixel.column, pixel.row);
    Check(seen.has_value(), "a camera's distortion can be inverted");
    const Vector3 direction(seen->x(), seen->y(), 1.0);
    const double length = direction.norm();
    const Vector3 in_window = shot.window_from_camera.linear() * direction / length;
    PutRay(origin, in_window.cast<float>(), shot.reach_m, ray, work.rays);
    work.z_per_range[ray] = static_cast<float>(1.0 / length);
  }
}

// Pixels as beams: the standard deviations are half the ways to the next pixels, about the middle
// of the block. A place half a pixel beyond the outer pixels is still within the image.
BeamShape ShapeOfPixels(const Shot& shot, const Pixel& corner) {
  const auto middle = [](std::uint32_t first, std::uint32_t size) {
    return std::min(first + 0.5 * kBlock, size - 1.0);
  };
  const double u_px = middle(corner.column, shot.spec.width_px);
  const double v_px = middle(corner.row, shot.spec.height_px);
  const auto seen_at = [&](double du_px, double dv_px) {
    const auto seen = shot.lens.DirectionAt(u_px + du_px, v_px + dv_px);
    Check(seen.has_value(), "a camera's distortion can be inverted");
    return Vector3(seen->x(), seen->y(), 1.0).normalized();
  };
  return {.up_window = -shot.window_from_camera.linear().col(1).cast<float>(),
          .sigma_horizontal_rad = 0.5 * (seen_at(0.5, 0.0) - seen_at(-0.5, 0.0)).norm(),
          .sigma_vertical_rad = 0.5 * (seen_at(0.0, 0.5) - seen_at(0.0, -0.5)).norm()};
}

// The normal, of unit length, on the camera's side.
Eigen::Vector3f NormalAt(const RayTile& rays, std::size_t ray) {
  const Eigen::Vector3f normal =
      VectorAt(rays.normal_x, rays.normal_y, rays.normal_z, ray).normalized();
  const Eigen::Vector3f direction =
      VectorAt(rays.direction_x, rays.direction_y, rays.direction_z, ray);
  return normal.dot(direction) > 0.0F ? Eigen::Vector3f(-normal) : normal;
}

// Finds out which of the surfaces hit the sun shines on: those that face it, with nothing between.
void CastShadows(const Shot& shot, const RayTile& rays, BlockWork& work) {
  std::fill_n(work.is_lit, kTileSize, false);
  if (!shot.daylight.has_sun()) return;
  const Eigen::Vector3f& to_sun = shot.daylight.to_sun();
  std::size_t num_shaded = 0;
  for (std::size_t ray = 0; ray < kTileSize; ++ray) {
    if (rays.surface[ray] == 0) continue;
    const Eigen::Vector3f normal = NormalAt(rays, ray);
    if (normal.dot(to_sun) <= 0.0F) continue;
    // Beyond the rounding of coordinates, so that no surface shades itself.
    const float off_m = 1e-3F + 2e-5F * rays.range_m[ray];
    const Eigen::Vector3f point =
        VectorAt(rays.origin_x, rays.origin_y, rays.origin_z, ray) +
        rays.range_m[ray] * VectorAt(rays.direction_x, rays.direction_y, rays.direction_z, ray) +
        off_m * normal;
    PutRay(point, to_sun, shot.reach_m, num_shaded, work.to_sun);
    work.shaded[num_shaded++] = static_cast<std::uint32_t>(ray);
  }
  if (num_shaded == 0) return;
  work.to_sun.mask = kAllButWires;
  work.to_sun.num_rays = (num_shaded + kPacketSize - 1) / kPacketSize * kPacketSize;
  const Eigen::Vector3f last =
      VectorAt(work.to_sun.origin_x, work.to_sun.origin_y, work.to_sun.origin_z, num_shaded - 1);
  for (std::size_t i = num_shaded; i < work.to_sun.num_rays; ++i) {
    PutRay(last, to_sun, shot.reach_m, i, work.to_sun);
  }
  shot.scene.caster.Cast(work.to_sun);
  for (std::size_t i = 0; i < num_shaded; ++i) {
    work.is_lit[work.shaded[i]] = work.to_sun.surface[i] == 0;
  }
}

Radiance ColorOf(const Shot& shot, const RayTile& rays, const BlockWork& work, std::size_t ray) {
  if (rays.surface[ray] == 0) {
    return shot.daylight.Background(
        VectorAt(rays.direction_x, rays.direction_y, rays.direction_z, ray), shot.reach_m);
  }
  const Radiance reflectance =
      shot.colors[shot.scene.surfaces[rays.surface[ray]].material].cast<float>();
  const Radiance radiance =
      shot.daylight.Surface(reflectance, NormalAt(rays, ray), work.is_lit[ray]);
  return shot.daylight.ThroughAir(radiance, rays.range_m[ray]);
}

void StoreBlock(const Shot& shot,
                const Pixel& corner,
                const RayTile& colored,
                const BlockWork& work,
                CameraImage& image) {
  for (std::size_t ray = 0; ray < kTileSize; ++ray) {
    const Pixel place = PlaceInBlock(ray);
    const Pixel pixel{corner.column + place.column, corner.row + place.row};
    if (pixel.column >= image.width_px || pixel.row >= image.height_px) continue;
    const std::size_t index = std::size_t{pixel.row} * image.width_px + pixel.column;
    const Surface& surface = shot.scene.surfaces[work.rays.surface[ray]];
    const bool is_hit = work.rays.surface[ray] != 0;
    image.depth_m[index] = is_hit ? work.z_per_range[ray] * work.rays.range_m[ray]
                                  : std::numeric_limits<float>::quiet_NaN();
    image.label[index] = surface.label;
    image.instance[index] = surface.instance;
    Radiance color = ColorOf(shot, colored, work, ray);
    if (!work.wires.is_empty()) color = work.wires.Over(colored, ray, color);
    const auto bytes = SrgbBytes(color);
    std::copy(bytes.begin(), bytes.end(), &image.rgb[3 * index]);
  }
}

void RenderBlocks(const Shot& shot, CameraImage& image) {
  const std::uint32_t num_across = (image.width_px + kBlock - 1) / kBlock;
  const std::uint32_t num_down = (image.height_px + kBlock - 1) / kBlock;
  tbb::parallel_for(0U, num_across * num_down, [&](std::uint32_t block) {
    const Pixel corner{block % num_across * kBlock, block / num_across * kBlock};
    BlockWork work;
    AimBlock(shot, corner, work);
    work.wires.Find(work.rays, ShapeOfPixels(shot, corner), shot.scene);
    const bool has_wires = !work.wires.is_empty();
    if (has_wires) {
      work.bare = work.rays;
      work.bare.mask = kAllButWires;
      shot.scene.caster.Cast(work.bare);
      work.wires.Shade(work.rays, shot.scene, shot.colors, shot.daylight, shot.reach_m);
    }
    shot.scene.caster.Cast(work.rays);
    const RayTile& colored = has_wires ? work.bare : work.rays;
    CastShadows(shot, colored, work);
    StoreBlock(shot, corner, colored, work, image);
  });
}

void ResizeImage(const CameraSpec& spec, CameraImage& image) {
  image.width_px = spec.width_px;
  image.height_px = spec.height_px;
  image.rgb.resize(3 * image.num_pixels());
  image.depth_m.resize(image.num_pixels());
  image.label.resize(image.num_pixels());
  image.instance.resize(image.num_pixels());
}

}  // namespace

Camera::Camera(const CameraSpec& spec,
               const Transform& vehicle_from_camera,
               const MaterialLibrary& materials)
    : spec_(spec), vehicle_from_camera_(vehicle_from_camera), colors_(MaterialColors(materials)) {
  if (!IsInvertible(spec)) {
    throw InputError({{"/distortion", "must be invertible over the whole image", ""}});
  }
}

void Camera::Render(Simulator& simulator, std::uint32_t frame_index, CameraImage& image) const {
  Render(simulator, *simulator.Begin(frame_index), image);
}

void Camera::Render(Simulator& simulator, BegunFrame& begun, CameraImage& image) const {
  const auto doing = [&] {
    return "rendering the image of frame " + std::to_string(begun.index) + " (" +
           std::to_string(spec_.width_px) + " x " + std::to_string(spec_.height_px) + " pixels)";
  };
  WithinMemory(doing, [&] {
    ResizeImage(spec_, image);
    const DetectorSpec& detector = simulator.spec().detector;
    simulator.VisitScene(begun, [&](const SceneOfFrame& scene) {
      const Transform window_from_camera = scene.window_from_vehicle * vehicle_from_camera_;
      image.stamp_ns = scene.stamp_ns;
      image.world_from_camera = scene.window_from_world.inverse() * window_from_camera;
      RenderBlocks({.spec = spec_,
                    .colors = colors_,
                    .scene = scene,
                    .reach_m = static_cast<float>(detector.range_max_m),
                    .lens = Lens(spec_),
                    .window_from_camera = window_from_camera,
                    .daylight = Daylight(detector.weather, scene.window_from_world.linear())},
                   image);
    });
  });
}

}  // namespace railcast
