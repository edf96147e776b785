// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/plastic_simd.hpp"
#include "contact/sphere_pair.hpp"
#include "terrain/detail/grain_simd_advance.hpp"
#include "terrain/detail/kernel_lists.hpp"
#include "terrain/grain_simd.hpp"

#include <algorithm>
#include <utility>

namespace grouser::terrain::detail {

/// The step of grains k in [first, last) of a launch, kWidth contacts side by side. It takes the grains in blocks whose
/// contacts fit into the processor's first cache, and each block in five sweeps:
///
///   find     which candidates touch, several of one grain at a time;
///   collect  what the law needs of each contact, as rows of four numbers;
///   contact  geometry and law, kWidth contacts at a time;
///   sum      grain by grain: its contacts in the order of the neighbours' ids;
///   advance  the step, several grains at a time (AdvanceLanes).
///
/// The law is contact::contactForce() itself. GrainStep and addCompensated() say what else is computed and why; here
/// the same operations act on the same numbers in the same order, and where those functions branch, both sides are
/// computed and one is taken. So the bits are theirs. What is rare goes to GrainStep itself.
///
/// This is compiled for processors that may not be there: it calls nothing that is not inlined, lest a copy made for
/// wide registers serve the whole program.
template <int kWidth, unsigned kFeatures> class GrainSimd {
public:
  GROUSER_SIMD GrainSimd(const GrainKernelData& data, const ForceData<float>& forces)
      : data_(data), forces_(forces), advance_(data, forces) {}

  /// Of the grains that have been advanced.
  GROUSER_SIMD GrainBooks books() const {
    GrainBooks books = books_;
    advance_.books().addTo(books);
    return books;
  }

  GROUSER_SIMD void run(int first, int last) {
    // A copy that no store can change: what follows from it alone is worked out once, not for each contact.
    const ForceData<float> f = forces_;
    for (int k = first; k < last;) {
      const int from = k;
      grains_ = contacts_ = 0;
      while (k < last && grains_ < kGrains && contacts_ + candidatesOf(k) <= kContacts) find(k++);
      if (k == from) { // among many small ones it has more neighbours than a block
        stepAlone(data_, f, k++, books_);
        continue;
      }
      begin_[grains_] = contacts_;
      collect();
      if (periodic())
        for (int g = 0; g < grains_; ++g)
          if (atSide_[g]) collectAcross(g);
      for (int c = contacts_; c % kWidth != 0; ++c) // lanes of the last group that no contact takes
        apart_[c] = moving_[c] = turning_[c] = theirs_[c] = spring_[c] = angle_[c] = dent_[c] = Float4{};
      for (int c = 0; c < contacts_; c += kWidth) computeContacts(c, f);
      if (kWithFriction) storeSprings();
      for (int g = 0; g < grains_; ++g) sum(g, slotOf(from + g));
      advance_.run(grains_, books_);
    }
  }

private:
  using Float = Simd<float, kWidth>;
  using Int = Simd<std::int32_t, kWidth>;
  using Long = Simd<std::int64_t, kWidth>;
  using Vec = base::Vec3<Float>;
  using Advance = AdvanceLanes < kWidth<16 ? 4 : 8, kFeatures>;
  static constexpr unsigned kLaw = kFeatures & (contact::kHertz | contact::kFriction | contact::kRollingFriction |
                                                contact::kCohesion | contact::kManyMasses | contact::kPlastic);
  static constexpr bool kWithFriction = kFeatures & contact::kFriction, kWithLedger = kFeatures & kLedger,
                        kWithRolling = kFeatures & contact::kRollingFriction, kYields = kFeatures & contact::kPlastic,
                        kManySizes = kFeatures & kManyRadii,
                        kSlips = (kFeatures & contact::kHertz) && kWithFriction && kWithLedger;
  static constexpr bool kBothSpins = kWithRolling || kManySizes;    ///< are needed, not their sum alone
  static constexpr int kGrains = Advance::kGrains, kContacts = 192; ///< of a block
  static constexpr std::size_t kHistory = contact::historyWidth(kFeatures), kDent = contact::plasticPlace(kFeatures);
  static constexpr int kUsual = 6;                  ///< contacts of a grain
  static constexpr int kFound = kWidth < 8 ? 4 : 8; ///< candidates that are tried side by side
  using Found = Simd<std::int32_t, kFound>;
  using FoundFloat = Simd<float, kFound>;

  // Of these a step decides as it runs: they are asked for once a grain or a group of contacts.
  GROUSER_SIMD bool hasFixed() const { return data_.features & kFixed; }
  GROUSER_SIMD bool periodic() const { return data_.features & kPeriodic; }
  GROUSER_SIMD int slotOf(int k) const { return data_.active ? static_cast<int>(data_.active[k]) : k; }
  GROUSER_SIMD int candidatesOf(int k) const { return static_cast<int>(data_.neighbours.count[slotOf(k)]); }

  /// History of a place of the neighbour list.
  GROUSER_SIMD float* springOf(std::uint32_t entry) const {
    return data_.neighbours.history + kHistory * std::size_t{entry};
  }

  /// Appends the contacts of the k-th grain to the block.
  GROUSER_SIMD void find(int k) {
    const int i = slotOf(k), n = candidatesOf(k);
    const std::uint32_t row = data_.neighbours.start[i]; // its places follow each other
    const std::uint32_t* const slot = data_.neighbours.slot + row;
    const Int4 p = load<Int4>(data_.position + i);
    const std::uint32_t* const reach = kManySizes ? data_.neighbours.reach + row : nullptr;
    const bool atSide = periodic() && isAtSide(p);
    auto reach2 = base::broadcast<FoundFloat>(static_cast<float>(data_.diameterUnits2));
    Found lane;
    for (int l = 0; l < kFound; ++l) lane[l] = l;

    std::uint64_t now = 0;
    int c = contacts_;
    begin_[grains_] = c;
    samePlace_[grains_] = false, atSide_[grains_] = atSide;
    std::uint64_t* before = data_.neighbours.touching + (kManySizes ? i * data_.neighbours.maskWords : i);
    for (int m = 0; m < n; m += kFound) {
      Found other[4];
      base::gatherRows<kFound>(data_.position, slot + m, other);
      const auto x = base::convert<float>(other[0] - p[0]);
      const auto y = base::convert<float>(other[1] - p[1]);
      const auto z = base::convert<float>(other[2] - p[2]);
      const auto distance2 = x * x + y * y + z * z;
      const unsigned inRow = n - m < kFound ? (1u << (n - m)) - 1 : (1u << kFound) - 1;
      if (kManySizes) {
        const auto units = base::convert<float>(load<Found>(reach + m));
        reach2 = units * units;
      }
      // Squares of distances in float are right to 5 roundings, 3e-7: beyond this margin they decide.
      const auto surely2 = reach2 * (1 - 2e-6f), perhaps2 = reach2 * (1 + 2e-6f);
      const auto open = ((distance2 < perhaps2) & (distance2 >= surely2)) | (distance2 == 0.0f);
      unsigned touching = base::laneBits(distance2 < surely2) & inRow;
      if (const unsigned undecided = (atSide ? ~0u : base::laneBits(open)) & inRow) [[unlikely]]
        touching = decide(i, slot + m, kManySizes ? reach + m : reach, touching, undecided);
      base::storeMarked(other_ + c, load<Found>(slot + m), touching);
      base::storeMarked(entry_ + c, lane + static_cast<std::int32_t>(row + m), touching);
      store(grain_ + c, Found{} + i);
      now |= std::uint64_t{touching} << m % 64;
      c += __builtin_popcount(touching);
      if (kManySizes && (m + kFound) % 64 == 0 && m + kFound < n) { // a word of bits is full
        begin(*before, now, row + static_cast<std::uint32_t>(m / 64 * 64));
        *before++ = now, now = 0;
      }
    }
    begin(*before, now, row + static_cast<std::uint32_t>(n > 0 ? (n - 1) / 64 * 64 : 0));
    *before = now;
    contacts_ = c;
    ++grains_;
  }
  /// Springs of contacts that begin are not stretched yet. Bit k is of place `first` + k.
  GROUSER_SIMD void begin(std::uint64_t before, std::uint64_t now, std::uint32_t first) const {
    if (!kWithFriction) return;
    for (std::uint64_t begun = now & ~before; begun != 0; begun &= begun - 1) {
      float* const spring = springOf(first + static_cast<std::uint32_t>(__builtin_ctzll(begun)));
      base::store3(spring, Float4{});
      if (kWithRolling) base::store3(spring + 3, Float4{});
      if (kYields) spring[kDent] = spring[kDent + 1] = 0;
    }
  }

  /// Corrects those bits of `touching` that are set in `open`, by exact squares.
  GROUSER_SIMD unsigned decide(int i, const std::uint32_t* slot, const std::uint32_t* reach, unsigned touching,
                               unsigned open) {
    for (; open != 0; open &= open - 1) {
      const int l = __builtin_ctz(open);
      const std::int64_t distance2 = squareOf(apart(i, slot[l]));
      touching &= ~(1u << l);
      if (distance2 == 0)
        samePlace_[grains_] = true;
      else if (distance2 < (reach ? std::int64_t{reach[l]} * reach[l] : data_.diameterUnits2))
        touching |= 1u << l;
    }
    return touching;
  }
  /// From i to the nearest image of j.
  GROUSER_SIMD Int4 apart(std::uint32_t i, std::uint32_t j) const {
    if (!periodic()) return load<Int4>(data_.position + j) - load<Int4>(data_.position + i);
    const base::Vec3l way = data_.period.apart(data_.position[i], data_.position[j]);
    return Int4{static_cast<std::int32_t>(way.x), static_cast<std::int32_t>(way.y), static_cast<std::int32_t>(way.z),
                0};
  }
  /// Whether a neighbour of a grain here may lie beyond a periodic boundary.
  GROUSER_SIMD bool isAtSide(const Int4& place) const {
    const base::Vec3l u = base::toUnits(base::bitsAs<base::Position>(place));
    const auto skin = static_cast<std::int64_t>(2 * __builtin_sqrt(static_cast<double>(data_.halfSkinUnits2))) + 2;
    const std::int64_t near = data_.diameterUnits + 2 * skin;
    bool atSide = false;
    for (int a = 0; a < 2; ++a)
      if (const std::int64_t in = u[a] - data_.period.low[a]; data_.period.along(a))
        atSide = atSide || in < near || in >= data_.period.length[a] - near;
    return atSide;
  }
  GROUSER_SIMD static std::int64_t squareOf(const Int4& v) {
    const std::int64_t x = v[0], y = v[1], z = v[2];
    return x * x + y * y + z * z;
  }

  /// The rows of each contact: what tells the two grains apart. Where things lie is taken once: for all the compiler
  /// knows, rows that are stored could change it.
  GROUSER_SIMD void collect() {
    const base::Position* const position = data_.position;
    const contact::Motion* const motion = data_.motion;
    const float* const history = data_.neighbours.history;
    const int contacts = contacts_;
    for (int c = 0; c < contacts; ++c) {
      const std::size_t i = grain_[c], j = other_[c];
      store(apart_ + c, load<Int4>(position + j) - load<Int4>(position + i));
      const auto v = load<Float4>(&motion[i].velocity), u = load<Float4>(&motion[j].velocity);
      // The fourth number: of grains of one radius 1 where j never moves, else 0; of others what velocities have there.
      Float4 relative = v - u;
      if (kManySizes) relative[3] = u[3];
      moving_[c] = relative;
      auto spin = load<Float4>(&motion[i].spin);
      if (kBothSpins) {
        theirs_[c] = load<Float4>(&motion[j].spin);
        if (kManySizes) spin[3] = v[3];
      } else {
        spin += load<Float4>(&motion[j].spin);
      }
      turning_[c] = spin;
      const float* const spring = history + kHistory * std::size_t{entry_[c]};
      if (kWithFriction) spring_[c] = base::load3(spring);
      if (kWithRolling) angle_[c] = base::load3(spring + 3);
      if (kYields) dent_[c] = Float4{spring[kDent], spring[kDent + 1], 0, 0};
    }
  }
  GROUSER_SIMD void storeSprings() const {
    float* const history = data_.neighbours.history;
    const int contacts = contacts_;
    for (int c = 0; c < contacts; ++c) {
      float* const spring = history + kHistory * std::size_t{entry_[c]};
      base::store3(spring, spring_[c]);
      if (kWithRolling) base::store3(spring + 3, angle_[c]);
      if (kYields) spring[kDent] = dent_[c][0], spring[kDent + 1] = dent_[c][1];
    }
  }
  /// Of a grain at a periodic boundary.
  GROUSER_SIMD void collectAcross(int g) {
    for (int c = begin_[g]; c < begin_[g + 1]; ++c) store(apart_ + c, apart(grain_[c], other_[c]));
  }

  GROUSER_SIMD static Vec firstThree(const Float (&r)[4]) { return {r[0], r[1], r[2]}; }

  /// What the law needs of both grains of each contact.
  struct Pair {
    Long reach2;
    Float reach, mass, share;              ///< effective mass; of what is dissipated, that of grain i
    Float dampingShare;                    ///< multiplies both damping coefficients
    Float ownMass, ownRadius, otherRadius; ///< where they differ
    Float otherMass;
  };
  /// `own`, `other`: velocity.w of both; of grains of one radius `other` tells whether it never moves.
  GROUSER_SIMD Pair pairOf(const Float& own, const Float& other, const ForceData<float>& f) const {
    Pair pair{};
    pair.share = base::broadcast<Float>(0.5f), pair.dampingShare = base::broadcast<Float>(1);
    const auto fixed = kManySizes ? other < 0.0f : other > 0.5f;
    if (kManySizes) {
      pair.ownRadius = own, pair.otherRadius = base::absolute(other);
      const Int units = base::convert<std::int32_t>(pair.ownRadius * data_.unitsPerLength) +
                        base::convert<std::int32_t>(pair.otherRadius * data_.unitsPerLength);
      const Long wide = base::convert<std::int64_t>(units);
      pair.reach2 = wide * wide, pair.reach = base::convert<float>(units);
      pair.ownMass = f.massPerCube * pair.ownRadius * pair.ownRadius * pair.ownRadius;
      pair.otherMass = f.massPerCube * pair.otherRadius * pair.otherRadius * pair.otherRadius;
      pair.mass = pair.ownMass * pair.otherMass / (pair.ownMass + pair.otherMass);
    } else {
      pair.reach2 = Long{} + data_.diameterUnits2, pair.reach = base::broadcast<Float>(f.diameterUnits);
      pair.ownMass = base::broadcast<Float>(f.mass), pair.ownRadius = base::broadcast<Float>(f.radius);
      pair.mass = base::broadcast<Float>(f.halfMass);
    }
    if (!hasFixed()) return pair;
    pair.mass = fixed ? pair.ownMass : pair.mass, pair.share = fixed ? base::broadcast<Float>(1) : pair.share;
    if (!(kFeatures & contact::kHertz))
      pair.dampingShare = fixed ? base::broadcast<Float>(f.law.fixedShare) : pair.dampingShare;
    return pair;
  }

  /// GrainStep::touchNeighbour() of the contacts from c on. Rows of forces and torques replace those of motion.
  GROUSER_SIMD void computeContacts(int c, const ForceData<float>& f) {
    Float rows[4], relative[4], turning[4], theirs[4], spring[4];
    base::loadRows(apart_ + c, rows);
    base::loadRows(moving_ + c, relative), base::loadRows(turning_ + c, turning);
    if (kBothSpins) base::loadRows(theirs_ + c, theirs);
    Vec shear{};
    if (kWithFriction) base::loadRows(spring_ + c, spring), shear = firstThree(spring);

    const base::Vec3<Int> apart{base::bitsAs<Int>(rows[0]), base::bitsAs<Int>(rows[1]), base::bitsAs<Int>(rows[2])};
    const Long x = base::convert<std::int64_t>(apart.x), y = base::convert<std::int64_t>(apart.y),
               z = base::convert<std::int64_t>(apart.z);
    const Long distance2 = x * x + y * y + z * z;
    const Pair both = pairOf(turning[3], relative[3], f);
    const auto pair = contact::spherePair<Float>(
        {base::convert<float>(apart.x), base::convert<float>(apart.y), base::convert<float>(apart.z)},
        base::convert<float>(distance2), base::convert<float>(both.reach2 - distance2), both.reach, f.unit);
    Float lever = 0.5f * pair.distance;
    if (kManySizes) lever = both.ownRadius - 0.5f * pair.overlap;
    const Vec arm = pair.normal * lever;
    Vec velocity = firstThree(relative);
    Vec spin{};
    if (kBothSpins) spin = firstThree(turning) - firstThree(theirs);
    if (kManySizes)
      velocity += cross(firstThree(turning) * lever + firstThree(theirs) * (both.otherRadius - 0.5f * pair.overlap),
                        pair.normal);
    else
      velocity += cross(kBothSpins ? firstThree(turning) + firstThree(theirs) : firstThree(turning), arm);
    Float radius = base::broadcast<Float>(0.5f * f.radius);
    if (kManySizes) radius = both.ownRadius * both.otherRadius / (both.ownRadius + both.otherRadius);
    const contact::BasicContactGeometry<Float> touch{pair.normal, pair.overlap, velocity,
                                                     both.mass,   radius,       both.dampingShare};
    Float dents[4] = {};
    if (kYields) base::loadRows(dent_ + c, dents);
    contact::BasicPlasticState<Float> dent{dents[0], dents[1]};
    const auto reaction = contact::contactForce<kLaw>(f.law, touch, f.timeStep, shear, kYields ? &dent : nullptr);
    if (kYields) {
      dents[0] = dent.deepest, dents[1] = dent.origin, dents[2] = both.share * reaction.yielded;
    }
    if (kSlips) dents[3] = both.share * reaction.slipped;
    if (kYields || kSlips) base::storeRows(dent_ + c, dents);
    if (kWithFriction) {
      spring[0] = shear.x, spring[1] = shear.y, spring[2] = shear.z,
      spring[3] = kWithLedger ? both.share * reaction.rubbed : Float{};
      base::storeRows(spring_ + c, spring);
    }
    if (kWithRolling) roll(c, f, both, {pair.normal, spin, radius, Float{}}, reaction);
    const Vec torque = cross(arm, reaction.force);
    Float forces[4] = {reaction.force.x, reaction.force.y, reaction.force.z,
                       kWithLedger ? both.share * reaction.damped : Float{}};
    Float torques[4] = {torque.x, torque.y, torque.z, pair.overlap};
    base::storeRows(moving_ + c, forces), base::storeRows(turning_ + c, torques);
  }

  /// Rolling resistance of these contacts: rows of torques, and what is dissipated, replace those of places.
  GROUSER_SIMD void roll(int c, const ForceData<float>& f, const Pair& both, contact::RollingMotion<Float> motion,
                         const contact::BasicReaction<Float>& reaction) {
    if (kManySizes)
      motion.inertia = contact::rollingInertia(both.ownMass, both.ownRadius, both.otherMass, both.otherRadius);
    else
      motion.inertia = base::broadcast<Float>(contact::rollingInertia(f.mass, f.radius, f.mass, f.radius));
    if (hasFixed())
      motion.inertia = both.share > 0.75f ? contact::rollingInertia(both.ownMass, both.ownRadius) : motion.inertia;
    Float rows[4];
    base::loadRows(angle_ + c, rows);
    Vec angle = firstThree(rows);
    Float rolled{};
    const Vec torque = contact::rollingTorque(f.law, motion, reaction.pressing, reaction.normalStiffness, f.timeStep,
                                              angle, rolled, kFeatures & contact::kHertz ? &reaction.change : nullptr);
    rows[0] = angle.x, rows[1] = angle.y, rows[2] = angle.z;
    base::storeRows(angle_ + c, rows);
    Float torques[4] = {torque.x, torque.y, torque.z, kWithLedger ? both.share * rolled : Float{}};
    base::storeRows(apart_ + c, torques);
  }

  /// Of the contacts of a grain; fourth numbers as in rows.
  struct Sum {
    Float4 force{}, torque{}, most{}, rubbed{}, rolled{}, dented{};
  };
  /// Contact c, where `there`.
  GROUSER_SIMD void add(int c, const Int4& there, Sum& sum) const {
    const auto row = [&](const Float4* rows) { return base::bitsAs<Float4>(base::bitsAs<Int4>(rows[c]) & there); };
    const Float4 turning = row(turning_);
    if (kWithFriction && kWithLedger) sum.rubbed += row(spring_);
    if ((kYields && kWithLedger) || kSlips) sum.dented += row(dent_);
    sum.force += row(moving_);
    sum.torque += turning;
    if (kWithRolling) {
      const Float4 rolling = row(apart_);
      sum.torque += rolling, sum.rolled += rolling;
    }
    sum.most = turning > sum.most ? turning : sum.most;
  }
  /// What acts on one grain.
  GROUSER_SIMD void sum(int g, int i) {
    if (hasFixed()) {
      if (data_.motion[i].velocity.w < 0) return advance_.addDone(g, i), letStay(data_, forces_, i, books_);
      if (kWithLedger) bookHeldContacts(g, i);
    }
    Sum all;
    const int first = begin_[g], n = begin_[g + 1] - first;
    // Without a branch for the most frequent numbers, which the processor would often foretell wrongly: to add zero
    // changes no sum that began with one.
#pragma GCC unroll 6
    for (int k = 0; k < kUsual; ++k) add(first + k, Int4{} + n > k, all);
    for (int k = kUsual; k < n; ++k) add(first + k, ~Int4{}, all);
    Float4 force = all.force, torque = all.torque;
    const float damped = force[3];
    if (kYields && kWithLedger && all.dented[2] != 0) bookYielded(data_, i, all.dented[2]);
    const std::uint32_t place = data_.features & kBoundaries ? data_.boundaryOf[i] : 0;
    if (place != 0) {
      const BoundaryLoad<float>& load = forces_.boundaryLoads[place - 1];
      force += base::load3(&load.force), torque += base::load3(&load.torque);
      const float radius = kManySizes ? data_.motion[i].velocity.w : forces_.radius;
      if (load.deepest > data_.maxSurfaceShare * radius) raiseThrough(data_, forces_, i);
    }
    force[3] = damped, torque[3] = samePlace_[g] ? data_.diameter : all.most[3];
    advance_.add(g, i, force, torque, all.rubbed[3], all.rolled[3], all.dented[3]);
    const bool pressed = data_.features & kSurfaces && place != 0,
               loaded = data_.features & kLoads && data_.loads.range[i] != 0;
    if (atSide_[g] || pressed || loaded) [[unlikely]]
      addOthers(g, i, pressed ? place : 0, loaded, force, torque);
  }
  /// What acts in double: surfaces that move and parts.
  GROUSER_SIMD void addOthers(int g, int i, std::uint32_t place, bool loaded, const Float4& force,
                              const Float4& torque) {
    Double4 f4 = base::toDouble(force), t4 = base::toDouble(torque);
    if (!kWithFriction) t4 = Double4{};
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

  /// Forces by grains that never move.
  GROUSER_SIMD void bookHeldContacts(int g, int i) {
    Float4 force{}, torque{};
    bool any = false;
    for (int c = begin_[g]; c < begin_[g + 1]; ++c)
      if (data_.motion[other_[c]].velocity.w < 0) {
        any = true, force += moving_[c];
        torque += kWithRolling ? turning_[c] + apart_[c] : turning_[c];
      }
    if (!any) return;
    if (!kWithFriction) torque = Float4{};
    bookHeld(data_, forces_, i, {force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]}, books_);
  }

  const GrainKernelData& data_;
  const ForceData<float>& forces_;
  GrainBooks books_; ///< of what is rare
  Advance advance_;
  int grains_ = 0, contacts_ = 0;
  int begin_[kGrains + 1];
  bool samePlace_[kGrains], atSide_[kGrains];
  // Of the block's contacts, and as many more as the last lanes may read and write for nothing.
  static constexpr int kRows = kContacts + std::max(8, kWidth);
  alignas(64) Float4 apart_[kRows], moving_[kRows], turning_[kRows], theirs_[kRows], spring_[kRows], angle_[kRows],
      dent_[kRows];                                          ///< plastic state, what yields, what is slipped
  std::uint32_t grain_[kRows], other_[kRows], entry_[kRows]; ///< slots of both, place in the neighbour list
};

namespace {

/// One kernel. Not inlined, so that its machine code does not depend on the number of kernels; internal linkage, so
/// that the linker cannot replace it with the copy of another instruction set.
template <int kWidth, unsigned kFeatures> __attribute__((noinline, flatten)) void
runOf(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  GrainSimd<kWidth, kFeatures> some(d, f);
  some.run(first, last);
  if (kFeatures & kLedger) addToBooks(d, first, some.books());
}

} // namespace

template <int kWidth, std::size_t... kPlace> GROUSER_SIMD void runCompiled(unsigned features, const GrainKernelData& d,
                                                                           const ForceData<float>& f, int first,
                                                                           int last, std::index_sequence<kPlace...>) {
  ((features == kSimdKernels[kPlace] ? runOf<kWidth, kSimdKernels[kPlace]>(d, f, first, last) : void()), ...);
}

/// Picks the features that are known at compile time; all others are asked for as a step runs.
template <int kWidth>
GROUSER_SIMD void runSimd(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  runCompiled<kWidth>(d.features & kSimdCompiled, d, f, first, last, std::make_index_sequence<kSimdKernels.size()>{});
}

} // namespace grouser::terrain::detail
