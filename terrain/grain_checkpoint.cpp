// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_checkpoint.hpp"

#include "base/error.hpp"
#include "terrain/grain_forces.hpp"
#include "terrain/row_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::terrain {

using base::Position;
using base::Vec3f;
using base::Vec3i;
using Words3 = base::Vec3<std::uint32_t>;

namespace {

Vec3f vectorAt(const std::vector<float>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// Contact history in device layout: spring, rolling angle and plastic state of each contact in sequence.
std::vector<float> historyOf(const std::vector<Vec3f>& shear, const std::vector<Vec3f>& rolling,
                             const std::vector<float>& deepest, const std::vector<float>& origin) {
  std::vector<float> history;
  for (std::size_t c = 0; c < shear.size(); ++c) {
    history.insert(history.end(), {shear[c].x, shear[c].y, shear[c].z});
    if (!rolling.empty()) history.insert(history.end(), {rolling[c].x, rolling[c].y, rolling[c].z});
    if (!deepest.empty()) history.insert(history.end(), {deepest[c], origin[c]});
  }
  return history;
}

Vec3i signedUnits(const Words3& travelled) {
  return {static_cast<std::int32_t>(travelled.x), static_cast<std::int32_t>(travelled.y),
          static_cast<std::int32_t>(travelled.z)};
}

/// Slots of the grains integrated by this rank, sorted by id.
std::vector<std::uint32_t> ownSlots(const GrainSystem& system) {
  constexpr std::uint32_t kElsewhere = ~std::uint32_t{0};
  const std::vector<std::uint32_t> id = system.arrays.fields().id.now.toHost(), ghost = system.ghostsOnHost();
  std::vector<std::uint32_t> slots, slotOf;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (ghost[i]) continue;
    if (id[i] >= slotOf.size()) slotOf.resize(std::max<std::size_t>(id[i] + std::size_t{1}, system.count), kElsewhere);
    slotOf[id[i]] = static_cast<std::uint32_t>(i);
  }
  for (const std::uint32_t slot : slotOf)
    if (slot != kElsewhere) slots.push_back(slot);
  return slots;
}

std::vector<int> blocksOf(const GrainSystem& system, const std::vector<std::uint32_t>& ids) {
  std::vector<int> block;
  for (const std::uint32_t id : ids)
    block.push_back(blockOf(system.comm, static_cast<std::int64_t>(system.present()), placeAmong(system.gone, id)));
  return block;
}

/// Calls visit(value) for the values of a field in these slots.
template <class T, class Visit>
void forSlots(const GrainField<T>& field, const std::vector<std::uint32_t>& slots, const Visit& visit) {
  const std::vector<T> values = field.now.toHost();
  for (const std::uint32_t i : slots) visit(values[i]);
}

/// Saves the fields that need no conversion.
void saveFields(const GrainArrays& arrays, const std::vector<std::uint32_t>& slots, GrainState& s) {
  arrays.forEach([&]<class T>(const GrainField<T>& field) {
    if (!field.savedAs || field.width == 0) return;
    forSlots(field, slots, [&](const T& value) { (s.*field.savedAs).push_back(value); });
  });
}

void saveMotion(const GrainFields& f, const std::vector<std::uint32_t>& slots, GrainState& s) {
  forSlots(f.motion, slots, [&](const Motion& m) {
    s.velocity.push_back(m.velocity.xyz()), s.spin.push_back(m.spin.xyz());
    if (s.layout.radii) s.radius.push_back(std::fabs(m.velocity.w));
    if (s.layout.fixed) s.fixed.push_back(isFixed(m.velocity));
    if (s.layout.materials) s.material.push_back(static_cast<std::uint32_t>(m.spin.w));
  });
}

/// Saves the displacements since the neighbours were listed; `s` has the positions.
void saveTravelled(const GrainSystem& system, const std::vector<std::uint32_t>& slots, GrainState& s) {
  s.travelled.resize(s.rows());
  if (system.rebuilds == 0) return;
  std::size_t k = 0;
  forSlots(system.arrays.fields().reference, slots, [&](const Words3& from) {
    const Position& p = s.position[k];
    s.travelled[k++] = {p.x - from.x, p.y - from.y, p.z - from.z};
  });
}

/// Springs of boundaries without contact are never read again.
void saveBoundarySprings(const GrainSystem& system, const std::vector<std::uint32_t>& slots, GrainState& s) {
  const std::size_t width = static_cast<std::size_t>(system.constants.historyWidth),
                    boundaries = static_cast<std::size_t>(system.constants.boundaryCount);
  if (width == 0 || boundaries == 0) return;
  const std::size_t row = system.boundaries.springsWidth(), places = static_cast<std::size_t>(s.layout.places);
  const std::size_t firstPlace = static_cast<std::size_t>(system.constants.wallCount);
  const std::vector<float> history = system.boundaries.springs().toHost();
  const std::vector<std::uint32_t> placeOf = system.arrays.fields().boundaryOf.now.toHost();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const std::size_t start = s.wallBits[k] ? (placeOf[slots[k]] - std::size_t{1}) * row : 0;
    for (std::size_t q = 0; q < places; ++q) {
      const bool held = s.wallBits[k] >> (firstPlace + q) & 1;
      s.floorNormal.push_back(held ? vectorAt(history, start + boundaries * width + 3 * q) : Vec3f{});
    }
    for (std::size_t b = 0; b < boundaries; ++b) {
      const bool held = s.wallBits[k] >> b & 1;
      const std::size_t at = start + b * width;
      s.wallShear.push_back(held ? vectorAt(history, at) : Vec3f{});
      if (s.layout.rolling) s.wallRolling.push_back(held ? vectorAt(history, at + 3) : Vec3f{});
      if (s.layout.plastic) {
        s.wallDeepest.push_back(held ? history[at + width - 2] : 0.0f);
        s.wallOrigin.push_back(held ? history[at + width - 1] : 0.0f);
      }
    }
  }
}

