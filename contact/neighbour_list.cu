// SPDX-License-Identifier: BSD-3-Clause
#include "contact/neighbour_list.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "contact/cell_sort.hpp"
#include "contact/neighbour_rows.cuh"
#include "contact/neighbour_search.cuh"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace grouser::contact {

using base::Position;

namespace {

constexpr std::uint32_t kMaxEqual = 64;    // neighbours of equal spheres: one word of touching bits
constexpr std::uint32_t kMaxOthers = 1024; // neighbours of spheres of several sizes
constexpr std::uint32_t kWindow = 1024;    // number of spheres sorted among themselves
constexpr std::size_t kSpare = 32;         // one spare place per this many places,
constexpr std::size_t kMaxSpare = 1 << 22; // maximum number of spare places
constexpr std::size_t kSlotsRead = 8;      // slots that SIMD loads on a CPU read beyond the last row

void checkLength(std::uint32_t most, bool equal) {
  const std::uint32_t limit = equal ? kMaxEqual : kMaxOthers;
  if (most > limit)
    throw base::SimulationError("a grain has " + std::to_string(most) + " neighbours, more than the limit of " +
                                std::to_string(limit) + ": the bed has collapsed" +
                                (equal ? "; use a smaller time step or stiffer grains"
                                       : ", or the grain sizes differ too much; use stiffer grains, a smaller "
                                         "time step, a smaller skin or larger smallest grains"));
}

/// Cells per maximum reach, at most kMax: cells are about as wide as the smallest grains. 1 for nearly equal grains.
int timesFiner(std::int64_t diameter, std::int64_t smallest) {
  constexpr double kTypical = 1.4; // cell width / smallest diameter
  constexpr int kMax = 4;
  if (smallest <= 0) return 1;
  const double ratio = static_cast<double>(diameter) / (kTypical * static_cast<double>(smallest));
  return std::clamp(static_cast<int>(std::min<double>(ratio, kMax)), 1, kMax);
}

} // namespace

NeighbourList::NeighbourList(const base::Exec& exec, std::int64_t diameter, std::int64_t skin, int width,
                             const base::Period& period, std::int64_t smallest)
    : exec_(exec), diameter_(diameter), skin_(skin), finer_(timesFiner(diameter, smallest)), period_(period),
      width_(width), count_(exec), start_(exec), slot_(exec), reach_(exec), history_(exec), touching_(exec), id_(exec),
      order_(exec), cellStart_(exec), slotAt_(exec) {}

void NeighbourList::sort(const Position* position, std::size_t count, const std::uint32_t* rowOf) {
  sorted_ = count;
  grid_ = fittedGrid(exec_, position, count, (diameter_ + skin_ + finer_ - 1) / finer_, period_);
  sortByCell(exec_, grid_, position, count, order_, cellStart_);
  if (!exec_.onCpu()) groupByContacts(rowOf);
}

/// A warp takes as long as its grain with the most contacts. Nearby grains are therefore reordered so that the grains
/// in a warp have similar numbers of contacts and neighbours. A CPU does not need this.
void NeighbourList::groupByContacts(const std::uint32_t* rowOf) {
  const auto n = static_cast<std::int64_t>(sorted_);
  base::Array<std::uint64_t> key(exec_, sorted_);
  base::Array<std::uint32_t> place(exec_, sorted_), byCell(exec_, sorted_);
  base::copyOnDevice(exec_, byCell.data(), order_.data(), sorted_ * sizeof(std::uint32_t));
  base::forEach(exec_, "assign contact keys", n,
                AssignContactKeys{contacts(), order_.data(), rowOf, kWindow, key.data()});
  base::iota(exec_, place.data(), sorted_);
  base::sortByKey(exec_, key.data(), place.data(), sorted_);
  slotAt_.resize(sorted_);
  base::forEach(exec_, "take places", n, TakePlaces{place.data(), byCell.data(), order_.data(), slotAt_.data()});
}

TouchingRows NeighbourList::contacts() const {
  return {{start_.data(), stride_}, count_.data(), slot_.data(), id_.data(), history_.data(),
          touching_.data(),         maskWords_,    rows(),       width_};
}

base::Array<std::uint32_t> NeighbourList::largestNear(const RadiiInW& radii) const {
  const std::size_t cells = cellStart_.size() - 1;
  const auto n = static_cast<std::int64_t>(cells);
  base::Array<std::uint32_t> largest(exec_, cells), further(exec_, cells);
  base::forEach(exec_, "find largest in cells", n,
                LargestInCell{radii, cellStart_.data(), slotAt_.empty() ? nullptr : slotAt_.data(), largest.data()});
  for (int axis = 0; axis < 3; ++axis) {
    base::forEach(exec_, "spread largest", n, LargestAlong{grid_, axis, finer_, largest.data(), further.data()});
    std::swap(largest, further);
  }
  return largest;
}

