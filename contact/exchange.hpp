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

/// One field of an element type, as it lies on the device: `words` 32-bit words for each element.
struct ExchangeField {
  void* data;          ///< by slot, or by place in the plan where `byPlace`
  std::uint32_t words; ///< of one element
  bool byPlace = false;
};

/// A field that is an array by slot.
template <class T> ExchangeField fieldOf(base::Array<T>& array) {
  static_assert(sizeof(T) % 4 == 0);
  return {array.data(), sizeof(T) / 4};
}

/// Options of an exchange; the transferred data do not depend on them.
struct ExchangeOptions {
  base::PeerUse peers;                             ///< whether GPUs of one machine unpack from each other's memory
  std::size_t wordsAtATime = std::size_t{1} << 30; ///< packed by one launch, at most
};

/// Moves elements between ranks. It is independent of the element type: the caller specifies which slots go to which
/// ranks (a communication plan), the fields to move, and the slots of the imports. Full state on a migration and less
/// on a ghost update are two plans, or one plan with two lists of fields.
///
/// An exchange may be run any number of times within a step. Elements are packed and unpacked on the device. If the
/// receiver's GPU can access the sender's memory, it unpacks from there, and MPI only carries the notice that the
/// sender has packed; otherwise MPI transfers device memory if it supports that, else pinned host memory. All ranks
/// call everything here, in the same order.
class Exchange {
public:
  static constexpr std::size_t kMaxFields = 16;

  Exchange(const base::Exec& exec, const base::Comm& comm, const ExchangeOptions& options);

  /// Sends `slots[k]` to rank `ranks[k]`, for k < count. Both are device arrays and are sorted by rank, stable, here.
  void setPlan(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count);

  std::size_t exportCount() const { return sendSlots_.size(); }
  std::size_t importCount() const { return importCount_; }
  /// Slots of the elements that leave, by place in the plan (grouped by rank).
  const std::uint32_t* exportSlots() const { return sendSlots_.data(); }

  /// Imports go to slots first, first + 1...
  void setImportSlots(std::size_t first);
  /// The elements have moved: slot s is now newSlot[s] (device array), of exports and imports.
  void renumber(const std::uint32_t* newSlot);

  /// Packs and sends. The fields may be overwritten as soon as this returns.
  void start(std::span<const ExchangeField> fields) {
    pack(exec_, fields);
    base::synchronize(exec_);
    send();
  }
  /// Waits for the imports and unpacks them into `fields`, which have as many words as those that were sent.
  void finish(std::span<const ExchangeField> fields) {
    arrive();
    unpack(exec_, fields);
  }
  bool underWay() const { return stage_ > Stage::packed; }
  void run(std::span<const ExchangeField> fields) {
    start(fields);
    finish(fields);
  }

  // The same in separate steps, to overlap it with other work. `exec` is the exchange's own or a side stream of it.

  /// Queues packing on `exec`, without waiting, into the half of the buffer that the run before did not use. Where
  /// memory has to grow it waits, for all ranks: not in the second of two runs of as many words on one plan. All ranks
  /// may pack again before send(); what was packed first is dropped.
  void pack(const base::Exec& exec, std::span<const ExchangeField> fields);
  void send();   ///< after the device has packed: call synchronize() first
  void arrive(); ///< waits for the messages; does nothing where none were sent
  /// Queues unpacking on `exec`, without waiting.
  void unpack(const base::Exec& exec, std::span<const ExchangeField> fields);

  /// Every rank sees the memory of all others. Then no message is needed where a base::PeerReduction, queued between
  /// pack() and unpack(), makes every GPU wait until all have packed: publish() takes the place of send() and arrive().
  bool peersOnly() const { return packed_.allSeeAll(); }
  bool sharesMemory() const { return packed_.seesAny(); } ///< with one other rank at least
  void publish();
  void discard();                    ///< drops what was packed or published
  void countRuns(std::int64_t runs); ///< adds runs that were published to the counts below
  unsigned bufferIndex() const {
    return bufferIndex_;
  } ///< half of the memory that was packed last; recorded graphs hold pointers into it

  std::int64_t bytesSent() const { return bytesSent_; } ///< by this rank since the start
  std::int64_t runs() const { return runs_; }

private:
  static std::size_t placeOf(const std::vector<std::uint32_t>& starts, int rank) {
    return starts[static_cast<std::size_t>(rank)];
  }
  std::size_t placesTo(int rank) const { return placeOf(sendStart_, rank + 1) - placeOf(sendStart_, rank); }
  std::size_t placesFrom(int rank) const { return placeOf(receiveStart_, rank + 1) - placeOf(receiveStart_, rank); }
  /// True if elements are exchanged with this peer: then each notifies the other by a message when it has packed.
  bool withPeer(int rank) const { return packed_.of(rank) && placesTo(rank) + placesFrom(rank) > 0; }
  template <class Each> void forWays(const Each& each) const;
  std::uint32_t* packedBy(int rank) const;

  base::Exec exec_;
  base::Comm comm_;
  std::size_t wordsAtATime_;
  bool direct_;                                         ///< MPI takes pointers to the buffers of the device
  std::vector<std::uint32_t> sendStart_, receiveStart_; ///< [ranks + 1] places in the plan
  std::vector<std::uint32_t> startAtSource_;            ///< [ranks] this rank's first place in the plan of another
  std::size_t mostExported_{0};                         ///< of all ranks
  base::Array<std::uint32_t> sendSlots_, receiveSlots_;
  std::size_t importCount_{0};
  /// Double-buffered: peers read run n out of one half while this rank packs run n + 1 into the other. Run n + 2, which
  /// overwrites run n, is packed only when every peer has unpacked n: its message of n + 1 says so, sent after its
  /// device had finished n, as does a reduction over all ranks in between. setPlan() contains such a reduction.
  base::PeerMemory packed_;
  unsigned bufferIndex_{0};
  base::DeviceMessage received_;
  base::HostMessage sendHost_, receiveHost_;
  std::size_t words_{0};              ///< of one element in the buffers
  std::uint32_t sent_{0};             ///< runs sent: the number in the message to peers
  std::vector<std::uint32_t> sentBy_; ///< by rank: the number in their last message
  base::Messages messages_;           ///< destroyed before the buffers above: waits for messages into them
  enum class Stage { idle, packed, sent, arrived, published } stage_{Stage::idle};
  std::int64_t bytesSent_{0}, runs_{0};
};

} // namespace grouser::contact
