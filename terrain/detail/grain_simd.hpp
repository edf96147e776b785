// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/plastic_simd.hpp"
#include "contact/sphere_pair.hpp"
#include "terrain/detail/grain_simd_advance.hpp"
#include "terrain/detail/grain_simd_find.hpp"
#include "terrain/detail/kernel_lists.hpp"
#include "terrain/grain_simd.hpp"

#include <algorithm>
#include <utility>

namespace grouser::terrain::detail {

/// Steps grains k in [first, last) of a launch, kWidth contacts at once. Grains are processed in blocks whose contacts
/// fit into the L1 cache, each block in five sweeps:
///
///   find     finds the contacts among the candidates, several of one grain at a time;
///   collect  collects the input of the law for each contact, as rows of four numbers;
///   contact  evaluates geometry and law, kWidth contacts at a time;
///   sum      sums the contacts of each grain in the order of the neighbours' ids;
///   advance  advances several grains at a time (AdvanceLanes).
///
/// The law is contact::contactForce() itself. The rest repeats the operations of GrainStep and addCompensated()
/// in the same order; where these functions branch, both sides are computed and one is selected. Results are therefore
/// bitwise equal. Rare cases are passed to GrainStep itself.
///
/// kFeatures is one of kSimdKernels, or kGeneral: then features are tested at run time, and contacts of several
/// materials are computed law by law, each in the lanes with that law.
///
/// The code is compiled for instruction sets that may be unavailable: it calls only inlined functions, so that the
/// linker cannot use its copies in the rest of the program.
template <int kWidth, unsigned kFeatures> class GrainSimd : ContactBlock<kWidth, kFeatures> {
public:
  GROUSER_SIMD GrainSimd(const GrainKernelData& data, const ForceData<float>& forces)
      : Block(data), forces_(forces), advance_(data, forces) {}

  /// Energy accounting of the advanced grains.
  GROUSER_SIMD GrainAccumulator accumulator() const {
    GrainAccumulator accumulator = accumulator_;
    advance_.accumulator().addTo(accumulator);
    return accumulator;
  }

  GROUSER_SIMD void run(int first, int last) {
    // A local copy, which no store can alias: derived values are computed once, not for each contact.
    const ForceData<float> f = forces_;
    for (int k = first; k < last;) {
      const int from = k;
      grains_ = contacts_ = 0;
      while (k < last && grains_ < kGrains && contacts_ + candidatesOf(k) <= kContacts) find(k++);
      if (k == from) { // a large grain among small ones may have more neighbours than a block holds
        stepAlone(data_, f, k++, accumulator_);
        continue;
      }
      begin_[grains_] = contacts_;
      collect();
      if (periodic())
        for (int g = 0; g < grains_; ++g)
          if (atSide_[g]) collectAcross(g);
      for (int c = contacts_; c % kWidth != 0; ++c) // unused lanes of the last group
        apart_[c] = moving_[c] = turning_[c] = theirs_[c] = spring_[c] = angle_[c] = dent_[c] = Float4{};
      for (int c = 0; c < contacts_; c += kWidth)
        for (unsigned left = kAll; left != 0;) left &= ~computeContacts(c, left, f);
      if (hasHistory()) storeSprings();
      for (int g = 0; g < grains_; ++g) sum(g, slotOf(from + g));
      advance_.run(grains_, accumulator_);
    }
  }

private:
  using Block = ContactBlock<kWidth, kFeatures>;
  using Block::has, Block::hasHistory, Block::slips, Block::bothSpins, Block::historyWidth, Block::dentPlace,
      Block::hasFixed, Block::periodic, Block::stays, Block::slotOf, Block::candidatesOf, Block::find;
  using Block::kGrains, Block::kContacts, Block::kRows, Block::data_, Block::grains_, Block::contacts_, Block::begin_,
      Block::samePlace_, Block::atSide_, Block::grain_, Block::other_, Block::entry_;
  using Float = Simd<float, kWidth>;
  using Int = Simd<std::int32_t, kWidth>;
  using Long = Simd<std::int64_t, kWidth>;
  using Vec = base::Vec3<Float>;
  using Advance = AdvanceLanes < kWidth<16 ? 4 : 8, kFeatures>;
  static constexpr unsigned kLaw =
      kFeatures & (contact::kGeneral | contact::kHertz | contact::kFriction | contact::kRollingFriction |
                   contact::kCohesion | contact::kManyMasses | contact::kPlastic);
  static_assert(kGrains == Advance::kGrains);
  static constexpr int kUsual = 6; ///< most grains have at most this many contacts
  static constexpr unsigned kAll = (1u << kWidth) - 1;

  /// Collects the rows of each contact. Addresses are loaded once, because the compiler must assume that stored rows
  /// alias them.
  GROUSER_SIMD void collect() {
    const base::Position* const position = data_.position;
    const contact::Motion* const motion = data_.motion;
    const float* const history = data_.neighbours.history;
    const std::size_t width = historyWidth(), dent = dentPlace();
    const int contacts = contacts_;
    for (int c = 0; c < contacts; ++c) {
      const std::size_t i = grain_[c], j = other_[c];
      store(apart_ + c, load<Int4>(position + j) - load<Int4>(position + i));
      const auto v = load<Float4>(&motion[i].velocity), u = load<Float4>(&motion[j].velocity);
      // Fourth number: if radii are equal, 1 for a fixed j, else 0; if radii differ, velocity.w of j.
      Float4 relative = v - u;
      if (has(kManyRadii)) relative[3] = u[3];
      moving_[c] = relative;
      auto spin = load<Float4>(&motion[i].spin);
      if (bothSpins()) {
        theirs_[c] = load<Float4>(&motion[j].spin);
        // Fourth number of theirs_: the pair of materials.
        if (has(kManyMaterials)) theirs_[c][3] += spin[3] * static_cast<float>(data_.materials);
        if (has(kManyRadii)) spin[3] = v[3];
      } else {
        spin += load<Float4>(&motion[j].spin);
      }
      turning_[c] = spin;
      const float* const spring = history + width * std::size_t{entry_[c]};
      if (hasHistory()) spring_[c] = base::load3(spring);
      if (has(contact::kRollingFriction)) angle_[c] = base::load3(spring + 3);
      if (has(contact::kPlastic)) dent_[c] = Float4{spring[dent], spring[dent + 1], 0, 0};
    }
  }
  GROUSER_SIMD void storeSprings() const {
    float* const history = data_.neighbours.history;
    const std::size_t width = historyWidth(), dent = dentPlace();
    const int contacts = contacts_;
    for (int c = 0; c < contacts; ++c) {
      float* const spring = history + width * std::size_t{entry_[c]};
      base::store3(spring, spring_[c]);
      if (has(contact::kRollingFriction)) base::store3(spring + 3, angle_[c]);
      if (has(contact::kPlastic)) spring[dent] = dent_[c][0], spring[dent + 1] = dent_[c][1];
    }
  }
  /// Same as collect(), for a grain at a periodic boundary.
  GROUSER_SIMD void collectAcross(int g) {
    for (int c = begin_[g]; c < begin_[g + 1]; ++c) store(apart_ + c, Block::apart(grain_[c], other_[c]));
  }

  GROUSER_SIMD static Vec firstThree(const Float (&r)[4]) { return {r[0], r[1], r[2]}; }

  /// Parameters of the law from the two grains of each contact.
  struct Pair {
    Long reach2;
    Float reach, mass, share;              ///< effective mass; share of grain i in the dissipation
    Float dampingShare;                    ///< multiplies both damping coefficients
    Float ownMass, ownRadius, otherRadius; ///< if radii or masses differ
    Float otherMass;
  };
  /// Law and densities of a pair of materials in contact.
  struct Materials {
    const contact::BasicLaw<float>& law;
    float ownPerCube, otherPerCube; ///< mass over radius^3 [kg/m3]
  };
  /// Returns the materials of the first lane in `left`; `taken`: all lanes with the same materials.
  GROUSER_SIMD Materials materialsOf(const Float& pairs, unsigned left, const ForceData<float>& f, Int& taken) const {
    taken = ~Int{};
    if (!has(kManyMaterials)) return {f.law, f.massPerCube, f.massPerCube};
    const float first = pairs[__builtin_ctz(left)];
    taken = pairs == first;
    const int pair = static_cast<int>(first);
    return {f.pairLaws[pair], static_cast<float>(data_.massPerCube[pair / data_.materials]),
            static_cast<float>(data_.massPerCube[pair % data_.materials])};
  }

  /// `own`, `other`: velocity.w of the two grains; if radii are equal, `other` marks a fixed grain.
  GROUSER_SIMD Pair pairOf(const Float& own, const Float& other, const Materials& of, const ForceData<float>& f) const {
    Pair pair{};
    pair.share = base::broadcast<Float>(0.5f), pair.dampingShare = base::broadcast<Float>(1);
    const auto fixed = has(kManyRadii) ? other < 0.0f : other > 0.5f;
    if (has(kManyRadii)) {
      pair.ownRadius = own, pair.otherRadius = base::absolute(other);
      const Int units = base::convert<std::int32_t>(pair.ownRadius * data_.unitsPerLength) +
                        base::convert<std::int32_t>(pair.otherRadius * data_.unitsPerLength);
      const Long wide = base::convert<std::int64_t>(units);
      pair.reach2 = wide * wide, pair.reach = base::convert<float>(units);
      pair.ownMass = of.ownPerCube * pair.ownRadius * pair.ownRadius * pair.ownRadius;
      pair.otherMass = of.otherPerCube * pair.otherRadius * pair.otherRadius * pair.otherRadius;
      pair.mass = pair.ownMass * pair.otherMass / (pair.ownMass + pair.otherMass);
    } else {
      pair.reach2 = Long{} + data_.diameterUnits2, pair.reach = base::broadcast<Float>(f.diameterUnits);
      pair.ownMass = base::broadcast<Float>(f.mass), pair.ownRadius = base::broadcast<Float>(f.radius);
      pair.mass = base::broadcast<Float>(f.halfMass);
    }
    if (!hasFixed()) return pair;
    pair.mass = fixed ? pair.ownMass : pair.mass, pair.share = fixed ? base::broadcast<Float>(1) : pair.share;
    if (!(kFeatures & contact::kHertz))
      pair.dampingShare = fixed ? base::broadcast<Float>(of.law.fixedShare) : pair.dampingShare;
    return pair;
  }

  /// Replaces rows, starting at `rows`, in the lanes set in `taken`.
  GROUSER_SIMD void storeTaken(Float4* rows, Float (&in)[4], const Int& taken) const {
    if (has(kManyMaterials)) {
      Float before[4];
      base::loadRows(rows, before);
      for (int k = 0; k < 4; ++k) in[k] = taken ? in[k] : before[k];
    }
    base::storeRows(rows, in);
  }

  /// GrainStep::touchNeighbour() for the contacts starting at c. In the lanes with the materials of the first lane in
  /// `left`, rows of forces and torques replace rows of motion. Returns the bit mask of these lanes.
  GROUSER_SIMD unsigned computeContacts(int c, unsigned left, const ForceData<float>& f) {
    Float rows[4], relative[4], turning[4], theirs[4], spring[4];
    base::loadRows(apart_ + c, rows);
    base::loadRows(moving_ + c, relative), base::loadRows(turning_ + c, turning);
    if (bothSpins()) base::loadRows(theirs_ + c, theirs);
    Vec shear{};
    if (hasHistory()) base::loadRows(spring_ + c, spring), shear = firstThree(spring);
    Int taken;
    const Materials materials = materialsOf(theirs[3], left, f, taken);

    const base::Vec3<Int> apart{base::bitsAs<Int>(rows[0]), base::bitsAs<Int>(rows[1]), base::bitsAs<Int>(rows[2])};
    const Long x = base::convert<std::int64_t>(apart.x), y = base::convert<std::int64_t>(apart.y),
               z = base::convert<std::int64_t>(apart.z);
    const Long distance2 = x * x + y * y + z * z;
    const Pair both = pairOf(turning[3], relative[3], materials, f);
    const auto pair = contact::spherePair<Float>(
        {base::convert<float>(apart.x), base::convert<float>(apart.y), base::convert<float>(apart.z)},
        base::convert<float>(distance2), base::convert<float>(both.reach2 - distance2), both.reach, f.unit);
    Float lever = 0.5f * pair.distance;
    if (has(kManyRadii)) lever = both.ownRadius - 0.5f * pair.overlap;
    const Vec arm = pair.normal * lever;
    Vec velocity = firstThree(relative);
    Vec spin{};
    if (bothSpins()) spin = firstThree(turning) - firstThree(theirs);
    if (has(kManyRadii))
      velocity += cross(firstThree(turning) * lever + firstThree(theirs) * (both.otherRadius - 0.5f * pair.overlap),
                        pair.normal);
    else
      velocity += cross(bothSpins() ? firstThree(turning) + firstThree(theirs) : firstThree(turning), arm);
    Float radius = base::broadcast<Float>(0.5f * f.radius);
    if (has(kManyRadii)) radius = both.ownRadius * both.otherRadius / (both.ownRadius + both.otherRadius);
    const contact::BasicContactGeometry<Float> touch{pair.normal, pair.overlap, velocity,
                                                     both.mass,   radius,       both.dampingShare};
    Float dents[4] = {};
    if (has(contact::kPlastic)) base::loadRows(dent_ + c, dents);
    contact::BasicPlasticState<Float> dent{dents[0], dents[1]};
    const auto reaction =
        contact::contactForce<kLaw>(materials.law, touch, f.timeStep, shear, has(contact::kPlastic) ? &dent : nullptr);
    if (has(contact::kPlastic)) {
      dents[0] = dent.deepest, dents[1] = dent.origin, dents[2] = both.share * reaction.yielded;
    }
    if (slips()) dents[3] = both.share * reaction.slipped;
    if (has(contact::kPlastic) || slips()) storeTaken(dent_ + c, dents, taken);
    if (hasHistory()) {
      spring[0] = shear.x, spring[1] = shear.y, spring[2] = shear.z,
      spring[3] = has(kLedger) ? both.share * reaction.rubbed : Float{};
      storeTaken(spring_ + c, spring, taken);
    }
    if (has(contact::kRollingFriction))
      roll(c, f, materials.law, both, {pair.normal, spin, radius, Float{}}, reaction, taken);
    Vec torque{};
    if (has(contact::kFriction)) torque = cross(arm, reaction.force);
    Float forces[4] = {reaction.force.x, reaction.force.y, reaction.force.z,
                       has(kLedger) ? both.share * reaction.damped : Float{}};
    Float torques[4] = {torque.x, torque.y, torque.z, pair.overlap};
    storeTaken(moving_ + c, forces, taken), storeTaken(turning_ + c, torques, taken);
    return base::laneBits(taken);
  }

  /// Computes rolling resistance: rows of torques and dissipation replace rows of positions.
  GROUSER_SIMD void roll(int c, const ForceData<float>& f, const contact::BasicLaw<float>& law, const Pair& both,
                         contact::RollingMotion<Float> motion, const contact::BasicReaction<Float>& reaction,
                         const Int& taken) {
    if (has(kManyRadii))
      motion.inertia = contact::rollingInertia(both.ownMass, both.ownRadius, both.otherMass, both.otherRadius);
    else
      motion.inertia = base::broadcast<Float>(contact::rollingInertia(f.mass, f.radius, f.mass, f.radius));
    if (hasFixed())
      motion.inertia = both.share > 0.75f ? contact::rollingInertia(both.ownMass, both.ownRadius) : motion.inertia;
    Float rows[4];
    base::loadRows(angle_ + c, rows);
    Vec angle = firstThree(rows);
    Float rolled{};
    const Vec torque = contact::rollingTorque(law, motion, reaction.pressing, reaction.normalStiffness, f.timeStep,
                                              angle, rolled, has(contact::kHertz) ? &reaction.change : nullptr);
    rows[0] = angle.x, rows[1] = angle.y, rows[2] = angle.z;
    storeTaken(angle_ + c, rows, taken);
    Float torques[4] = {torque.x, torque.y, torque.z, has(kLedger) ? both.share * rolled : Float{}};
    storeTaken(apart_ + c, torques, taken);
  }

  /// Sum over the contacts of a grain; the fourth numbers are those of the rows.
  struct Sum {
    Float4 force{}, torque{}, most{}, rubbed{}, rolled{}, dented{};
  };
  /// Adds contact c if `there` is set.
  GROUSER_SIMD void add(int c, const Int4& there, Sum& sum) const {
    const auto row = [&](const Float4* rows) { return base::bitsAs<Float4>(base::bitsAs<Int4>(rows[c]) & there); };
    const Float4 turning = row(turning_);
    if (has(contact::kFriction) && has(kLedger)) sum.rubbed += row(spring_);
    if ((has(contact::kPlastic) && has(kLedger)) || slips()) sum.dented += row(dent_);
    sum.force += row(moving_);
    sum.torque += turning;
    if (has(contact::kRollingFriction)) {
      const Float4 rolling = row(apart_);
      sum.torque += rolling, sum.rolled += rolling;
    }
    sum.most = turning > sum.most ? turning : sum.most;
  }
  /// Copies the unchanged state of a fixed grain.
  GROUSER_SIMD void keep(int i) {
    if (data_.features & kLoads && data_.loads.range[i] != 0) return copyFixedGrain(data_, forces_, i, accumulator_);
    data_.nextPosition[i] = data_.position[i], data_.nextMotion[i] = data_.motion[i];
  }
  /// Sums the loads on one grain.
  GROUSER_SIMD void sum(int g, int i) {
    if (stays(i)) return advance_.addDone(g, i), keep(i);
    if (hasFixed() && has(kLedger)) accountFixedContacts(g, i);
    Sum all;
    const int first = begin_[g], n = begin_[g + 1] - first;
    // No branch on the most frequent counts, since it would often be mispredicted: adding zero does not change a sum
    // that started at zero. Masks are loaded from memory, since the compiler turns comparisons into masked loads, and
    // these wait for the rows just stored.
    const std::int32_t* const there = there_ + (n < kUsual ? kUsual - n : 0);
#pragma GCC unroll 6
    for (int k = 0; k < kUsual; ++k) add(first + k, Int4{} + there[k], all);
    for (int k = kUsual; k < n; ++k) add(first + k, ~Int4{}, all);
    Float4 force = all.force, torque = all.torque;
    const float damped = force[3];
    if (has(contact::kPlastic) && has(kLedger) && all.dented[2] != 0) accountPlasticWork(data_, i, all.dented[2]);
    const std::uint32_t place = data_.features & kBoundaries ? data_.boundaryOf[i] : 0;
    if (place != 0) {
      const BoundaryLoad<float>& load = forces_.boundaryLoads[place - 1];
      force += base::load3(&load.force), torque += base::load3(&load.torque);
      const float radius = has(kManyRadii) ? data_.motion[i].velocity.w : forces_.radius;
      if (load.deepest > data_.maxSurfaceShare * radius) raiseThrough(data_, forces_, i);
    }
    force[3] = damped, torque[3] = samePlace_[g] ? data_.diameter : all.most[3];
    advance_.add(g, i, force, torque, all.rubbed[3], all.rolled[3], all.dented[3]);
    const bool pressed = data_.features & kSurfaces && place != 0,
               loaded = data_.features & kLoads && data_.loads.range[i] != 0;
    if (atSide_[g] || pressed || loaded) [[unlikely]]
      addOthers(g, i, pressed ? place : 0, loaded, force, torque);
  }
  /// Adds loads in double precision: moving surfaces and parts.
  GROUSER_SIMD void addOthers(int g, int i, std::uint32_t place, bool loaded, const Float4& force,
                              const Float4& torque) {
    Double4 f4 = base::toDouble(force), t4 = base::toDouble(torque);
    if (place != 0) {
      const base::Vec3d& pressed = data_.fromSurfaces[place - 1];
      if (!atSide_[g] && !loaded && pressed == base::Vec3d{}) return;
      f4 += Double4{pressed.x, pressed.y, pressed.z, 0};
    }
    if (loaded) {
      base::Vec3d f3{f4[0], f4[1], f4[2]}, t3{t4[0], t4[1], t4[2]};
      addLoadsOf(data_, forces_, i, f3, t3);
      f4 = Double4{f3.x, f3.y, f3.z, 0}, t4 = Double4{t3.x, t3.y, t3.z, 0};
    }
    advance_.setAlone(g, f4, t4);
  }

  /// Accounts for the forces of fixed grains.
  GROUSER_SIMD void accountFixedContacts(int g, int i) {
    Float4 force{}, torque{};
    bool any = false;
    for (int c = begin_[g]; c < begin_[g + 1]; ++c)
      if (data_.motion[other_[c]].velocity.w < 0) {
        any = true, force += moving_[c];
        torque += has(contact::kRollingFriction) ? turning_[c] + apart_[c] : turning_[c];
      }
    if (!any) return;
    accountFixedGrain(data_, forces_, i, {force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]},
                      accumulator_);
  }

