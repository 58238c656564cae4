#include "core/io/content_hash.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include <xxhash.h>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr std::string_view kBegin = ",\"line_xxh3\":\"";
constexpr std::string_view kEnd = "\"}";

std::string HashText(std::uint64_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = 0; i < text.size(); ++i) {
    text[i] = kDigits[static_cast<std::size_t>((hash >> (60U - 4U * i)) & 0xFU)];
  }
  return text;
}

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

}  // namespace

std::string ContentHash(std::string_view bytes) {
  return HashText(ContentHashNumber(bytes));
}

std::uint64_t ContentHashNumber(std::string_view bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

FileHash HashFile(const std::filesystem::path& file) {
  const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
  if (state == nullptr) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  std::ifstream stream = OpenInput(file);
  constexpr std::size_t kBlock = 1U << 18U;
  std::vector<char> block(kBlock);
  std::uint64_t num_bytes = 0;
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    XXH3_64bits_update(state.get(), block.data(), count);
    num_bytes += count;
  }
  if (stream.bad()) throw FileError(file, errno);
  return {HashText(XXH3_64bits_digest(state.get())), num_bytes};
}

std::string WithLineHash(std::string_view object) {
  Check(object.size() > 2 && object.ends_with('}'), "a line is an object with members");
  object.remove_suffix(1);
  std::string line(object);
  line += kBegin;
  line += ContentHash(object);
  return line += kEnd;
}

std::string WithoutLineHash(std::string_view line) {
  const std::size_t begin = line.rfind(kBegin);
  if (begin == std::string_view::npos) return std::string(line);
  return std::string(line.substr(0, begin)) + "}";
}

std::string LineHashFault(std::string_view line) {
  const std::size_t begin = line.rfind(kBegin);
  if (begin == std::string_view::npos) return "must end with line_xxh3, the hash of all before it";
  const std::string hash = ContentHash(line.substr(0, begin));
  std::string_view got = line.substr(begin + kBegin.size());
  if (got == hash + std::string(kEnd)) return "";
  if (got.ends_with(kEnd)) got.remove_suffix(kEnd.size());
  return "/line_xxh3: must be " + hash + ", that of all before it (got " + ShownText(got) + ")";
}

}  // namespace railcast
