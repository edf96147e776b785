// SPDX-License-Identifier: BSD-3-Clause
// The neighbour list against a search over all pairs, and the contact history kept from list to list.
#include "base/error.hpp"
#include "base/random.hpp"
#include "contact/neighbour_list.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace grouser::contact {
namespace {

using base::Position;
using base::Vec3l;
using Ids = std::vector<std::uint32_t>;

constexpr std::int64_t kDiameter = 150'000'001, kSkin = 20'000'000;

double randomNumber(int sphere, int axis, const char* what) {
  return base::uniform(7, base::purpose(what), static_cast<std::uint64_t>(sphere), static_cast<std::uint64_t>(axis));
}

/// Spheres and their list, as in the grains: sorted in space at every rebuild. Ids identify spheres.
struct Bed {
  explicit Bed(std::vector<Vec3l> places, int width = 0, const base::Period& period = {}, std::vector<float> radii = {},
               std::int64_t smallest = 0)
      : place(std::move(places)), radius(std::move(radii)), list(exec, kDiameter, kSkin, width, period, smallest) {}

  void build() {
    std::vector<Position> positions;
    for (const Vec3l& u : place) positions.push_back(base::fromUnits(u));
    // Slots of the last rebuild; new spheres follow.
    while (id.size() < place.size()) id.push_back(static_cast<std::uint32_t>(id.size()));
    base::Array<Position> bySlot(exec, gathered(positions, id));
    list.sort(bySlot.data(), place.size());
    id = gathered(id, base::toHost(exec, list.order(), place.size()));
    bySlot.assign(gathered(positions, id));
    base::Array<std::uint32_t> ids(exec, id);
    std::vector<Motion> spheres;
    for (const std::uint32_t i : id) spheres.push_back({{0, 0, 0, radius.empty() ? 0 : radius[i]}, {}});
    base::Array<Motion> inW(exec, spheres);
    list.build(bySlot.data(), ids.data(), nullptr, radius.empty() ? RadiiInW{} : RadiiInW{inW.data(), 1.0f});
  }
  template <class T> static std::vector<T> gathered(const std::vector<T>& from, const Ids& order) {
    std::vector<T> to;
    for (const std::uint32_t i : order) to.push_back(from[i]);
    return to;
  }

  /// Neighbours by sphere id, in the order of the list.
  std::vector<Ids> rows() const {
    const NeighbourList::HostCopy host = list.toHost();
    std::vector<Ids> out(id.size());
    for (std::size_t i = 0; i < id.size(); ++i)
      for (std::uint32_t k = 0; k < host.count[i]; ++k)
        out[id[i]].push_back(id[host.slot[static_cast<std::size_t>(host.at(i, k))]]);
    return out;
  }

  /// By pair of ids: the first history number of pairs that touch.
  using History = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<float>>;
  History history(std::size_t width) const {
    const NeighbourList::HostCopy host = list.toHost();
    History out;
    for (std::size_t i = 0; i < id.size(); ++i)
      for (std::uint32_t k = 0; k < host.count[i]; ++k) {
        if (!host.touched(i, k)) continue;
        const auto at = static_cast<std::size_t>(host.at(i, k));
        const auto first = host.history.begin() + static_cast<std::ptrdiff_t>(at * width);
        out[{id[i], id[host.slot[at]]}] = {first, first + static_cast<std::ptrdiff_t>(width)};
      }
    return out;
  }
  /// Marks the pairs of `marks` as touching, with these numbers, and all others as not touching.
  void setHistory(const History& marks, std::size_t width) {
    NeighbourList::HostCopy host = list.toHost();
    std::fill(host.touching.begin(), host.touching.end(), 0);
    for (std::size_t i = 0; i < id.size(); ++i)
      for (std::uint32_t k = 0; k < host.count[i]; ++k) {
        const auto at = static_cast<std::size_t>(host.at(i, k));
        const auto found = marks.find({id[i], id[host.slot[at]]});
        if (found == marks.end()) continue;
        host.touching[i * static_cast<std::size_t>(host.maskWords) + k / 64] |= std::uint64_t{1} << (k & 63u);
        std::copy_n(found->second.begin(), width, host.history.begin() + static_cast<std::ptrdiff_t>(at * width));
      }
    list.setHistory(host);
  }

