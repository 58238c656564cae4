#pragma once

#include <unistd.h>

#include <utility>

namespace railcast {

/// An open file, folder or socket of the system, which is closed when this goes out of scope.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  /// @param number As the system gives it: negative if it could not open anything.
  explicit FileDescriptor(int number) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor() {
    if (is_open()) ::close(number_);
  }

  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }
  /// Closes it and checks the result: some file systems report a full disk only here.
  [[nodiscard]] bool Close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_ = -1;
};

}  // namespace railcast
