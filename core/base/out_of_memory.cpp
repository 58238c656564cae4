#include "core/base/out_of_memory.h"

#include <algorithm>
#include <atomic>
#include <string_view>

#include "core/base/text.h"

namespace railcast {

namespace {

constexpr std::size_t kReserve_bytes = 65536;
std::atomic<char*> memory_reserve = new char[kReserve_bytes];

constexpr std::string_view kOutOfMemory = "out of memory while ";
constexpr std::string_view kOutOfThreads = "no thread can be started while ";

}  // namespace

void FreeMemoryReserve() {
  delete[] memory_reserve.exchange(nullptr);
}

InputError OutOfMemory(const std::string& doing) {
  return InputError(std::string(kOutOfMemory) + doing);
}

InputError OutOfThreads(const std::string& doing) {
  return InputError(std::string(kOutOfThreads) + doing);
}

bool IsOutOfMemory(const InputError& error) {
  return std::any_of(error.faults().begin(), error.faults().end(), [](const Fault& fault) {
    return fault.rule.starts_with(kOutOfMemory) || fault.rule.starts_with(kOutOfThreads);
  });
}

std::string ReadingText(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t num_bytes = std::filesystem::file_size(file, error);
  const std::string size = error ? "" : " (" + std::to_string(num_bytes) + " bytes)";
  return "reading " + ShownPath(file) + size;
}

}  // namespace railcast
