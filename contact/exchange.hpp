// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "base/message_buffer.hpp"
#include "base/peer_memory.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grouser::contact {

/// One field of an element type in device memory: `words` 32-bit words per element.
struct ExchangeField {
  void* data;          ///< one per slot, or one per plan entry if `byPlace`
  std::uint32_t words; ///< words per element
  bool byPlace = false;
};

/// Field stored as an array by slot.
template <class T> ExchangeField fieldOf(base::Array<T>& array) {
  static_assert(sizeof(T) % 4 == 0);
  return {array.data(), sizeof(T) / 4};
}

/// Options of an exchange; they do not change the transferred data.
struct ExchangeOptions {
  base::PeerUse peers;                             ///< whether GPUs of one machine unpack from each other's memory
  std::size_t wordsAtATime = std::size_t{1} << 30; ///< maximum packed per launch
};

/// Transfers elements between ranks, independent of the element type: the caller specifies which slots go to which
/// ranks (a communication plan), the fields to transfer, and the slots of the imports. A migration (full state) and a
/// ghost update (fewer fields) need two plans, or one plan with two field lists.
///
/// An exchange may run any number of times within a step. Elements are packed and unpacked on the device. If the
/// receiver's GPU can access the sender's memory, it unpacks from there, and MPI only notifies it that the sender has
/// packed; otherwise MPI transfers device memory if it supports this, else pinned host memory. All member functions are
/// collective and must be called in the same order on all ranks.
class Exchange {
public:
  static constexpr std::size_t kMaxFields = 16;

  Exchange(const base::Exec& exec, const base::Comm& comm, const ExchangeOptions& options);

  /// Sends `slots[k]` to rank `ranks[k]`, for k < count. Both are device arrays; this call sorts them by rank, stably.
  void setPlan(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count);

  std::size_t exportCount() const { return sendSlots_.size(); }
  std::size_t importCount() const { return importCount_; }
  /// Slots of exported elements in plan order (grouped by rank).
  const std::uint32_t* exportSlots() const { return sendSlots_.data(); }

  /// Imports are stored in slots first, first + 1...
  void setImportSlots(std::size_t first);
  /// Updates the plan after a sort: slot s is now newSlot[s] (device array), for exports and imports.
  void renumber(const std::uint32_t* newSlot);

  /// Packs and sends the fields, which may be overwritten as soon as this returns.
  void start(std::span<const ExchangeField> fields) {
    pack(exec_, fields);
    base::synchronize(exec_);
    send();
  }
  /// Waits for the imports and unpacks them into `fields`, which must have the same word counts as the fields sent.
  void finish(std::span<const ExchangeField> fields) {
    arrive();
    unpack(exec_, fields);
  }
  bool underWay() const { return stage_ > Stage::packed; }
  void run(std::span<const ExchangeField> fields) {
    start(fields);
    finish(fields);
  }

  // Separate steps of start() and finish(), to overlap with other work. `exec`: the exchange's Exec or a side stream.

  /// Enqueues packing on `exec` into the buffer half not used by the previous run, without waiting. If the buffer must
  /// grow, this waits for all ranks; the second of two equally large runs on one plan never grows it. Packing may be
  /// repeated on all ranks before send(); the first packing is then discarded.
  void pack(const base::Exec& exec, std::span<const ExchangeField> fields);
  void send();   ///< call synchronize() first, so that packing is complete
  void arrive(); ///< waits for the messages; returns at once if there are none
  /// Enqueues unpacking on `exec`, without waiting.
  void unpack(const base::Exec& exec, std::span<const ExchangeField> fields);

  /// True if every rank can access the memory of all others. Then a base::PeerReduction queued between pack() and
  /// unpack() replaces the messages, and publish() replaces send() and arrive().
  bool peersOnly() const { return packed_.allSeeAll(); }
  bool sharesMemory() const { return packed_.seesAny(); } ///< true if it can access another rank's memory
  void publish();
  void discard();                    ///< discards packed or published data
  void countRuns(std::int64_t runs); ///< adds published runs to the counts below
  unsigned bufferIndex() const {
    return bufferIndex_;
  } ///< buffer half packed last; recorded graphs contain pointers to it

  std::int64_t bytesSent() const { return bytesSent_; } ///< bytes sent by this rank since the start
  std::int64_t runs() const { return runs_; }

private:
  static std::size_t placeOf(const std::vector<std::uint32_t>& starts, int rank) {
    return starts[static_cast<std::size_t>(rank)];
  }
  std::size_t placesTo(int rank) const { return placeOf(sendStart_, rank + 1) - placeOf(sendStart_, rank); }
  std::size_t placesFrom(int rank) const { return placeOf(receiveStart_, rank + 1) - placeOf(receiveStart_, rank); }
  /// True if elements are exchanged with this peer; each then notifies the other by a message after packing.
  bool withPeer(int rank) const { return packed_.of(rank) && placesTo(rank) + placesFrom(rank) > 0; }
  template <class Each> void forWays(const Each& each) const;
  std::uint32_t* packedBy(int rank) const;

  base::Exec exec_;
  base::Comm comm_;
  std::size_t wordsAtATime_;
  bool direct_;                                         ///< MPI accepts device pointers
  std::vector<std::uint32_t> sendStart_, receiveStart_; ///< [ranks + 1] first entry in the plan
  std::vector<std::uint32_t> startAtSource_;            ///< [ranks] first entry for this rank in the plan of another
  std::size_t maxExported_{0};                          ///< maximum over all ranks
  base::Array<std::uint32_t> sendSlots_, receiveSlots_;
  std::size_t importCount_{0};
  /// Double-buffered: peers read run n from one half while this rank packs run n + 1 into the other. Run n + 2
  /// overwrites run n and is packed only after every peer has unpacked n. A peer signals this by its message of n + 1,
  /// sent after its device finished n, or by a reduction over all ranks in between; setPlan() contains one.
  base::PeerMemory packed_;
  unsigned bufferIndex_{0};
  base::DeviceMessage received_;
  base::HostMessage sendHost_, receiveHost_;
  std::size_t words_{0};              ///< words per element in the buffers
  std::uint32_t sent_{0};             ///< number of runs sent, included in the messages to peers
  std::vector<std::uint32_t> sentBy_; ///< per rank: number in its last message
  base::Messages messages_;           ///< destroyed before the buffers above: waits for messages into them
  enum class Stage { idle, packed, sent, arrived, published } stage_{Stage::idle};
  std::int64_t bytesSent_{0}, runs_{0};
};

} // namespace grouser::contact
