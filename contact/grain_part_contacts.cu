// SPDX-License-Identifier: BSD-3-Clause
#include "contact/grain_part_contacts.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/for_each_group.cuh"
#include "contact/rolling_resistance.hpp"

namespace grouser::contact {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

constexpr float kSameNormal = 0.9f; // cosine: touches within 26 degrees are one patch
constexpr float kSameFace = 0.97f;  // cosine: discs of one face are one patch
constexpr float kSamePatch = 0.8f;  // cosine: a patch is the one it was in the step before

/// Squared distance from a point to a box, in the box' frame.
GROUSER_HD double distance2ToBox(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double out = p[a] < low[a] ? low[a] - p[a] : p[a] > high[a] ? p[a] - high[a] : 0.0;
    sum += out * out;
  }
  return sum;
}

/// Counts (where `key` is null) or lists the parts near one grain.
struct ListParts {
  base::PositionScale scale;
  const Position* position;
  const std::uint32_t *id, *ghost;
  const PartMotion* motion;
  const GrainPart* parts;
  int partCount;
  double reach;
  Vec3d low, high; ///< world box around all parts and their reach
  std::uint32_t *count, *first;
  std::uint64_t* key;
  std::uint32_t* slot;

  GROUSER_HD void operator()(int i) const {
    const Vec3d x = scale.toMetres(position[i]);
    std::uint32_t found = 0;
    if (!(ghost && ghost[i]) && distance2ToBox(x, low, high) == 0) {
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

/// Finds each pair in the sorted keys of the former list and takes its history.
struct CarryMemory {
  const std::uint64_t *key, *oldKey;
  const std::uint32_t* oldIndex;
  std::int64_t oldCount;
  const PatchMemory* old;
  PatchMemory* memory;
  const Vec3f* oldAngle;
  Vec3f* angle; ///< null without rolling friction
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
    }
  }
};

/// The rank that a pair follows its grain to; the own one for those that stay.
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

/// One patch while it is being made out.
struct Patch {
  Vec3f normal; ///< outward from the part, in its frame
  Vec3f face;   ///< plane normal of the disc that is deepest
  float overlap;
};

template <unsigned kFeatures> struct Compute {
  GrainPartModel model;
  const BasicLaw<float>* laws;
  const double* massPerCube;
  GrainPartContacts::GrainsView grains;
  const PartMotion* motion;
  const GrainPart* parts;
  const SurfaceGridView* grids;
  const std::uint64_t* key;
  const std::uint32_t* slot;
  PatchMemory* memory;
  Vec3f* angle; ///< null without rolling friction
  GrainLoad* load;
  PartLoad* partLoad;
  std::int64_t* sums;

  template <class Lanes> GROUSER_HD void operator()(int e, const Lanes& lanes) const {
    const int i = static_cast<int>(slot[e]);
    const int p = static_cast<int>(key[e] & 0xFFFFu);
    const PartMotion part = motion[p];
    const Vec3d x = model.scale.toMetres(grains.position[i]);
    const Vec3d c = part.toPart(x);
    const Ball ball = ballOf(i);
    Patch patches[kPatches];
    const int found = findPatches(grids[parts[p].surface], c, ball.radius, lanes, patches);
    if (lanes.lane != 0) return; // the rest is for one thread
    GrainLoad result{};
    PatchMemory fresh[kPatches] = {};
    Vec3f freshAngle[kPatches] = {};
    PatchMemory* held = memory + static_cast<std::int64_t>(e) * kPatches;
    Vec3f* heldAngle = angle ? angle + static_cast<std::int64_t>(e) * kPatches : nullptr;
    unsigned used = 0;
    base::Vec3l torqueOnPart{};
    double elastic = 0;
    for (int k = 0; k < found; ++k) {
      const int former = recall(held, patches[k].normal, used);
      fresh[k] = {patches[k].normal, former < 0 ? Vec3f{} : held[former].shear};
      if (angle && former >= 0) freshAngle[k] = heldAngle[former];
      apply(part, i, ball, x, patches[k], fresh[k].shear, freshAngle[k], result, torqueOnPart, elastic);
    }
    for (int k = 0; k < kPatches; ++k) {
      held[k] = fresh[k];
      if (angle) heldAngle[k] = freshAngle[k];
    }
    load[e] = result;
    if (found == 0) return;
    addTo(partLoad[p].force, -result.force);
    addTo(partLoad[p].torque, torqueOnPart);
    base::atomicAdd64(sums + 0, found);
    base::atomicAdd64(sums + 1, model.energy.quantise(elastic));
    base::atomicAdd64(sums + 2, model.energy.quantise(static_cast<double>(result.dissipated)));
  }

private:
  struct Ball {
    double radius, mass;
    int material;
  };
  GROUSER_HD Ball ballOf(int i) const {
    if (!model.manyRadii) return {model.radius, model.mass, 0};
    const int m = static_cast<int>(grains.spin[i].w);
    const double r = static_cast<double>(grains.velocity[i].w);
    return {r, massPerCube[m] * r * r * r, m};
  }

  GROUSER_HD static void addTo(base::Vec3l& target, const base::Vec3l& value) {
    base::atomicAdd64(&target.x, value.x);
    base::atomicAdd64(&target.y, value.y);
    base::atomicAdd64(&target.z, value.z);
  }

  /// The deepest touch first, then the deepest that belongs to none of the patches so far.
  template <class Lanes> GROUSER_HD int findPatches(const SurfaceGridView& grid, const Vec3d& c, double ballRadius,
                                                    const Lanes& lanes, Patch* patches) const {
    const std::int64_t cell = grid.cellAt(c);
    if (cell < 0) return 0;
    const float radius = static_cast<float>(ballRadius);
    const std::uint32_t first = grid.start[cell], last = grid.start[cell + 1];
    int found = 0;
    for (; found < kPatches; ++found) {
      float deepest = 0;
      std::uint32_t at = last;
      for (std::uint32_t k = first + static_cast<std::uint32_t>(lanes.lane); k < last; k += Lanes::width) {
        const Disc& disc = grid.disc[grid.entry[k]];
        if (outOfReach(disc, c, ballRadius)) continue;
        const DiscDistance d = distanceTo(disc, c);
        const float overlap = radius + disc.radius - d.distance;
        if (overlap <= deepest) continue;
        bool taken = false;
        for (int q = 0; q < found; ++q)
          taken =
              taken || dot(d.normal, patches[q].normal) > kSameNormal || dot(disc.normal, patches[q].face) > kSameFace;
        if (!taken) deepest = overlap, at = k;
      }
      lanes.agreeOnGreatest(deepest, at);
      if (deepest <= 0) break;
      const Disc& disc = grid.disc[grid.entry[at]];
      patches[found] = {distanceTo(disc, c).normal, disc.normal, deepest};
    }
    return found;
  }

  /// The patch whose normal lay closest in the last step; -1 where there is none.
  GROUSER_HD static int recall(const PatchMemory* held, const Vec3f& normal, unsigned& used) {
    int best = -1;
    float alignment = kSamePatch;
    for (int k = 0; k < kPatches; ++k) {
      const float cosine = dot(held[k].normal, normal);
      if (!(used >> k & 1) && cosine > alignment) best = k, alignment = cosine;
    }
    if (best >= 0) used |= 1u << best;
    return best;
  }

  /// Force of one patch, in the part's frame as the history is, then quantised in the world.
  GROUSER_HD void apply(const PartMotion& part, int i, const Ball& ball, const Vec3d& x, const Patch& patch,
                        Vec3f& shear, Vec3f& rolled, GrainLoad& result, base::Vec3l& torqueOnPart,
                        double& elastic) const {
    const BasicLaw<float>& law = laws[ball.material];
    const Vec3d outward = part.rotation * patch.normal.template as<double>();
    const Vec3d arm = outward * -(ball.radius - static_cast<double>(patch.overlap));
    const Vec3d point = x + arm;
    const Vec3d spin = grains.spin[i].xyz().template as<double>();
    const Vec3d relative = grains.velocity[i].xyz().template as<double>() + cross(spin, arm) - part.velocityAt(point);
    const float mass = static_cast<float>(ball.mass), radius = static_cast<float>(ball.radius);
    const float dt = static_cast<float>(model.timeStep);
    const Touch touch{-patch.normal, patch.overlap, transposedTimes(part.rotation, relative).template as<float>(), mass,
                      radius};
    const Reaction reaction = contactForce<kFeatures>(law, touch, dt, shear);
    const base::Vec3l quanta = model.force.quantise(part.rotation * reaction.force.template as<double>());
    const Vec3d force = model.force.value(quanta);
    result.force += quanta;
    result.torque += cross(arm, force).template as<float>();
    result.dissipated += reaction.dissipated;
    elastic += storedEnergy(law, static_cast<double>(patch.overlap), ball.radius, shear);
    if (patch.overlap > result.deepest) result.deepest = patch.overlap;
    torqueOnPart += model.torque.quantise(cross(point - part.centre, -force));
    if ((kFeatures & kGeneral) && law.rollingFriction > 0) {
      const Vec3f rolling = transposedTimes(part.rotation, spin - part.spin).template as<float>();
      const RollingMotion<float> how{touch.normal, rolling, radius, 1.4f * mass * radius * radius};
      const Vec3f torque =
          rollingTorque(law, how, reaction.pressing, reaction.normalStiffness, dt, rolled, result.dissipated);
      const float k = rollingStiffness(law, reaction.normalStiffness, radius);
      elastic += 0.5 * static_cast<double>(k * dot(rolled, rolled));
      // In quanta on both sides, so that angular momentum balances to the last bit but the float of the grain's.
      const base::Vec3l turned = model.torque.quantise(part.rotation * torque.template as<double>());
      result.torque += model.torque.value(turned).template as<float>();
      torqueOnPart -= turned;
    }
  }
};

} // namespace

