// SPDX-License-Identifier: BSD-3-Clause
#include "contact/subdomain.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/for_each.cuh"

#include <algorithm>
#include <string>
#include <utility>

namespace grouser::contact {

using base::Position;
using base::Vec3l;

namespace {

GROUSER_HD bool isSlave(const std::uint32_t* role, int i) {
  return role && role[i] == static_cast<std::uint32_t>(Role::slave);
}

/// Finds the rank that owns each element at its current position.
struct FindOwner {
  PartitionView partition;
  base::Period period;
  const Position* position;
  const std::uint32_t* role; ///< null before the first roles
  int me;
  std::uint32_t *destination, *leaves, *stays;
  GROUSER_HD void operator()(int i) const {
    const bool slave = isSlave(role, i);
    const int owner = slave ? -1 : partition.ownerOf(period.wrapped(base::toUnits(position[i])));
    destination[i] = slave ? Subdomain::kNobody : static_cast<std::uint32_t>(owner);
    leaves[i] = !slave && owner != me;
    stays[i] = !slave && owner == me;
  }
};

/// Closes the gaps: pairs each leaving slot below `kept` with a staying one at or above `kept`.
struct PairMoves {
  const std::uint32_t *stays, *staysBefore; ///< by slot: 1 if it stays; number of staying slots before it
  std::uint32_t kept;
  std::uint32_t *from, *to;
  GROUSER_HD void operator()(int i) const {
    const auto slot = static_cast<std::uint32_t>(i);
    if (slot < kept && !stays[i]) to[slot - staysBefore[i]] = slot;
    if (slot >= kept && stays[i]) from[staysBefore[i] - staysBefore[kept]] = slot;
  }
};

struct ReadRanks {
  const std::uint32_t *slots, *destination;
  std::uint64_t* ranks;
  GROUSER_HD void operator()(int k) const { ranks[k] = destination[slots[k]]; }
};

/// Counts the other subdomains within range of an element, or lists them if `ranks` is not null.
struct FindGhostTargets {
  PartitionView partition;
  base::Period period;
  const Position* position;
  std::int64_t range;
  int me;
  std::uint32_t* count;
  const std::uint32_t* first;
  std::uint64_t* ranks;
  std::uint32_t* slots;
  GROUSER_HD void operator()(int i) const {
    const Vec3l u = period.wrapped(base::toUnits(position[i]));
    const std::uint64_t near[3] = {slabsNear(0, u.x), slabsNear(1, u.y), slabsNear(2, u.z)};
    std::uint32_t found = 0;
    for (int x = 0; x < partition.shape[0]; ++x) {
      if (!(near[0] >> x & 1)) continue;
      for (int y = 0; y < partition.shape[1]; ++y) {
        if (!(near[1] >> y & 1)) continue;
        for (int z = 0; z < partition.shape[2]; ++z) {
          const int rank = partition.rankAt(x, y, z);
          if (rank == me || !(near[2] >> z & 1)) continue;
          if (ranks) {
            ranks[first[i] + found] = static_cast<std::uint64_t>(rank);
            slots[first[i] + found] = static_cast<std::uint32_t>(i);
          }
          ++found;
        }
      }
    }
    if (!ranks) count[i] = found;
  }

private:
  /// Bit k: slab k of this axis, or an image of it across periodic boundaries, is within range of `u`.
  GROUSER_HD std::uint64_t slabsNear(int axis, std::int64_t u) const {
    const std::int64_t low = u - range, high = u + range;
    if (!period.along(axis)) return slabs(axis, low, high);
    const std::int64_t start = period.low[axis], last = start + period.length[axis] - 1;
    std::uint64_t bits = slabs(axis, low < start ? start : low, high > last ? last : high);
    if (low < start) bits |= slabs(axis, low + period.length[axis], last);
    if (high > last) bits |= slabs(axis, start, high - period.length[axis]);
    return bits;
  }
  GROUSER_HD std::uint64_t slabs(int axis, std::int64_t low, std::int64_t high) const {
    static_assert(kMaxSubdomainsAnAxis <= 64);
    std::uint64_t bits = 0;
    for (int k = partition.along(axis, low), end = partition.along(axis, high); k <= end; ++k)
      bits |= std::uint64_t{1} << k;
    return bits;
  }
};

/// Assigns roles by slot before sorting. Owned elements: master if another rank needs it, else unique; then ghosts.
struct AssignRoles {
  const std::uint32_t* ghostTargets;
  std::uint32_t owned;
  std::uint32_t* role;
  GROUSER_HD void operator()(int i) const {
    const auto slot = static_cast<std::uint32_t>(i);
    role[i] = static_cast<std::uint32_t>(slot >= owned         ? Role::slave
                                         : ghostTargets[i] > 0 ? Role::master
                                                               : Role::unique);
  }
};

struct Sorted {
  const std::uint32_t *order, *roleBefore;
  std::uint32_t *role, *ghost, *unique, *master, *newSlot;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t r = roleBefore[order[i]];
    role[i] = r;
    ghost[i] = r == static_cast<std::uint32_t>(Role::slave);
    unique[i] = r == static_cast<std::uint32_t>(Role::unique);
    master[i] = r == static_cast<std::uint32_t>(Role::master);
    newSlot[order[i]] = static_cast<std::uint32_t>(i);
  }
};

/// Histogram of the elements of this rank along each axis.
struct CountInBins {
  const Position* position;
  const std::uint32_t* role;
  Vec3l low, width;
  std::int64_t* bins; ///< [axis][kPartitionBins]
  GROUSER_HD void operator()(int i) const {
    if (isSlave(role, i)) return;
    const Vec3l u = base::toUnits(position[i]);
    for (int a = 0; a < 3; ++a) {
      std::int64_t bin = (u[a] - low[a]) / width[a];
      bin = bin < 0 ? 0 : bin < kPartitionBins ? bin : kPartitionBins - 1;
      base::atomicAdd64(bins + a * kPartitionBins + bin, 1);
    }
  }
};

constexpr std::int64_t kBias = std::int64_t{1} << 41; // makes coordinates positive

struct FindExtent {
  const Position* position;
  const std::uint32_t* role;
  std::uint64_t* extent; ///< [6] minimum of u + bias, then of bias - u
  GROUSER_HD void operator()(int i) const {
    if (isSlave(role, i)) return;
    const Vec3l u = base::toUnits(position[i]);
    for (int a = 0; a < 3; ++a) {
      base::atomicMin64(extent + a, static_cast<std::uint64_t>(u[a] + kBias));
      base::atomicMin64(extent + 3 + a, static_cast<std::uint64_t>(kBias - u[a]));
    }
  }
};

} // namespace