  base::Exec exec = testExec(2);
  std::vector<Vec3l> place; ///< by id
  std::vector<float> radius;
  Ids id; ///< by slot
  NeighbourList list;
};

/// Random spheres in a box with this edge in diameters.
std::vector<Vec3l> randomPlaces(int count, double edge) {
  std::vector<Vec3l> places(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    for (int a = 0; a < 3; ++a)
      places[static_cast<std::size_t>(i)][a] =
          static_cast<std::int64_t>((randomNumber(i, a, "test.places") - 0.5) * edge * double(kDiameter));
  return places;
}

/// Rows from all pairs, with nearest images if there is a period.
std::vector<Ids> bruteForce(const std::vector<Vec3l>& place, const base::Period& period = {},
                            const std::vector<float>& radius = {}) {
  std::vector<Ids> rows(place.size());
  for (std::uint32_t i = 0; i < place.size(); ++i)
    for (std::uint32_t j = 0; j < place.size(); ++j) {
      const Vec3l apart = period.apart(base::fromUnits(place[i]), base::fromUnits(place[j]));
      const std::int64_t reach =
          radius.empty() ? kDiameter + kSkin
                         : static_cast<std::int64_t>(radius[i]) + static_cast<std::int64_t>(radius[j]) + kSkin;
      if (i != j && std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}) < reach &&
          dot(apart, apart) < reach * reach)
        rows[i].push_back(j);
    }
  return rows;
}

TEST(NeighbourList, HoldsEveryPairCloserThanTheSkin_FromBothSides_InTheOrderOfIds) {
  Bed bed(randomPlaces(1500, 9));
  bed.build();
  const std::vector<Ids> expected = bruteForce(bed.place);
  EXPECT_EQ(bed.rows(), expected);
  std::size_t most = 0;
  for (const Ids& row : expected) most = std::max(most, row.size());
  EXPECT_GT(most, 10u);
}

TEST(NeighbourList, TheSkinEndsToTheUnit) {
  for (const std::int64_t beyond : {-1, 0}) {
    Bed bed({{0, 0, 0}, {kDiameter + kSkin + beyond, 0, 0}});
    bed.build();
    EXPECT_EQ(bed.rows()[0].size(), beyond < 0 ? 1u : 0u);
  }
}

TEST(NeighbourList, SpheresOfSeveralSizesReachAsFarAsTheirRadii) {
  std::vector<float> radius;
  for (int i = 0; i < 1200; ++i) // whole units that a float can represent
    radius.push_back(static_cast<float>(i % 5 ? 1 << 22 : (kDiameter / 2) & ~std::int64_t{0xFF}));
  Bed bed(randomPlaces(1200, 6), 0, {}, radius);
  bed.build();
  EXPECT_EQ(bed.rows(), bruteForce(bed.place, {}, radius));
}

TEST(NeighbourList, FineCellsHoldTheSamePairs) {
  // Coarse spheres below, fine ones above, a few coarse ones among the fine; periods that are no multiple of a cell.
  std::vector<Vec3l> place = randomPlaces(4000, 9);
  const auto radiusOf = [&](std::size_t i) {
    const double height = static_cast<double>(place[i].z) / (9.0 * kDiameter) + 0.5; // 0 to 1
    const double share = i % 97 == 0 ? 1 : std::max(0.2, 1 - 1.2 * height);
    return static_cast<float>(static_cast<std::int64_t>(share * kDiameter / 2) & ~std::int64_t{0xFF});
  };
  std::vector<float> radius;
  for (std::size_t i = 0; i < place.size(); ++i) radius.push_back(radiusOf(i));
  for (const std::int64_t smallest : {kDiameter / 2, kDiameter / 3, kDiameter / 5, kDiameter / 30}) {
    Bed bed(place, 0, {}, radius, smallest);
    bed.build();
    EXPECT_EQ(bed.rows(), bruteForce(place, {}, radius)) << smallest;
    base::Period period;
    period.low = {-4 * kDiameter, -5 * kDiameter, 0};
    period.length = {8 * kDiameter + 12'345'678, 9 * kDiameter + 77'000'001, 0};
    std::vector<Vec3l> inside = place;
    for (Vec3l& u : inside) u = period.wrapped(u);
    Bed ring(inside, 0, period, radius, smallest);
    ring.build();
    EXPECT_EQ(ring.rows(), bruteForce(inside, period, radius)) << smallest;
  }
  place[7] = {std::int64_t{1} << 40, 0, 0}; // a distant one widens all cells
  Bed wide(place, 0, {}, radius, kDiameter / 5);
  wide.build();
  EXPECT_EQ(wide.rows(), bruteForce(place, {}, radius));
}

TEST(NeighbourList, PairsAcrossPeriodicBoundariesAreListed) {
  base::Period period;
  period.low = {-4 * kDiameter, -5 * kDiameter, 0}, period.length = {8 * kDiameter + 12345, 10 * kDiameter, 0};
  std::vector<Vec3l> place = randomPlaces(1000, 8);
  for (Vec3l& u : place) u = period.wrapped(u);
  Bed bed(place, 0, period);
  bed.build();
  const std::vector<Ids> expected = bruteForce(place, period);
  EXPECT_EQ(bed.rows(), expected);
  EXPECT_NE(expected, bruteForce(place)) << "some pairs lie across the boundary";
}

