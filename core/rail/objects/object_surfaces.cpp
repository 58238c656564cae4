#include "core/rail/objects/object_surfaces.h"

#include <algorithm>

#include "core/base/error.h"

namespace railcast {
namespace {

struct PersonSurfaceRow {
  SurfaceClass PersonSurfaces::*surface;
  std::string_view material;
};

constexpr PersonSurfaceRow kPersonRows[] = {
    {&PersonSurfaces::skin, "skin"},
    {&PersonSurfaces::clothing, "clothing"},
};

constexpr PersonSurfaceRow kHiVisRows[] = {
    {&PersonSurfaces::hi_vis_fabric, "hi_vis_fabric"},
    {&PersonSurfaces::hi_vis_band, "hi_vis_band"},
    {&PersonSurfaces::helmet, "plastic"},
};

constexpr PersonSurfaceRow kLuggageRows[] = {
    {&PersonSurfaces::suitcase, "plastic"},         {&PersonSurfaces::frame, "grey_paint"},
    {&PersonSurfaces::tyre, "black_rubber"},        {&PersonSurfaces::canvas, "clothing"},
    {&PersonSurfaces::reflector, "retro_sheeting"},
};

}  // namespace

std::optional<std::uint16_t> IndexOfMaterial(const MaterialLibrary& library,
                                             std::string_view name) {
  const auto& all = library.materials();
  const auto it = std::find_if(all.begin(), all.end(),
                               [&](const auto& material) { return material.name == name; });
  if (it == all.end()) return std::nullopt;
  return static_cast<std::uint16_t>(it - all.begin());
}

bool SurfaceFinder::has_tables() const {
  constexpr std::size_t kNoMaterials = 1;  // But that with index 0.
  return !labels_.labels().empty() && materials_.materials().size() > kNoMaterials;
}

std::uint16_t SurfaceFinder::MaterialNamed(std::string_view name) {
  if (!has_tables()) return 0;
  const auto index = IndexOfMaterial(materials_, name);
  if (!index) missing_.insert("material \"" + std::string(name));
  return index.value_or(0);
}

std::uint32_t SurfaceFinder::LabelNamed(std::string_view name) {
  if (!has_tables()) return 0;
  const auto* const label = labels_.Find(name);
  if (label == nullptr) missing_.insert("label \"" + std::string(name));
  return label == nullptr ? 0 : label->id;
}

void SurfaceFinder::ThrowIfAnyIsMissing(const std::string& key) const {
  ErrorList errors;
  for (const std::string& what : missing_) errors.AddLine(key + ": requires the " + what + '"');
  errors.ThrowIfAny();
}

PersonSurfaces FindPersonSurfaces(const PersonSpec& look,
                                  const LabelTable& labels,
                                  const MaterialLibrary& materials) {
  PersonSurfaces surfaces;
  SurfaceFinder finder(labels, materials);
  const auto find = [&](const auto& rows) {
    for (const PersonSurfaceRow& row : rows) {
      surfaces.*row.surface = {finder.MaterialNamed(row.material), finder.LabelNamed("person")};
    }
  };
  find(kPersonRows);
  if (look.clothing == Clothing::kHiVis) find(kHiVisRows);
  if (look.luggage != Luggage::kNone) find(kLuggageRows);
  finder.ThrowIfAnyIsMissing("person");
  return surfaces;
}

}  // namespace railcast
