#include "core/rail/objects/object_surfaces.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

struct WordRow {
  std::string_view word;
  std::string_view material;  ///< Empty: the name stands for none.
};

/// The first row that a name has counts. docs/things.md lists them.
constexpr auto kWordRows = std::to_array<WordRow>({
    // What surrounds a pane, and colours of paint: "FensterRahmen", "metallicPaint".
    {"frame", ""},
    {"rahmen", ""},
    {"paint", ""},
    {"glass", "glass"},
    {"glas", "glass"},
    {"window", "glass"},
    {"windscreen", "glass"},
    {"windshield", "glass"},
    {"fenster", "glass"},
    {"scheibe", "glass"},
    {"vitre", "glass"},
    {"rubber", "black_rubber"},
    {"tyre", "black_rubber"},
    {"tyres", "black_rubber"},
    {"tire", "black_rubber"},
    {"tires", "black_rubber"},
    {"reifen", "black_rubber"},
    {"gummi", "black_rubber"},
    {"leaf", "leaf"},
    {"leaves", "leaf"},
    {"foliage", "leaf"},
    {"laub", "leaf"},
    {"bark", "bark"},
    {"rinde", "bark"},
    {"wood", "wood"},
    {"wooden", "wood"},
    {"timber", "wood"},
    {"holz", "wood"},
    {"brick", "masonry"},
    {"masonry", "masonry"},
    {"mauerwerk", "masonry"},
    {"concrete", "concrete"},
    {"beton", "concrete"},
    {"asphalt", "asphalt"},
    {"gravel", "ballast"},
    {"schotter", "ballast"},
    {"plastic", "plastic"},
    {"kunststoff", "plastic"},
    {"skin", "skin"},
    {"shirt", "clothing"},
    {"trousers", "clothing"},
    {"pants", "clothing"},
    {"metal", "galvanised_steel"},
    {"steel", "galvanised_steel"},
    {"stahl", "galvanised_steel"},
    {"chrome", "galvanised_steel"},
    {"alumin", "galvanised_steel"},
    {"alu", "galvanised_steel"},
    {"iron", "galvanised_steel"},
});

/// Its words in small letters.
std::vector<std::string> WordsOfName(std::string_view name) {
  std::vector<std::string> words;
  bool is_in_word = false;
  bool was_small = false;
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool is_letter = byte < 0x80 && std::isalpha(byte) != 0;
    const bool is_capital = is_letter && std::isupper(byte) != 0;
    if (is_letter) {
      if (!is_in_word || (is_capital && was_small)) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(byte));
    }
    is_in_word = is_letter;
    was_small = is_letter && !is_capital;
  }
  return words;
}

bool HasWordOfTable(const std::vector<std::string>& words, std::string_view word) {
  constexpr std::size_t kLeastPiece = 5;
  return std::any_of(words.begin(), words.end(), [&](const std::string& mine) {
    return mine == word || (word.size() >= kLeastPiece && mine.find(word) != std::string::npos);
  });
}

/// Whether a material is called like `paint_25`.
bool IsPaintOfColors(const Material& material) {
  constexpr std::string_view kPrefix = "paint_";
  const std::string_view name = material.name;
  return name.starts_with(kPrefix) && name.size() == kPrefix.size() + 2 && IsDigit(name[6]) &&
         IsDigit(name[7]) && material.reflectivity > 0.0;
}

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

std::optional<NamedMaterial> MaterialOfName(std::string_view name) {
  const std::vector<std::string> words = WordsOfName(name);
  const auto* row = std::find_if(kWordRows.begin(), kWordRows.end(), [&](const WordRow& candidate) {
    return HasWordOfTable(words, candidate.word);
  });
  if (row == kWordRows.end() || row->material.empty()) return std::nullopt;
  return NamedMaterial{.material = row->material, .word = row->word};
}

std::optional<std::uint16_t> PaintOfLuminance(const MaterialLibrary& library, double luminance) {
  std::optional<std::uint16_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < library.materials().size(); ++i) {
    const Material& material = library.materials()[i];
    if (!IsPaintOfColors(material)) continue;
    // The logarithm of black is equally far from that of every paint.
    const double distance = std::abs(std::log(material.reflectivity / std::max(luminance, 1e-6)));
    if (distance >= least) continue;
    least = distance;
    best = static_cast<std::uint16_t>(i);
  }
  return best;
}

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
