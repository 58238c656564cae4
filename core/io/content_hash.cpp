#include "core/io/content_hash.h"

#include <xxhash.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "core/base/input_file.h"

namespace railcast {
namespace {

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

}  // namespace railcast
