// SPDX-License-Identifier: BSD-3-Clause
// Fluid on several ranks: each rank integrates the particles of its subdomain and stores ghosts within twice the
// reach of its lists, so that the pressures of all markers near its particles can be computed locally.
#include "base/algorithms.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_kernels.cuh"

#include <array>
#include <numeric>

namespace grouser::fluid {

namespace {

constexpr std::int64_t kBalanceEvery = 16; ///< rebuilds

template <class T> struct CloseGaps {
  const std::uint32_t *from, *to;
  T* array;
  GROUSER_HD void operator()(int k) const { array[to[k]] = array[from[k]]; }
};

/// Copies the records of an array from index `from` on.
template <class T> base::Array<T> tailOf(const base::Exec& exec, const base::Array<T>& array, std::size_t from) {
  auto tail = base::Array<T>::unset(exec, array.size() - from);
  base::copyOnDevice(exec, tail.data(), array.data() + from, tail.size() * sizeof(T));
  return tail;
}

template <class T> void append(const base::Exec& exec, base::Array<T>& array, const base::Array<T>& tail) {
  const std::size_t before = array.size();
  array.resizeKeeping(before + tail.size());
  base::copyOnDevice(exec, array.data() + before, tail.data(), tail.size() * sizeof(T));
}

} // namespace

template <class Visit> void Fluid::eachOwned(const Visit& visit) {
  visit(position_), visit(motion_), visit(precise_), visit(force_), visit(losses_), visit(id_);
}

std::vector<std::uint32_t> Fluid::divide(const std::vector<base::Position>& positions,
                                         const contact::PartitionOptions& ranks) {
  std::vector<std::uint32_t> mine(positions.size());
  std::iota(mine.begin(), mine.end(), 0U);
  if (ranks.comm.alone()) return mine;
  // The pressure of a marker near a particle of this rank depends on all fluid within its own reach.
  subdomain_ = std::make_unique<contact::Subdomain>(exec_, ranks, 2 * lists_.reach(), constants_.period);
  subdomain_->setPartition(contact::startingPartition(positions, ranks, constants_.scale));
  const contact::PartitionView partition = subdomain_->partition().view();
  std::erase_if(mine,
                [&](std::uint32_t i) { return partition.ownerOf(base::toUnits(positions[i])) != ranks.comm.rank(); });
  return mine;
}

/// Migrates particles that have left the subdomain, and creates the ghosts. Markers, which follow the particles in the
/// arrays, are stored elsewhere meanwhile.
void Fluid::migrate() {
  if (rebalances_ && rebuilds_ > 0 && rebuilds_ % kBalanceEvery == 0)
    subdomain_->setPartition(subdomain_->balanced(position_.data(), slots_, 1));
  const base::Array<base::Position> markerPosition = tailOf(exec_, position_, slots_);
  const base::Array<base::Vec4f> markerMotion = tailOf(exec_, motion_, slots_);
  contact::Exchange& migration = subdomain_->migration();
  const auto fields = [this] {
    std::vector<contact::ExchangeField> all;
    eachOwned([&all](auto& array) { all.push_back(contact::fieldOf(array)); });
    return all;
  };
  subdomain_->findLeaving(position_.data(), slots_);
  migration.start(fields());
  const contact::Subdomain::Staying staying = subdomain_->staying();
  const std::size_t owned = staying.kept + migration.importCount();
  eachOwned([&]<class T>(base::Array<T>& array) {
    base::forEach(exec_, "close gaps", static_cast<std::int64_t>(staying.moves),
                  CloseGaps<T>{staying.from, staying.to, array.data()});
    array.resizeKeeping(staying.kept), array.resizeKeeping(owned);
  });
  migration.setImportSlots(staying.kept);
  migration.finish(fields());
  subdomain_->findMasters(position_.data(), owned);
  slots_ = owned + subdomain_->ghosts();
  eachOwned([&]<class T>(base::Array<T>& array) {
    array.resizeKeeping(slots_);
    base::setZero(exec_, array.data() + owned, subdomain_->ghosts() * sizeof(T)); // sorted with the other slots
  });
  change_.resize(slots_), reference_.resize(slots_);
  if (model_.shifting > 0) shift_.resize(slots_), divergence_.resize(slots_);
  updateGhosts();
  append(exec_, position_, markerPosition), append(exec_, motion_, markerMotion);
}

void Fluid::updateGhosts() {
  if (!subdomain_) return;
  const std::array fields{contact::fieldOf(position_), contact::fieldOf(motion_)};
  subdomain_->haloExchange().run(fields);
}

/// Shifting is scaled by the maximum particle speed of all ranks.
void Fluid::agreeOnSpeed() {
  if (!subdomain_ || !(model_.shifting > 0)) return;
  flags_.download();
  base::synchronize(exec_);
  flags_.host()->fastest = static_cast<std::uint32_t>(comm_.maximumOf(flags_.host()->fastest));
  flags_.upload();
}

/// Combines flags and body loads over all ranks.
void Fluid::agree() {
  if (!subdomain_) return;
  FluidFlags& flags = *flags_.host();
  std::vector<std::int64_t> sums{flags.listEnded, flags.fault != kNoFault};
  const auto eachLoad = [&](const auto& visit) {
    for (std::size_t b = 0; b < bodyLoad_.size(); ++b)
      for (base::Vec3l* v : {&bodyLoad_.host()[b].force, &bodyLoad_.host()[b].torque})
        for (int a = 0; a < 3; ++a) visit((*v)[a]);
  };
  eachLoad([&sums](std::int64_t load) { sums.push_back(load); });
  comm_.sum(sums.data(), sums.size());
  std::size_t next = 2;
  eachLoad([&](std::int64_t& load) { load = sums[next++]; });
  flags.listEnded = sums[0] > 0;
  if (sums[1] > 0) comm_.minimum(&flags.fault, 1);
}

template <class T> std::vector<T> Fluid::byId(const base::Array<T>& array) const {
  std::vector<T> mine = base::toHost(exec_, array.data(), slots_), all(particles_);
  std::vector<std::uint32_t> id = base::toHost(exec_, id_.data(), slots_);
  if (!subdomain_) {
    for (std::size_t i = 0; i < mine.size(); ++i) all[id[i]] = mine[i];
    return all;
  }
  const std::vector<std::uint32_t> ghost = base::toHost(exec_, ghostMarks(), slots_);
  std::size_t owned = 0;
  for (std::size_t i = 0; i < mine.size(); ++i)
    if (!ghost[i]) mine[owned] = mine[i], id[owned++] = id[i];
  mine.resize(owned), id.resize(owned);
  const std::vector<std::vector<T>> records = comm_.gatherAll(mine);
  const std::vector<std::vector<std::uint32_t>> ids = comm_.gatherAll(id);
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t k = 0; k < records[r].size(); ++k) all[ids[r][k]] = records[r][k];
  return all;
}

template std::vector<base::Position> Fluid::byId(const base::Array<base::Position>&) const;
template std::vector<PreciseMotion> Fluid::byId(const base::Array<PreciseMotion>&) const;
template std::vector<Losses> Fluid::byId(const base::Array<Losses>&) const;
template std::vector<base::Vec3l> Fluid::byId(const base::Array<base::Vec3l>&) const;

std::int64_t Fluid::bytesSent() const { return subdomain_ ? subdomain_->bytesSent() : 0; }

} // namespace grouser::fluid
