// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/peer_reduction.hpp"
#include "base/period.hpp"
#include "contact/exchange.hpp"
#include "contact/partition.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::contact {

/// Role of an element in a subdomain that has a copy of it.
enum class Role : std::uint32_t {
  unique, ///< needed by no other subdomain; integrated here. Kernels require the value 0
  master, ///< centre is here, within range of a border; integrated here, copied to others as slaves
  slave,  ///< copy of a master of another subdomain (ghost): it exerts forces and is not integrated
};

/// Options of the domain decomposition.
struct PartitionOptions {
  base::Comm comm;                         ///< single rank: one subdomain, other options ignored
  std::array<int, 3> subdomains{0, 0, 0};  ///< requested along x, y, z; 0: automatic
  std::array<std::vector<double>, 3> cuts; ///< [m] initial planes across x, y, z; empty: automatic
  bool rebalance = true;                   ///< moves the cuts when one rank has clearly more work than another
  base::PeerUse peers = base::PeerUse::automatic;
};

/// Initial partition: equal numbers of elements in all slabs of an axis. Throws InputError if `options.cuts` and
/// `options.subdomains` disagree.
Partition startingPartition(const std::vector<base::Position>& position, const PartitionOptions& options,
                            const base::PositionScale& scale);

/// Subdomain of one rank: its own elements (grains, fluid particles), those required by other ranks, and its ghosts.
/// Uses slots and positions only; the caller of an exchange specifies the other fields.
class Subdomain {
public:
  /// `range` [units]: elements farther apart than this cannot touch before the next rebuild.
  Subdomain(const base::Exec& exec, const PartitionOptions& options, std::int64_t range,
            const base::Period& period = {});

  const base::Comm& comm() const { return comm_; }
  const Partition& partition() const { return partition_; }
  void setPartition(const Partition& partition) { partition_ = partition; }

  /// Finds the elements that are now in another subdomain: sets destination(), staying() and the plan of
  /// migration().
  void findLeaving(const base::Position* position, std::size_t slots);
  /// New rank of the element in each slot, or kNobody for a slave; valid until the next migration.
  static constexpr std::uint32_t kNobody = ~0u;
  const std::uint32_t* destination() const { return destination_.data(); }
  /// Compaction: staying elements beyond the first `kept` slots move from slot from[k] to slot to[k] (device arrays), k
  /// < moves, replacing leaving elements and ghosts.
  struct Staying {
    std::size_t kept, moves;
    const std::uint32_t *from, *to;
  };
  Staying staying() const { return {kept_, movesFrom_.size(), movesFrom_.data(), movesTo_.data()}; }
  Exchange& migration() { return migration_; }

  /// Finds the masters among the first `owned` elements: sets the plan of haloExchange(). The ghosts() ghosts occupy
  /// the slots after the owned ones.
  void findMasters(const base::Position* position, std::size_t owned);
  std::size_t ghosts() const { return haloExchange_.importCount(); }
  Exchange& haloExchange() { return haloExchange_; }
  base::PeerReduction& agreement() { return reduction_; }
  /// True if the GPUs of all ranks can step without their hosts: halo data and flags use peer memory.
  bool stepsTogether() const { return reduction_.possible() && haloExchange_.peersOnly(); }

  /// Updates slots after a sort: slot i now holds the element of slot order[i].
  void sorted(const std::uint32_t* order, std::size_t slots);
  /// Registers appended elements, which belong to this rank until the next migration.
  void appended(std::size_t count);
  /// Resets the roles after loading: the slots contain owned elements only.
  void forgetRoles() { haveRoles_ = false; }
  const std::uint32_t* ghostMarks() const { return ghostMark_.data(); }  ///< nonzero for slaves
  const std::uint32_t* roles() const { return role_.data(); }            ///< Role per slot
  const base::Array<std::uint32_t>& uniques() const { return uniques_; } ///< slots, ascending; on a CPU
  const base::Array<std::uint32_t>& masters() const { return masters_; }

  /// Returns the cuts that balance the load, if each element of this rank costs `costEach` (any unit).
  Partition balanced(const base::Position* position, std::size_t slots, double costEach) const;
  std::size_t bytes() const;
  /// Time that this rank or its GPU has waited for other ranks since the start [s]. Waits for queued GPU work.
  double waited() const { return comm_.waited() + reduction_.waited(); }
  /// Communication method between ranks, for messages to the user.
  const char* way() const;
  std::int64_t bytesSent() const { return migration_.bytesSent() + haloExchange_.bytesSent(); }

private:
  base::Exec exec_;
  base::Comm comm_;
  std::int64_t range_;
  base::Period period_;
  Partition partition_;
  Exchange migration_, haloExchange_;
  base::PeerReduction reduction_;
  bool haveRoles_{false};
  std::size_t kept_{0};
  base::Array<std::uint32_t> role_, ghostMark_, destination_, movesFrom_, movesTo_, uniques_, masters_;
};

} // namespace grouser::contact
