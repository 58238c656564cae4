#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// How a surface answers a laser pulse: five numbers, of which two have a second value at 1550 nm.
struct Material {
  std::string name;
  double reflectivity{};                        ///< Diffuse, at 905 nm; 1 = white Lambertian.
  std::optional<double> reflectivity_1550nm{};  ///< Absent = as at 905 nm.
  double facet_slope_deg =
      0.0;                   ///< Oren-Nayar's sigma: roughness of the diffuse part; 0 = Lambert.
  double specular_f0 = 0.0;  ///< Reflectance of the GGX lobe at normal incidence, 905 nm.
  std::optional<double> specular_f0_1550nm{};  ///< Absent = as at 905 nm.
  double specular_roughness = 0.3;             ///< GGX's alpha.
  double retroreflectance = 0.0;  ///< Of a retroreflector, as a multiple of a white Lambertian.

  bool operator==(const Material&) const = default;
};

/// A material at one wavelength: what the equations of physics.md 3 take.
struct SurfaceOptics {
  float diffuse{};             ///< Reflectance of the diffuse part; 1 = white Lambertian.
  float facet_slope_rad{};     ///< Oren-Nayar's sigma.
  float specular_f0{};         ///< Reflectance of the GGX lobe at normal incidence.
  float specular_roughness{};  ///< GGX's alpha.
  float retroreflectance{};    ///< As a multiple of a white Lambertian.

  bool operator==(const SurfaceOptics&) const = default;
};

/// @pre `wavelength_nm` is 905 or 1550.
[[nodiscard]] SurfaceOptics OpticsAt(const Material& material, int wavelength_nm);

/// A surface under water. `wetness` is the share of a full film of about 1 mm, from 0 = dry to
/// 1 = soaked; everything grows or shrinks in proportion to it.
///
/// - Diffuse: down to 0.6 of the dry value at 905 nm and 0.3 at 1550 nm, where water absorbs. The
///   middles of physics.md 2.2 (0.5 to 0.7 and 0.2 to 0.4), which are working values.
/// - Film: a lobe of F0 0.02 (water's n = 1.33 by Fresnel) and roughness 0.15, where the dry
/// surface
///   has no stronger lobe of its own; a stronger one stays as it is.
/// - Facets: a quarter less slope. The film levels texture of its own depth and leaves the larger;
///   the quarter is our assumption between fine concrete (about a half) and ballast (nothing).
/// - Retroreflectors stay as they are: behind their cover the optics remain dry.
///
/// @pre `wetness` is in [0, 1]; `wavelength_nm` is 905 or 1550.
[[nodiscard]] SurfaceOptics WetOptics(const SurfaceOptics& dry, double wetness, int wavelength_nm);

/// The materials of a scenario. Index 0 is "none": the material of nothing.
class MaterialLibrary {
 public:
  /// Beside "none": indices have 16 bits.
  static constexpr std::size_t kMostMaterials = 65'535;

  MaterialLibrary() : materials_(1) { materials_.front().name = "none"; }
  /// @pre At most kMostMaterials, of unique names of which none is "none"; the scenario reader
  ///   checks.
  explicit MaterialLibrary(const std::vector<Material>& materials);

  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  /// @throws InputError if the library lacks the name.
  [[nodiscard]] std::uint16_t Index(std::string_view name) const;

 private:
  std::vector<Material> materials_;
};

}  // namespace railcast
