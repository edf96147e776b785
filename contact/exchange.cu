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
  std::uint32_t count, words; ///< of fields; of one element, all fields together
};

Fields collect(std::span<const ExchangeField> fields) {
  if (fields.size() > Exchange::kMaxFields) throw std::logic_error("too many fields in one exchange");
  Fields all{};
  for (const ExchangeField& f : fields) all.field[all.count++] = f, all.words += f.words;
  return all;
}

/// One word of one element between its field and the buffer, in which elements lie one after the other.
template <bool kPack> struct MoveWord {
  Fields fields;
  std::uint32_t first; ///< place of the first element of this launch
  const std::uint32_t* slots;
  std::uint32_t* buffer;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t place = first + static_cast<std::uint32_t>(i) / fields.words;
    const std::uint64_t inBuffer = static_cast<std::uint64_t>(first) * fields.words + static_cast<std::uint32_t>(i);
    std::uint32_t word = static_cast<std::uint32_t>(i) % fields.words, f = 0;
    while (word >= fields.field[f].words) word -= fields.field[f++].words;
    const ExchangeField& field = fields.field[f];
    const std::uint64_t element = field.byPlace ? place : slots[place];
    std::uint32_t* at = static_cast<std::uint32_t*>(field.data) + element * field.words + word;
    if (kPack)
      buffer[inBuffer] = *at;
    else
      *at = buffer[inBuffer];
  }
};

/// Launches count in int: elements go in groups of at most `wordsAtATime` words.
template <bool kPack> void moveWords(const base::Exec& exec, const Fields& fields, const std::uint32_t* slots,
                                     std::size_t elements, std::uint32_t* buffer, std::size_t wordsAtATime) {
  if (fields.words == 0) return;
  const std::size_t atATime = std::max<std::size_t>(1, wordsAtATime / fields.words);
  for (std::size_t first = 0; first < elements; first += atATime)
    base::forEach(exec, kPack ? "pack" : "unpack",
                  static_cast<std::int64_t>(std::min(atATime, elements - first) * fields.words),
                  MoveWord<kPack>{fields, static_cast<std::uint32_t>(first), slots, buffer});
}

/// start[r] = first place whose rank is >= r, in sorted ranks.
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

Exchange::Exchange(const base::Exec& exec, const base::Comm& comm, std::size_t wordsAtATime)
    : exec_(exec), comm_(comm), wordsAtATime_(wordsAtATime),
      direct_(exec.onCpu() || base::Messages::deviceMemoryTravels()),
      sendStart_(static_cast<std::size_t>(comm.size()) + 1), receiveStart_(sendStart_), sendSlots_(exec),
      receiveSlots_(exec), sendBuffer_(exec), receiveBuffer_(exec), messages_(comm) {}

void Exchange::route(base::Array<std::uint64_t>& ranks, base::Array<std::uint32_t>& slots, std::size_t count) {
  const auto size = static_cast<std::size_t>(comm_.size());
  base::sortByKey(exec_, ranks.data(), slots.data(), count);
  base::Array<std::uint32_t> starts(exec_, size + 1);
  base::forEach(exec_, "find starts of a route", static_cast<std::int64_t>(size) + 1,
                FindStarts{ranks.data(), static_cast<std::uint32_t>(count), starts.data()});
  sendStart_ = starts.toHost();
  sendSlots_.resize(count);
  base::copyOnDevice(exec_, sendSlots_.data(), slots.data(), count * sizeof(std::uint32_t));
  base::synchronize(exec_);

  std::vector<base::Bytes> counts(size);
  for (std::size_t r = 0; r < size; ++r)
    counts[r] = base::Comm::bytesOf(std::vector<std::uint32_t>{sendStart_[r + 1] - sendStart_[r]});
  const std::vector<base::Bytes> back = comm_.allToAll(counts);
  for (std::size_t r = 0; r < size; ++r)
    receiveStart_[r + 1] = receiveStart_[r] + base::Comm::valuesOf<std::uint32_t>(back[r]).front();
  coming_ = receiveStart_.back();
  putFrom(0);
}

void Exchange::putFrom(std::size_t first) {
  receiveSlots_.resize(coming_);
  base::forEach(exec_, "places of what comes", static_cast<std::int64_t>(coming_),
                CountUp{static_cast<std::uint32_t>(first), receiveSlots_.data()});
}

void Exchange::renumber(const std::uint32_t* newSlot) {
  for (base::Array<std::uint32_t>* slots : {&sendSlots_, &receiveSlots_})
    base::forEach(exec_, "renumber a route", static_cast<std::int64_t>(slots->size()),
                  Renumber{newSlot, slots->data()});
}

void Exchange::reserve(std::size_t words) {
  bufferWords_ = words;
  sendBuffer_.reserve(leaving() * words);
  receiveBuffer_.reserve(coming_ * words);
}

void Exchange::start(std::span<const ExchangeField> fields) {
  const Fields all = collect(fields);
  reserve(all.words);
  const std::size_t words = bufferWords_, sent = leaving() * words;
  moveWords<true>(exec_, all, sendSlots_.data(), leaving(), sendBuffer_.device(), wordsAtATime_);
  if (!direct_) base::copyToHostLater(exec_, sendBuffer_.host(), sendBuffer_.device(), sent * 4);
  base::synchronize(exec_);
  std::uint32_t* out = direct_ ? sendBuffer_.device() : sendBuffer_.host();
  std::uint32_t* in = direct_ ? receiveBuffer_.device() : receiveBuffer_.host();
  for (int r = 0; r < comm_.size(); ++r) {
    const std::size_t first = receiveStart_[static_cast<std::size_t>(r)] * words;
    messages_.receive(r, in + first, (receiveStart_[static_cast<std::size_t>(r) + 1] * words - first) * 4, kTag);
  }
  for (int r = 0; r < comm_.size(); ++r) {
    const std::size_t first = sendStart_[static_cast<std::size_t>(r)] * words;
    messages_.send(r, out + first, (sendStart_[static_cast<std::size_t>(r) + 1] * words - first) * 4, kTag);
  }
  bytesSent_ += static_cast<std::int64_t>(sent * 4);
  ++runs_;
  underWay_ = true;
}

void Exchange::finish(std::span<const ExchangeField> fields) {
  const Fields all = collect(fields);
  if (!underWay_ || all.words != bufferWords_) throw std::logic_error("an exchange is finished with other fields");
  messages_.waitAll();
  underWay_ = false;
  const std::size_t received = coming_ * bufferWords_;
  if (!direct_) base::copyToDeviceLater(exec_, receiveBuffer_.device(), receiveBuffer_.host(), received * 4);
  moveWords<false>(exec_, all, receiveSlots_.data(), coming_, receiveBuffer_.device(), wordsAtATime_);
}

} // namespace grouser::contact
