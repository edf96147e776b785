// SPDX-License-Identifier: BSD-3-Clause
#include "contact/grain_part_contacts.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/for_each_group.cuh"
#include "contact/grain_part_kernel.cuh"
#include "contact/part_patches.cuh"
#include "contact/strongest_force.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::contact {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

/// Squared distance from a point to a box, in the box frame.
GROUSER_HD double distance2ToBox(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double out = p[a] < low[a] ? low[a] - p[a] : p[a] > high[a] ? p[a] - high[a] : 0.0;
    sum += out * out;
  }
  return sum;
}

/// Counts (if `key` is null) or lists the parts near one grain.
struct ListParts {
  static constexpr double kNanoseconds = 60;
  base::PositionScale scale;
  const Position* position;
  const std::uint32_t *id, *ghost;
  const PartMotion* motion;
  const GrainPart* parts;
  int partCount;
  double reach;
  Vec3d low, high; ///< world box around all parts, enlarged by their reach
  std::uint32_t *count, *first;
  std::uint64_t* key;
  std::uint32_t* slot;

  GROUSER_HD void operator()(int i) const {
    const Vec3d x = scale.toMetres(position[i]);
    std::uint32_t found = 0;
    const bool knownToHaveNone = key && count[i] == 0;
    if (!knownToHaveNone && !(ghost && ghost[i]) && distance2ToBox(x, low, high) == 0) {
      for (int p = 0; p < partCount; ++p) {
        if (distance2ToBox(motion[p].toPart(x), parts[p].boxLow, parts[p].boxHigh) > reach * reach) continue;
        if (key) {
          key[first[i] + found] = static_cast<std::uint64_t>(id[i]) << 16 | static_cast<std::uint64_t>(p);
          slot[first[i] + found] = static_cast<std::uint32_t>(i);
        }
        ++found;
      }
    }
    if (!key)
      count[i] = found;
    else
      first[i] = found == 0 ? 0 : first[i] << 8 | found;
  }
};

/// Finds each pair in the sorted keys of the previous list and copies its history.
struct RestorePatches {
  static constexpr double kNanoseconds = 30;
  const std::uint64_t *key, *oldKey;
  const std::uint32_t* oldIndex;
  std::int64_t oldCount;
  const PatchMemory* old;
  PatchMemory* memory;
  const Vec3f* oldAngle;
  Vec3f* angle; ///< null without rolling friction
  const float* oldDent;
  float* dent; ///< null if no grain crushes
  GROUSER_HD void operator()(int e) const {
    std::int64_t low = 0, high = oldCount;
    while (low < high) {
      const std::int64_t middle = (low + high) / 2;
      if (oldKey[middle] < key[e])
        low = middle + 1;
      else
        high = middle;
    }
    const bool found = low < oldCount && oldKey[low] == key[e];
    for (int k = 0; k < kPatches; ++k) {
      const std::int64_t from = found ? static_cast<std::int64_t>(oldIndex[low]) * kPatches + k : 0;
      memory[e * kPatches + k] = found ? old[from] : PatchMemory{};
      if (angle) angle[e * kPatches + k] = found ? oldAngle[from] : Vec3f{};
      if (dent) dent[e * kPatches + k] = found ? oldDent[from] : 0.0f;
    }
  }
};

/// Marks the pairs with a grain that moves to another rank.
struct FindDestination {
  const std::uint32_t *slot, *destination;
  std::uint32_t me;
  std::uint32_t* leaves;
  GROUSER_HD void operator()(int e) const { leaves[e] = destination[slot[e]] != me; }
};
struct ReadDestination {
  const std::uint32_t *pair, *slot, *destination;
  std::uint64_t* rank;
  GROUSER_HD void operator()(int k) const { rank[k] = destination[slot[pair[k]]]; }
};

struct Forget {
  const std::uint32_t* pair;
  PatchMemory* memory;
  GROUSER_HD void operator()(int k) const {
    for (int p = 0; p < kPatches; ++p) memory[static_cast<std::int64_t>(pair[k]) * kPatches + p] = PatchMemory{};
  }
};

std::vector<ContactLaw> scaled(const GrainPartMaterials& materials, const GrainPartModel& model) {
  std::vector<ContactLaw> laws;
  for (const ContactLaw& law : materials.laws) laws.push_back(scaledFor(law, model.radius));
  if (laws.empty()) laws.push_back(scaledFor(model.law, model.radius));
  return laws;
}

struct Box {
  Vec3d low, high;
};
Box boxOf(const base::SphereSet& set) {
  Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (const base::SetSphere& s : set.spheres) {
    const double r = s.radius + s.flat;
    box.low = base::min(box.low, s.centre - Vec3d{r, r, r}), box.high = base::max(box.high, s.centre + Vec3d{r, r, r});
  }
  return box;
}

} // namespace

