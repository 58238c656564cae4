#include "core/base/inputs.h"

#include <map>
#include <mutex>
#include <optional>

#include "core/base/error.h"
#include "core/base/input_file.h"

namespace railcast {
namespace {

/// By absolute path; null where a file was noted alone, or released.
using InputsByPath = std::map<std::filesystem::path, InputBytes>;

std::mutex inputs_mutex;
std::optional<InputsByPath>& Current() {
  static std::optional<InputsByPath> current;
  return current;
}

std::filesystem::path KeyOf(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal();
}

}  // namespace

Inputs::Inputs() {
  const std::lock_guard lock(inputs_mutex);
  Check(!Current(), "a program has one list of inputs");
  Current().emplace();
}

Inputs::~Inputs() {
  const std::lock_guard lock(inputs_mutex);
  Current().reset();
}

void Inputs::Release() {
  const std::lock_guard lock(inputs_mutex);
  if (!Current()) return;
  for (auto& [file, bytes] : *Current()) bytes.reset();
}

InputBytes ReadInput(const std::filesystem::path& file) {
  const auto read = [&] { return std::make_shared<const std::string>(ReadFileWhole(file)); };
  const std::lock_guard lock(inputs_mutex);
  if (!Current()) return read();
  InputBytes& bytes = (*Current())[KeyOf(file)];
  if (!bytes) bytes = read();
  return bytes;
}

void NoteInput(const std::filesystem::path& file) {
  const std::lock_guard lock(inputs_mutex);
  if (Current()) Current()->try_emplace(KeyOf(file));
}

std::vector<std::filesystem::path> InputFiles() {
  const std::lock_guard lock(inputs_mutex);
  std::vector<std::filesystem::path> files;
  if (!Current()) return files;
  for (const auto& [file, bytes] : *Current()) files.push_back(file);
  return files;
}

}  // namespace railcast
