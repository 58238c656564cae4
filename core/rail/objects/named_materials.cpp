#include "core/rail/objects/named_materials.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <vector>

namespace railcast {
namespace {

struct WordRow {
  std::string_view word;
  std::string_view material;  ///< Empty: the name stands for none.
};

/// The first row that a name has counts. docs/world.md lists them.
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

}  // namespace

std::optional<NamedMaterial> MaterialOfName(std::string_view name) {
  const std::vector<std::string> words = WordsOfName(name);
  const auto* row = std::find_if(kWordRows.begin(), kWordRows.end(), [&](const WordRow& candidate) {
    return HasWordOfTable(words, candidate.word);
  });
  if (row == kWordRows.end() || row->material.empty()) return std::nullopt;
  return NamedMaterial{.material = row->material, .word = row->word};
}

}  // namespace railcast
