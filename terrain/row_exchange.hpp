// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

/// Packs rows of several columns into words, and transfers them between ranks.
///
/// A row type has a column `id` [rows], a function withoutRows(), and a static visitRow(self, visitor), which calls the
/// following for each of the other columns, in the order of a row's words:
///   visitor.column(values)                     one value per row
///   visitor.unhashed(values)                   the same, excluded from the state hash
///   visitor.contacts(counts, column*...)       counts[row] values per row and column; null pointer: column absent
///   visitor.several(values, width)             `width` values per row
///   visitor.boundaries(bits, width, column*...)  a word of bits, and `width` values per row and column
namespace grouser::terrain {

template <class T> void putWords(std::vector<std::uint32_t>& words, const T& value) {
  static_assert(sizeof value % 4 == 0 && std::is_trivially_copyable_v<T>);
  std::uint32_t raw[sizeof value / 4];
  std::memcpy(raw, &value, sizeof value);
  words.insert(words.end(), raw, raw + sizeof value / 4);
}

/// Position in a loop over rows and their contacts.
struct RowCursor {
  std::size_t row = 0, contact = 0; ///< index of the row, and of its first contact
};

/// Visitor that appends the values of one row to the words and advances the cursor.
class RowPacker {
public:
  RowPacker(RowCursor& at, std::vector<std::uint32_t>& words) : at_(at), words_(words) {}
  template <class T> void column(const std::vector<T>& values) { putWords(words_, values[at_.row]); }
  template <class T> void unhashed(const std::vector<T>& values) { column(values); }
  template <class T> void several(const std::vector<T>& values, std::size_t width) {
    for (std::size_t k = at_.row * width; k < (at_.row + 1) * width; ++k) putWords(words_, values[k]);
  }
  template <class... T> void contacts(const std::vector<std::uint32_t>& counts, const std::vector<T>*... columns) {
    column(counts);
    for (std::uint32_t n = 0; n < counts[at_.row]; ++n, ++at_.contact)
      ((columns ? putWords(words_, (*columns)[at_.contact]) : void()), ...);
  }
  template <class... T>
  void boundaries(const std::vector<std::uint32_t>& bits, std::size_t width, const std::vector<T>*... columns) {
    column(bits);
    for (std::size_t b = at_.row * width; b < (at_.row + 1) * width; ++b)
      ((columns ? putWords(words_, (*columns)[b]) : void()), ...);
  }

private:
  RowCursor& at_;
  std::vector<std::uint32_t>& words_;
};

/// Visitor that appends a row written by RowPacker.
class RowReader {
public:
  explicit RowReader(const std::uint32_t* words) : at_(words) {}
  template <class T> void column(std::vector<T>& values) {
    values.emplace_back();
    std::memcpy(static_cast<void*>(&values.back()), at_, sizeof(T));
    at_ += sizeof(T) / 4;
  }
  template <class T> void unhashed(std::vector<T>& values) { column(values); }
  template <class T> void several(std::vector<T>& values, std::size_t width) {
    for (std::size_t k = 0; k < width; ++k) column(values);
  }
  template <class... T> void contacts(std::vector<std::uint32_t>& counts, std::vector<T>*... columns) {
    column(counts);
    for (std::uint32_t n = 0; n < counts.back(); ++n) ((columns ? column(*columns) : void()), ...);
  }
  template <class... T>
  void boundaries(std::vector<std::uint32_t>& bits, std::size_t width, std::vector<T>*... columns) {
    column(bits);
    for (std::size_t b = 0; b < width; ++b) ((columns ? column(*columns) : void()), ...);
  }

private:
  const std::uint32_t* at_;
};

/// Moves row k to rank `destination[k]`; the result is sorted by id. Collective.
template <class Rows>
Rows redistributeRows(const base::Comm& comm, const Rows& rows, const std::vector<int>& destination) {
  // A row consists of its number of words, its id, and the words.
  std::vector<std::vector<std::uint32_t>> to(static_cast<std::size_t>(comm.size()));
  RowCursor at;
  for (; at.row < rows.id.size(); ++at.row) {
    std::vector<std::uint32_t>& words = to[static_cast<std::size_t>(destination[at.row])];
    const std::size_t start = words.size();
    words.insert(words.end(), {0, rows.id[at.row]});
    RowPacker packer(at, words);
    Rows::visitRow(rows, packer);
    words[start] = static_cast<std::uint32_t>(words.size() - start);
  }
  std::vector<base::Bytes> bytes;
  for (std::vector<std::uint32_t>& words : to) {
    bytes.push_back(base::Comm::bytesOf(words));
    std::vector<std::uint32_t>().swap(words);
  }
  std::vector<std::vector<std::uint32_t>> from;
  for (const base::Bytes& part : comm.allToAll(bytes)) from.push_back(base::Comm::valuesOf<std::uint32_t>(part));
  std::vector<const std::uint32_t*> arrived;
  for (const std::vector<std::uint32_t>& words : from)
    for (std::size_t w = 0; w < words.size(); w += words[w]) arrived.push_back(&words[w]);
  std::sort(arrived.begin(), arrived.end(), [](const std::uint32_t* a, const std::uint32_t* b) { return a[1] < b[1]; });
  Rows out = rows.withoutRows();
  for (const std::uint32_t* row : arrived) {
    out.id.push_back(row[1]);
    RowReader reader(row + 2);
    Rows::visitRow(out, reader);
  }
  return out;
}

} // namespace grouser::terrain
