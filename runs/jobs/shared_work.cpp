// SPDX-License-Identifier: BSD-3-Clause
#include "runs/jobs/shared_work.hpp"

#include "base/error.hpp"
#include "base/shared_memory.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/support/child_process.hpp"
#include "runs/support/device_choice.hpp"
#include "runs/support/failure.hpp"
#include "runs/support/stop_signals.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <deque>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace grouser::jobs {

namespace {

// Output of a child: one character per finished piece; on failure, a letter for its kind, then the message.
constexpr char kDone = '.', kFirstKind = 'a';
constexpr int kPause = 100; ///< interval between checks for signals [ms]

/// Index of the next piece, shared by all processes.
class NextPiece {
public:
  NextPiece() : block_(base::createShared(sizeof(Number))) {
    if (!block_.memory)
      throw base::DeviceError("cannot allocate shared memory for several processes; use --jobs 1 or --processes 1");
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

/// Runs in a child process: processes pieces until none are left, and reports each.
void doPieces(const support::Descriptor& report, NextPiece& next, std::size_t count,
              const std::function<void(std::size_t)>& work) {
  try {
    for (std::size_t i = next.take(); i < count; i = next.take()) {
      work(i);
      report.write({kDone});
    }
  } catch (...) {
    const support::Failure failure = support::failureOf(std::current_exception());
    report.write(static_cast<char>(kFirstKind + static_cast<int>(failure.kind)) + failure.message);
  }
}

/// Reads a report; text after the letters of finished pieces describes a failure. False when the process has ended.
bool listen(support::ChildProcess& child, std::string& failure, const std::function<void()>& done) {
  std::string report;
  const bool continues = child.read(report);
  for (const char c : report) {
    if (failure.empty() && c == kDone)
      done();
    else
      failure += c;
  }
  return continues;
}

/// Throws an exception if a process has ended with an error.
void judge(const support::ProcessEnd& end, const std::string& failure) {
  if (!failure.empty())
    support::rethrow({static_cast<support::FailureKind>(failure[0] - kFirstKind), failure.substr(1)});
  if (end.signal == SIGKILL)
    throw base::DeviceError("one of the processes was killed; out of memory? Use fewer --processes");
  if (end.signal != 0) throw std::runtime_error(fmt::format("one of the processes was {}", end.text()));
}

} // namespace

void shareWork(int processes, std::size_t count, const std::function<void(std::size_t)>& work,
               const std::function<void()>& done) {
  const support::StopSignals signals;
  if (processes <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      stopStudyOnRequest();
      work(i);
      done();
    }
    return;
  }
  NextPiece next;
  std::deque<support::ChildProcess> children;
  const std::size_t all = std::min(static_cast<std::size_t>(processes), std::max<std::size_t>(count, 1));
  while (children.size() < all) {
    const std::string gpu = support::firstGpuOf(static_cast<int>(children.size()));
    children.emplace_back([&](const support::Descriptor& report) { doPieces(report, next, count, work); },
                          support::Environment{{support::kFirstGpu, gpu}});
  }
  std::vector<std::string> failures(all);
  std::size_t ready = 0;
  const auto oneMore = [&] { ++ready, done(); };
  for (std::size_t running = all; running > 0;) {
    std::vector<pollfd> ends;
    for (const support::ChildProcess& child : children) ends.push_back({child.output(), POLLIN, 0});
    poll(ends.data(), ends.size(), kPause);
    stopStudyOnRequest();
    for (std::size_t k = 0; k < all; ++k) {
      if (ends[k].revents == 0 || listen(children[k], failures[k], oneMore)) continue;
      --running;
      judge(children[k].wait(), failures[k]);
    }
  }
  if (ready < count) throw std::runtime_error("one of the processes ended before it had finished its work");
}

} // namespace grouser::jobs