TEST(NeighbourList, AFewSpheresFarAwayDoNotHideOthers) {
  std::vector<Vec3l> place = randomPlaces(300, 5);
  place.push_back({std::int64_t{1} << 40, 0, 0});
  // The low words of these two positions equal the low words of other positions.
  place.push_back(place[0] + Vec3l{std::int64_t{1} << 32, 0, 0});
  place.push_back(place[1] + Vec3l{0, std::int64_t{1} << 33, 10});
  Bed bed(place);
  bed.build();
  EXPECT_EQ(bed.rows(), bruteForce(place));
}

class History : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Width, History, ::testing::Values(0, 3, 6));

TEST_P(History, FollowsThePairOfIdsThroughARebuild) {
  const auto width = static_cast<std::size_t>(GetParam());
  Bed bed(randomPlaces(800, 7), GetParam());
  bed.build();
  Bed::History marks;
  const std::vector<Ids> before = bed.rows();
  for (std::uint32_t i = 0; i < before.size(); ++i)
    for (const std::uint32_t j : before[i]) {
      if ((i + j) % 3 == 0) continue; // these do not touch
      std::vector<float>& numbers = marks[{i, j}];
      for (std::size_t w = 0; w < width; ++w)
        numbers.push_back(static_cast<float>(i) + 1000.0f * static_cast<float>(j) + 0.125f * static_cast<float>(w));
    }
  bed.setHistory(marks, width);
  ASSERT_EQ(bed.history(width), marks);

  // All move by half a diameter at most, some out of reach of each other; new ones enter.
  const std::vector<Ids> slots{bed.id};
  for (std::size_t i = 0; i < bed.place.size(); ++i)
    for (int a = 0; a < 3; ++a)
      bed.place[i][a] +=
          static_cast<std::int64_t>((randomNumber(static_cast<int>(i), a, "test.moves") - 0.5) * double(kDiameter));
  for (const Vec3l& u : randomPlaces(40, 6)) bed.place.push_back(u + Vec3l{1, 1, 1});
  bed.build();
  EXPECT_NE(bed.id, slots.front()) << "slots have changed";
  const std::vector<Ids> after = bed.rows();
  ASSERT_EQ(after, bruteForce(bed.place));
  std::size_t lost = 0;
  Bed::History kept;
  for (const auto& [pair, numbers] : marks) {
    const Ids& row = after[pair.first];
    if (std::binary_search(row.begin(), row.end(), pair.second))
      kept[pair] = numbers;
    else
      ++lost;
  }
  EXPECT_GT(lost, 100u);
  EXPECT_EQ(bed.history(width), kept) << "and no other pair has history";
}

TEST(NeighbourList, ForgottenHistoryIsGone) {
  Bed bed({{0, 0, 0}, {kDiameter, 0, 0}}, 3);
  bed.build();
  bed.setHistory({{{0, 1}, {1, 2, 3}}, {{1, 0}, {4, 5, 6}}}, 3);
  bed.build();
  ASSERT_EQ(bed.history(3).size(), 2u);
  bed.list.forget();
  bed.build();
  EXPECT_TRUE(bed.history(3).empty());
}

TEST(NeighbourList, RowsTravelAsIdsAndHistories) {
  Bed bed({{0, 0, 0}, {kDiameter, 0, 0}, {0, kDiameter, 0}, {5 * kDiameter, 0, 0}}, 3);
  bed.build();
  bed.setHistory({{{0, 1}, {1, 2, 3}}, {{0, 2}, {4, 5, 6}}, {{1, 0}, {7, 8, 9}}}, 3);
  Ids slots; // slots of spheres 0 and 3
  for (const std::uint32_t wanted : {0u, 3u})
    slots.push_back(static_cast<std::uint32_t>(std::find(bed.id.begin(), bed.id.end(), wanted) - bed.id.begin()));
  base::Array<std::uint32_t> leaving(bed.exec, slots);
  ASSERT_EQ(bed.list.maxTouching(leaving.data(), 2), 2u);
  TravellingRows rows{nullptr, 2, 3};
  base::Array<std::uint32_t> data(bed.exec, 2 * rows.words());
  rows.data = data.data();
  bed.list.exportRows(leaving.data(), 2, rows);
  const Ids words = data.toHost();
  EXPECT_EQ(words[0], 2u);
  EXPECT_EQ(words[1], 1u);
  EXPECT_EQ(words[2], 2u);
  float history[6];
  std::memcpy(history, &words[3], sizeof history);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(history[k], static_cast<float>(k + 1));
  EXPECT_EQ(words[rows.words()], 0u) << "sphere 3 has no contacts";
}

TEST(NeighbourList, ACollapsedBedIsRefused) {
  std::vector<Vec3l> place = randomPlaces(400, 1);
  Bed bed(place);
  EXPECT_THROW(bed.build(), base::SimulationError);
}

} // namespace
} // namespace grouser::contact
