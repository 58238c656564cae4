#include "core/mesh/limited_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

// The first byte that the process sends, before its result or message. Without one it broke down.
constexpr char kDoneMark = 'd';
constexpr char kFaultMark = 'f';
constexpr char kMemoryMark = 'm';

constexpr int kPipe = STDERR_FILENO + 1;

/// The address space that this process may come to have, and whether that is all the system leaves
/// it.
struct AddressSpace {
  rlim_t most_bytes{};
  bool is_systems{};
};

AddressSpace AddressSpaceWith(std::uint64_t more_bytes) {
  std::uint64_t num_pages = 0;
  std::ifstream("/proc/self/statm") >> num_pages;
  const rlim_t wanted =
      num_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + more_bytes;
  rlimit now{};
  ::getrlimit(RLIMIT_AS, &now);
  const bool is_systems = now.rlim_cur != RLIM_INFINITY && now.rlim_cur < wanted;
  return {is_systems ? now.rlim_cur : wanted, is_systems};
}

void SetLimit(__rlimit_resource resource, rlim_t most) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? most : std::min(most, limit.rlim_max);
  ::setrlimit(resource, &limit);
}

/// Runs in the new process: what it has of its parent's is taken away, but for the pipe, which
/// becomes kPipe.
void Enclose(int pipe, const AddressSpace& space, std::uint64_t time_s) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // SIGABRT and those of faults, too: a host program may have handlers that write reports.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGBUS, SIGABRT, SIGFPE,
                           SIGILL, SIGXCPU, SIGALRM, SIGPIPE}) {
    ::signal(number, SIG_DFL);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(pipe, kPipe);  // First: a host program may have given it the number of a stream.
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  // Among the other files are the pipes of processes that other threads have started: these would
  // not end for their readers before this process does.
  ::close_range(kPipe + 1, std::numeric_limits<unsigned>::max(), 0);
  SetLimit(RLIMIT_CORE, 0);
  SetLimit(RLIMIT_AS, space.most_bytes);
  SetLimit(RLIMIT_CPU, time_s);
  // Against waiting for a lock that another thread of the parent held when it was copied.
  constexpr std::uint64_t kWaitingFactor = 20;
  ::alarm(static_cast<unsigned>(kWaitingFactor * time_s));
}

void SendAll(int pipe, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t num_sent = ::write(pipe, bytes.data(), bytes.size());
    if (num_sent < 0 && errno == EINTR) continue;
    if (num_sent <= 0) ::_exit(1);
    bytes.remove_prefix(static_cast<std::size_t>(num_sent));
  }
}

/// Runs in the new process: does the work and ends.
[[noreturn]] void WorkAndEnd(int pipe, const std::function<std::string()>& work) {
  const auto send = [&](char mark, std::string_view bytes) {
    SendAll(pipe, {&mark, 1});
    SendAll(pipe, bytes);
  };
  try {
    send(kDoneMark, work());
  } catch (const InputError& error) {
    send(kFaultMark, error.what());
  } catch (const std::bad_alloc&) {
    send(kMemoryMark, "");
  } catch (const std::length_error&) {
    send(kMemoryMark, "");
  } catch (...) {
    ::_exit(1);
  }
  // Nothing of the parent's is flushed or destroyed twice.
  ::_exit(0);
}

std::string ReceiveAll(int pipe) {
  std::string all;
  std::array<char, 65536> part{};
  while (true) {
    const ssize_t num_read = ::read(pipe, part.data(), part.size());
    if (num_read < 0 && errno == EINTR) continue;
    if (num_read <= 0) return all;
    all.append(part.data(), static_cast<std::size_t>(num_read));
  }
}

ProcessEnd EndOf(pid_t process, std::string received) {
  int status = 0;
  pid_t ended = 0;
  do {
    ended = ::waitpid(process, &status, 0);
  } while (ended < 0 && errno == EINTR);
  // A host program may have waited for it instead, and knows its status alone.
  const bool is_whole = ended < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 0);
  using Kind = ProcessEnd::Kind;
  if (!is_whole || received.empty()) {
    const bool lacks_time = ended > 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
    return {.kind = lacks_time ? Kind::kLackTime : Kind::kBroken};
  }
  const char mark = received.front();
  received.erase(0, 1);
  return {.kind = mark == kDoneMark    ? Kind::kDone
                  : mark == kFaultMark ? Kind::kFault
                                       : Kind::kLackMemory,
          .bytes = std::move(received)};
}

}  // namespace

ProcessEnd RunLimited(const ProcessLimits& limits, const std::function<std::string()>& work) {
  const auto fail = [] {
    throw InputError("no process can be started: " + std::generic_category().message(errno));
  };
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail();
  const AddressSpace space = AddressSpaceWith(limits.memory_bytes);
  const pid_t process = ::fork();
  if (process < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    fail();
  }
  if (process == 0) {
    Enclose(ends[1], space, limits.time_s);
    WorkAndEnd(kPipe, work);
  }
  ::close(ends[1]);
  std::string received;
  try {
    received = ReceiveAll(ends[0]);
  } catch (...) {
    ::close(ends[0]);  // Its next write ends the process.
    static_cast<void>(EndOf(process, {}));
    throw;
  }
  ::close(ends[0]);
  ProcessEnd end = EndOf(process, std::move(received));
  if (end.kind == ProcessEnd::Kind::kLackMemory && space.is_systems) throw std::bad_alloc();
  return end;
}

}  // namespace railcast
