#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// How a surface answers a laser pulse.
struct Material {
  std::string name;
  double reflectivity{};  ///< Diffuse, at 905 nm; 1 = white Lambertian.

  bool operator==(const Material&) const = default;
};

/// The materials of a scenario. Index 0 is "none": the material of nothing.
class MaterialLibrary {
 public:
  MaterialLibrary() : materials_{{"none", 0.0}} {}
  /// @pre Names are unique and none is "none"; the scenario reader checks.
  explicit MaterialLibrary(const std::vector<Material>& materials);

  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

  /// @throws InputError if the library lacks the name.
  [[nodiscard]] std::uint16_t Index(std::string_view name) const;

 private:
  std::vector<Material> materials_;
};

}  // namespace railcast