GrainPartContacts::GrainPartContacts(const base::Exec& exec, const GrainPartModel& model,
                                     const std::vector<const base::SphereSet*>& sets, std::vector<GrainPart> parts,
                                     const base::Comm& comm, const GrainPartMaterials& materials)
    : exec_(exec), comm_(comm), model_(model), partCount_(parts.size()), rolling_(false), features_(0) {
  std::vector<BasicLaw<float>> laws;
  for (const ContactLaw& law : materials.laws) laws.push_back(law.as<float>());
  if (laws.empty()) laws.push_back(model.law.as<float>());
  for (const BasicLaw<float>& law : laws) features_ |= law.features();
  rolling_ = (features_ & kRollingFriction) != 0;
  laws_ = base::Array<BasicLaw<float>>(exec, laws);
  massPerCube_ = base::Array<double>(exec, materials.massPerCube);
  angle_ = base::Array<Vec3f>(exec), oldAngle_ = base::Array<Vec3f>(exec);
  std::vector<SurfaceGridView> views;
  for (const base::SphereSet* set : sets) {
    const double edge = set->spacing > 0.006 ? 0.75 * set->spacing : 0.0045;
    grids_.push_back(set->surfaceCount ? SurfaceGrid(exec, *set, model.radius, edge) : SurfaceGrid());
    views.push_back(grids_.back().view());
  }
  for (GrainPart& part : parts) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const base::SetSphere& s : sets[static_cast<std::size_t>(part.surface)]->spheres) {
      const double r = s.radius + s.flat;
      low = base::min(low, s.centre - Vec3d{r, r, r}), high = base::max(high, s.centre + Vec3d{r, r, r});
    }
    part.boxLow = low, part.boxHigh = high;
  }
  gridViews_ = base::Array<SurfaceGridView>(exec, views);
  parts_ = base::Array<GrainPart>(exec, parts);
  range_ = base::Array<std::uint32_t>(exec);
  count_ = base::Array<std::uint32_t>(exec);
  slot_ = base::Array<std::uint32_t>(exec);
  oldIndex_ = base::Array<std::uint32_t>(exec);
  key_ = base::Array<std::uint64_t>(exec);
  oldKey_ = base::Array<std::uint64_t>(exec);
  memory_ = base::Array<PatchMemory>(exec);
  oldMemory_ = base::Array<PatchMemory>(exec);
  load_ = base::Array<GrainLoad>(exec);
  sums_ = base::Array<std::int64_t>(exec, 6);
}

