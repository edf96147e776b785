// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

/// MPI ranks that run one scene together. Only these functions call MPI, except for HDF5 output that all ranks write to
/// one file. A program started as a single process never calls MPI.
namespace grouser::base {

using Bytes = std::vector<std::byte>;

/// Communicator of a run; cheap to copy. The default has a single rank, for which every call returns immediately
/// without MPI. Results are in rank order. All ranks must make the same calls in the same order. MPI errors abort all.
class Comm {
public:
  Comm() = default;

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool alone() const { return size_ == 1; }
  bool first() const { return rank_ == 0; }

  /// Sums values over all ranks in place. Integer sums are exact, so the result does not depend on the rank order.
  void sum(std::int64_t* values, std::size_t count) const;
  void minimum(std::uint64_t* values, std::size_t count) const;
  void maximum(std::uint64_t* values, std::size_t count) const;
  void maximum(double* values, std::size_t count) const;
  std::uint64_t maximumOf(std::uint64_t value) const {
    maximum(&value, 1);
    return value;
  }
  std::int64_t sumOf(std::int64_t value) const {
    sum(&value, 1);
    return value;
  }
  /// Sum of the values of all lower ranks.
  std::int64_t sumBelow(std::int64_t value) const;
  void wait() const; ///< barrier over all ranks
  /// Host of a rank, identified by the lowest rank on that host.
  int hostOf(int rank) const { return hosts_ ? (*hosts_)[static_cast<std::size_t>(rank)] : 0; }
  /// Time this rank has spent waiting for other ranks since the start [s]; 0 for a single rank.
  double waited() const { return waited_ ? *waited_ : 0.0; }

  /// Gathers data from all ranks, in rank order.
  std::vector<Bytes> gather(const Bytes& mine) const;
  /// Sends `to[r]` to rank r; returns the data received, by rank.
  std::vector<Bytes> allToAll(const std::vector<Bytes>& to) const;
  /// Copies the data of `root` to all ranks.
  Bytes broadcast(const Bytes& bytes, int root = 0) const;
  std::string broadcast(const std::string& text, int root = 0) const;

  /// Gathers one trivially copyable value from every rank, in rank order.
  template <class T> std::vector<T> gatherValue(const T& mine) const {
    std::vector<T> all;
    for (const std::vector<T>& part : gatherAll(std::vector<T>{mine})) all.push_back(part.front());
    return all;
  }
  template <class T> std::vector<std::vector<T>> gatherAll(const std::vector<T>& mine) const {
    std::vector<std::vector<T>> all;
    for (const Bytes& bytes : gather(bytesOf(mine))) all.push_back(valuesOf<T>(bytes));
    return all;
  }

  /// Blocking send to one rank and receive from one rank.
  void send(int to, const Bytes& bytes) const;
  Bytes receive(int from) const;

  template <class T> static Bytes bytesOf(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* raw = reinterpret_cast<const std::byte*>(values.data());
    return {raw, raw + values.size() * sizeof(T)};
  }
  template <class T> static std::vector<T> valuesOf(const Bytes& bytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* values = reinterpret_cast<const T*>(bytes.data());
    return {values, values + bytes.size() / sizeof(T)};
  }

private:
  friend class Ranks;
  friend class Messages;
  int rank_{0}, size_{1};
  std::shared_ptr<double> waited_;                ///< shared by all copies
  std::shared_ptr<const std::vector<int>> hosts_; ///< hostOf() by rank; null for a single rank
};

/// Non-blocking messages between ranks, completed together by waitAll().
class Messages {
public:
  explicit Messages(const Comm& comm);
  ~Messages();
  Messages(Messages&&) noexcept;
  Messages& operator=(Messages&&) noexcept;

  /// Posts a receive. Do not change `memory` before waitAll(). Messages between two ranks with the same tag stay in
  /// order. Large messages are split, so any size is allowed.
  void receive(int from, void* memory, std::size_t bytes, int tag);
  void send(int to, const void* memory, std::size_t bytes, int tag);
  void waitAll();
  /// True if MPI accepts pointers to device memory (CUDA-aware MPI).
  static bool deviceMemoryTravels();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Initialises and finalises MPI; one instance for the life of the program. Has no effect if the program was started
/// as a single process.
class Ranks {
public:
  /// Initialises MPI if an MPI launcher has started several processes.
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  const Comm& comm() const { return comm_; }
  int rankOnHost() const { return rankOnHost_; }
  int ranksOnHost() const { return ranksOnHost_; }
  /// Aborts all ranks with an exit code. Returns if there is only one rank.
  void abort(int code) const;

private:
  Comm comm_;
  int rankOnHost_{0}, ranksOnHost_{1};
};

} // namespace grouser::base
