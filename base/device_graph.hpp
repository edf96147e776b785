// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <array>
#include <utility>

namespace grouser::base {

/// Repeated device work, recorded once and launched as one CUDA graph, at the host cost of a single kernel. A CPU
/// executes it directly.
///
/// Records launches and copies with their pointers, counts and constants, but no host code. The work must not allocate
/// or wait; call forget() when any of these has changed.
class DeviceGraph {
public:
  DeviceGraph() = default;
  explicit DeviceGraph(const Exec& exec) : exec_(exec) {}
  DeviceGraph(DeviceGraph&& other) noexcept { swap(other); }
  DeviceGraph& operator=(DeviceGraph&& other) noexcept {
    swap(other);
    return *this;
  }
  DeviceGraph(const DeviceGraph&) = delete;
  DeviceGraph& operator=(const DeviceGraph&) = delete;
  ~DeviceGraph();

  /// Runs `work()`, which queues work on the Exec and on side streams that fork from it and join it.
  template <class Work> void run(const Work& work) {
    if (exec_.onCpu()) return work();
    if (!recorded_) {
      Recording recording(*this);
      work();
      recording.finish();
    }
    start();
  }
  /// The next run records anew.
  void forget() { recorded_ = false; }

private:
  /// While it lives, work queued on the stream is recorded instead of executed.
  class Recording {
  public:
    explicit Recording(DeviceGraph& graph) : graph_(graph) { graph_.begin(); }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;
    ~Recording() {
      if (!finished_) graph_.abandon();
    }
    void finish() {
      finished_ = true;
      graph_.end();
    }

  private:
    DeviceGraph& graph_;
    bool finished_{false};
  };

  void begin();
  void end();
  void abandon() noexcept;
  void start();
  void swap(DeviceGraph& other) noexcept {
    std::swap(exec_, other.exec_);
    std::swap(graph_, other.graph_);
    std::swap(recorded_, other.recorded_);
  }

  Exec exec_{};
  void* graph_{nullptr}; ///< cudaGraphExec_t
  bool recorded_{false};
};

/// Graphs of work on double-buffered memory: a graph holds pointers, so there is one for each of the two buffers.
class DoubleBufferedGraph {
public:
  DoubleBufferedGraph() = default;
  explicit DoubleBufferedGraph(const Exec& exec) {
    for (Turn& turn : turns_) turn.graph = DeviceGraph(exec);
  }
  /// The graph of work that reads `buffer` first, and half `other` of a second double buffer. A third combination
  /// replaces the second.
  DeviceGraph& from(const void* buffer, unsigned other = 0) {
    for (Turn& turn : turns_)
      if (turn.taken && turn.buffer == buffer && turn.other == other) return turn.graph;
    Turn& turn = turns_[turns_[0].taken ? 1 : 0];
    turn.taken = true, turn.buffer = buffer, turn.other = other;
    turn.graph.forget();
    return turn.graph;
  }
  void forget() {
    for (Turn& turn : turns_) turn.taken = false;
  }

private:
  struct Turn {
    bool taken{false};
    const void* buffer{nullptr};
    unsigned other{0};
    DeviceGraph graph;
  };
  std::array<Turn, 2> turns_;
};

/// A second stream of an Exec's device, for work that may run beside the Exec's own. On a CPU it is the Exec itself.
class SideStream {
public:
  SideStream() = default;
  /// `first`: blocks of the side stream start before those of the main stream that wait; else after them.
  explicit SideStream(const Exec& main, bool first = false);
  SideStream(SideStream&& other) noexcept { swap(other); }
  SideStream& operator=(SideStream&& other) noexcept {
    swap(other);
    return *this;
  }
  SideStream(const SideStream&) = delete;
  SideStream& operator=(const SideStream&) = delete;
  ~SideStream();

  const Exec& exec() const { return side_; }
  /// Work queued on the side from now on waits for all that is queued on the main stream so far.
  void fork();
  /// Work queued on the main stream from now on waits for all that is queued on the side so far.
  void join();

private:
  void swap(SideStream& other) noexcept {
    std::swap(main_, other.main_);
    std::swap(side_, other.side_);
    std::swap(forked_, other.forked_);
    std::swap(joined_, other.joined_);
  }
  Exec main_{}, side_{};
  void *forked_{nullptr}, *joined_{nullptr}; ///< cudaEvent_t
};

} // namespace grouser::base