GrainPartContacts::GrainPartContacts(const base::Exec& exec, const GrainPartModel& model,
                                     const std::vector<const base::SphereSet*>& sets, std::vector<GrainPart> parts,
                                     const base::Comm& comm, const GrainPartMaterials& materials)
    : exec_(exec), comm_(comm), model_(model), scaledLaws_(scaled(materials, model)), partCount_(parts.size()),
      rolling_(false), crushes_(materials.crush()), features_(0) {
  std::vector<BasicLaw<float>> laws;
  for (const ContactLaw& law : scaledLaws_) laws.push_back(law.as<float>());
  for (const BasicLaw<float>& law : laws) features_ |= law.features(), allHertz_ = allHertz_ && law.hertz;
  rolling_ = (features_ & kRollingFriction) != 0;
  searchFrom_ = model.searchFrom > 0 ? model.searchFrom : exec.onCpu() ? ~std::size_t{0} : 8192;
  laws_ = base::Array<BasicLaw<float>>(exec, laws);
  massPerCube_ = base::Array<double>(exec, materials.massPerCube);
  angle_ = base::Array<Vec3f>(exec), oldAngle_ = base::Array<Vec3f>(exec);
  dent_ = base::Array<float>(exec), oldDent_ = base::Array<float>(exec);
  energyHeld_ = base::Array<std::int64_t>(exec);
  std::vector<Crushing> crushing;
  for (std::size_t m = 0; crushes_ && m < materials.laws.size(); ++m)
    crushing.push_back(crushingOf(materials.crushing[m % materials.crushing.size()], materials.laws[m]));
  crushing_ = base::Array<Crushing>(exec, crushing);
  std::vector<bool> isMet(sets.size()); // only parts that grains can touch need a table
  for (const GrainPart& part : parts)
    if (part.meets && part.surface >= 0) isMet[static_cast<std::size_t>(part.surface)] = true;
  std::vector<SurfaceGridView> views;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const double edge = sets[s]->spacing > 0.006 ? 0.75 * sets[s]->spacing : 0.0045;
    grids_.push_back(isMet[s] && sets[s]->surfaceCount > 0 ? SurfaceGrid(exec, *sets[s], model.radius + model.gap, edge)
                                                           : SurfaceGrid());
    views.push_back(grids_.back().view());
  }
  for (GrainPart& part : parts) {
    auto [low, high] = part.surface < 0 ? Box{-halfExtent(part.shape), halfExtent(part.shape)}
                                        : boxOf(*sets[static_cast<std::size_t>(part.surface)]);
    constexpr double kFarAway = 1e100; // its square is finite
    if (!part.meets) low = high = {kFarAway, kFarAway, kFarAway};
    part.boxLow = low, part.boxHigh = high;
  }
  gridViews_ = base::Array<SurfaceGridView>(exec, views);
  parts_ = base::Array<GrainPart>(exec, parts);
  range_ = base::Array<std::uint32_t>(exec);
  count_ = base::Array<std::uint32_t>(exec);
  slot_ = base::Array<std::uint32_t>(exec);
  near_ = base::Array<std::uint32_t>(exec);
  oldIndex_ = base::Array<std::uint32_t>(exec);
  key_ = base::Array<std::uint64_t>(exec);
  oldKey_ = base::Array<std::uint64_t>(exec);
  memory_ = base::Array<PatchMemory>(exec);
  oldMemory_ = base::Array<PatchMemory>(exec);
  load_ = base::Array<GrainLoad>(exec);
  moments_ = base::Array<ContactMoment>(exec);
  sums_ = base::Array<std::int64_t>(exec, kPartSums);
  deepest_ = base::Array<std::uint64_t>(exec);
  resetDeepestOverlap();
}

/// History fields sent with a pair.
std::vector<ExchangeField> GrainPartContacts::history() {
  std::vector<ExchangeField> fields{{key_.data(), 2}, {memory_.data(), kPatches * sizeof(PatchMemory) / 4}};
  if (rolling_) fields.push_back({angle_.data(), kPatches * sizeof(Vec3f) / 4});
  if (crushes_) fields.push_back({dent_.data(), kPatches});
  return fields;
}

