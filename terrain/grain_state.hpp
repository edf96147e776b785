// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/hash.hpp"
#include "base/position.hpp"
#include "terrain/grain_records.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Layout of a scene's grain fields.
struct GrainLayout {
  std::int64_t ledger{};     ///< 1: energy accounting
  std::int64_t boundaries{}; ///< planes and floor together
  std::int64_t friction{};   ///< 1: contacts have springs
  std::int64_t rolling{};    ///< 1: contacts also have rolling angles
  std::int64_t radii{};      ///< 1: each grain has its own radius
  std::int64_t materials{};  ///< number of materials; 0: one
  std::int64_t periodic{};   ///< 1: some boundaries are periodic
  std::int64_t fixed{};      ///< 1: some grains are fixed
  std::int64_t plastic{};    ///< 1: contacts have a plastic state
  std::int64_t places{};     ///< maximum floor contacts of a grain, if several, distinguished by their normals
  bool operator==(const GrainLayout&) const = default;
  /// History values per contact: contact::historyWidth().
  std::int64_t historyWidth() const { return 3 * (friction + rolling) + 2 * plastic; }
};

/// Grain state required by later steps or output, by id, for checkpoints and the hash. Independent of slots, devices
/// and list layouts. Lists are not included, since they can be rebuilt. On several ranks each rank has some of the
/// rows.
struct GrainState {
  GrainLayout layout;
  std::int64_t total{};                    ///< grains present in the scene
  std::vector<std::uint32_t> gone;         ///< ids of removed grains, ascending; the same on all ranks
  std::vector<std::uint32_t> id;           ///< [rows], ascending
  std::vector<base::Position> position;    ///< [rows]
  std::vector<base::Vec3f> velocity;       ///< [rows] [m/s]
  std::vector<base::Vec3f> spin;           ///< [rows] [rad/s]
  std::vector<Remainders> remainders;      ///< [rows]
  std::vector<float> radius;               ///< [rows] [m]; empty if all are equal
  std::vector<std::uint32_t> material;     ///< [rows]; empty for a single material
  std::vector<std::uint32_t> fixed;        ///< [rows] 1 for a fixed grain; empty if none is fixed
  std::vector<Crossings> crossings;        ///< [rows] crossings of periodic boundaries; empty without them
  std::vector<std::uint32_t> wallBits;     ///< [rows] bit mask of walls and floor in contact; empty without them
  std::vector<base::Vec3f> wallShear;      ///< [rows][walls and floor] [m], 0 without contact; empty without friction
  std::vector<std::uint32_t> contacts;     ///< [rows] number of neighbours in contact
  std::vector<std::uint32_t> neighbour;    ///< their ids, ascending for each grain, grain by grain
  std::vector<base::Vec3f> contactShear;   ///< [m], one per neighbour in contact; empty without friction
  std::vector<base::Vec3f> wallRolling;    ///< as wallShear [rad]; empty without rolling friction
  std::vector<base::Vec3f> contactRolling; ///< as contactShear [rad]; empty without rolling friction
  std::vector<float> wallDeepest, wallOrigin;       ///< as wallShear [m], [N]: contact::BasicPlasticState; else empty
  std::vector<float> contactDeepest, contactOrigin; ///< as contactShear
  std::vector<base::Vec3f> floorNormal;             ///< [rows][floor contacts] of the last step, 0 without contact

  /// Energy accounting since the start (GrainEnergyAccounting), if there is a ledger; with complementarity contacts
  /// followed by the totals of their solver (ImpulseTotals).
  std::vector<std::int64_t> ledgerSums;

  // State at the last neighbour list, so that a resumed run builds the next list at the same step.
  std::vector<base::Vec3<std::uint32_t>> travelled; ///< [rows] displacement since then [units], as wrapping words
  double skin{};                                    ///< [-] skin / radius
  std::int64_t rebuilds{};

  std::size_t rows() const { return position.size(); }
  /// Words of the state hash: the data that the next step depends on, grain by grain.
  std::vector<std::uint32_t> words() const;
  GrainState withoutRows() const;
  /// Removes grains and the contacts of others with them; `ids` must be ascending, from all ranks.
  void remove(const std::vector<std::uint32_t>& ids);

  // All columns except `id`, twice: in the order of the state hash and in the order of files; neither may change.

