// SPDX-License-Identifier: BSD-3-Clause
#include "contact/exchange.hpp"

#include "base/algorithms.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <stdexcept>

namespace grouser::contact {

namespace {

constexpr int kTag = 11;

struct Fields {
  ExchangeField field[Exchange::kMaxFields];
  std::uint32_t count, words; ///< number of fields; words per element, summed over all fields
};

Fields collect(std::span<const ExchangeField> fields) {
  if (fields.size() > Exchange::kMaxFields) throw std::logic_error("too many fields in one exchange");
  Fields all{};
  for (const ExchangeField& f : fields) all.field[all.count++] = f, all.words += f.words;
  return all;
}

/// Copies one word of one element between its field and the buffer, in which elements are contiguous.
template <bool kPack> struct MoveWord {
  Fields fields;
  std::uint32_t first; ///< plan index of the first element of this launch
  const std::uint32_t* slots;
  std::uint32_t* buffer; ///< starts at that element
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t place = first + static_cast<std::uint32_t>(i) / fields.words;
    std::uint32_t word = static_cast<std::uint32_t>(i) % fields.words, f = 0;
    while (word >= fields.field[f].words) word -= fields.field[f++].words;
    const ExchangeField& field = fields.field[f];
    const std::uint64_t element = field.byPlace ? place : slots[place];
    std::uint32_t* at = static_cast<std::uint32_t*>(field.data) + element * field.words + word;
    if (kPack)
      buffer[i] = *at;
    else
      *at = buffer[i];
  }
};

/// Copies between fields and `buffer`, which begins with element `first`. Launch sizes are of type int, so each launch
/// copies at most `wordsAtATime` words, but at least one element.
template <bool kPack> void moveWords(const base::Exec& exec, const Fields& fields, const std::uint32_t* slots,
                                     std::size_t first, std::size_t elements, std::uint32_t* buffer,
                                     std::size_t wordsAtATime) {
  if (fields.words == 0) return;
  const std::size_t atATime = std::max<std::size_t>(1, wordsAtATime / fields.words);
  for (std::size_t done = 0; done < elements; done += atATime)
    base::forEach(
        exec, kPack ? "pack" : "unpack", static_cast<std::int64_t>(std::min(atATime, elements - done) * fields.words),
        MoveWord<kPack>{fields, static_cast<std::uint32_t>(first + done), slots, buffer + done * fields.words});
}

/// Sets start[r] to the first place with rank >= r in the sorted ranks.
struct FindStarts {
  const std::uint64_t* ranks;
  std::uint32_t count;
  std::uint32_t* start;
  GROUSER_HD void operator()(int r) const {
    std::uint32_t low = 0, high = count;
    while (low < high) {
      const std::uint32_t middle = (low + high) / 2;
      if (ranks[middle] < static_cast<std::uint64_t>(r))
        low = middle + 1;
      else
        high = middle;
    }
    start[r] = low;
  }
};

struct CountUp {
  std::uint32_t first;
  std::uint32_t* out;
  GROUSER_HD void operator()(int i) const { out[i] = first + static_cast<std::uint32_t>(i); }
};

struct Renumber {
  const std::uint32_t* newSlot;
  std::uint32_t* slots;
  GROUSER_HD void operator()(int i) const { slots[i] = newSlot[slots[i]]; }
};

} // namespace

Exchange::Exchange(const base::Exec& exec, const base::Comm& comm, const ExchangeOptions& options)
    : exec_(exec), comm_(comm), wordsAtATime_(options.wordsAtATime),
      direct_(exec.onCpu() || base::Messages::deviceMemoryTravels()),
      sendStart_(static_cast<std::size_t>(comm.size()) + 1), receiveStart_(sendStart_),
      startAtSource_(static_cast<std::size_t>(comm.size())), sendSlots_(exec), receiveSlots_(exec),
      packed_(exec, comm, options.peers), received_(exec), sendHost_(exec), receiveHost_(exec),
      sentBy_(static_cast<std::size_t>(comm.size())), messages_(comm) {}

void Exchange::setPlan(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count) {
  if (underWay()) throw std::logic_error("cannot change the plan while elements are in transit");
  const auto size = static_cast<std::size_t>(comm_.size());
  base::sortByKey(exec_, ranks.data(), slots.data(), count);
  base::Array<std::uint32_t> starts(exec_, size + 1);
  base::forEach(exec_, "find starts of a plan", static_cast<std::int64_t>(size) + 1,
                FindStarts{ranks.data(), static_cast<std::uint32_t>(count), starts.data()});
  sendStart_ = starts.toHost();
  sendSlots_.resize(count);
  base::copyOnDevice(exec_, sendSlots_.data(), slots.data(), count * sizeof(std::uint32_t));
  base::synchronize(exec_);

  // For each rank: its first element in this plan, its number of elements, and the total of this plan.
  std::vector<base::Bytes> mine(size);
  for (std::size_t r = 0; r < size; ++r)
    mine[r] = base::Comm::bytesOf(std::vector<std::uint32_t>{sendStart_[r], sendStart_[r + 1] - sendStart_[r],
                                                             static_cast<std::uint32_t>(count)});
  const std::vector<base::Bytes> theirs = comm_.allToAll(mine);
  maxExported_ = 0;
  for (std::size_t r = 0; r < size; ++r) {
    const std::vector<std::uint32_t> said = base::Comm::valuesOf<std::uint32_t>(theirs[r]);
    startAtSource_[r] = said[0];
    receiveStart_[r + 1] = receiveStart_[r] + said[1];
    maxExported_ = std::max<std::size_t>(maxExported_, said[2]);
  }
  importCount_ = receiveStart_.back();
  setImportSlots(0);
}