  const ForceData<float>& forces_;
  GrainAccumulator accumulator_; ///< sums of rare cases
  /// kUsual masks, starting at kUsual - n: n set, then clear.
  const std::int32_t there_[2 * kUsual] = {-1, -1, -1, -1, -1, -1};
  Advance advance_;
  alignas(64) Float4 apart_[kRows], moving_[kRows], turning_[kRows], theirs_[kRows], spring_[kRows], angle_[kRows],
      dent_[kRows]; ///< plastic state, plastic work, micro-slip
};

namespace {

/// One kernel. Not inlined, so that its machine code does not depend on the number of kernels; internal linkage
/// prevents the linker from replacing it by the copy of another instruction set.
template <int kWidth, unsigned kFeatures> __attribute__((noinline, flatten)) void
runOf(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  GrainSimd<kWidth, kFeatures> some(d, f);
  some.run(first, last);
  if (hasFeature<kFeatures>(d, kLedger)) addToLedger(d, first, some.accumulator());
}

} // namespace

/// Runs the kernel selected by simdKernel().
template <int kWidth, std::size_t... kPlace> GROUSER_SIMD void
runSimd(const GrainKernelData& d, const ForceData<float>& f, int first, int last, std::index_sequence<kPlace...>) {
  const unsigned wanted = simdKernel(d.features);
  if (wanted == contact::kGeneral) return runOf<kWidth, contact::kGeneral>(d, f, first, last);
  ((wanted == kSimdKernels[kPlace] ? runOf<kWidth, kSimdKernels[kPlace]>(d, f, first, last) : void()), ...);
}

template <int kWidth>
GROUSER_SIMD void runSimd(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  runSimd<kWidth>(d, f, first, last, std::make_index_sequence<kSimdKernels.size()>{});
}

} // namespace grouser::terrain::detail
