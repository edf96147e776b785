// SPDX-License-Identifier: BSD-3-Clause
#include "base/cpu_algorithms.hpp"

#include "base/array.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#include <vector>

namespace grouser::base::cpu {

namespace {

constexpr std::size_t kBlock = 2048; // items of a loop's item
constexpr int kDigits = 256;         // of the sort's radix
constexpr int kDigitBits = 8;
using Counts = std::array<std::uint32_t, kDigits>;

std::int64_t blocksOf(std::size_t count) { return static_cast<std::int64_t>((count + kBlock - 1) / kBlock); }

/// The items of one block.
struct Blocks {
  std::size_t count;
  std::size_t first(int block) const { return static_cast<std::size_t>(block) * kBlock; }
  std::size_t last(int block) const { return std::min(first(block) + kBlock, count); }
};

struct SumBlock : Blocks {
  static constexpr double kNanoseconds = 0.5 * kBlock;
  const std::uint32_t* in;
  std::uint32_t* sum;
  void operator()(int block) const {
    std::uint32_t all = 0;
    for (std::size_t i = first(block); i < last(block); ++i) all += in[i];
    sum[block] = all;
  }
};

struct ScanBlock : Blocks {
  static constexpr double kNanoseconds = 1.0 * kBlock;
  const std::uint32_t *in, *before;
  std::uint32_t* out;
  void operator()(int block) const {
    std::uint32_t sum = before[block];
    for (std::size_t i = first(block); i < last(block); ++i) {
      const std::uint32_t here = in[i];
      out[i] = sum, sum += here;
    }
  }
};

struct MaximumOfBlock : Blocks {
  static constexpr double kNanoseconds = 0.5 * kBlock;
  const std::uint32_t* in;
  std::uint32_t* most;
  void operator()(int block) const {
    std::uint32_t all = 0;
    for (std::size_t i = first(block); i < last(block); ++i) all = std::max(all, in[i]);
    most[block] = all;
  }
};

struct CountMarks : Blocks {
  static constexpr double kNanoseconds = 0.5 * kBlock;
  const std::uint32_t* marks;
  std::uint32_t* found;
  void operator()(int block) const {
    std::uint32_t all = 0;
    for (std::size_t i = first(block); i < last(block); ++i) all += marks[i] != 0 ? 1u : 0u;
    found[block] = all;
  }
};

struct ListMarks : Blocks {
  static constexpr double kNanoseconds = 2.0 * kBlock;
  const std::uint32_t *marks, *before;
  std::uint32_t* list;
  void operator()(int block) const {
    std::uint32_t at = before[block];
    for (std::size_t i = first(block); i < last(block); ++i)
      if (marks[i] != 0) list[at++] = static_cast<std::uint32_t>(i);
  }
};

struct Number {
  static constexpr double kNanoseconds = 0.5;
  std::uint32_t* out;
  void operator()(int i) const { out[i] = static_cast<std::uint32_t>(i); }
};

/// All bits that are set in any key of a block.
struct BitsOfBlock : Blocks {
  static constexpr double kNanoseconds = 0.5 * kBlock;
  const std::uint64_t* keys;
  std::uint64_t* bits;
  void operator()(int block) const {
    std::uint64_t all = 0;
    for (std::size_t i = first(block); i < last(block); ++i) all |= keys[i];
    bits[block] = all;
  }
};

struct CountDigits : Blocks {
  static constexpr double kNanoseconds = 1.0 * kBlock;
  const std::uint64_t* keys;
  int shift;
  Counts* counts;
  void operator()(int block) const {
    Counts mine{};
    for (std::size_t i = first(block); i < last(block); ++i) ++mine[keys[i] >> shift & (kDigits - 1)];
    counts[block] = mine;
  }
};

struct PlaceByDigit : Blocks {
  static constexpr double kNanoseconds = 3.0 * kBlock;
  const std::uint64_t* keys;
  const std::uint32_t* values;
  int shift;
  const Counts* before;
  std::uint64_t* keysTo;
  std::uint32_t* valuesTo;
  void operator()(int block) const {
    Counts at = before[block];
    for (std::size_t i = first(block); i < last(block); ++i) {
      const std::uint32_t place = at[keys[i] >> shift & (kDigits - 1)]++;
      keysTo[place] = keys[i], valuesTo[place] = values[i];
    }
  }
};

/// Each number becomes the sum of those before it; returns the sum of all.
std::uint32_t scanSerially(std::vector<std::uint32_t>& numbers) {
  std::uint32_t sum = 0;
  for (std::uint32_t& number : numbers) sum += std::exchange(number, sum);
  return sum;
}

/// From how often each block has a digit to where its first of them goes: smaller digits first, then earlier blocks.
void scanDigits(std::vector<Counts>& counts) {
  Counts next{};
  for (const Counts& block : counts)
    for (std::size_t digit = 0; digit < kDigits; ++digit) next[digit] += block[digit];
  std::uint32_t sum = 0;
  for (std::uint32_t& first : next) sum += std::exchange(first, sum);
  for (Counts& block : counts)
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      const std::uint32_t here = block[digit];
      block[digit] = next[digit], next[digit] += here;
    }
}

} // namespace