/// What travels with a pair.
std::vector<ExchangeField> GrainPartContacts::history() {
  std::vector<ExchangeField> fields{{key_.data(), 2}, {memory_.data(), kPatches * sizeof(PatchMemory) / 4}};
  if (rolling_) fields.push_back({angle_.data(), kPatches * sizeof(Vec3f) / 4});
  return fields;
}

void GrainPartContacts::handOver(const std::uint32_t* destination) {
  if (held_ == Held::everywhere) return;
  // Twice between two steps: nobody knows slots any more, so all ranks take all pairs.
  if (held_ == Held::handedOver) return restore(save());
  if (!exchange_) exchange_ = std::make_unique<Exchange>(exec_, comm_);
  const auto n = static_cast<std::int64_t>(pairs_);
  base::Array<std::uint32_t> leaves(exec_, pairs_), leaving(exec_);
  base::forEach(exec_, "find pairs that leave", n,
                FindDestination{slot_.data(), destination, static_cast<std::uint32_t>(comm_.rank()), leaves.data()});
  base::listMarked(exec_, leaves.data(), pairs_, leaving);
  base::Array<std::uint64_t> ranks(exec_, leaving.size());
  base::forEach(exec_, "read destinations of pairs", static_cast<std::int64_t>(leaving.size()),
                ReadDestination{leaving.data(), slot_.data(), destination, ranks.data()});
  exchange_->route(ranks, leaving, leaving.size());
  exchange_->start(history());
  // Those that leave are found by no grain of the next list, and are not saved here.
  base::forEach(exec_, "forget pairs that leave", static_cast<std::int64_t>(leaving.size()),
                Forget{exchange_->leavingSlots(), memory_.data()});
  key_.resizeKeeping(pairs_ + exchange_->coming());
  memory_.resizeKeeping(kPatches * key_.size());
  if (rolling_) angle_.resizeKeeping(kPatches * key_.size());
  exchange_->putFrom(pairs_);
  exchange_->finish(history());
  pairs_ += exchange_->coming();
  held_ = Held::handedOver;
}