void GrainPartContacts::migrate(const std::uint32_t* destination) {
  if (held_ == Held::everywhere) return;
  // Second migration before a refresh: received pairs have no slots yet and cannot follow their grains. Every rank
  // therefore stores all pairs of the scene, as after a restore.
  if (held_ == Held::migrated) return restore(save());
  // Few pairs, and only at rebuilds: plain messages are fast enough.
  if (!exchange_) exchange_ = std::make_unique<Exchange>(exec_, comm_, ExchangeOptions{.peers = base::PeerUse::never});
  const auto n = static_cast<std::int64_t>(pairs_);
  base::Array<std::uint32_t> leaves(exec_, pairs_), leaving(exec_);
  base::forEach(exec_, "find pairs that leave", n,
                FindDestination{slot_.data(), destination, static_cast<std::uint32_t>(comm_.rank()), leaves.data()});
  base::listMarked(exec_, leaves.data(), pairs_, leaving);
  base::Array<std::uint64_t> ranks(exec_, leaving.size());
  base::forEach(exec_, "read destinations of pairs", static_cast<std::int64_t>(leaving.size()),
                ReadDestination{leaving.data(), slot_.data(), destination, ranks.data()});
  exchange_->setPlan(ranks, leaving, leaving.size());
  exchange_->start(history());
  // Sent pairs stay in the arrays until the next refresh, which finds no grain for them. Clear them, so that save()
  // skips them.
  base::forEach(exec_, "forget pairs that leave", static_cast<std::int64_t>(leaving.size()),
                Forget{exchange_->exportSlots(), memory_.data()});
  key_.resizeKeeping(pairs_ + exchange_->importCount());
  memory_.resizeKeeping(kPatches * key_.size());
  if (rolling_) angle_.resizeKeeping(kPatches * key_.size());
  if (crushes_) dent_.resizeKeeping(kPatches * key_.size());
  exchange_->setImportSlots(pairs_);
  exchange_->finish(history());
  pairs_ += exchange_->importCount();
  held_ = Held::migrated;
}

void GrainPartContacts::refresh(const GrainsView& grains, const base::Array<PartMotion>& motion) {
  // Sort the previous list by key; the history is copied from it.
  const std::size_t oldPairs = pairs_;
  key_.swap(oldKey_);
  memory_.swap(oldMemory_);
  angle_.swap(oldAngle_);
  dent_.swap(oldDent_);
  oldIndex_.resize(oldPairs);
  base::iota(exec_, oldIndex_.data(), oldPairs);
  base::sortByKey(exec_, oldKey_.data(), oldIndex_.data(), oldPairs);

  const auto n = static_cast<std::int64_t>(grains.count);
  range_.resize(grains.count);
  count_.resize(grains.count);
  ListParts list{model_.scale,
                 grains.position,
                 grains.id,
                 grains.ghost,
                 motion.data(),
                 parts_.data(),
                 static_cast<int>(partCount_),
                 model_.radius + model_.gap + model_.margin,
                 {1e300, 1e300, 1e300},
                 {-1e300, -1e300, -1e300},
                 count_.data(),
                 range_.data(),
                 nullptr,
                 nullptr};
  const std::vector<PartMotion> poses = motion.toHost();
  const std::vector<GrainPart> parts = parts_.toHost();
  for (std::size_t p = 0; p < partCount_; ++p)
    for (int corner = parts[p].meets ? 0 : 8; corner < 8; ++corner) {
      const Vec3d c{corner & 1 ? parts[p].boxHigh.x : parts[p].boxLow.x,
                    corner & 2 ? parts[p].boxHigh.y : parts[p].boxLow.y,
                    corner & 4 ? parts[p].boxHigh.z : parts[p].boxLow.z};
      const Vec3d w = poses[p].toWorld(c);
      list.low = base::min(list.low, w - Vec3d{list.reach, list.reach, list.reach});
      list.high = base::max(list.high, w + Vec3d{list.reach, list.reach, list.reach});
    }
  base::forEach(exec_, "count parts near grains", n, list);
  pairs_ = base::exclusiveScan(exec_, count_.data(), range_.data(), grains.count);
  if (pairs_ >= 1u << 24)
    throw base::SimulationError(std::to_string(pairs_) +
                                " pairs of grains and parts exceed the limit of 16,777,215; use more ranks");
  key_.resize(pairs_);
  slot_.resize(pairs_);
  memory_.resize(pairs_ * kPatches);
  if (rolling_) angle_.resize(pairs_ * kPatches);
  if (crushes_) dent_.resize(pairs_ * kPatches), energyHeld_.resize(pairs_);
  load_.resize(pairs_);
  near_.resize(pairs_ >= searchFrom_ ? kNearCount + pairs_ : 0);
  list.key = key_.data(), list.slot = slot_.data();
  base::forEach(exec_, "list parts near grains", n, list);
  base::forEach(exec_, "restore patch history", static_cast<std::int64_t>(pairs_),
                RestorePatches{key_.data(), oldKey_.data(), oldIndex_.data(), static_cast<std::int64_t>(oldPairs),
                               oldMemory_.data(), memory_.data(), oldAngle_.data(), rolling_ ? angle_.data() : nullptr,
                               oldDent_.data(), crushes_ ? dent_.data() : nullptr});
  held_ = Held::listed;
}

