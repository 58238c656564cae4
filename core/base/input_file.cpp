#include "core/base/input_file.h"

#include <cctype>
#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>

#include "core/base/text.h"

namespace railcast {

InputError FileError(const std::filesystem::path& file, int error_number) {
  std::string reason = std::generic_category().message(error_number);
  reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
  return InputError(ShownPath(file) + ": " + reason);
}

std::string_view NameOf(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::directory:
      return "a directory";
    case std::filesystem::file_type::fifo:
      return "a FIFO";
    case std::filesystem::file_type::character:
      return "a character device";
    case std::filesystem::file_type::block:
      return "a block device";
    case std::filesystem::file_type::socket:
      return "a socket";
    case std::filesystem::file_type::symlink:
      return "a symbolic link";
    default:
      return "something else";
  }
}

void CheckIsRegular(const std::filesystem::path& file, const std::filesystem::file_status& status) {
  using std::filesystem::file_type;
  const file_type type = status.type();
  if (type == file_type::regular || type == file_type::not_found || type == file_type::none) return;
  throw InputError(ShownPath(file) + ": must be a regular file (got " + std::string(NameOf(type)) +
                   ")");
}

void CheckIsReadable(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!exists(status)) throw FileError(file, error ? error.value() : ENOENT);
  CheckIsRegular(file, status);
}

std::ifstream OpenInput(const std::filesystem::path& file) {
  CheckIsReadable(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, errno);
  return stream;
}

std::string ReadFileWhole(const std::filesystem::path& file) {
  std::ifstream stream = OpenInput(file);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw FileError(file, error.value());
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) throw FileError(file, errno);
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace railcast
