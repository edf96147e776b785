// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/fluid_lists.hpp"

#include "base/algorithms.hpp"
#include "contact/cell_sort.hpp"
#include "contact/neighbour_search.cuh"

namespace grouser::fluid {

namespace {

using contact::NearSpheres;

struct AddOffset {
  std::uint32_t* slot;
  std::uint32_t offset;
  GROUSER_HD void operator()(int k) const { slot[k] += offset; }
};

/// Finds the neighbours of a slot: particles, and for a particle also markers.
struct CountPoints {
  static constexpr double kNanoseconds = 2000;
  NearSpheres particles, markers;
  int particleCount;
  const std::uint32_t* ghost; ///< [particleCount], or null
  std::uint32_t *count, *fluidCount;
  GROUSER_HD void operator()(int i) const {
    std::uint32_t fluid = 0, wall = 0;
    if (i < particleCount && ghost && ghost[i]) return void(fluidCount[i] = count[i] = 0);
    particles.each(i, [&fluid](std::uint32_t) { ++fluid; });
    if (i < particleCount) markers.each(i, [&wall](std::uint32_t) { ++wall; });
    fluidCount[i] = fluid, count[i] = fluid + wall;
  }
};

struct ListPoints {
  static constexpr double kNanoseconds = 2500;
  NearSpheres particles, markers;
  int particleCount;
  const std::uint32_t* ghost; ///< as above
  contact::NeighbourRows rows;
  std::uint32_t* slot;
  GROUSER_HD void operator()(int i) const {
    if (i < particleCount && ghost && ghost[i]) return;
    std::uint32_t filled = 0;
    const auto add = [&](std::uint32_t j) { slot[rows.at(i, filled++)] = j; };
    particles.each(i, add);
    if (i < particleCount) markers.each(i, add);
  }
};

} // namespace

FluidLists::FluidLists(const base::Exec& exec, std::int64_t reach, const base::Period& period)
    : exec_(exec), reach_(reach), period_(period), order_(exec), cellStart_(exec), markerSlot_(exec),
      markerCellStart_(exec), count_(exec), fluidCount_(exec), start_(exec), slot_(exec), wet_(exec) {}

void FluidLists::sort(const base::Position* position, std::size_t particles, std::size_t markers) {
  particles_ = particles, markers_ = markers;
  grid_ = contact::fittedGrid(exec_, position, particles + markers, reach_, period_);
  contact::sortByCell(exec_, grid_, position, particles, order_, cellStart_);
  contact::sortByCell(exec_, grid_, position + particles, markers, markerSlot_, markerCellStart_);
  base::forEach(exec_, "number markers", static_cast<std::int64_t>(markers),
                AddOffset{markerSlot_.data(), static_cast<std::uint32_t>(particles)});
}

void FluidLists::build(const base::Position* position, const std::uint32_t* ghost) {
  const std::size_t all = particles_ + markers_;
  const auto n = static_cast<std::int64_t>(all);
  const auto particleCount = static_cast<int>(particles_);
  const NearSpheres particles{grid_, position, cellStart_.data(), nullptr, reach_ * reach_, {}, 0, nullptr, nullptr};
  NearSpheres markers = particles;
  markers.cellStart = markerCellStart_.data(), markers.slotAt = markerSlot_.data();
  count_.resize(all), fluidCount_.resize(all);
  base::forEach(exec_, "count fluid neighbours", n,
                CountPoints{particles, markers, particleCount, ghost, count_.data(), fluidCount_.data()});
  const contact::RowLayout layout = contact::layRows(exec_, count_, start_);
  stride_ = layout.stride;
  const std::size_t places = layout.places;
  if (places > slot_.size()) slot_.resize(places + places / 32);
  base::forEach(exec_, "list fluid neighbours", n,
                ListPoints{particles, markers, particleCount, ghost, {start_.data(), stride_}, slot_.data()});
  base::listMarked(exec_, count_.data() + particles_, markers_, wet_);
}

FluidRows FluidLists::rows() const {
  return {{start_.data(), stride_}, count_.data(), fluidCount_.data(), slot_.data()};
}

} // namespace grouser::fluid
