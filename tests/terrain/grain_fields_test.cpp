// SPDX-License-Identifier: BSD-3-Clause
// The lists of fields and columns contain each of them exactly once.
#include "terrain/grain_arrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace grouser::terrain::testing {
namespace {

/// Addresses in ascending order.
using Places = std::vector<const void*>;

bool distinct(Places& places) {
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end();
}

/// Names passed to visitRow().
struct RowColumns {
  Places places;
  template <class T> void column(const std::vector<T>& values) { places.push_back(&values); }
  template <class T> void unhashed(const std::vector<T>& values) { column(values); }
  template <class T> void several(const std::vector<T>& values, std::size_t) { column(values); }
  template <class... T> void contacts(const std::vector<std::uint32_t>& counts, const std::vector<T>*... columns) {
    column(counts), (column(*columns), ...);
  }
  template <class... T>
  void boundaries(const std::vector<std::uint32_t>& bits, std::size_t, const std::vector<T>*... columns) {
    column(bits), (column(*columns), ...);
  }
};

TEST(GrainFields, AllNamesEachFieldOnce) {
  const GrainFields fields(GrainLayout{});
  Places places;
  std::apply([&](const auto&... field) { (places.push_back(&field), ...); }, GrainFields::all(fields));
  EXPECT_TRUE(distinct(places)); // completeness follows from their number: a static_assert
}

TEST(GrainFields, StateNamesEachColumnForHashAndFiles) {
  GrainState state;
  state.layout = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  RowColumns row;
  GrainState::visitRow(state, row);
  Places inFiles;
  const auto add = [&](const char*, const auto& column) { inFiles.push_back(&column); };
  GrainState::visitColumns(state, add, add);
  EXPECT_TRUE(distinct(row.places));
  EXPECT_TRUE(distinct(inFiles));
  EXPECT_EQ(row.places, inFiles);
  const std::size_t columns = inFiles.size() + 1; // and `id`
  EXPECT_EQ(sizeof(GrainState), sizeof(GrainLayout) + sizeof state.total + sizeof(decltype(state.gone)) +
                                    columns * sizeof(std::vector<int>) + sizeof(decltype(state.ledgerSums)) +
                                    sizeof state.skin + sizeof state.rebuilds);
}

TEST(GrainFields, WidthsFollowFromTheLayout) {
  const std::size_t bare = GrainFields(GrainLayout{}).bytesPerGrain();
  const auto more = [&](const GrainLayout& layout) { return GrainFields(layout).bytesPerGrain() - bare; };
  EXPECT_EQ(bare, 2 * (sizeof(base::Position) + 2 * sizeof(Vec4f)) + sizeof(Remainders) + 4 + 12);
  EXPECT_EQ(more({.ledger = 1}), 0u);
  EXPECT_EQ(more({.periodic = 1}), sizeof(Crossings));
  EXPECT_EQ(more({.boundaries = 2}), 8u);
  EXPECT_EQ(more({.boundaries = 5, .friction = 1, .rolling = 1}), 8u) << "springs exist for grains near boundaries";
  EXPECT_EQ(GrainFields(GrainLayout{}).bytesMadeAnew(), sizeof(base::Position) + 2 * sizeof(Vec4f) + 12);
}

} // namespace
} // namespace grouser::terrain::testing