std::vector<std::int64_t> GrainPartContacts::allSums() const {
  std::vector<std::int64_t> sums = sums_.toHost();
  comm_.sum(sums.data(), sums.size());
  return sums;
}

void GrainPartContacts::computeOn(const base::Exec& exec, const GrainsView& grains,
                                  const base::Array<PartMotion>& motion, PartLoad* loads) {
  for (const base::Parcel& cleared : {clearedSums(), clearedCount()}) base::setZero(exec, cleared.to, cleared.bytes);
  computeOnCleared(exec, grains, motion, loads, nullptr);
}

base::Parcel GrainPartContacts::clearedCount() {
  return near_.empty() ? base::Parcel{} : base::Parcel{near_.data(), nullptr, kNearCount * sizeof(std::uint32_t)};
}

base::Parcel GrainPartContacts::clearedSums() { return {sums_.data(), nullptr, kSumsOfStep * sizeof(std::int64_t)}; }

template <unsigned kFeatures>
GrainPartForces<kFeatures> GrainPartContacts::forcesOf(const GrainsView& grains, const base::Array<PartMotion>& motion,
                                                       PartLoad* loads, const std::uint32_t* off) {
  return {model_,
          laws_.data(),
          massPerCube_.data(),
          grains,
          motion.data(),
          parts_.data(),
          gridViews_.data(),
          key_.data(),
          slot_.data(),
          memory_.data(),
          rolling_ ? angle_.data() : nullptr,
          crushes_ ? crushing_.data() : nullptr,
          crushes_ ? dent_.data() : nullptr,
          crushes_ ? energyHeld_.data() : nullptr,
          static_cast<int>(partCount_),
          load_.data(),
          loads,
          sums_.data(),
          deepest_.data(),
          off};
}

void GrainPartContacts::computeOnCleared(const base::Exec& exec, const GrainsView& grains,
                                         const base::Array<PartMotion>& motion, PartLoad* loads,
                                         const std::uint32_t* off) {
  const auto run = [&]<unsigned kFeatures>() {
    const auto forces = forcesOf<kFeatures>(grains, motion, loads, off);
    const auto pairs = static_cast<std::int64_t>(pairs_);
    if (near_.empty()) return base::forEachGroup<16>(exec, "grain-part contacts", pairs, forces);
    constexpr std::int64_t kGroups = 8192;
    std::uint32_t *const count = near_.data(), *const near = count + kNearCount;
    base::forEach(exec, "find grains near parts", pairs, FindNearPairs<kFeatures>{forces, near, count});
    const std::int64_t groups = std::min(pairs, kGroups);
    base::forEachGroup<16>(exec, "grain-part contacts", groups,
                           NearPairForces<kFeatures>{forces, near, count, static_cast<std::uint32_t>(groups)});
  };
  // Most beds are linear with friction, soils use Hertz's law; all others use the general functions.
  constexpr unsigned kSoil = kHertz | kFriction | kRollingFriction | kCohesion;
  if (allHertz_ && !(features_ & ~kSoil) && !crushes_)
    run.template operator()<kSoil>();
  else if ((features_ & ~kFriction) != 0 || crushes_)
    run.template operator()<kGeneral>();
  else if (model_.manyRadii)
    run.template operator()<kFriction | kManyMasses>();
  else
    run.template operator()<kFriction>();
}

PartPatches GrainPartContacts::patches(const GrainsView& grains, const base::Array<PartMotion>& motion,
                                       PartLoad* loads) {
  return {forcesOf<kGeneral>(grains, motion, loads, nullptr), range_.data(), static_cast<std::int64_t>(pairs_)};
}

PartMomentsView GrainPartContacts::measure(const GrainsView& grains, const base::Array<PartMotion>& motion) {
  moments_.resize(pairs_);
  base::forEach(exec_, "measure grain-part contacts", static_cast<std::int64_t>(pairs_),
                MeasurePairs{forcesOf<kGeneral | kMeasured>(grains, motion, nullptr, nullptr), moments_.data()});
  return {range_.data(), moments_.data()};
}

GrainLoadsView GrainPartContacts::grainLoads() {
  return {range_.data(), load_.data(),
          model_.force,  sums_.data() + kReceivedByGrains,
          slot_.data(),  static_cast<std::int64_t>(pairs_)};
}

