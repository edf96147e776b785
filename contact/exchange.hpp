// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/comm.hpp"
#include "base/message_buffer.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grouser::contact {

/// One field of an element type, as it lies on the device: `words` 32-bit words for each element.
struct ExchangeField {
  void* data;          ///< by slot, or by place on the route where `byPlace`
  std::uint32_t words; ///< of one element
  bool byPlace = false;
};

/// A field that is an array by slot.
template <class T> ExchangeField fieldOf(base::Array<T>& array) {
  static_assert(sizeof(T) % 4 == 0);
  return {array.data(), sizeof(T) / 4};
}

/// Moves elements between ranks. It knows nothing of what an element is: whoever owns the elements says which slots go
/// to which ranks (a route) and names the fields that travel; what comes is put where they want it. Full state on a
/// hand-over and less on a ghost update are two routes, or one route with two lists of fields.
///
/// An exchange may be run any number of times within a step. Elements are packed and unpacked on the device; their
/// bytes go straight to MPI where it takes device memory, through pinned memory otherwise. All ranks call
/// everything here, in the same order.
class Exchange {
public:
  static constexpr std::size_t kMaxFields = 12;

  /// `wordsAtATime`: how many are packed by one launch, at most.
  Exchange(const base::Exec& exec, const base::Comm& comm, std::size_t wordsAtATime = std::size_t{1} << 30);

  /// Sends `slots[k]` to rank `ranks[k]`, for k < count. Both are device arrays and are sorted by rank, stable, here.
  void route(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count);

  std::size_t leaving() const { return sendSlots_.size(); }
  std::size_t coming() const { return coming_; }
  /// Slots of the elements that leave, by place on the route (grouped by rank).
  const std::uint32_t* leavingSlots() const { return sendSlots_.data(); }

  /// What comes goes to slots first, first + 1...
  void putFrom(std::size_t first);
  /// The elements have moved: slot s is now newSlot[s] (device array), here and at the places of what comes.
  void renumber(const std::uint32_t* newSlot);

  /// Packs and sends. The fields may be overwritten as soon as this returns, but for the slots of what comes.
  void start(std::span<const ExchangeField> fields);
  /// Waits for what comes and unpacks it into `fields`, which have as many words as those that were sent.
  void finish(std::span<const ExchangeField> fields);
  bool underWay() const { return underWay_; }
  void run(std::span<const ExchangeField> fields) {
    start(fields);
    finish(fields);
  }

  std::int64_t bytesSent() const { return bytesSent_; } ///< by this rank since the start
  std::int64_t runs() const { return runs_; }

private:
  void reserve(std::size_t words);

  base::Exec exec_;
  base::Comm comm_;
  std::size_t wordsAtATime_;
  bool direct_;                                         ///< MPI takes pointers to the buffers of the device
  std::vector<std::uint32_t> sendStart_, receiveStart_; ///< [ranks + 1] places on the route
  base::Array<std::uint32_t> sendSlots_, receiveSlots_;
  std::size_t coming_{0};
  base::MessageBuffer sendBuffer_, receiveBuffer_;
  std::size_t bufferWords_{0}; ///< of one element in the buffers under way
  base::Messages messages_;
  bool underWay_{false};
  std::int64_t bytesSent_{0}, runs_{0};
};

} // namespace grouser::contact
