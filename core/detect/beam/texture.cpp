#include "core/detect/beam/texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/surface_response.h"

namespace railcast {
namespace {

// By Eigen, which uses vector instructions where compilers are not asked to.
void PlaceInWorld(const TextureScene& scene, const RayTile& rays, TextureLanes& lanes) {
  using Values = Eigen::Array<float, kTileSize, 1>;
  using Numbers = Eigen::Array<std::uint32_t, kTileSize, 1>;
  const auto in = [](const float* values) { return Eigen::Map<const Values>(values); };
  const auto range_m = in(rays.range_m);
  const Values x = in(rays.origin_x) + range_m * in(rays.direction_x);
  const Values y = in(rays.origin_y) + range_m * in(rays.direction_y);
  const Values z = in(rays.origin_z) + range_m * in(rays.direction_z);
  float* const cells[] = {lanes.x, lanes.y, lanes.z};
  std::uint32_t* const base[] = {lanes.base_x, lanes.base_y, lanes.base_z};
  for (int k = 0; k < 3; ++k) {
    const CellField& field = scene.cells_from_window;
    Eigen::Map<Values>{cells[k]} =
        field(k, 0) * x + field(k, 1) * y + field(k, 2) * z + field(k, 3);
    Eigen::Map<Numbers>{base[k]}.setConstant(scene.base[k]);
  }
  Eigen::Map<Numbers>{lanes.instance}.setZero();
}

}  // namespace

Eigen::Matrix<double, 3, 4> CellsFromWindow(const Eigen::Affine3d& thing_from_window) {
  constexpr double kBeside = 0.381966;  // The golden section, far from all simple fractions.
  Eigen::Matrix<double, 3, 4> cells =
      thing_from_window.matrix().topRows<3>() / static_cast<double>(kTextureCell_m);
  cells.col(3).array() += kBeside;
  return cells;
}

void TexturedThings::Add(std::uint32_t first_surface,
                         std::uint32_t num_surfaces,
                         const std::vector<CellField>& steps) {
  things_.push_back(steps);
  const std::size_t end = std::size_t{first_surface} + num_surfaces;
  thing_of_surface_.resize(std::max(thing_of_surface_.size(), end));
  std::fill(thing_of_surface_.begin() + first_surface,
            thing_of_surface_.begin() + static_cast<std::ptrdiff_t>(end),
            static_cast<std::uint32_t>(things_.size()));
}

const CellField* TexturedThings::FieldOf(std::uint32_t surface,
                                         float shutter,
                                         CellField& between) const {
  const std::uint32_t thing = surface < thing_of_surface_.size() ? thing_of_surface_[surface] : 0;
  if (thing == 0) return nullptr;
  const std::vector<CellField>& steps = things_[thing - 1];
  if (steps.size() == 1) return steps.data();
  const float step = shutter * static_cast<float>(steps.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(step), steps.size() - 2);
  const float share = step - static_cast<float>(before);
  between = (1.0F - share) * steps[before] + share * steps[before + 1];
  return &between;
}

Texture::Texture(const DetectorSpec& spec,
                 const std::vector<Material>& materials,
                 const Kernels& kernels)
    : parameters_{.seed = spec.ground_seed,
                  .sigma_h_rad = static_cast<float>(HorizontalSigma_rad(spec.beam)),
                  .sigma_v_rad = static_cast<float>(VerticalSigma_rad(spec.beam))},
      apply_(kernels.texture) {
  for (const Material& material : materials) {
    variance_.push_back(static_cast<float>(std::expm1(material.texture * material.texture)));
    is_on_ = is_on_ || (spec.effects.texture && material.texture > 0.0);
  }
}

TextureScene Texture::SceneOf(const Transform& window_from_world, const TexturedThings* things) {
  const Transform world_from_window = window_from_world.inverse();
  Eigen::Matrix<double, 3, 4> cells = CellsFromWindow(Eigen::Affine3d(world_from_window.matrix()));
  TextureScene scene{.cells_from_window = {}, .base = {}, .things = things};
  for (int k = 0; k < 3; ++k) {
    const double whole = std::floor(cells(k, 3));
    scene.base[k] = static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
    cells(k, 3) -= whole;
  }
  scene.cells_from_window = cells.cast<float>();
  return scene;
}

void Texture::Apply(const TextureScene& scene,
                    const std::vector<Surface>& surfaces,
                    const RayTile& rays,
                    DetectTile& tile) const {
  TextureLanes lanes;
  // Local copies, since stores to `lanes` might change the originals.
  const Surface* const all = surfaces.data();
  const float* const variance = variance_.data();
  const std::size_t num = tile.num_rays;
  float greatest = 0.0F;
  std::uint32_t instances = 0;
  for (std::size_t i = 0; i < num; ++i) {
    const Surface& surface = all[rays.surface[i]];
    lanes.variance[i] = variance[surface.material];
    greatest = std::max(greatest, lanes.variance[i]);
    instances |= surface.instance;
  }
  if (!(greatest > 0.0F)) return;
  PlaceInWorld(scene, rays, lanes);
  CellField between;
  const bool has_things = scene.things != nullptr && instances != 0;
  for (std::size_t i = 0; has_things && i < num; ++i) {
    const std::uint32_t instance = all[rays.surface[i]].instance;
    if (instance == 0 || !(lanes.variance[i] > 0.0F)) continue;
    const CellField* cells = scene.things->FieldOf(rays.surface[i], rays.shutter[i], between);
    if (cells == nullptr) continue;
    const Eigen::Vector3f place(rays.origin_x[i] + rays.range_m[i] * rays.direction_x[i],
                                rays.origin_y[i] + rays.range_m[i] * rays.direction_y[i],
                                rays.origin_z[i] + rays.range_m[i] * rays.direction_z[i]);
    const Eigen::Vector3f cell = cells->leftCols<3>() * place + cells->col(3);
    lanes.x[i] = cell.x();
    lanes.y[i] = cell.y();
    lanes.z[i] = cell.z();
    lanes.base_x[i] = lanes.base_y[i] = lanes.base_z[i] = 0;
    lanes.instance[i] = instance;
  }
  apply_(tile, lanes, parameters_);
}

}  // namespace railcast
