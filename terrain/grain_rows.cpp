// SPDX-License-Identifier: BSD-3-Clause
// Rows of the grain state: hash words, and transfer between the ranks that own the grains and those that write
// files.
#include "terrain/grain_state.hpp"
#include "terrain/row_exchange.hpp"

#include <algorithm>
#include <utility>

namespace grouser::terrain {

namespace {

/// Visitor that appends the data that the next step depends on; for boundaries only springs in contact.
class HashedWords {
public:
  explicit HashedWords(std::vector<std::uint32_t>& words) : words_(words) {}
  void next() { ++at_.row; }

  template <class T> void column(const std::vector<T>& values) { putWords(words_, values[at_.row]); }
  template <class T> void unhashed(const std::vector<T>&) {}
  template <class T> void several(const std::vector<T>& values, std::size_t width) {
    for (std::size_t k = at_.row * width; k < (at_.row + 1) * width; ++k) putWords(words_, values[k]);
  }
  template <class... T> void contacts(const std::vector<std::uint32_t>& counts, const std::vector<T>*... columns) {
    for (std::uint32_t n = 0; n < counts[at_.row]; ++n, ++at_.contact)
      ((columns ? putWords(words_, (*columns)[at_.contact]) : void()), ...);
  }
  template <class... T>
  void boundaries(const std::vector<std::uint32_t>& bits, std::size_t width, const std::vector<T>*... columns) {
    column(bits);
    for (std::size_t b = 0; b < width; ++b)
      if (bits[at_.row] >> b & 1) ((columns ? putWords(words_, (*columns)[at_.row * width + b]) : void()), ...);
  }

private:
  std::vector<std::uint32_t>& words_;
  RowCursor at_;
};

} // namespace

std::vector<std::uint32_t> GrainState::words() const {
  std::vector<std::uint32_t> words;
  words.reserve(rows() * 24);
  HashedWords visitor(words);
  for (std::size_t g = 0; g < rows(); ++g, visitor.next()) visitRow(*this, visitor);
  return words;
}

GrainState GrainState::withoutRows() const {
  GrainState out;
  out.layout = layout, out.total = total, out.gone = gone, out.skin = skin, out.rebuilds = rebuilds,
  out.ledgerSums = ledgerSums;
  return out;
}

void GrainState::remove(const std::vector<std::uint32_t>& ids) {
  const auto isOne = [&ids](std::uint32_t which) { return std::binary_search(ids.begin(), ids.end(), which); };
  GrainState kept = withoutRows();
  RowCursor at;
  std::vector<std::uint32_t> words;
  for (; at.row < rows(); ++at.row) {
    words.clear();
    RowPacker packer(at, words);
    visitRow(*this, packer);
    if (isOne(id[at.row])) continue;
    kept.id.push_back(id[at.row]);
    RowReader reader(words.data());
    visitRow(kept, reader);
  }
  // Copy the remaining contacts.
  std::size_t from = 0, to = 0;
  for (std::uint32_t& count : kept.contacts) {
    std::uint32_t left = 0;
    for (std::uint32_t k = 0; k < count; ++k, ++from) {
      if (isOne(kept.neighbour[from])) continue;
      kept.neighbour[to] = kept.neighbour[from];
      if (layout.friction) kept.contactShear[to] = kept.contactShear[from];
      if (layout.rolling) kept.contactRolling[to] = kept.contactRolling[from];
      if (layout.plastic) {
        kept.contactDeepest[to] = kept.contactDeepest[from];
        kept.contactOrigin[to] = kept.contactOrigin[from];
      }
      ++to, ++left;
    }
    count = left;
  }
  kept.neighbour.resize(to);
  if (layout.friction) kept.contactShear.resize(to);
  if (layout.rolling) kept.contactRolling.resize(to);
  if (layout.plastic) kept.contactDeepest.resize(to), kept.contactOrigin.resize(to);
  kept.gone.insert(kept.gone.end(), ids.begin(), ids.end());
  std::sort(kept.gone.begin(), kept.gone.end());
  kept.total -= static_cast<std::int64_t>(ids.size());
  *this = std::move(kept);
}

std::uint32_t placeAmong(const std::vector<std::uint32_t>& gone, std::uint32_t id) {
  return id - static_cast<std::uint32_t>(std::lower_bound(gone.begin(), gone.end(), id) - gone.begin());
}

std::vector<std::uint32_t> idsFrom(const std::vector<std::uint32_t>& gone, std::uint64_t first, std::size_t count) {
  std::vector<std::uint32_t> ids;
  // The id at an index is the index plus the number of removed grains with smaller ids.
  std::uint64_t before = 0;
  for (std::uint64_t place = first; ids.size() < count; ++place) {
    while (before < gone.size() && gone[before] <= place + before) ++before;
    ids.push_back(static_cast<std::uint32_t>(place + before));
  }
  return ids;
}

GrainState redistribute(const base::Comm& comm, const GrainState& rows, const std::vector<int>& destination) {
  return comm.alone() ? rows : redistributeRows(comm, rows, destination);
}

/// Each rank continues the hash received from the rank before it.
base::StateHash hashOf(const GrainState& grains, const base::Comm& comm) {
  const std::vector<std::uint32_t> words = grains.words();
  std::uint64_t value = 0;
  const auto total = static_cast<std::uint64_t>(comm.sumOf(static_cast<std::int64_t>(words.size())));
  if (!comm.first()) value = base::Comm::valuesOf<std::uint64_t>(comm.receive(comm.rank() - 1)).front();
  base::StateHash hash(value);
  if (comm.first()) hash.add(total);
  for (const std::uint32_t word : words) hash.add(static_cast<std::uint64_t>(word));
  const auto bytes = base::Comm::bytesOf(std::vector<std::uint64_t>{hash.value()});
  if (comm.rank() + 1 < comm.size()) comm.send(comm.rank() + 1, bytes);
  return base::StateHash(base::Comm::valuesOf<std::uint64_t>(comm.broadcast(bytes, comm.size() - 1)).front());
}

std::uint64_t blockStart(const base::Comm& comm, std::int64_t total, int rank) {
  const auto size = static_cast<std::uint64_t>(comm.size()), r = static_cast<std::uint64_t>(rank);
  const auto all = static_cast<std::uint64_t>(total);
  return all / size * r + std::min(r, all % size);
}

int blockOf(const base::Comm& comm, std::int64_t total, std::uint32_t id) {
  const auto size = static_cast<std::uint64_t>(comm.size()), all = static_cast<std::uint64_t>(total);
  const std::uint64_t each = all / size, larger = all % size, edge = (each + 1) * larger;
  return static_cast<int>(id < edge ? id / (each + 1) : larger + (id - edge) / each);
}

} // namespace grouser::terrain