void NeighbourList::build(const Position* position, const std::uint32_t* id, const RowOrigins* origins,
                          const RadiiInW& radii) {
  const auto n = static_cast<std::int64_t>(sorted_);
  // Cache the contacts of the previous list; the new list overwrites the memory of the previous one.
  const std::uint32_t former = rows();
  base::Array<std::uint32_t> keptStart(exec_, std::size_t{former} + 1), keptId(exec_);
  base::Array<float> keptHistory(exec_);
  if (former > 0) {
    base::forEach(exec_, "count contacts", former, CountTouching{contacts(), nullptr, keptStart.data()});
    const std::uint32_t kept = base::exclusiveScan(exec_, keptStart.data(), keptStart.data(), std::size_t{former} + 1);
    keptId.resize(kept), keptHistory.resize(std::size_t{kept} * static_cast<std::size_t>(width_));
  }
  const ContactCache kept{keptStart.data(), keptId.data(), keptHistory.data()};
  if (former > 0) base::forEach(exec_, "keep contacts", former, KeepRow{contacts(), kept});

  if (finer_ > 1 && !radii.sphere) throw std::logic_error("spheres of many sizes without their radii");
  const base::Array<std::uint32_t> largest = finer_ > 1 ? largestNear(radii) : base::Array<std::uint32_t>(exec_);
  const NearSpheres near{grid_,
                         position,
                         cellStart_.data(),
                         slotAt_.empty() ? nullptr : slotAt_.data(),
                         (diameter_ + skin_) * (diameter_ + skin_),
                         radii,
                         skin_,
                         origins ? origins->ghost : nullptr,
                         largest.empty() ? nullptr : largest.data()};
  count_.resize(sorted_);
  base::forEach(exec_, "count neighbours", n, CountNear{near, count_.data()});
  const std::uint32_t most = base::maximum(exec_, count_.data(), sorted_);
  checkLength(most, !radii.sphere);
  const RowLayout layout = layRows(exec_, count_, start_, kSlotsRead);
  stride_ = layout.stride;
  const std::size_t places = layout.places + kSlotsRead;
  // Reserve more than needed, so that most rebuilds do not allocate.
  const auto width = static_cast<std::size_t>(width_);
  if (places > slot_.size())
    slot_.resize(places + std::min(places / kSpare, kMaxSpare)), history_.resize(slot_.size() * width);
  base::forEach(exec_, "list neighbours", n, ListNear{near, id, {start_.data(), stride_}, slot_.data()});
  if (radii.sphere) {
    reach_.resize(slot_.size());
    base::forEach(exec_, "list reaches", n,
                  ListReach{radii, {start_.data(), stride_}, count_.data(), slot_.data(), reach_.data()});
  }
  base::setZero(exec_, slot_.data() + places - kSlotsRead, kSlotsRead * sizeof(std::uint32_t));
  id_.resize(sorted_);
  base::copyOnDevice(exec_, id_.data(), id, sorted_ * sizeof(std::uint32_t));
  maskWords_ = std::max<std::int64_t>(1, (most + 63) / 64);
  touching_.resize(sorted_ * static_cast<std::size_t>(maskWords_));
  if (!haveRows_)
    touching_.zero();
  else
    base::forEach(exec_, "restore contact history", n,
                  RestoreHistory{origins ? origins->origin : order_.data(),
                                 id,
                                 count_.data(),
                                 slot_.data(),
                                 {start_.data(), stride_},
                                 maskWords_,
                                 width_,
                                 history_.data(),
                                 touching_.data(),
                                 kept,
                                 former,
                                 origins ? origins->arrived : TravellingRows{}});
  haveRows_ = true;
  for (base::Array<std::uint32_t>* array : {&cellStart_, &slotAt_, &order_}) *array = base::Array<std::uint32_t>(exec_);
}

std::uint32_t NeighbourList::maxTouching(const std::uint32_t* slots, std::size_t count) const {
  if (!haveRows_ || count == 0) return 0;
  base::Array<std::uint32_t> bits(exec_, count);
  base::forEach(exec_, "count neighbours in touch", static_cast<std::int64_t>(count),
                CountTouching{contacts(), slots, bits.data()});
  return base::maximum(exec_, bits.data(), count);
}

void NeighbourList::exportRows(const std::uint32_t* slots, std::size_t count, const TravellingRows& travelling) const {
  if (!haveRows_) return;
  base::forEach(exec_, "export rows", static_cast<std::int64_t>(count), ExportRow{contacts(), slots, travelling});
}

std::uint64_t NeighbourList::listed() const { return base::sum(exec_, count_.data(), rows()); }

NeighbourView NeighbourList::view() {
  return {{start_.data(), stride_}, count_.data(),    slot_.data(), reach_.data(),
          history_.data(),          touching_.data(), maskWords_};
}

std::size_t NeighbourList::bytes() const {
  return count_.bytes() + start_.bytes() + slot_.bytes() + reach_.bytes() + history_.bytes() + touching_.bytes() +
         id_.bytes() + order_.bytes() + cellStart_.bytes() + slotAt_.bytes();
}

NeighbourList::HostCopy NeighbourList::toHost() const {
  return {count_.toHost(), start_.toHost(), slot_.toHost(), history_.toHost(), touching_.toHost(), stride_, maskWords_};
}

void NeighbourList::setHistory(const HostCopy& copy) {
  touching_.assign(copy.touching);
  if (width_) history_.assign(copy.history);
}

} // namespace grouser::contact