void saveContacts(const GrainSystem& system, const std::vector<std::uint32_t>& slots, GrainState& s) {
  s.contacts.resize(s.rows());
  if (system.rebuilds == 0) return;
  const auto width = static_cast<std::size_t>(system.constants.historyWidth);
  const std::vector<std::uint32_t> id = system.arrays.fields().id.now.toHost();
  const contact::NeighbourList::HostCopy lists = system.neighbours.toHost();
  for (std::size_t row = 0; row < slots.size(); ++row) {
    const std::uint32_t i = slots[row];
    for (std::uint32_t k = 0; k < lists.count[i]; ++k) {
      if (!lists.touched(i, k)) continue;
      const auto at = static_cast<std::size_t>(lists.at(i, k));
      s.neighbour.push_back(id[lists.slot[at]]);
      if (width > 0) s.contactShear.push_back(vectorAt(lists.history, at * width));
      if (s.layout.rolling) s.contactRolling.push_back(vectorAt(lists.history, at * width + 3));
      if (s.layout.plastic) {
        s.contactDeepest.push_back(lists.history[at * width + width - 2]);
        s.contactOrigin.push_back(lists.history[at * width + width - 1]);
      }
      ++s.contacts[row];
    }
  }
}

/// Snapshot values of each grain, as rows sent to the rank with their block of ids.
struct SnapshotRows {
  bool manyRadii{}, someFixed{}, contactForces{};
  std::vector<std::uint32_t> id;
  std::vector<Position> position;
  std::vector<Vec3f> velocity, spin;
  std::vector<float> radius;
  std::vector<std::uint32_t> fixed;
  std::vector<Vec3f> contactForce;

  SnapshotRows withoutRows() const {
    SnapshotRows out;
    out.manyRadii = manyRadii, out.someFixed = someFixed, out.contactForces = contactForces;
    return out;
  }
  template <class Self, class Visitor> static void visitRow(Self& s, Visitor& visitor) {
    visitor.column(s.position), visitor.column(s.velocity), visitor.column(s.spin);
    if (s.manyRadii) visitor.column(s.radius);
    if (s.someFixed) visitor.column(s.fixed);
    if (s.contactForces) visitor.column(s.contactForce);
  }
};

} // namespace

GrainState GrainCheckpoint::state(const GrainSystem& system) {
  const std::vector<std::uint32_t> slots = ownSlots(system);
  GrainState s;
  s.layout = system.constants.layout();
  s.total = static_cast<std::int64_t>(system.present()), s.gone = system.gone;
  s.skin = system.constants.model.skin, s.rebuilds = system.rebuilds;
  s.ledgerSums = system.accounting.save(system.comm);
  if (system.impulses) {
    const std::vector<std::int64_t> words = system.impulses->totals().words();
    s.ledgerSums.insert(s.ledgerSums.end(), words.begin(), words.end());
  }
  saveFields(system.arrays, slots, s);
  saveMotion(system.arrays.fields(), slots, s);
  saveTravelled(system, slots, s);
  saveBoundarySprings(system, slots, s);
  saveContacts(system, slots, s);
  return system.comm.alone() ? s : redistribute(system.comm, s, blocksOf(system, s.id));
}

void GrainCheckpoint::readPositions(const GrainSystem& system, double* xyz) {
  forSlots(system.arrays.fields().position, ownSlots(system), [&](const Position& p) {
    const Vec3d metres = system.constants.scale.toMetres(p);
    *xyz++ = metres.x, *xyz++ = metres.y, *xyz++ = metres.z;
  });
}