  /// Visits the columns of the layout in the order of a row's words in the state hash; see row_exchange.hpp for the
  /// visitor.
  template <class Self, class Visitor> static void visitRow(Self& s, Visitor& visitor) {
    const GrainLayout& l = s.layout;
    visitor.column(s.position), visitor.column(s.velocity), visitor.column(s.spin), visitor.column(s.remainders);
    visitor.contacts(s.contacts, &s.neighbour, l.friction ? &s.contactShear : nullptr,
                     l.rolling ? &s.contactRolling : nullptr, l.plastic ? &s.contactDeepest : nullptr,
                     l.plastic ? &s.contactOrigin : nullptr);
    if (l.radii) visitor.column(s.radius);
    if (l.materials) visitor.column(s.material);
    if (l.fixed) visitor.column(s.fixed);
    if (l.boundaries)
      visitor.boundaries(s.wallBits, static_cast<std::size_t>(l.boundaries), l.friction ? &s.wallShear : nullptr,
                         l.rolling ? &s.wallRolling : nullptr, l.plastic ? &s.wallDeepest : nullptr,
                         l.plastic ? &s.wallOrigin : nullptr);
    if (l.places) visitor.several(s.floorNormal, static_cast<std::size_t>(l.places));
    visitor.unhashed(s.travelled);
    if (l.periodic) visitor.unhashed(s.crossings);
  }

  /// Visits the columns with their names and order in files: perGrain(name, column), with several values per grain for
  /// boundaries, then perContact(name, column). Columns absent from the layout are empty.
  template <class Self, class PerGrain, class PerContact>
  static void visitColumns(Self& s, const PerGrain& perGrain, const PerContact& perContact) {
    perGrain("position", s.position), perGrain("velocity", s.velocity), perGrain("spin", s.spin);
    perGrain("remainders", s.remainders), perGrain("radius", s.radius), perGrain("material", s.material);
    perGrain("fixed", s.fixed), perGrain("crossings", s.crossings);
    perGrain("wall_bits", s.wallBits), perGrain("wall_shear", s.wallShear), perGrain("wall_rolling", s.wallRolling);
    perGrain("wall_deepest", s.wallDeepest), perGrain("wall_origin", s.wallOrigin);
    perGrain("floor_normal", s.floorNormal);
    perGrain("contacts", s.contacts), perGrain("travelled", s.travelled);
    perContact("neighbour", s.neighbour), perContact("contact_shear", s.contactShear);
    perContact("contact_rolling", s.contactRolling);
    perContact("contact_deepest", s.contactDeepest), perContact("contact_origin", s.contactOrigin);
  }
};

/// Host copy of the grains of a scene, by id, for output: all grains, or on several ranks this rank's block of ids.
struct GrainSnapshot {
  std::uint64_t first{}, total{};    ///< index of the first grain among all present; number of grains present
  std::vector<std::uint32_t> id;     ///< ascending
  std::vector<base::Vec3d> position; ///< [m]
  std::vector<base::Vec3f> velocity; ///< [m/s]
  std::vector<base::Vec3f> spin;     ///< [rad/s]
  std::vector<float> radius;         ///< [m]; empty if all equal the model's radius
  std::vector<std::uint32_t> fixed;  ///< 1 for fixed grains; empty if none is fixed
  /// Resultant contact force in the last step [N], including rigid parts; 0 for fixed grains; empty unless requested.
  /// Ordered like `id`.
  std::vector<base::Vec3f> contactForce;
};

/// Optional data of a snapshot.
struct SnapshotOptions {
  bool contactForces = false; ///< valid only after a step, and before restore() or stop()
};

/// Moves row k to rank `destination[k]`; the result is sorted by id. Collective.
GrainState redistribute(const base::Comm& comm, const GrainState& rows, const std::vector<int>& destination);
/// Hash over the words of all rows, independent of the number of ranks; rows must be in blocks of ids. Collective.
base::StateHash hashOf(const GrainState& rows, const base::Comm& comm);
/// Rank of grain `id` of `total` for rows distributed in blocks of ids, as in files.
int blockOf(const base::Comm& comm, std::int64_t total, std::uint32_t id);
/// Index of a grain among those present, by id.
std::uint32_t placeAmong(const std::vector<std::uint32_t>& gone, std::uint32_t id);
/// Returns the ids of `count` present grains, starting with the one at index `first`.
std::vector<std::uint32_t> idsFrom(const std::vector<std::uint32_t>& gone, std::uint64_t first, std::size_t count);
/// First id of a rank's block; `total` for rank = number of ranks.
std::uint64_t blockStart(const base::Comm& comm, std::int64_t total, int rank);

} // namespace grouser::terrain
