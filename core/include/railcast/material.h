#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// Optical properties of a surface: diffuse, specular and retroreflective response, its variation
/// from place to place, and mirroring. docs/physics.md, section 3, has the equations.
struct Material {
  std::string name;
  double reflectivity{};  ///< Diffuse reflectance at 905 nm; 1 = white Lambertian.
  std::optional<double> reflectivity_1550nm{};  ///< Absent = as at 905 nm.
  double facet_slope_deg = 0.0;  ///< Oren-Nayar's sigma: diffuse roughness; 0 = Lambertian.
  double specular_f0 = 0.0;      ///< Reflectance of the GGX lobe at normal incidence, 905 nm.
  std::optional<double> specular_f0_1550nm{};  ///< Absent = as at 905 nm.
  double specular_roughness = 0.3;             ///< GGX's alpha.
  /// Peak of a retroreflector, as a multiple of a white Lambertian; 0 = none.
  double retroreflectance = 0.0;
  /// Standard deviation of ln(response) from cell to cell of 3 cm, about the mean response above.
  double texture = 0.0;
  /// Standard deviation of the heights of a flat surface that is smooth enough to mirror,
  /// micrometres. Absent = too rough, or not flat.
  std::optional<double> height_rms_um{};
  bool holds_puddles = false;  ///< Whether water stands on it (WeatherSpec::puddle_share).

  bool operator==(const Material&) const = default;
};

/// A material at one wavelength: the inputs of the equations in docs/physics.md, section 3.
struct SurfaceOptics {
  float diffuse{};             ///< Reflectance of the diffuse part; 1 = white Lambertian.
  float facet_slope_rad{};     ///< Oren-Nayar's sigma.
  float specular_f0{};         ///< Reflectance of the GGX lobe at normal incidence.
  float specular_roughness{};  ///< GGX's alpha.
  float retroreflectance{};    ///< As a multiple of a white Lambertian; 0 = none.

  bool operator==(const SurfaceOptics&) const = default;
};

/// The optical properties of a material at one wavelength.
/// @pre `wavelength_nm` is 905 or 1550.
[[nodiscard]] SurfaceOptics OpticsAt(const Material& material, int wavelength_nm);

/// The optical properties of a wet surface. `wetness` is the share of a full water film of about 1
/// mm, from 0 = dry to 1 = soaked; every change below scales linearly with it.
///
/// - Diffuse: reduced to 0.6 of the dry value at 905 nm and to 0.3 at 1550 nm, where water absorbs.
///   These are the midpoints of the working ranges in docs/physics.md 2.2 (0.5 to 0.7 and 0.2 to
///   0.4).
/// - Film: a specular lobe of F0 0.02 (Fresnel reflectance of water, n = 1.33) and roughness 0.15.
///   It replaces the surface's own lobe only where that is weaker.
/// - Facets: slope reduced by a quarter. The film levels texture of its own depth but not coarser
///   texture; the quarter is our assumption between fine concrete (about a half) and ballast
///   (none).
/// - Retroreflectors: unchanged, because their optics stay dry behind the cover.
///
/// @pre `wetness` is in [0, 1]; `wavelength_nm` is 905 or 1550.
[[nodiscard]] SurfaceOptics WetOptics(const SurfaceOptics& dry, double wetness, int wavelength_nm);

/// The materials of a scenario. Index 0 is "none", the material of slots without a surface.
class MaterialLibrary {
 public:
  /// Maximum number of materials besides "none": indices have 16 bits.
  static constexpr std::size_t kMostMaterials = 65'535;

  MaterialLibrary() : materials_(1) { materials_.front().name = "none"; }
  /// @pre At most kMostMaterials entries with unique names, none of them "none" (the scenario
  ///   reader checks this).
  explicit MaterialLibrary(const std::vector<Material>& materials);

  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  /// The index of a material.
  /// @throws InputError if the library lacks the name.
  [[nodiscard]] std::uint16_t Index(std::string_view name) const;

 private:
  std::vector<Material> materials_;
};

}  // namespace railcast
