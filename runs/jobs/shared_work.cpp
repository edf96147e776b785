// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/shared_work.hpp"

#include "base/error.hpp"
#include "base/shared_memory.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/failure.hpp"
#include "runs/support/stop_signals.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace grouser::jobs {

namespace {

// What a child says: one letter for each piece done; where one fails, the letter of its kind and then the message to
// the end.
constexpr char kDone = '.', kFirstKind = 'a';
constexpr int kPause = 100; ///< between looks at the signals [ms]

[[noreturn]] void stopped(int signal) {
  throw support::Stopped(signal, fmt::format("stopped by {}", support::StopSignals::name(signal)));
}

void say(int pipe, const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = write(pipe, text.data() + sent, text.size() - sent);
    if (n < 0 && errno != EINTR) return; // the parent is gone
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
}

/// What is to be done next, for all processes.
class NextPiece {
public:
  NextPiece() : block_(base::createShared(sizeof(Number))) {
    if (!block_.memory) throw base::DeviceError("no memory to share among processes; take --jobs 1 or --processes 1");
    number_ = new (block_.memory) Number(0);
  }
  ~NextPiece() { base::closeShared(block_.memory, sizeof(Number)), base::endSharing(block_); }
  NextPiece(const NextPiece&) = delete;
  NextPiece& operator=(const NextPiece&) = delete;
  std::size_t take() { return number_->fetch_add(1); }

private:
  using Number = std::atomic<std::size_t>;
  static_assert(Number::is_always_lock_free);
  base::SharedBlock block_;
  Number* number_ = nullptr;
};

[[noreturn]] void child(const std::string& gpu, int pipe, NextPiece& next, std::size_t count,
                        const std::function<void(std::size_t)>& work) {
  // The parent decides what a signal means, and no child outlives it.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setenv(support::kFirstGpu, gpu.c_str(), 1);
  try {
    for (std::size_t i = next.take(); i < count; i = next.take()) {
      work(i);
      say(pipe, {kDone});
    }
  } catch (...) {
    const support::Failure failure = support::failureOf(std::current_exception());
    say(pipe, static_cast<char>(kFirstKind + static_cast<int>(failure.kind)) + failure.message);
  }
  _exit(0); // nothing of the parent's may be flushed or tidied up twice
}

struct Child {
  pid_t process = -1;
  int pipe = -1;
  std::string message; ///< kind and text of a failure
};

/// All children of one call; those that still run are ended with it, at once: a gentler signal that comes before a
/// child has set its own handlers would be lost.
class Children {
public:
  Children() = default;
  ~Children() {
    for (Child& c : all) {
      if (c.process > 0) kill(c.process, SIGKILL), waitpid(c.process, nullptr, 0);
      if (c.pipe >= 0) close(c.pipe);
    }
  }
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  std::vector<Child> all;
};

void start(Children& children, NextPiece& next, std::size_t count, const std::function<void(std::size_t)>& work) {
  const std::string gpu = support::firstGpuOf(static_cast<int>(children.all.size()));
  int ends[2];
  if (pipe(ends) != 0) throw base::DeviceError(fmt::format("no pipe to a process: {}", std::strerror(errno)));
  const pid_t process = fork();
  if (process == 0) {
    close(ends[0]);
    child(gpu, ends[1], next, count, work);
  }
  close(ends[1]);
  children.all.push_back({process, ends[0], ""});
  if (process < 0) throw base::DeviceError(fmt::format("no process could be started: {}", std::strerror(errno)));
}

/// Takes what a child has said. False when it has ended.
bool listen(Child& c, const std::function<void()>& done) {
  char buffer[4096];
  const ssize_t n = read(c.pipe, buffer, sizeof buffer);
  if (n < 0 && errno == EINTR) return true;
  for (ssize_t i = 0; i < n; ++i) {
    if (c.message.empty() && buffer[i] == kDone)
      done();
    else
      c.message += buffer[i];
  }
  return n > 0;
}

/// What the end of a child means.
void judge(const Child& c, int status) {
  if (!c.message.empty())
    support::rethrow({static_cast<support::FailureKind>(c.message[0] - kFirstKind), c.message.substr(1)});
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    throw base::DeviceError("one of the processes was killed; out of memory? Take fewer --processes");
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("one of the processes was ended by signal {}", WTERMSIG(status)));
}

} // namespace

void shareWork(int processes, std::size_t count, const std::function<void(std::size_t)>& work,
               const std::function<void()>& done) {
  const support::StopSignals signals;
  if (processes <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      if (const int signal = support::StopSignals::received()) stopped(signal);
      work(i);
      done();
    }
    return;
  }
  NextPiece next;
  Children children;
  const std::size_t all = std::min(static_cast<std::size_t>(processes), std::max<std::size_t>(count, 1));
  for (std::size_t k = 0; k < all; ++k) start(children, next, count, work);
  std::size_t ready = 0;
  const auto oneMore = [&] { ++ready, done(); };
  for (std::size_t running = all; running > 0;) {
    std::vector<pollfd> ends;
    for (const Child& c : children.all) ends.push_back({c.process > 0 ? c.pipe : -1, POLLIN, 0});
    poll(ends.data(), ends.size(), kPause);
    if (const int signal = support::StopSignals::received()) stopped(signal);
    for (std::size_t k = 0; k < all; ++k) {
      Child& c = children.all[k];
      if (!(ends[k].revents & (POLLIN | POLLHUP)) || listen(c, oneMore)) continue;
      int status = 0;
      waitpid(c.process, &status, 0);
      c.process = -1;
      --running;
      judge(c, status);
    }
  }
  if (ready < count) throw std::runtime_error("one of the processes ended before its work was done");
}

} // namespace grouser::jobs