void Exchange::setImportSlots(std::size_t first) {
  receiveSlots_.resize(importCount_);
  base::forEach(exec_, "set import slots", static_cast<std::int64_t>(importCount_),
                CountUp{static_cast<std::uint32_t>(first), receiveSlots_.data()});
}

void Exchange::renumber(const std::uint32_t* newSlot) {
  for (base::Array<std::uint32_t>* slots : {&sendSlots_, &receiveSlots_})
    base::forEach(exec_, "renumber a plan", static_cast<std::int64_t>(slots->size()), Renumber{newSlot, slots->data()});
}

/// Buffer into which `rank` packs the current run, as mapped on this rank; null if not accessible.
std::uint32_t* Exchange::packedBy(int rank) const {
  void* memory = rank == comm_.rank() ? packed_.own() : packed_.of(rank);
  if (!memory) return nullptr;
  return static_cast<std::uint32_t*>(memory) + (packed_.shares() ? bufferIndex_ * (packed_.size() / 8) : 0);
}

/// Calls `each(first, end, peer)` for ranges of ranks with the same transport: one peer with accessible memory, or any
/// number of other ranks that use messages.
template <class Each> void Exchange::forWays(const Each& each) const {
  for (int first = 0, end = 0; first < comm_.size(); first = end) {
    end = first + 1;
    const bool peer = packed_.of(first);
    while (!peer && end < comm_.size() && !packed_.of(end)) ++end;
    each(first, end, peer);
  }
}

void Exchange::pack(const base::Exec& exec, std::span<const ExchangeField> fields) {
  if (underWay()) throw std::logic_error("cannot pack elements while others are in transit");
  const Fields all = collect(fields);
  words_ = all.words;
  bufferIndex_ ^= 1u;
  packed_.reserve((packed_.shares() ? 2 * maxExported_ : exportCount()) * words_ * sizeof(std::uint32_t));
  std::uint32_t* const out = packedBy(comm_.rank());
  moveWords<true>(exec, all, sendSlots_.data(), 0, exportCount(), out, wordsAtATime_);
  stage_ = Stage::packed;
  if (direct_) return;
  forWays([&](int first, int end, bool peer) {
    const std::size_t from = placeOf(sendStart_, first) * words_, words = placeOf(sendStart_, end) * words_ - from;
    if (peer || words == 0) return;
    sendHost_.reserve(exportCount() * words_);
    base::copyToHostLater(exec, sendHost_.data() + from, out + from, words * sizeof(std::uint32_t));
  });
}

void Exchange::send() {
  if (stage_ != Stage::packed) throw std::logic_error("cannot send elements that have not been packed");
  forWays([&](int first, int end, bool peer) {
    if (peer || placeOf(receiveStart_, first) == placeOf(receiveStart_, end)) return;
    received_.reserve(importCount_ * words_);
    if (!direct_) receiveHost_.reserve(importCount_ * words_);
  });
  std::uint32_t* const out = direct_ ? packedBy(comm_.rank()) : sendHost_.data();
  std::uint32_t* const in = direct_ ? received_.data() : receiveHost_.data();
  ++sent_;
  for (int r = 0; r < comm_.size(); ++r)
    if (withPeer(r))
      messages_.receive(r, &sentBy_[static_cast<std::size_t>(r)], sizeof sent_, kTag);
    else if (!packed_.of(r) && placesFrom(r) > 0)
      messages_.receive(r, in + placeOf(receiveStart_, r) * words_, placesFrom(r) * words_ * 4, kTag);
  for (int r = 0; r < comm_.size(); ++r)
    if (withPeer(r))
      messages_.send(r, &sent_, sizeof sent_, kTag);
    else if (!packed_.of(r) && placesTo(r) > 0)
      messages_.send(r, out + placeOf(sendStart_, r) * words_, placesTo(r) * words_ * 4, kTag);
  countRuns(1);
  stage_ = Stage::sent;
}

void Exchange::arrive() {
  if (stage_ != Stage::sent) return;
  messages_.waitAll();
  for (int r = 0; r < comm_.size(); ++r)
    if (withPeer(r) && sentBy_[static_cast<std::size_t>(r)] != sent_)
      throw std::logic_error("the ranks run their exchanges in different orders");
  stage_ = Stage::arrived;
}

void Exchange::publish() {
  if (stage_ != Stage::packed || !peersOnly())
    throw std::logic_error("cannot publish: a rank cannot access this memory, or nothing has been packed");
  stage_ = Stage::published;
}

void Exchange::discard() {
  if (stage_ == Stage::sent) throw std::logic_error("cannot discard an exchange while its messages are in transit");
  stage_ = Stage::idle;
}

void Exchange::countRuns(std::int64_t runs) {
  bytesSent_ += runs * static_cast<std::int64_t>(exportCount() * words_ * sizeof(std::uint32_t));
  runs_ += runs;
}

void Exchange::unpack(const base::Exec& exec, std::span<const ExchangeField> fields) {
  const Fields all = collect(fields);
  if (stage_ < Stage::arrived || all.words != words_)
    throw std::logic_error("cannot unpack: no elements have arrived, or the fields differ from those sent");
  stage_ = Stage::idle;
  forWays([&](int first, int end, bool peer) {
    const std::size_t place = placeOf(receiveStart_, first), count = placeOf(receiveStart_, end) - place;
    if (count == 0) return;
    std::uint32_t* from = nullptr;
    if (peer) {
      from = packedBy(first) + std::size_t{startAtSource_[static_cast<std::size_t>(first)]} * words_;
    } else {
      from = received_.data() + place * words_;
      if (!direct_) base::copyToDeviceLater(exec, from, receiveHost_.data() + place * words_, count * words_ * 4);
    }
    moveWords<false>(exec, all, receiveSlots_.data(), place, count, from, wordsAtATime_);
  });
}

} // namespace grouser::contact
