// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "base/hash.hpp"
#include "base/position.hpp"
#include "terrain/grain_records.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Fields of a scene's grains.
struct GrainLayout {
  std::int64_t ledger{};     ///< 1: energy accounting
  std::int64_t boundaries{}; ///< planes and floor together
  std::int64_t friction{};   ///< 1: contacts have springs
  std::int64_t rolling{};    ///< 1: contacts have rolling angles too
  std::int64_t radii{};      ///< 1: each grain has its own
  std::int64_t materials{};  ///< of the grains; 0: one
  std::int64_t periodic{};   ///< 1: some boundaries are periodic
  std::int64_t fixed{};      ///< 1: some grains are fixed
  std::int64_t plastic{};    ///< 1: contacts have a plastic state
  std::int64_t places{};     ///< contacts that a grain may have with the floor, where several; normals tell them apart
  bool operator==(const GrainLayout&) const = default;
  /// Numbers of history of a contact: contact::historyWidth().
  std::int64_t historyWidth() const { return 3 * (friction + rolling) + 2 * plastic; }
};

/// State of the grains that later steps or later output depend on, by id, for checkpoints and the hash. Independent of
/// slots, devices and list layouts. Lists are left out; they can be rebuilt. On several ranks each has some of the
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
  std::vector<float> radius;               ///< [rows] [m]; empty where all are alike
  std::vector<std::uint32_t> material;     ///< [rows]; empty where there is one
  std::vector<std::uint32_t> fixed;        ///< [rows] 1 for a grain that never moves; empty where all may
  std::vector<Crossings> crossings;        ///< [rows] of periodic boundaries; empty without them
  std::vector<std::uint32_t> wallBits;     ///< [rows] bit a wall or floor in touch; empty without them
  std::vector<base::Vec3f> wallShear;      ///< [rows][walls and floor] [m], zero out of touch; empty without friction
  std::vector<std::uint32_t> contacts;     ///< [rows] neighbours in touch
  std::vector<std::uint32_t> neighbour;    ///< ids of those, ascending for each grain, grain by grain
  std::vector<base::Vec3f> contactShear;   ///< [m], one a neighbour; empty without friction
  std::vector<base::Vec3f> wallRolling;    ///< as wallShear [rad]; empty without rolling friction
  std::vector<base::Vec3f> contactRolling; ///< as contactShear [rad]; empty without rolling friction
  std::vector<float> wallDeepest, wallOrigin;       ///< as wallShear [m], [N]: contact::BasicPlasticState; else empty
  std::vector<float> contactDeepest, contactOrigin; ///< as contactShear
  std::vector<base::Vec3f> floorNormal;             ///< [rows][places] of the last step, zero out of touch; else empty

  /// Energy accounting since the start (GrainEnergyAccounting), if there is a ledger; then, with complementarity
  /// contacts, the totals of their solver (ImpulseTotals).
  std::vector<std::int64_t> books;

  // When the neighbour list was built, so that a resumed run builds the next one at the same step.
  std::vector<base::Vec3<std::uint32_t>> travelled; ///< [rows] since then [units], as wrapping words
  double skin{};                                    ///< [-] share of the radius
  std::int64_t rebuilds{};

  std::size_t rows() const { return position.size(); }
  /// For the hash: the data that the next step depends on, grain by grain.
  std::vector<std::uint32_t> words() const;
  GrainState withoutRows() const;
  /// Removes grains and the contacts of others with them; `ids` ascend, and are of all ranks.
  void remove(const std::vector<std::uint32_t>& ids);

  // All columns but `id`, twice: in the order of the state hash and in that of files, neither of which may change.

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

  /// Under the names and in the order that they have in files: perGrain(name, column), columns of boundaries with
  /// several values a grain; then perContact(name, column). Those that the layout lacks are empty.
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

/// The grains of a scene on the host, by id, for output: all of them, or on several ranks this rank's block of ids.
struct GrainSnapshot {
  std::uint64_t first{}, total{};    ///< place of the first among them; grains present in the scene
  std::vector<std::uint32_t> id;     ///< ascending
  std::vector<base::Vec3d> position; ///< [m]
  std::vector<base::Vec3f> velocity; ///< [m/s]
  std::vector<base::Vec3f> spin;     ///< [rad/s]
  std::vector<float> radius;         ///< [m]; empty where all are the model's
  std::vector<std::uint32_t> fixed;  ///< 1 for grains that never move; empty where all may
  /// Resultant of all contact forces in the last step [N], those of rigid parts among them; of fixed grains 0; empty
  /// unless asked for.
  std::vector<base::Vec3f> contactForce;
};

/// Optional data of a snapshot.
struct SnapshotOptions {
  bool contactForces = false; ///< only after a step, and before restore() or stop()
};

/// Moves row k to rank `destination[k]`; the result is in the order of ids. All ranks call it.
GrainState redistribute(const base::Comm& comm, const GrainState& rows, const std::vector<int>& destination);
/// Hash over the words of all rows, as if one rank had them; rows lie in blocks of ids. All ranks call it.
base::StateHash hashOf(const GrainState& rows, const base::Comm& comm);
/// The rank of grain `id` of `total` if rows are distributed by id, in blocks: for files.
int blockOf(const base::Comm& comm, std::int64_t total, std::uint32_t id);
/// Place of a grain among those present, by id.
std::uint32_t placeAmong(const std::vector<std::uint32_t>& gone, std::uint32_t id);
/// Ids of `count` present grains, starting at place `first` among them.
std::vector<std::uint32_t> idsFrom(const std::vector<std::uint32_t>& gone, std::uint64_t first, std::size_t count);
/// First id of a rank's block; that of rank `size` is `total`.
std::uint64_t blockStart(const base::Comm& comm, std::int64_t total, int rank);

} // namespace grouser::terrain
