// SPDX-License-Identifier: BSD-3-Clause
// Grains on several ranks: migration of those that have crossed a border, ghosts of those near one.
#include "terrain/grains.hpp"

#include "base/algorithms.hpp"
#include "base/gather.cuh"

#include <algorithm>

namespace grouser::terrain {

using contact::Exchange;
using contact::ExchangeField;
using contact::fieldOf;

namespace {

/// Where the row of each grain is found after the migration, before sorting, as if none had moved.
struct NoteOrigins {
  std::uint32_t kept, owned, former;
  std::uint32_t* origin;
  GROUSER_HD void operator()(int i) const {
    const auto slot = static_cast<std::uint32_t>(i);
    if (slot < kept)
      origin[i] = slot < former ? slot : contact::RowOrigins::kNone; // added since: no row yet
    else
      origin[i] = slot < owned ? former + (slot - kept) : contact::RowOrigins::kNone;
  }
};

/// The same of those that have moved.
struct NoteMovedOrigins {
  const std::uint32_t *from, *to;
  std::uint32_t former;
  std::uint32_t* origin;
  GROUSER_HD void operator()(int k) const { origin[to[k]] = from[k] < former ? from[k] : contact::RowOrigins::kNone; }
};

/// Records of `width` elements go to places that nobody moves from.
template <class T> struct Move {
  const std::uint32_t *from, *to;
  T* array;
  std::uint32_t width;
  GROUSER_HD void operator()(int k) const {
    for (std::uint32_t w = 0; w < width; ++w)
      array[std::int64_t{to[k]} * width + w] = array[std::int64_t{from[k]} * width + w];
  }
};

constexpr double kImbalance = 1.15;         // the dearest rank over the mean, above which cuts are moved [-]
constexpr std::int64_t kBalanceEvery = 200; // steps, at least

} // namespace

template <class Each> void Grains::forOwnArrays(const Each& each) {
  each(position_[0], 1), each(velocity_[0], 1), each(spin_[0], 1);
  each(remainders_, 1), each(id_, 1);
  if (!dissipated_.empty() || model_.ledger) each(dissipated_, 1);
  if (period_.any()) each(crossings_, 1);
  if (boundaryCount_ > 0) each(boundaryContactMask_, 1);
  if (boundaryCount_ > 0 && historyWidth_ > 0)
    each(boundaryHistory_, static_cast<std::uint32_t>(boundaryCount_ * historyWidth_));
}

/// Every grain goes to the rank that its centre lies with, and ghosts are made of those near the borders. Afterwards
/// the slots hold the grains that stayed, those that came, and the ghosts, in this order.
void Grains::migrate() {
  Subdomain& subdomain = *subdomain_;
  finishGhostUpdate();
  if (subdomain.rebalances()) rebalance();
  subdomain.findLeaving(position_[0].data(), slots_);
  if (onMigrate_) onMigrate_(subdomain.destination());

  // The rows of the neighbour list travel with their grains, as ids and springs.
  Exchange& exchange = subdomain.migration();
  const std::size_t kept = subdomain.kept(), owned = kept + exchange.importCount();
  const auto moves = static_cast<std::int64_t>(subdomain.moves());
  contact::TravellingRows rows{nullptr, 0, static_cast<std::uint32_t>(historyWidth_)};
  rows.capacity = static_cast<std::uint32_t>(
      subdomain.comm().maximumOf(neighbours_.mostTouching(exchange.exportSlots(), exchange.exportCount())));
  base::Array<std::uint32_t> leavingRows(exec_, exchange.exportCount() * rows.words());
  rows.data = leavingRows.data();
  neighbours_.exportRows(exchange.exportSlots(), exchange.exportCount(), rows);
  arrivedRows_.resize(exchange.importCount() * rows.words());

  std::vector<ExchangeField> fields;
  forOwnArrays([&](auto& array, std::uint32_t width) {
    const ExchangeField one = fieldOf(array);
    fields.push_back({one.data, one.words * width});
  });
  fields.push_back({leavingRows.data(), rows.words(), true});
  exchange.start(fields);
  fields.clear();
  forOwnArrays([&]<class T>(base::Array<T>& array, std::uint32_t width) {
    base::forEach(exec_, "close ranks", moves,
                  Move<T>{subdomain.movesFrom(), subdomain.movesTo(), array.data(), width});
    if (owned > slots_) array.resizeKeeping(owned * width);
    const ExchangeField field = fieldOf(array);
    fields.push_back({field.data, field.words * width});
  });
  fields.push_back({arrivedRows_.data(), rows.words(), true});
  exchange.setImportSlots(kept);
  exchange.finish(fields);
  rows.data = arrivedRows_.data();

  subdomain.findMasters(position_[0].data(), owned);
  const std::uint32_t former = neighbours_.rows();
  slots_ = owned + subdomain.ghosts();
  forOwnArrays([&](auto& array, std::uint32_t width) { array.resizeKeeping(slots_ * width); });
  position_[1].resizeInLeaps(slots_), velocity_[1].resizeInLeaps(slots_), spin_[1].resizeInLeaps(slots_);
  const ExchangeField ghosts[] = {fieldOf(position_[0]), fieldOf(velocity_[0]), fieldOf(spin_[0]), fieldOf(id_)};
  subdomain.haloExchange().run(ghosts);

  origin_.resize(slots_);
  base::forEach(
      exec_, "note origins", static_cast<std::int64_t>(slots_),
      NoteOrigins{static_cast<std::uint32_t>(kept), static_cast<std::uint32_t>(owned), former, origin_.data()});
  base::forEach(exec_, "note origins of the moved", moves,
                NoteMovedOrigins{subdomain.movesFrom(), subdomain.movesTo(), former, origin_.data()});
  origins_ = {nullptr, nullptr, rows};
}

std::array<ExchangeField, 3> Grains::ghostFields(int buffer) {
  return {fieldOf(position_[buffer]), fieldOf(velocity_[buffer]), fieldOf(spin_[buffer])};
}

/// The ghosts take what their masters sent, where they have not yet.
void Grains::finishGhostUpdate(const base::Exec& exec) {
  if (!subdomain_ || !subdomain_->haloExchange().underWay()) return;
  subdomain_->haloExchange().arrive();
  subdomain_->haloExchange().unpack(exec, ghostFields(0));
}

/// The ghosts are made what their masters are now.
void Grains::updateGhosts() { subdomain_->haloExchange().run(ghostFields(0)); }

/// Moves the cuts where one rank has had clearly more to do than the mean. Time is only measured, so no two runs cut
/// alike; no bit of the answer depends on it.
void Grains::rebalance() {
  const base::Comm& comm = subdomain_->comm();
  const Clock::time_point now = Clock::now();
  if (steps_ < balancedAt_ + kBalanceEvery) return;
  const double waited = subdomain_->waited();
  const double busy =
      std::chrono::duration<double>(now - measuredFrom_).count() - (waited - waitedBefore_) - replicatedSeconds_;
  std::int64_t mine = std::max<std::int64_t>(1, static_cast<std::int64_t>(1e9 * busy));
  const auto most = static_cast<std::int64_t>(comm.maximumOf(static_cast<std::uint64_t>(mine)));
  const std::int64_t all = comm.sumOf(mine);
  if (static_cast<double>(most) * comm.size() > kImbalance * static_cast<double>(all)) {
    const auto own = static_cast<double>(std::max<std::size_t>(1, slots_ - subdomain_->ghosts()));
    subdomain_->setPartition(subdomain_->balanced(position_[0].data(), slots_, static_cast<double>(mine) / own));
    ++rebalancings_;
  }
  balancedAt_ = steps_, measuredFrom_ = now, waitedBefore_ = subdomain_->waited(), replicatedSeconds_ = 0;
}

} // namespace grouser::terrain