GrainSnapshot GrainCheckpoint::snapshot(const GrainSystem& system, const SnapshotOptions& options) {
  const GrainFields& f = system.arrays.fields();
  const std::vector<std::uint32_t> slots = ownSlots(system);
  SnapshotRows rows;
  rows.manyRadii = system.constants.manyRadii(), rows.someFixed = system.constants.has(kFixed);
  rows.contactForces = options.contactForces;
  forSlots(f.id, slots, [&](std::uint32_t id) { rows.id.push_back(id); });
  forSlots(f.position, slots, [&](const Position& p) { rows.position.push_back(p); });
  forSlots(f.motion, slots, [&](const Motion& m) {
    rows.velocity.push_back(m.velocity.xyz()), rows.spin.push_back(m.spin.xyz());
    if (rows.manyRadii) rows.radius.push_back(std::fabs(m.velocity.w));
    if (rows.someFixed) rows.fixed.push_back(isFixed(m.velocity));
  });
  if (options.contactForces) {
    const std::vector<Vec3f> force = contactForces(system);
    for (const std::uint32_t i : slots) rows.contactForce.push_back(force[i]);
  }
  const base::Comm& comm = system.comm;
  if (!comm.alone()) rows = redistributeRows(comm, rows, blocksOf(system, rows.id));
  GrainSnapshot out;
  out.total = system.present(), out.id = rows.id;
  out.first = blockStart(comm, static_cast<std::int64_t>(out.total), comm.rank());
  for (const Position& p : rows.position) out.position.push_back(system.constants.scale.toMetres(p));
  out.velocity = rows.velocity, out.spin = rows.spin, out.radius = rows.radius;
  out.fixed = rows.fixed, out.contactForce = rows.contactForce;
  return out;
}

GrainCheckpoint::GrainCheckpoint(const GrainState& saved, const GrainSystem& system, bool grows)
    : asThen_(saved.rebuilds > 0 && saved.skin == system.constants.model.skin) {
  const auto count = static_cast<std::int64_t>(system.count);
  const std::int64_t given = saved.total + static_cast<std::int64_t>(saved.gone.size());
  if (given < count || (given > count && !grows) || saved.layout != system.constants.layout())
    throw base::InputError(fmt::format("the checkpoint belongs to another scene ({} grains, this scene has {}); "
                                       "resume with the scene that was run",
                                       given, count));
  std::vector<int> owner;
  for (std::size_t k = 0; k < saved.rows(); ++k) owner.push_back(system.ownerOf(placeAtList(saved, k)));
  own_ = redistribute(system.comm, saved, owner);
}

Position GrainCheckpoint::placeAtList(const GrainState& s, std::size_t k) const {
  return asThen_ ? base::fromUnits(base::toUnits(s.position[k]) - signedUnits(s.travelled[k]).as<std::int64_t>())
                 : s.position[k];
}

void GrainCheckpoint::loadAsListed(GrainSystem& system) const {
  system.finishGhostUpdate(); // otherwise it would overwrite loaded grains with the former ghosts
  system.count = static_cast<std::size_t>(own_.total) + own_.gone.size(), system.gone = own_.gone;
  system.fixedCount =
      static_cast<std::size_t>(system.comm.sumOf(std::count(own_.fixed.begin(), own_.fixed.end(), std::uint32_t{1})));
  system.arrays.setSlots(own_.rows());
  GrainFields& f = system.arrays.fields();
  system.arrays.forEach([&]<class T>(GrainField<T>& field) {
    if (field.savedAs && field.width > 0) field.now.assign(own_.*field.savedAs);
  });
  std::vector<Position> position(own_.rows());
  std::vector<Motion> motion(own_.rows());
  for (std::size_t k = 0; k < own_.rows(); ++k) {
    position[k] = placeAtList(own_, k);
    const Vec3f &v = own_.velocity[k], &w = own_.spin[k];
    const float radius = own_.radius.empty() ? 0.0f : own_.radius[k];
    motion[k].velocity = {v.x, v.y, v.z,
                          system.constants.storedRadius(radius, !own_.fixed.empty() && own_.fixed[k] != 0)};
    motion[k].spin = {w.x, w.y, w.z, own_.material.empty() ? 0.0f : static_cast<float>(own_.material[k])};
  }
  f.position.now.assign(position), f.motion.now.assign(motion);
  loadBoundarySprings(system);
  if (system.distribution) system.distribution->subdomain().forgetRoles();
  system.neighbours.forget();
  std::vector<std::int64_t> sums = own_.ledgerSums;
  // A state of penalty contacts has no solver totals.
  if (system.impulses && sums.size() == system.accounting.words() + ImpulseTotals::kWords) {
    system.impulses->setTotals(sums.data() + sums.size() - ImpulseTotals::kWords);
    sums.resize(sums.size() - ImpulseTotals::kWords);
  }
  system.accounting.restore(sums, system.comm);
}

