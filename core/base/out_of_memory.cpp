#include "core/base/out_of_memory.h"

#include <atomic>

#include "core/base/text.h"

namespace railcast {

namespace {

constexpr std::size_t kReserve_bytes = 65536;
std::atomic<char*> memory_reserve = new char[kReserve_bytes];

}  // namespace

void FreeMemoryReserve() {
  delete[] memory_reserve.exchange(nullptr);
}

InputError OutOfMemory(const std::string& doing) {
  return InputError("out of memory while " + doing);
}

InputError OutOfThreads(const std::string& doing) {
  return InputError("no thread can be started while " + doing);
}

std::string ReadingText(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t num_bytes = std::filesystem::file_size(file, error);
  const std::string size = error ? "" : " (" + std::to_string(num_bytes) + " bytes)";
  return "reading " + ShownPath(file) + size;
}

}  // namespace railcast