Partition startingPartition(const std::vector<Position>& position, const PartitionOptions& options,
                            const base::PositionScale& scale) {
  std::array<int, 3> wanted = options.subdomains;
  for (std::size_t a = 0; a < 3; ++a) {
    const int given = static_cast<int>(options.cuts[a].size()) + 1;
    if (given == 1) continue;
    if (wanted[a] != 0 && wanted[a] != given)
      throw base::InputError(std::string("parallel.cuts_") + "xyz"[a] + " has " + std::to_string(given - 1) +
                             " planes, hence " + std::to_string(given) + " subdomains, but parallel.subdomains is " +
                             std::to_string(wanted[a]) + " along that axis; change one of them");
    wanted[a] = given;
  }
  base::Vec3l low{}, high{};
  for (std::size_t i = 0; i < position.size(); ++i) {
    const base::Vec3l u = base::toUnits(position[i]);
    low = i == 0 ? u : base::min(low, u), high = i == 0 ? u : base::max(high, u);
  }
  std::array<std::vector<std::int64_t>, 3> weights;
  std::array<double, 3> size{};
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    size[k] = static_cast<double>(high[a] - low[a]) + 1;
    weights[k].resize(kPartitionBins);
    const std::int64_t width = binWidth(low[a], high[a]);
    for (const Position& p : position) ++weights[k][static_cast<std::size_t>((base::toUnits(p)[a] - low[a]) / width)];
  }
  const Partition chosen(latticeShape(options.comm.size(), size, wanted), low, high, weights);
  std::array<std::vector<std::int64_t>, 3> cuts;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    cuts[k] = chosen.cuts(a);
    for (std::size_t c = 0; c < options.cuts[k].size(); ++c) cuts[k][c] = scale.inUnits(options.cuts[k][c]);
  }
  return Partition(cuts);
}

Subdomain::Subdomain(const base::Exec& exec, const PartitionOptions& options, std::int64_t range,
                     const base::Period& period)
    : exec_(exec), comm_(options.comm), range_(range), period_(period),
      migration_(exec, options.comm, {.peers = options.peers}),
      haloExchange_(exec, options.comm, {.peers = options.peers}), reduction_(exec, options.comm, options.peers),
      role_(exec), ghostMark_(exec), destination_(exec), movesFrom_(exec), movesTo_(exec), uniques_(exec),
      masters_(exec) {}

void Subdomain::findLeaving(const Position* position, std::size_t slots) {
  base::Array<std::uint32_t> leaves(exec_, slots), stays(exec_, slots), leaving(exec_);
  destination_.resize(slots);
  base::forEach(exec_, "find owners", static_cast<std::int64_t>(slots),
                FindOwner{partition_.view(), period_, position, haveRoles_ ? role_.data() : nullptr, comm_.rank(),
                          destination_.data(), leaves.data(), stays.data()});
  base::listMarked(exec_, leaves.data(), slots, leaving);
  base::Array<std::uint32_t> staysBefore(exec_, slots);
  kept_ = base::exclusiveScan(exec_, stays.data(), staysBefore.data(), slots);
  const std::size_t behind = kept_ < slots ? kept_ - staysBefore.at(kept_) : 0;
  movesFrom_.resize(behind), movesTo_.resize(behind);
  base::forEach(exec_, "pair moves", behind > 0 ? static_cast<std::int64_t>(slots) : 0,
                PairMoves{stays.data(), staysBefore.data(), static_cast<std::uint32_t>(kept_), movesFrom_.data(),
                          movesTo_.data()});
  base::Array<std::uint64_t> ranks(exec_, leaving.size());
  base::forEach(exec_, "read destinations", static_cast<std::int64_t>(leaving.size()),
                ReadRanks{leaving.data(), destination_.data(), ranks.data()});
  migration_.setPlan(ranks, leaving, leaving.size());
}

