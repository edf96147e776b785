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

/// How an exchange goes about it; no bit of what arrives depends on it.
struct ExchangeOptions {
  base::PeerUse peers;                             ///< GPUs of one machine fetch what comes from each other
  std::size_t wordsAtATime = std::size_t{1} << 30; ///< packed by one launch, at most
};

/// Moves elements between ranks. It knows nothing of what an element is: whoever owns the elements says which slots go
/// to which ranks (a communication plan) and names the fields that travel; what comes is put where they want it. Full
/// state on a migration and less on a ghost update are two plans, or one plan with two lists of fields.
///
/// An exchange may be run any number of times within a step. Elements are packed and unpacked on the device. Where the
/// GPU of the receiver sees the memory of the sender's, it unpacks from there, and MPI carries only the word that it
/// may; else the bytes go straight to MPI where it takes device memory, and through pinned memory where it does not.
/// All ranks call everything here, in the same order.
class Exchange {
public:
  static constexpr std::size_t kMaxFields = 12;

  Exchange(const base::Exec& exec, const base::Comm& comm, const ExchangeOptions& options);

  /// Sends `slots[k]` to rank `ranks[k]`, for k < count. Both are device arrays and are sorted by rank, stable, here.
  void setPlan(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count);

  std::size_t exportCount() const { return sendSlots_.size(); }
  std::size_t importCount() const { return importCount_; }
  /// Slots of the elements that leave, by place in the plan (grouped by rank).
  const std::uint32_t* exportSlots() const { return sendSlots_.data(); }

  /// What comes goes to slots first, first + 1...
  void setImportSlots(std::size_t first);
  /// The elements have moved: slot s is now newSlot[s] (device array), here and at the places of what comes.
  void renumber(const std::uint32_t* newSlot);

  /// Packs and sends. The fields may be overwritten as soon as this returns, but for the slots of what comes.
  void start(std::span<const ExchangeField> fields) {
    pack(exec_, fields);
    base::synchronize(exec_);
    send();
  }
  /// Waits for what comes and unpacks it into `fields`, which have as many words as those that were sent.
  void finish(std::span<const ExchangeField> fields) {
    arrive();
    unpack(exec_, fields);
  }
  bool underWay() const { return stage_ > Stage::packed; }
  void run(std::span<const ExchangeField> fields) {
    start(fields);
    finish(fields);
  }

  // The same in its parts, for those who have other work to do in between. `exec` is the exchange's own or a side
  // stream of it.

  /// On the device, without waiting; only where memory has to grow it waits, for all ranks: not in the second of two
  /// runs of as many words on one plan. What was packed may be packed anew, by all ranks, and the former is forgotten.
  void pack(const base::Exec& exec, std::span<const ExchangeField> fields);
  void send();   ///< what has been packed: that work has ended
  void arrive(); ///< waits for what comes, where it was sent
  /// On the device, without waiting.
  void unpack(const base::Exec& exec, std::span<const ExchangeField> fields);

  /// Every rank sees the memory of all others. Then GPUs that agree in their streams that all have packed
  /// (base::PeerReduction) need no message: publish() takes the place of send() and arrive().
  bool peersOnly() const { return packed_.allSeeAll(); }
  bool sharesMemory() const { return packed_.seesAny(); } ///< with one other rank at least
  void publish();
  void discard();                    ///< nobody wants it any more
  void countRuns(std::int64_t runs); ///< of those that were passed on
  unsigned bufferIndex() const {
    return bufferIndex_;
  } ///< which half of the memory was packed last: what is recorded depends on it

  std::int64_t bytesSent() const { return bytesSent_; } ///< by this rank since the start
  std::int64_t runs() const { return runs_; }

private:
  static std::size_t placeOf(const std::vector<std::uint32_t>& starts, int rank) {
    return starts[static_cast<std::size_t>(rank)];
  }
  std::size_t placesTo(int rank) const { return placeOf(sendStart_, rank + 1) - placeOf(sendStart_, rank); }
  std::size_t placesFrom(int rank) const { return placeOf(receiveStart_, rank + 1) - placeOf(receiveStart_, rank); }
  /// A peer that something goes to or comes from: it is told when this rank has packed, and tells.
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
  /// Two runs take turns, each in its half. A rank packs run n + 2 into the half of run n only after every reader of n
  /// has told it so: with its word of run n + 1, sent after its work on n had ended, or by what all ranks have agreed
  /// upon in between. A new plan ends with such an agreement.
  base::PeerMemory packed_;
  unsigned bufferIndex_{0};
  base::DeviceMessage received_;
  base::HostMessage sendHost_, receiveHost_;
  std::size_t words_{0};              ///< of one element in the buffers
  std::uint32_t sent_{0};             ///< runs sent: the word for peers
  std::vector<std::uint32_t> sentBy_; ///< by rank: their word
  base::Messages messages_;           ///< waits, at the latest when it goes, for what comes into all of the above
  enum class Stage { idle, packed, sent, arrived, published } stage_{Stage::idle};
  std::int64_t bytesSent_{0}, runs_{0};
};

} // namespace grouser::contact
