#pragma once

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
  double specular_roughness = 0.3;                 ///< GGX's alpha.
  double retroreflectance = 0.0;  ///< Of a retroreflector, as a multiple of a white Lambertian.

  bool operator==(const Material&) const = default;
};

/// A surface's optics at one wavelength, in one condition.
struct SurfaceOptics {
  float diffuse{};             ///< Of Oren-Nayar's facets.
  float facet_slope_rad{};     ///< Oren-Nayar's sigma.
  float specular_f0{};         ///< GGX lobe at normal incidence.
  float specular_roughness{};  ///< GGX's alpha.
  float retroreflectance{};
};

[[nodiscard]] SurfaceOptics OpticsAt(const Material& material, int wavelength_nm);
[[nodiscard]] SurfaceOptics WetOptics(const SurfaceOptics& dry, double wetness, int wavelength_nm);

/// The materials of a scenario. Index 0 is "none": the material of nothing.
class MaterialLibrary {
 public:
  MaterialLibrary() : materials_(1) { materials_.front().name = "none"; }
  /// @pre Names are unique and none is "none"; the scenario reader checks.
  explicit MaterialLibrary(const std::vector<Material>& materials);

  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  /// @throws InputError if the library lacks the name.
  [[nodiscard]] std::uint16_t Index(std::string_view name) const;

 private:
  std::vector<Material> materials_;
};

}  // namespace railcast