/// Assigns storage for the springs of grains in contact, for the next list of grains near boundaries.
void GrainCheckpoint::loadBoundarySprings(GrainSystem& system) const {
  if (!system.boundaries.any()) return;
  const std::vector<float> all = historyOf(own_.wallShear, own_.wallRolling, own_.wallDeepest, own_.wallOrigin);
  const auto places = static_cast<std::size_t>(own_.layout.places);
  const std::size_t width = system.boundaries.springsWidth() - 3 * places;
  std::vector<float> springs;
  std::vector<std::uint32_t> placeOf(own_.rows());
  std::uint32_t rows = 0;
  for (std::size_t k = 0; k < own_.rows(); ++k) {
    if (own_.wallBits[k] == 0) continue;
    placeOf[k] = ++rows;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(k * width);
    springs.insert(springs.end(), first, first + static_cast<std::ptrdiff_t>(width));
    for (std::size_t q = 0; q < places; ++q) {
      const Vec3f& n = own_.floorNormal[k * places + q];
      springs.insert(springs.end(), {n.x, n.y, n.z});
    }
  }
  system.arrays.fields().boundaryOf.now.assign(placeOf);
  system.boundaries.setSprings(springs);
}

bool GrainCheckpoint::loadAsSaved(GrainSystem& system) const {
  const std::vector<std::uint32_t> id = system.arrays.fields().id.now.toHost();
  const bool beyond = loadPlaces(system, id);
  if (system.distribution) system.distribution->updateGhosts(system.arrays);
  const bool listHasEnded = asThen_ && system.comm.maximumOf(beyond ? 1 : 0) > 0;
  loadContacts(system, id);
  system.rebuilds = own_.rebuilds;
  return !listHasEnded && own_.rebuilds > 0; // at 0 the saved run had not built a list yet
}

/// Row of a grain; rows() for a ghost.
std::size_t GrainCheckpoint::rowOf(std::uint32_t id) const {
  const auto row = std::lower_bound(own_.id.begin(), own_.id.end(), id);
  return row != own_.id.end() && *row == id ? static_cast<std::size_t>(row - own_.id.begin()) : own_.rows();
}

/// True if a grain has moved more than half the skin since it was listed.
bool GrainCheckpoint::loadPlaces(GrainSystem& system, const std::vector<std::uint32_t>& id) const {
  base::Array<Position>& array = system.arrays.fields().position.now;
  std::vector<Position> position = array.toHost();
  bool beyond = false;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const std::size_t k = rowOf(id[i]);
    if (k == own_.rows()) continue;
    position[i] = own_.position[k];
    beyond = beyond || base::squaredNorm(signedUnits(own_.travelled[k])) > system.constants.halfSkinUnits2();
  }
  array.assign(position);
  return beyond;
}

void GrainCheckpoint::loadContacts(GrainSystem& system, const std::vector<std::uint32_t>& id) const {
  std::vector<std::size_t> first(own_.rows() + 1);
  for (std::size_t g = 0; g < own_.rows(); ++g) first[g + 1] = first[g] + own_.contacts[g];
  contact::NeighbourList::HostCopy lists = system.neighbours.toHost();
  const std::vector<float> history =
      historyOf(own_.contactShear, own_.contactRolling, own_.contactDeepest, own_.contactOrigin);
  const auto width = static_cast<std::size_t>(system.constants.historyWidth),
             words = static_cast<std::size_t>(lists.maskWords);
  std::fill(lists.touching.begin(), lists.touching.end(), 0);
  const std::vector<std::uint32_t> ghost = system.ghostsOnHost();
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (ghost[i]) continue;
    // Both lists ascend in the neighbours' ids.
    const std::size_t row = rowOf(id[i]), end = first[row + 1];
    std::size_t c = first[row];
    for (std::uint32_t k = 0; k < lists.count[i] && c < end; ++k) {
      const auto at = static_cast<std::size_t>(lists.at(i, k));
      if (id[lists.slot[at]] != own_.neighbour[c]) continue;
      lists.touching[i * words + k / 64] |= std::uint64_t{1} << (k & 63u);
      std::copy_n(history.begin() + static_cast<std::ptrdiff_t>(c * width), width,
                  lists.history.begin() + static_cast<std::ptrdiff_t>(at * width));
      ++c;
    }
    if (c < end)
      throw base::InputError(fmt::format("run.skin = {:g} is too small for the contacts in the checkpoint, written "
                                         "with {:g}; raise it",
                                         system.constants.model.skin, own_.skin));
  }
  system.neighbours.setHistory(lists);
}

} // namespace grouser::terrain
