#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"

namespace railcast {

/// A material that a name stands for.
struct NamedMaterial {
  std::string_view material;  ///< A material of scenarios/materials/railway.json.
  std::string_view word;      ///< Which of the words of docs/things.md the name has.
};

/// Guesses what a part of a mesh is made of by the name of its material or group: "Window_front",
/// "blackRubber.001", "Holz 2". A name's words begin at capitals and after anything but letters. A
/// word of the table with at least five letters may also be a piece of one (darkglass), a shorter
/// one must be whole (tire, but not entire).
[[nodiscard]] std::optional<NamedMaterial> MaterialOfName(std::string_view name);

/// The material for a colour: of the library's paints (`paint_05` to `paint_85`), the one whose
/// reflectivity is nearest by ratio to the colour's luminance. Nothing if it has none.
///
/// Law: the reflectivity at 905 nm is the luminance of the linear colour, between the darkest and
/// the brightest paint. Of 888 spectra of roofs, roads, walls and paint (UCSB Urban Reflectance),
/// the ratio of reflectivity to luminance is 1.20 in the median and 0.97 to 2.22 for nine of ten:
/// the law errs by a factor of 1.4 (rms), where grey paint for all of them would err by 2.4. Steps
/// of 1.5 between paints add nothing to that. It does not hold for plants, which are dark to the
/// eye and bright at 905 nm.
/// @param luminance 0 to 1.
[[nodiscard]] std::optional<std::uint16_t> PaintOfLuminance(const MaterialLibrary& library,
                                                            double luminance);

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
