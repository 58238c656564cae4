#include "core/extras/recipe/shard.h"

#include "core/base/text.h"

namespace railcast {

std::optional<Shard> ParseShard(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const auto number = ParseNumber<std::uint32_t>(text.substr(0, slash));
  const auto of = ParseNumber<std::uint32_t>(text.substr(slash + 1));
  if (!number || !of || *number < 1 || *number > *of || *of > Shard::kMost) return std::nullopt;
  return Shard{*number, *of};
}

std::string ShardRule(const std::string& text) {
  if (ParseShard(text)) return "";
  return "must be I/N with I from 1 to N and N at most " + std::to_string(Shard::kMost) + " (got " +
         text + ")";
}

std::string ShardText(const Shard& shard) {
  return std::to_string(shard.number) + "/" + std::to_string(shard.of);
}

}  // namespace railcast
