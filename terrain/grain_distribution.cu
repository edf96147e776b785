// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_distribution.hpp"

#include "base/for_each.cuh"

#include <algorithm>
#include <stdexcept>

namespace grouser::terrain {

using base::Position;
using contact::Exchange;
using contact::ExchangeField;
using contact::TravellingRows;

namespace {

/// For each slot after the migration, before sorting: the row of its grain in the last neighbour list (or among the
/// received rows), as if all remaining grains had kept their slots.
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

/// Same for grains moved to another slot to close a gap.
struct NoteMovedOrigins {
  const std::uint32_t *from, *to;
  std::uint32_t former;
  std::uint32_t* origin;
  GROUSER_HD void operator()(int k) const { origin[to[k]] = from[k] < former ? from[k] : contact::RowOrigins::kNone; }
};

constexpr double kImbalance = 1.15;         // load imbalance (maximum / mean busy time) above which cuts are moved [-]
constexpr std::int64_t kBalanceEvery = 200; // minimum number of steps between two balances

} // namespace

GrainDistribution::GrainDistribution(const base::Exec& exec, const PartitionOptions& options, const GrainConstants& c,
                                     const std::vector<Position>& start)
    : exec_(exec), rebalances_(options.rebalance), historyWidth_(c.historyWidth),
      subdomain_(exec, options, c.listRange(), c.period), arrivedRows_(exec) {
  setPartition(contact::startingPartition(start, options, c.scale));
}

void GrainDistribution::onMigrate(OnMigrate onMigrate) {
  if (onMigrate_) throw std::logic_error("grain migration already has a listener");
  onMigrate_ = std::move(onMigrate);
}

void GrainDistribution::migrate(GrainArrays& arrays, contact::NeighbourList& neighbours, GrainBoundaries& boundaries,
                                std::int64_t step) {
  finishGhostUpdate(exec_, arrays); // otherwise it would be unpacked into slots reassigned below
  if (rebalances_) rebalance(arrays, step);
  subdomain_.findLeaving(arrays.fields().position.now.data(), arrays.slots());
  if (onMigrate_) onMigrate_(subdomain_.destination());

  base::Array<std::uint32_t> leavingRows(exec_);
  TravellingRows rows = exportRows(neighbours, leavingRows);
  arrivedRows_.resize(subdomain_.migration().importCount() * rows.words());
  moveFields(arrays, boundaries, rows);
  rows.data = arrivedRows_.data();

  const std::size_t owned = subdomain_.staying().kept + subdomain_.migration().importCount();
  subdomain_.findMasters(arrays.fields().position.now.data(), owned);
  arrays.resizeKeeping(owned + subdomain_.ghosts());
  subdomain_.haloExchange().run(arrays.exchanged(kGhosted));
  noteOrigins(static_cast<std::uint32_t>(owned), neighbours.rows(), arrays);
  origins_ = {nullptr, nullptr, rows};
}

/// Packs the contacts of leaving grains, as ids and springs, to be sent with them.
TravellingRows GrainDistribution::exportRows(const contact::NeighbourList& neighbours,
                                             base::Array<std::uint32_t>& leaving) {
  const Exchange& exchange = subdomain_.migration();
  TravellingRows rows{nullptr, 0, static_cast<std::uint32_t>(historyWidth_)};
  rows.capacity = static_cast<std::uint32_t>(
      subdomain_.comm().maximumOf(neighbours.maxTouching(exchange.exportSlots(), exchange.exportCount())));
  leaving.resize(exchange.exportCount() * rows.words());
  rows.data = leaving.data();
  neighbours.exportRows(exchange.exportSlots(), exchange.exportCount(), rows);
  return rows;
}

/// Sends leaving grains, closes the gaps, and appends received grains. The gaps may be filled while the messages are in
/// flight: start() returns when all leaving grains are packed into separate buffers.
void GrainDistribution::moveFields(GrainArrays& arrays, GrainBoundaries& boundaries, const TravellingRows& leaving) {
  Exchange& exchange = subdomain_.migration();
  const auto springs = static_cast<std::uint32_t>(boundaries.springsWidth());
  const auto withRows = [&](std::uint32_t* rows, float* atBoundaries) {
    std::vector<ExchangeField> fields = arrays.exchanged(kMigrates);
    fields.push_back({rows, leaving.words(), true});
    if (springs > 0) fields.push_back({atBoundaries, springs, true});
    return fields;
  };
  {
    base::Array<float> out = boundaries.exportSprings(arrays.fields(), exchange.exportSlots(), exchange.exportCount());
    exchange.start(withRows(leaving.data, out.data()));
  }
  const Subdomain::Staying staying = subdomain_.staying();
  arrays.move(staying.from, staying.to, staying.moves);
  const std::size_t owned = staying.kept + exchange.importCount();
  arrays.resizeKeeping(std::max(arrays.slots(), owned));
  exchange.setImportSlots(staying.kept);
  // The field boundaryOf arrives with values of another rank's list: set the indices after the local ones.
  float* const room = boundaries.makeRoomForSprings(exchange.importCount());
  exchange.finish(withRows(arrivedRows_.data(), room));
  boundaries.numberArrived(arrays.fields(), staying.kept, exchange.importCount());
}

void GrainDistribution::noteOrigins(std::uint32_t owned, std::uint32_t former, GrainArrays& arrays) {
  const Subdomain::Staying staying = subdomain_.staying();
  arrays.fields().rowOrigin.width = 1;
  base::Array<std::uint32_t>& origin = arrays.fields().rowOrigin.now;
  origin.resize(arrays.slots());
  base::forEach(exec_, "note origins", static_cast<std::int64_t>(arrays.slots()),
                NoteOrigins{static_cast<std::uint32_t>(staying.kept), owned, former, origin.data()});
  base::forEach(exec_, "note origins of the moved", static_cast<std::int64_t>(staying.moves),
                NoteMovedOrigins{staying.from, staying.to, former, origin.data()});
}

const contact::RowOrigins* GrainDistribution::sorted(const std::uint32_t* order, GrainArrays& arrays) {
  subdomain_.sorted(order, arrays.slots());
  origins_.origin = arrays.fields().rowOrigin.now.data(), origins_.ghost = subdomain_.ghostMarks();
  return &origins_;
}

void GrainDistribution::packGhosts(const base::Exec& exec, GrainArrays& arrays) {
  subdomain_.haloExchange().pack(exec, arrays.exchanged(kUpdated, true));
}

void GrainDistribution::sendGhosts() { subdomain_.haloExchange().send(); }

void GrainDistribution::finishGhostUpdate(const base::Exec& exec, GrainArrays& arrays) {
  if (!subdomain_.haloExchange().underWay()) return;
  subdomain_.haloExchange().arrive();
  subdomain_.haloExchange().unpack(exec, arrays.exchanged(kUpdated));
}

void GrainDistribution::updateGhosts(GrainArrays& arrays) { subdomain_.haloExchange().run(arrays.exchanged(kUpdated)); }

/// Moves the cuts if the busiest rank exceeds the mean by kImbalance. Busy time is the wall time since the last check,
/// minus waiting for other ranks and minus replicated work. Measured times differ between runs, and so do the cuts; the
/// results are bitwise identical.
void GrainDistribution::rebalance(const GrainArrays& arrays, std::int64_t step) {
  const base::Comm& comm = subdomain_.comm();
  const Clock::time_point now = Clock::now();
  if (step < balancedAt_ + kBalanceEvery) return;
  const double waited = subdomain_.waited();
  const double busy =
      std::chrono::duration<double>(now - measuredFrom_).count() - (waited - waitedBefore_) - replicatedSeconds_;
  std::int64_t mine = std::max<std::int64_t>(1, static_cast<std::int64_t>(1e9 * busy));
  const auto most = static_cast<std::int64_t>(comm.maximumOf(static_cast<std::uint64_t>(mine)));
  const std::int64_t all = comm.sumOf(mine);
  if (static_cast<double>(most) * comm.size() > kImbalance * static_cast<double>(all)) {
    const auto own = static_cast<double>(std::max<std::size_t>(1, arrays.slots() - subdomain_.ghosts()));
    setPartition(
        subdomain_.balanced(arrays.fields().position.now.data(), arrays.slots(), static_cast<double>(mine) / own));
    ++rebalancings_;
  }
  balancedAt_ = step, measuredFrom_ = now, waitedBefore_ = subdomain_.waited(), replicatedSeconds_ = 0;
}

} // namespace grouser::terrain