/// By the digits of the keys, the lowest first; each pass keeps the order of equal digits.
void sortByKey(const Exec& exec, std::uint64_t* keys, std::uint32_t* values, std::size_t count) {
  if (count == 0) return;
  const std::int64_t blocks = blocksOf(count);
  std::vector<std::uint64_t> bits(static_cast<std::size_t>(blocks));
  forEach(exec, "find the bits of keys", blocks, BitsOfBlock{{count}, keys, bits.data()});
  std::uint64_t all = 0;
  for (const std::uint64_t some : bits) all |= some;
  if (all == 0) return;
  const int passes = (static_cast<int>(std::bit_width(all)) + kDigitBits - 1) / kDigitBits;
  auto otherKeys = Array<std::uint64_t>::unset(exec, count);
  auto otherValues = Array<std::uint32_t>::unset(exec, count);
  std::vector<Counts> counts(static_cast<std::size_t>(blocks));
  std::uint64_t *from = keys, *to = otherKeys.data();
  std::uint32_t *valuesFrom = values, *valuesTo = otherValues.data();
  for (int pass = 0; pass < passes; ++pass) {
    const int shift = kDigitBits * pass;
    forEach(exec, "count digits", blocks, CountDigits{{count}, from, shift, counts.data()});
    scanDigits(counts);
    forEach(exec, "place by digit", blocks,
            PlaceByDigit{{count}, from, valuesFrom, shift, counts.data(), to, valuesTo});
    std::swap(from, to), std::swap(valuesFrom, valuesTo);
  }
  if (from == keys) return;
  copyOnDevice(exec, keys, from, count * sizeof(std::uint64_t));
  copyOnDevice(exec, values, valuesFrom, count * sizeof(std::uint32_t));
}

std::uint32_t exclusiveScan(const Exec& exec, const std::uint32_t* in, std::uint32_t* out, std::size_t count) {
  const std::int64_t blocks = blocksOf(count);
  std::vector<std::uint32_t> before(static_cast<std::size_t>(blocks));
  forEach(exec, "sum of blocks", blocks, SumBlock{{count}, in, before.data()});
  const std::uint32_t total = scanSerially(before);
  forEach(exec, "scan of blocks", blocks, ScanBlock{{count}, in, before.data(), out});
  return total;
}

std::uint32_t maximum(const Exec& exec, const std::uint32_t* values, std::size_t count) {
  const std::int64_t blocks = blocksOf(count);
  std::vector<std::uint32_t> most(static_cast<std::size_t>(blocks));
  forEach(exec, "maximum of blocks", blocks, MaximumOfBlock{{count}, values, most.data()});
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

std::size_t listMarked(const Exec& exec, const std::uint32_t* marks, std::size_t count, std::uint32_t* list) {
  const std::int64_t blocks = blocksOf(count);
  std::vector<std::uint32_t> before(static_cast<std::size_t>(blocks));
  forEach(exec, "count marks", blocks, CountMarks{{count}, marks, before.data()});
  const std::uint32_t total = scanSerially(before);
  forEach(exec, "list marks", blocks, ListMarks{{count}, marks, before.data(), list});
  return total;
}

void iota(const Exec& exec, std::uint32_t* out, std::size_t count) {
  forEach(exec, "number", static_cast<std::int64_t>(count), Number{out});
}

} // namespace grouser::base::cpu