void GrainPartContacts::refresh(const GrainsView& grains, const base::Array<PartMotion>& motion) {
  // The former list, sorted by key, to find history in.
  const std::size_t oldPairs = pairs_;
  key_.swap(oldKey_);
  memory_.swap(oldMemory_);
  angle_.swap(oldAngle_);
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
                 model_.radius + model_.margin,
                 {1e300, 1e300, 1e300},
                 {-1e300, -1e300, -1e300},
                 count_.data(),
                 range_.data(),
                 nullptr,
                 nullptr};
  const std::vector<PartMotion> poses = motion.toHost();
  const std::vector<GrainPart> parts = parts_.toHost();
  for (std::size_t p = 0; p < partCount_; ++p)
    for (int corner = 0; corner < 8; ++corner) {
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
    throw base::SimulationError(std::to_string(pairs_) + " pairs of grains and parts; at most 16,777,215 are possible");
  key_.resize(pairs_);
  slot_.resize(pairs_);
  memory_.resize(pairs_ * kPatches);
  if (rolling_) angle_.resize(pairs_ * kPatches);
  load_.resize(pairs_);
  list.key = key_.data(), list.slot = slot_.data();
  base::forEach(exec_, "list parts near grains", n, list);
  base::forEach(exec_, "carry patch history", static_cast<std::int64_t>(pairs_),
                CarryMemory{key_.data(), oldKey_.data(), oldIndex_.data(), static_cast<std::int64_t>(oldPairs),
                            oldMemory_.data(), memory_.data(), oldAngle_.data(), rolling_ ? angle_.data() : nullptr});
  held_ = Held::listed;
}

std::vector<std::int64_t> GrainPartContacts::allSums() const {
  std::vector<std::int64_t> sums = sums_.toHost();
  comm_.sum(sums.data(), sums.size());
  return sums;
}

void GrainPartContacts::compute(const GrainsView& grains, const base::Array<PartMotion>& motion, PartLoad* loads) {
  base::setZero(exec_, sums_.data(), 2 * sizeof(std::int64_t));
  const auto run = [&]<unsigned kFeatures>() {
    base::forEachGroup<16>(exec_, "grain-part contacts", static_cast<std::int64_t>(pairs_),
                           Compute<kFeatures>{model_, laws_.data(), massPerCube_.data(), grains, motion.data(),
                                              parts_.data(), gridViews_.data(), key_.data(), slot_.data(),
                                              memory_.data(), rolling_ ? angle_.data() : nullptr, load_.data(), loads,
                                              sums_.data()});
  };
  // Most beds are linear with friction; all else takes the general functions.
  if ((features_ & ~kFriction) == 0 && !model_.manyRadii)
    run.template operator()<kFriction>();
  else
    run.template operator()<kGeneral>();
}

GrainLoadsView GrainPartContacts::grainLoads() { return {range_.data(), load_.data(), model_.force, sums_.data() + 3}; }

GrainPartContacts::Ledger GrainPartContacts::ledger() const {
  const std::vector<std::int64_t> q = allSums();
  return {q[0], model_.energy.value(q[1]), model_.energy.value(q[2]),
          model_.force.value({q[3], q[4], q[5]}) * model_.timeStep};
}

std::size_t GrainPartContacts::bytes() const {
  std::size_t total = range_.bytes() + count_.bytes() + slot_.bytes() + key_.bytes() + oldKey_.bytes() +
                      memory_.bytes() + oldMemory_.bytes() + angle_.bytes() + oldAngle_.bytes() + load_.bytes();
  for (const SurfaceGrid& grid : grids_) total += grid.bytes();
  return total;
}

} // namespace grouser::contact
