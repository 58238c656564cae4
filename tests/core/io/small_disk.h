#pragma once

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace railcast {

/// The result of a process on a small disk, or why the system refused to run it.
struct SmallDiskResult {
  /// For example "unshare: Operation not permitted"; empty if the work was done.
  std::string refused;
  std::string said;
};

inline std::string RefusedCall(const char* call) {
  return std::string(call) + ": " + std::generic_category().message(errno);
}

inline bool WriteTo(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Maps the user to root of the user namespace; without such a mapping it cannot create files.
inline bool KeepUser(uid_t user, gid_t group) {
  const auto write_file = [](const char* file, const std::string& text) {
    const int descriptor = ::open(file, O_WRONLY | O_CLOEXEC);
    const bool is_written = descriptor >= 0 && WriteTo(descriptor, text);
    ::close(descriptor);
    return is_written;
  };
  return write_file("/proc/self/setgroups", "deny") &&
         write_file("/proc/self/uid_map", "0 " + std::to_string(user) + " 1") &&
         write_file("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
}

/// Mounts an empty 1 MiB tmpfs that only this process sees.
/// @return The call that the system refused; empty if none.
inline std::string MountSmallDisk(const std::filesystem::path& disk) {
  const uid_t user = ::getuid();
  const gid_t group = ::getgid();
  if (::unshare(CLONE_NEWNS) != 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return RefusedCall("unshare");
    if (!KeepUser(user, group)) return RefusedCall("uid_map");
  }
  if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("none", disk.c_str(), "tmpfs", 0, "size=1m") != 0) {
    return RefusedCall("mount");
  }
  return {};
}

// The first character of each message from the child.
inline constexpr char kSaysRefused = 'r';
inline constexpr char kSaysMounted = 'm';  // Sent before the work; the two below, after it.
inline constexpr char kSaysDone = 'd';
inline constexpr char kSaysThrown = 't';

/// Runs in the child: mounts the disk, does the work and reports the result. No exception may leave
/// this function, or the parent's destructors would run a second time in the child.
[[noreturn]] inline void WorkOnSmallDisk(
    const std::filesystem::path& disk,
    const std::function<std::string(const std::filesystem::path&)>& work,
    int parent) noexcept {
  // A lock that another thread held at the fork is held forever here: the process must end all the
  // same, and the test fail.
  constexpr unsigned kMost_s = 300;
  ::alarm(kMost_s);
  const std::string refused = MountSmallDisk(disk);
  if (!refused.empty()) ::_exit(WriteTo(parent, kSaysRefused + refused) ? 0 : 1);
  std::string said(1, kSaysMounted);
  bool is_heard = WriteTo(parent, said);
  try {
    said = kSaysDone + work(disk);
  } catch (const std::exception& error) {
    said = kSaysThrown + std::string(error.what());
  }
  is_heard = WriteTo(parent, said) && is_heard;
  ::_exit(is_heard ? 0 : 1);
}

/// Runs `work(disk)` in a child process that sees an empty 1 MiB tmpfs at `disk`, in a mount
/// namespace of its own (and a user namespace, where the test is not run as root). Returns the
/// result of `work`.
/// @throws std::runtime_error if the work throws or its process dies. Calls that the system refuses
///   are not failures; SmallDiskResult::refused names them.
inline SmallDiskResult RunOnSmallDisk(
    const std::filesystem::path& disk,
    const std::function<std::string(const std::filesystem::path&)>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error(RefusedCall("pipe"));
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error(RefusedCall("fork"));
  if (child == 0) WorkOnSmallDisk(disk, work, ends[1]);
  ::close(ends[1]);
  std::string said;
  std::array<char, 4096> buffer{};
  ssize_t count = 0;
  while ((count = ::read(ends[0], buffer.data(), buffer.size())) > 0) {
    said.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (said.starts_with(kSaysRefused)) return {"no small disk here: " + said.substr(1), {}};
  if (said.size() < 2 || said[0] != kSaysMounted || status != 0) {
    throw std::runtime_error("the process on the small disk died with status " +
                             std::to_string(status) + " (said \"" + said + "\")");
  }
  if (said[1] == kSaysThrown) {
    throw std::runtime_error("the work on the small disk threw: " + said.substr(2));
  }
  return {{}, said.substr(2)};
}

}  // namespace railcast