void Subdomain::appended(std::size_t count) {
  if (!haveRoles_) return;
  const std::size_t before = role_.size();
  role_.resizeKeeping(before + count), ghostMark_.resizeKeeping(before + count);
  const std::vector<std::uint32_t> unique(count, static_cast<std::uint32_t>(Role::unique)), own(count, 0);
  base::copyToDevice(exec_, role_.data() + before, unique.data(), count * sizeof(std::uint32_t));
  base::copyToDevice(exec_, ghostMark_.data() + before, own.data(), count * sizeof(std::uint32_t));
}

void Subdomain::findMasters(const Position* position, std::size_t owned) {
  const auto n = static_cast<std::int64_t>(owned);
  base::Array<std::uint32_t> count(exec_, owned), first(exec_, owned);
  FindGhostTargets find{partition_.view(), period_, position, range_, comm_.rank(),
                        count.data(),      nullptr, nullptr,  nullptr};
  base::forEach(exec_, "count ghost targets", n, find);
  const std::uint32_t total = base::exclusiveScan(exec_, count.data(), first.data(), owned);
  base::Array<std::uint64_t> ranks(exec_, total);
  base::Array<std::uint32_t> slots(exec_, total);
  find.first = first.data(), find.ranks = ranks.data(), find.slots = slots.data();
  if (total > 0) base::forEach(exec_, "list ghost targets", n, find);
  haloExchange_.setPlan(ranks, slots, total);
  haloExchange_.setImportSlots(owned);
  role_.resize(owned + ghosts());
  base::forEach(exec_, "assign roles", static_cast<std::int64_t>(role_.size()),
                AssignRoles{count.data(), static_cast<std::uint32_t>(owned), role_.data()});
}

void Subdomain::sorted(const std::uint32_t* order, std::size_t slots) {
  base::Array<std::uint32_t> role(exec_, slots), unique(exec_, slots), master(exec_, slots), newSlot(exec_, slots);
  ghostMark_.resize(slots);
  base::forEach(
      exec_, "sort roles", static_cast<std::int64_t>(slots),
      Sorted{order, role_.data(), role.data(), ghostMark_.data(), unique.data(), master.data(), newSlot.data()});
  role_.swap(role);
  haveRoles_ = true;
  if (exec_.onCpu()) base::listMarked(exec_, unique.data(), slots, uniques_);
  base::listMarked(exec_, master.data(), slots, masters_);
  haloExchange_.renumber(newSlot.data());
}

Partition Subdomain::balanced(const Position* position, std::size_t slots, double costEach) const {
  const auto n = static_cast<std::int64_t>(slots);
  const std::uint32_t* role = haveRoles_ ? role_.data() : nullptr;
  base::Array<std::uint64_t> extent(exec_, std::vector<std::uint64_t>(6, ~std::uint64_t{0}));
  base::forEach(exec_, "find the extent", n, FindExtent{position, role, extent.data()});
  std::vector<std::uint64_t> e = extent.toHost();
  comm_.minimum(e.data(), e.size());
  Vec3l low, high, width;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    low[a] = static_cast<std::int64_t>(e[k]) - kBias;
    high[a] = kBias - static_cast<std::int64_t>(e[k + 3]);
    width[a] = binWidth(low[a], high[a]);
  }
  base::Array<std::int64_t> bins(exec_, 3 * kPartitionBins);
  base::forEach(exec_, "count elements in bins", n, CountInBins{position, role, low, width, bins.data()});
  std::vector<std::int64_t> weight = bins.toHost();
  // Costs are whole numbers, in 1/1024 of the maximum, so that all ranks compute the same sums.
  double dearest = costEach;
  comm_.maximum(&dearest, 1);
  const auto cost = std::max<std::int64_t>(1, static_cast<std::int64_t>(1024 * costEach / dearest));
  for (std::int64_t& w : weight) w *= cost;
  comm_.sum(weight.data(), weight.size());
  std::array<std::vector<std::int64_t>, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto first = weight.begin() + static_cast<std::ptrdiff_t>(a) * kPartitionBins;
    axes[a].assign(first, first + kPartitionBins);
  }
  return {partition_.shape(), low, high, axes};
}

const char* Subdomain::way() const {
  if (exec_.onCpu()) return haloExchange_.peersOnly() ? "shared memory" : "messages";
  if (stepsTogether()) return "GPU to GPU, steps synchronised by the GPUs";
  if (haloExchange_.peersOnly()) return "GPU to GPU";
  return haloExchange_.sharesMemory() ? "GPU to GPU where possible, else messages" : "messages";
}

std::size_t Subdomain::bytes() const {
  return role_.bytes() + ghostMark_.bytes() + destination_.bytes() + movesFrom_.bytes() + movesTo_.bytes() +
         uniques_.bytes() + masters_.bytes();
}

} // namespace grouser::contact