GrainPartContacts::Ledger GrainPartContacts::ledger() const {
  const std::vector<std::int64_t> q = allSums();
  const auto energy = [&](std::size_t k) { return model_.energy.value(q[k]); };
  constexpr std::size_t kForce = kReceivedByGrains;
  return {q[kPatchesNow],
          q[kDeepOverlapsNow],
          energy(kElasticNow),
          energy(kDampedByParts),
          energy(kSlidingLossByParts),
          energy(kRolledByParts),
          energy(kSlippedByParts),
          energy(kCrushedByParts),
          model_.force.value({q[kCutByCrushing], 0, 0}).x * model_.timeStep,
          q[kCappedNow],
          model_.force.value({q[kForce], q[kForce + 1], q[kForce + 2]}) * model_.timeStep};
}

std::vector<std::uint32_t> GrainPartContacts::ended() const {
  std::vector<std::uint32_t> mine, all;
  if (crushes_ && held_ == Held::listed) {
    const std::vector<std::uint64_t> key = key_.toHost();
    const std::vector<GrainLoad> load = load_.toHost();
    for (std::size_t e = 0; e < pairs_; ++e)
      if (load[e].deepest < 0) mine.push_back(static_cast<std::uint32_t>(key[e] >> 16));
  }
  for (const std::vector<std::uint32_t>& rank : comm_.gatherAll(mine)) all.insert(all.end(), rank.begin(), rank.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void GrainPartContacts::takeOut(const std::vector<std::uint32_t>& ids) {
  const std::vector<std::uint64_t> key = key_.toHost();
  const std::vector<std::int64_t> held = energyHeld_.toHost();
  std::vector<std::uint32_t> theirs;
  std::vector<std::int64_t> sums = sums_.toHost();
  for (std::size_t e = 0; e < pairs_; ++e) {
    if (!std::binary_search(ids.begin(), ids.end(), static_cast<std::uint32_t>(key[e] >> 16))) continue;
    theirs.push_back(static_cast<std::uint32_t>(e));
    sums[kElasticNow] -= held[e], sums[kCrushedByParts] += held[e];
  }
  sums_.assign(sums);
  const base::Array<std::uint32_t> pairs(exec_, theirs);
  base::forEach(exec_, "forget grains taken out", static_cast<std::int64_t>(theirs.size()),
                Forget{pairs.data(), memory_.data()});
  restore(save()); // grains will move to other slots, and possibly ranks
}

void GrainPartContacts::resetDeepestOverlap() { deepest_.assign(std::vector<std::uint64_t>(partCount_, kNotPressed)); }

std::vector<std::uint64_t> GrainPartContacts::allDeepest() const {
  std::vector<std::uint64_t> deepest = deepest_.toHost();
  comm_.minimum(deepest.data(), deepest.size());
  return deepest;
}

std::optional<GrainPartContacts::MostPressed> GrainPartContacts::mostPressed() const {
  const std::vector<std::uint64_t> deepest = allDeepest();
  const auto most = std::min_element(deepest.begin(), deepest.end());
  if (most == deepest.end() || *most == kNotPressed) return {};
  return MostPressed{static_cast<int>(most - deepest.begin()), static_cast<std::uint32_t>(*most),
                     static_cast<double>(base::bitsAs<float>(static_cast<std::uint32_t>(~(*most >> 32))))};
}

std::vector<GrainPartContacts::Press> GrainPartContacts::pressing(std::uint32_t grain) const {
  std::vector<Press> found;
  if (held_ == Held::listed) {
    const std::vector<std::uint64_t> key = key_.toHost();
    const std::vector<GrainLoad> load = load_.toHost();
    for (std::size_t e = 0; e < pairs_; ++e)
      if (key[e] >> 16 == grain && load[e].deepest != 0)
        found.push_back({static_cast<int>(key[e] & 0xFFFFu), std::fabs(load[e].deepest)});
  }
  std::vector<Press> all;
  for (const std::vector<Press>& rank : comm_.gatherAll(found)) all.insert(all.end(), rank.begin(), rank.end());
  return all;
}

std::size_t GrainPartContacts::bytes() const {
  std::size_t total = range_.bytes() + count_.bytes() + slot_.bytes() + key_.bytes() + oldKey_.bytes() +
                      memory_.bytes() + oldMemory_.bytes() + angle_.bytes() + oldAngle_.bytes() + dent_.bytes() +
                      oldDent_.bytes() + load_.bytes() + near_.bytes();
  for (const SurfaceGrid& grid : grids_) total += grid.bytes();
  return total;
}

} // namespace grouser::contact
