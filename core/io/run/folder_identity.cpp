#include "core/io/run/folder_identity.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

// A key as the user knows it, and what its absence means.
struct KeyText {
  std::string_view key;
  std::string_view name;
  std::string_view absent = "nothing";
};

constexpr std::array kKeyTexts = {KeyText{"num_frames", "--frames"},
                                  KeyText{"start_frame", "--start-frame"},
                                  KeyText{"stride", "--stride", "1"},
                                  KeyText{"format", "--format"},
                                  KeyText{"fields", "--fields"},
                                  KeyText{"merged", "--merged"},
                                  KeyText{"points_alone", "--points-alone"},
                                  KeyText{"shard", "--shard", "1/1"},
                                  KeyText{"rare", "--rare", "off"},
                                  KeyText{"certify", "--certify", "off"}};

std::string IdentityText(const Json& value) {
  if (value.is_null()) return "nothing";
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_string()) return ShownText(value.get_ref<const std::string&>());
  return value.is_primitive() ? value.dump() : value.type_name();
}

// What two program versions or instruction sets make must not be mixed: neither would have made it.
std::string ProgramDifference(const std::string& key,
                              const Json& found,
                              const Json& ours,
                              const FolderIdentity& identity) {
  const bool is_isa = key == "isa";
  const std::string what = is_isa ? "instruction set" : key == "embree" ? "Embree" : "railcast";
  const std::string got = IdentityText(found) + " (got " + IdentityText(ours) + "); ";
  const std::string same = is_isa ? "add --isa " + IdentityText(found) : "use that one";
  if (identity.is_complete) {
    return "is complete, made " + std::string(is_isa ? "with " : "by ") + what + " " + got + same +
           ", or " + identity.advice;
  }
  return "must be continued " +
         (is_isa ? "with the " + what + " that it was begun with, "
                 : "by the " + what + " that began it, ") +
         got + same + ", or " + identity.advice;
}

}  // namespace

// A reference, because the library copies and writes recursively, and the member may be deeply
// nested.
const Json& MemberOf(const Json& object, const std::string& key) {
  static const Json nothing;
  const auto member = object.find(key);
  return member == object.end() ? nothing : *member;
}

std::string ValuesText(const std::string& key, const Json& found, const Json& ours) {
  const auto* const known = std::ranges::find(kKeyTexts, key, &KeyText::key);
  const KeyText text = known == kKeyTexts.end() ? KeyText{key, key} : *known;
  const auto show = [&](const Json& value) {
    if (value.is_null()) return std::string(text.absent);
    const bool is_share = key == "certify" && value.is_number();
    return is_share ? ShortText(100.0 * value.get<double>()) + "%" : IdentityText(value);
  };
  return "its " + std::string(text.name) + " is " + show(found) + " (got " + show(ours) + ")";
}

bool TakeFolder(const FolderIdentity& ours, const std::string& run, const DifferenceText& text_of) {
  if (std::filesystem::exists(ours.file)) {
    CheckIsSame(ours, text_of);
    return false;
  }
  const std::filesystem::path folder = ours.file.parent_path();
  const std::string unfinished = ours.file.string() + std::string(kUnfinishedSuffix);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool is_left_over = entry.path() == unfinished && entry.is_regular_file() &&
                              !entry.is_symlink() &&
                              ours.text.starts_with(ReadFileWhole(entry.path()));
    if (is_left_over) continue;
    throw InputError("--out: must be a new or an empty folder, or that of " + run +
                     " to continue (got " + ShownPath(folder) + ")");
  }
  WriteFileWhole(ours.file, ours.text);
  return true;
}

void CheckIsSame(const FolderIdentity& ours, const DifferenceText& text_of) {
  // Members nested deeper than railcast writes them are dropped, since the library copies
  // recursively.
  constexpr int kDepth = 8;
  const Json found = Json::parse(
      ReadFileWhole(ours.file),
      [](int depth, auto /*event*/, const auto& /*parsed*/) { return depth <= kDepth; }, false);
  const std::string place = ShownPath(ours.file.parent_path()) + ": ";
  if (!found.is_object()) {
    throw InputError(place + "holds a " + ours.file.filename().string() +
                     " that is not railcast's; " + ours.advice);
  }
  const Json own = Json::parse(ours.text);
  const auto compare = [&](const std::string& key) {
    const Json& theirs = MemberOf(found, key);
    if (theirs == MemberOf(own, key)) return;
    const bool is_program = key == "version" || key == "embree" || key == "isa";
    throw InputError(place + (is_program ? ProgramDifference(key, theirs, MemberOf(own, key), ours)
                                         : text_of(key, found, own) + "; " + ours.advice));
  };
  for (const auto& [key, value] : own.items()) compare(key);
  for (const auto& [key, value] : found.items()) compare(key);
}

}  // namespace railcast
