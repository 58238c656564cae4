#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"

namespace railcast {

/// Looks up materials and labels by name, and remembers the names that the tables lack, each once.
class SurfaceFinder {
 public:
  SurfaceFinder(const LabelTable& labels, const MaterialLibrary& materials)
      : labels_(labels), materials_(materials) {}

  /// Whether both tables have entries: one that could not be read has none, and then nothing is
  /// missing, for geometry that is built only to be checked.
  [[nodiscard]] bool has_tables() const;
  /// What is missing is 0.
  [[nodiscard]] std::uint16_t MaterialNamed(std::string_view name);
  [[nodiscard]] std::uint32_t LabelNamed(std::string_view name);
  /// @param key Of the object, which requires the names.
  /// @throws InputError with a line for every name that the tables lack.
  void ThrowIfAnyIsMissing(const std::string& key) const;

 private:
  const LabelTable& labels_;
  const MaterialLibrary& materials_;
  std::set<std::string> missing_;
};

/// The index of a material of that name, if there is one.
[[nodiscard]] std::optional<std::uint16_t> IndexOfMaterial(const MaterialLibrary& library,
                                                           std::string_view name);

/// The surfaces of a person (person.h), which tables need only if there are persons.
struct PersonSurfaces {
  SurfaceClass skin, clothing;
  SurfaceClass hi_vis_fabric, hi_vis_band, helmet;        ///< 0 unless it wears them.
  SurfaceClass suitcase, frame, tyre, canvas, reflector;  ///< 0 unless it has luggage.
};

/// @throws InputError with a line for every name that the tables lack.
[[nodiscard]] PersonSurfaces FindPersonSurfaces(const PersonSpec& look,
                                                const LabelTable& labels,
                                                const MaterialLibrary& materials);

}  // namespace railcast
