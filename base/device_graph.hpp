// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"

#include <array>
#include <utility>

namespace grouser::base {

/// Device work recorded once and replayed as one CUDA graph, at the host cost of a single kernel launch. On a CPU the
/// work runs directly.
///
/// The graph records launches and copies with their pointers, counts and constants, but no host code; call forget()
/// after any of these changes. The work must not allocate or wait.
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

  /// Runs `work()`, which enqueues work on the Exec and on side streams that fork from it and join it.
  template <class Work> void run(const Work& work) {
    if (exec_.onCpu()) return work();
    if (!recorded_) {
      Recording recording(*this);
      work();
      recording.finish();
    }
    start();
  }
  /// Discards the graph; the next run() records a new one.
  void forget() { recorded_ = false; }

private:
  /// Scope during which work enqueued on the stream is recorded instead of executed.
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

/// Graphs of work on double-buffered memory: a graph contains pointers, so each of the two buffers has its own graph.
class DoubleBufferedGraph {
public:
  DoubleBufferedGraph() = default;
  explicit DoubleBufferedGraph(const Exec& exec) {
    for (Turn& turn : turns_) turn.graph = DeviceGraph(exec);
  }
  /// Returns the graph of work that reads `buffer`, and half `other` of a second double buffer. A third combination
  /// replaces the second stored graph.
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

/// A second stream of an Exec's device, for work that may run concurrently with the Exec's own. On a CPU, the Exec.
class SideStream {
public:
  SideStream() = default;
  /// `first`: blocks of the side stream start before pending blocks of the main stream; otherwise after them.
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
  /// Makes later work on the side stream wait for all work now queued on the main stream.
  void fork();
  /// Makes later work on the main stream wait for all work now queued on the side stream.
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
