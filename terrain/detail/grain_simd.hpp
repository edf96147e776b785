// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd_rows.hpp"
#include "contact/sphere_pair.hpp"
#include "terrain/grain_simd.hpp"

namespace grouser::terrain::detail {

using base::Double4;
using base::Float4;
using base::Int4;
using base::load;
using base::Simd;
using base::store;

/// The step of grains k in [first, last) of a launch, kWidth contacts side by side. It takes the grains in blocks whose
/// contacts fit into the processor's first cache, and each block in four sweeps:
///
///   find     which candidates touch, several of one grain at a time;
///   collect  what the law needs of each contact, as rows of four numbers;
///   contact  geometry and law, kWidth contacts at a time;
///   advance  grain by grain: the sum of its contacts in the order of the neighbours' ids, and the step, with the three
///            axes side by side.
///
/// The law is contact::contactForce() itself. GrainStep and addCompensated() say what else is computed and why; here
/// the same operations act on the same numbers in the same order, and where those functions branch, both sides are
/// computed and one is taken. So the bits are theirs. What is rare goes to GrainStep itself.
///
/// This is compiled for processors that may not be there: it calls nothing that is not inlined, lest a copy made for
/// wide registers serve the whole program.
template <int kWidth, bool kWithFriction, bool kWithLedger> class GrainSimd {
public:
  GROUSER_SIMD GrainSimd(const GrainKernelData& data, const ForceData<float>& forces) : data_(data), forces_(forces) {}

  /// Of the grains that have been advanced.
  GROUSER_SIMD GrainBooks books() const {
    GrainBooks books = books_;
    for (int l = 0; l < 4; ++l) {
      books.of[kWork] += work_[l], books.of[kTurnover] += turnover_[l];
      books.of[kDamped] += damped_[l], books.of[kRubbed] += rubbed_[l];
      for (int a = 0; a < 3; ++a) books.of[kMoment + a] += moment_[a][l];
    }
    books.of[kMass] += advanced_ * kMassQuanta;
    return books;
  }

  GROUSER_SIMD void run(int first, int last) {
    // A copy that no store can change: what follows from it alone is worked out once, not for each contact.
    const ForceData<float> f = forces_;
    for (int k = first; k < last;) {
      const int from = k;
      grains_ = contacts_ = toBook_ = 0;
      do find(k++);
      while (k < last && grains_ < kGrains && contacts_ + candidatesOf(k) <= kContacts);
      begin_[grains_] = contacts_;
      for (int c = 0; c < contacts_; ++c) collect(c);
      for (int c = contacts_; c % kWidth != 0; ++c) // lanes of the last group that no contact takes
        apart_[c] = moving_[c] = turning_[c] = spring_[c] = Float4{};
      for (int c = 0; c < contacts_; c += kWidth) computeContacts(c, f);
      if (kWithFriction)
        for (int c = 0; c < contacts_; ++c) base::store3(springOf(entry_[c]), spring_[c]);
      for (int g = 0; g < grains_; ++g) advance(g, slotOf(from + g));
      if (kWithLedger) bookAll();
    }
  }

private:
  using Float = Simd<float, kWidth>;
  using Int = Simd<std::int32_t, kWidth>;
  using Long = Simd<std::int64_t, kWidth>;
  using Long4 = Simd<std::int64_t, 4>;
  using Vec = base::Vec3<Float>;
  static constexpr unsigned kLaw = kWithFriction ? contact::kFriction : 0u;
  static constexpr int kGrains = 64, kContacts = 192; ///< of a block
  static constexpr int kFound = kWidth < 8 ? 4 : 8;   ///< candidates that are tried side by side
  using Found = Simd<std::int32_t, kFound>;

  GROUSER_SIMD bool hasFixed() const { return data_.features & kFixed; }
  GROUSER_SIMD int slotOf(int k) const { return data_.active ? static_cast<int>(data_.active[k]) : k; }
  GROUSER_SIMD int candidatesOf(int k) const { return static_cast<int>(data_.neighbours.count[slotOf(k)]); }

  /// History of a place of the neighbour list.
  GROUSER_SIMD float* springOf(std::uint32_t entry) const {
    return data_.neighbours.history + contact::historyWidth(contact::kFriction) * std::size_t{entry};
  }

  /// Appends the contacts of the k-th grain to the block.
  GROUSER_SIMD void find(int k) {
    const int i = slotOf(k), n = candidatesOf(k);
    const std::uint32_t row = data_.neighbours.start[i]; // its places follow each other
    const std::uint32_t* const slot = data_.neighbours.slot + row;
    const Int4 p = load<Int4>(data_.position + i);
    // Squares of distances in float are right to 5 roundings, 3e-7: beyond this margin they decide.
    const auto reach2 = static_cast<float>(data_.diameterUnits2);
    const float surely2 = reach2 * (1 - 2e-6f), perhaps2 = reach2 * (1 + 2e-6f);
    Found lane;
    for (int l = 0; l < kFound; ++l) lane[l] = l;

    std::uint64_t now = 0;
    int c = contacts_;
    begin_[grains_] = c;
    samePlace_[grains_] = false;
    for (int m = 0; m < n; m += kFound) {
      Found other[4];
      base::gatherRows<kFound>(data_.position, slot + m, other);
      const auto x = base::convert<float>(other[0] - p[0]);
      const auto y = base::convert<float>(other[1] - p[1]);
      const auto z = base::convert<float>(other[2] - p[2]);
      const auto distance2 = x * x + y * y + z * z;
      const unsigned inRow = n - m < kFound ? (1u << (n - m)) - 1 : (1u << kFound) - 1;
      const auto open = ((distance2 < perhaps2) & (distance2 >= surely2)) | (distance2 == 0.0f);
      unsigned touching = base::laneBits(distance2 < surely2) & inRow;
      if (const unsigned undecided = base::laneBits(open) & inRow) [[unlikely]]
        touching = decide(i, slot + m, touching, undecided);
      base::storeMarked(other_ + c, load<Found>(slot + m), touching);
      base::storeMarked(entry_ + c, lane + static_cast<std::int32_t>(row + m), touching);
      store(grain_ + c, Found{} + i);
      now |= std::uint64_t{touching} << m;
      c += __builtin_popcount(touching);
    }
    std::uint64_t& before = data_.neighbours.touching[i];
    if (kWithFriction) // springs of contacts that begin are not stretched yet
      for (std::uint64_t begun = now & ~before; begun != 0; begun &= begun - 1)
        base::store3(springOf(row + static_cast<std::uint32_t>(__builtin_ctzll(begun))), Float4{});
    before = now;
    contacts_ = c;
    ++grains_;
  }

  /// Corrects those bits of `touching` that are set in `open`, by exact squares.
  GROUSER_SIMD unsigned decide(int i, const std::uint32_t* slot, unsigned touching, unsigned open) {
    const Int4 p = load<Int4>(data_.position + i);
    for (; open != 0; open &= open - 1) {
      const int l = __builtin_ctz(open);
      const std::int64_t distance2 = squareOf(load<Int4>(data_.position + slot[l]) - p);
      touching &= ~(1u << l);
      if (distance2 == 0)
        samePlace_[grains_] = true;
      else if (distance2 < data_.diameterUnits2)
        touching |= 1u << l;
    }
    return touching;
  }
  GROUSER_SIMD static std::int64_t squareOf(const Int4& v) {
    const std::int64_t x = v[0], y = v[1], z = v[2];
    return x * x + y * y + z * z;
  }

  /// The rows of contact c: what tells the two grains apart.
  GROUSER_SIMD void collect(int c) {
    const std::uint32_t i = grain_[c], j = other_[c];
    store(apart_ + c, load<Int4>(data_.position + j) - load<Int4>(data_.position + i));
    // Of grains of one radius the fourth number is 1 where j never moves, else 0.
    store(moving_ + c, load<Float4>(data_.velocity + i) - load<Float4>(data_.velocity + j));
    store(turning_ + c, load<Float4>(data_.spin + i) + load<Float4>(data_.spin + j));
    if (kWithFriction) spring_[c] = base::load3(springOf(entry_[c]));
  }

  GROUSER_SIMD static Vec firstThree(const Float (&r)[4]) { return {r[0], r[1], r[2]}; }

  /// GrainStep::touchNeighbour() of the contacts from c on. Rows of forces and torques replace those of motion.
  GROUSER_SIMD void computeContacts(int c, const ForceData<float>& f) {
    Float rows[4], relative[4], turning[4], spring[4];
    base::loadRows(apart_ + c, rows);
    base::loadRows(moving_ + c, relative), base::loadRows(turning_ + c, turning);
    Vec shear{};
    if (kWithFriction) base::loadRows(spring_ + c, spring), shear = firstThree(spring);

    const base::Vec3<Int> apart{base::bitsAs<Int>(rows[0]), base::bitsAs<Int>(rows[1]), base::bitsAs<Int>(rows[2])};
    const Long x = base::convert<std::int64_t>(apart.x), y = base::convert<std::int64_t>(apart.y),
               z = base::convert<std::int64_t>(apart.z);
    const Long distance2 = x * x + y * y + z * z;
    const auto pair = contact::spherePair<Float>(
        {base::convert<float>(apart.x), base::convert<float>(apart.y), base::convert<float>(apart.z)},
        base::convert<float>(distance2), base::convert<float>(data_.diameterUnits2 - distance2), f.diameterUnits,
        f.unit);
    const Vec arm = pair.normal * (0.5f * pair.distance);

    const Vec velocity = firstThree(relative) + cross(firstThree(turning), arm);
    Float mass = base::broadcast<Float>(f.halfMass), share = base::broadcast<Float>(0.5f);
    if (hasFixed()) {
      const auto fixed = relative[3] > 0.5f;
      mass = fixed ? base::broadcast<Float>(f.mass) : mass, share = fixed ? base::broadcast<Float>(1) : share;
    }
    const contact::BasicContactGeometry<Float> touch{pair.normal, pair.overlap, velocity, mass,
                                                     base::broadcast<Float>(0.5f * f.radius)};
    const auto reaction = contact::contactForce<kLaw>(f.law, touch, f.timeStep, shear);
    if (kWithFriction) {
      spring[0] = shear.x, spring[1] = shear.y, spring[2] = shear.z,
      spring[3] = kWithLedger ? share * reaction.rubbed : Float{};
      base::storeRows(spring_ + c, spring);
    }
    const Vec torque = cross(arm, reaction.force);
    Float forces[4] = {reaction.force.x, reaction.force.y, reaction.force.z,
                       kWithLedger ? share * reaction.damped : Float{}};
    Float torques[4] = {torque.x, torque.y, torque.z, pair.overlap};
    base::storeRows(moving_ + c, forces), base::storeRows(turning_ + c, torques);
  }

  GROUSER_SIMD void advance(int g, int i) {
    if (hasFixed()) {
      if (data_.velocity[i].w < 0) return letStay(data_, forces_, i);
      if (kWithLedger) bookHeldContacts(g, i);
    }
    Float4 force{}, torque{}, most{};
    float rubbed = 0;
    for (int c = begin_[g]; c < begin_[g + 1]; ++c) {
      if (kWithFriction && kWithLedger) rubbed += spring_[c][3];
      force += moving_[c];
      torque += turning_[c];
      most = turning_[c] > most ? turning_[c] : most;
    }
    float deepest = samePlace_[g] ? data_.diameter : most[3];
    if (const std::uint32_t place = data_.features & kBoundaries ? data_.boundaryOf[i] : 0) {
      const BoundaryLoad<float>& load = forces_.boundaryLoads[place - 1];
      force += base::load3(&load.force), torque += base::load3(&load.torque);
      if (load.deepest > data_.maxSurfaceShare * forces_.radius) deepest = kThrough;
    }
    Double4 f4 = base::toDouble(force), t4 = base::toDouble(torque);
    if (!kWithFriction) t4 = Double4{};
    if (data_.features & kLoads && data_.loads.range[i] != 0) {
      base::Vec3d f3{f4[0], f4[1], f4[2]}, t3{t4[0], t4[1], t4[2]};
      addLoadsOf(data_, forces_, i, f3, t3, deepest);
      f4 = Double4{f3.x, f3.y, f3.z, 0}, t4 = Double4{t3.x, t3.y, t3.z, 0};
    }
    const Lost lost{static_cast<double>(force[3]), static_cast<double>(rubbed), 0};
    if (!advanceSimd(i, f4, t4, deepest, lost))
      advanceGrain(data_, forces_, i, {f4[0], f4[1], f4[2]}, {t4[0], t4[1], t4[2]}, deepest, lost, books_);
  }

  /// Forces by grains that never move.
  GROUSER_SIMD void bookHeldContacts(int g, int i) {
    Float4 force{}, torque{};
    bool any = false;
    for (int c = begin_[g]; c < begin_[g + 1]; ++c)
      if (data_.velocity[other_[c]].w < 0) any = true, force += moving_[c], torque += turning_[c];
    if (!any) return;
    if (!kWithFriction) torque = Float4{};
    bookHeld(data_, forces_, i, {force[0], force[1], force[2]}, {torque[0], torque[1], torque[2]});
  }

  /// addCompensated() of the axes. Remainders are counted in 2^-39 of the value's binade, both powers of two: dividing
  /// by one is multiplying by its inverse, to the last bit.
  struct CompensatedAxes {
    Double4 sum, rounding;
  };
  GROUSER_SIMD static CompensatedAxes addCompensatedAxes(Float4& value, Int4& remainder, const Double4& increment) {
    const Double4 sum =
        base::toDouble(value) +
        base::toDouble(remainder) * (base::toDouble(base::bitsAs<Float4>(binadeOf(value))) * kRemainderOfBinade) +
        increment;
    value = base::toFloat(sum);
    const Int4 binade = binadeOf(value);
    const Float4 perBinade = base::bitsAs<Float4>((254 << 23) - binade);
    const Double4 rest = (sum - base::toDouble(value)) * (base::toDouble(perBinade) * (1 / kRemainderOfBinade));
    remainder = base::clamped(base::toInt(base::roundedDown(rest + 0.5)), kLeastRemainder, kMostRemainder);
    return {sum,
            (base::toDouble(remainder) - rest) * (base::toDouble(base::bitsAs<Float4>(binade)) * kRemainderOfBinade)};
  }
  GROUSER_SIMD static Int4 binadeOf(const Float4& v) {
    const Int4 bits = base::bitsAs<Int4>(v) & 0x7F800000, least = base::broadcast<Int4>(kLeastBinade);
    return bits < least ? least : bits;
  }

  /// GrainStep::advance() where nothing is out of the ordinary; else false, and nothing is done.
  GROUSER_SIMD bool advanceSimd(int i, const Double4& force, const Double4& torque, float deepest, const Lost& lost) {
    Float4 v = load<Float4>(data_.velocity + i), w = load<Float4>(data_.spin + i);
    const Int4 kept = load<Int4>(data_.remainders + i);
    Int4 rv = kept << 16 >> 16, rw = kept >> 16;
    const Double4 gravity{data_.gravityStep.x, data_.gravityStep.y, data_.gravityStep.z, 0};
    const Double4 faster = force * data_.stepPerMass + gravity, turning = torque * data_.stepPerInertia;
    const CompensatedAxes speed = addCompensatedAxes(v, rv, faster);
    CompensatedAxes turn{};
    if (kWithFriction || data_.features & kLoads) turn = addCompensatedAxes(w, rw, turning);
    Double4 displacement = speed.sum * data_.unitsPerSpeed;
    const auto near = (displacement > -kMostUnitsPerStep) & (displacement < kMostUnitsPerStep);
    displacement = near ? displacement : Double4{}; // a speed that is no number must not reach the integer conversion

    const float speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    // advanceKeeping()
    const Int4 places = Int4{kept[3], kept[3], kept[3], 0} << Int4{22, 12, 2, 0} >> 22; // ten bits each
    const Double4 wanted = displacement + base::toDouble(places) * (1.0 / kPlacesPerUnit);
    const Double4 whole = base::roundedDown(wanted + 0.5);
    const Int4 r = base::clamped(base::toInt(base::roundedDown((wanted - whole) * double{kPlacesPerUnit} + 0.5)),
                                 kLeastPlace, kMostPlace) &
                   0x3FF;
    const Int4 p = load<Int4>(data_.position + i);
    const Int4 units = base::toInt(whole) & Int4{-1, -1, -1, 0};
    const Int4 q = p + units;
    // The high words change where a low word passes its end.
    const Int4 passes =
        (base::bitsAs<Simd<std::uint32_t, 4>>(q) < base::bitsAs<Simd<std::uint32_t, 4>>(p)) ^ (units < 0);
    const bool ordinary = speed2 <= data_.maxSpeed2 && speed2 < 1e30f && !(deepest > data_.maxOverlap) &&
                          base::laneBits(passes) == 0 && (base::laneBits(near) & 7) == 7;
    if (!ordinary) return false;

    if (kWithLedger) {
      Double4 work = halfSquaresGained(faster, speed) * data_.mass + halfSquaresGained(turning, turn) * data_.inertia;
      work[3] = lost.damped;
      workOf_[toBook_] = work, rubbedOf_[toBook_] = lost.rubbed, placeOf_[toBook_] = p;
      ++toBook_;
    }
    Int4 keep = (rv & 0xFFFF) | rw << 16;
    keep[3] = (kept[3] & ~0x3FFFFFFF) | r[0] | r[1] << 10 | r[2] << 20;
    v[3] = 0, w[3] = 0;
    store(data_.nextPosition + i, q), store(data_.nextVelocity + i, v), store(data_.nextSpin + i, w);
    store(data_.remainders + i, keep);
    if (squareOf(q - base::bitsAs<Int4>(base::load3(data_.reference + i))) > data_.halfSkinUnits2)
      __atomic_store_n(&data_.flags->stale, 1u, __ATOMIC_RELAXED);
    return true;
  }

  /// halfSquareGained() of the axes.
  GROUSER_SIMD static Double4 halfSquaresGained(const Double4& faster, const CompensatedAxes& now) {
    return faster * (now.sum - faster * 0.5) + now.rounding * now.sum;
  }

  /// GrainStep::book() of the block's grains, four side by side: one by one each would wait for the one before.
  GROUSER_SIMD void bookAll() {
    advanced_ += toBook_;
    for (int g = toBook_; g % 4 != 0; ++g) workOf_[g] = Double4{}, rubbedOf_[g] = 0, placeOf_[g] = Int4{};
    for (int g = 0; g < toBook_; g += 4) {
      Double4 work[4] = {workOf_[g], workOf_[g + 1], workOf_[g + 2], workOf_[g + 3]};
      base::transpose(work); // by axis; what is damped
      const Double4 all = (work[0] + work[2]) + work[1];
      work_ += quantaOf(all), turnover_ += quantaOf(all < 0.0 ? -all : all);
      damped_ += quantaOf(work[3]);
      if (kWithFriction) rubbed_ += quantaOf(load<Double4>(rubbedOf_ + g));
      Int4 place[4] = {placeOf_[g], placeOf_[g + 1], placeOf_[g + 2], placeOf_[g + 3]};
      base::transpose(place);
      for (int a = 0; a < 3; ++a) moment_[a] += axisOf(place[a], place[3], a);
    }
  }
  /// wholeQuanta() of four energies.
  GROUSER_SIMD Long4 quantaOf(const Double4& energies) const {
    const Double4 most = base::broadcast<Double4>(0x1p51), shift = base::broadcast<Double4>(0x1.8p52);
    Double4 quanta = energies * data_.bookScale.perEnergy;
    quanta = quanta > -most ? quanta : -most;
    quanta = quanta < most ? quanta : most;
    return base::bitsAs<Long4>(quanta + shift) - base::bitsAs<Long4>(shift);
  }
  /// base::axisOf() of four places.
  GROUSER_SIMD static Long4 axisOf(const Int4& low, const Int4& high, int axis) {
    const Int4 top = high << (22 - 10 * axis) >> 22;
    return base::convert<std::int64_t>(top) << 32 |
           base::convert<std::int64_t>(base::bitsAs<Simd<std::uint32_t, 4>>(low));
  }

  const GrainKernelData& data_;
  const ForceData<float>& forces_;
  GrainBooks books_; ///< of what is rare
  Long4 work_{}, turnover_{}, damped_{}, rubbed_{}, moment_[3] = {};
  std::int64_t advanced_ = 0; ///< grains
  int grains_ = 0, contacts_ = 0, toBook_ = 0;
  int begin_[kGrains + 1];
  bool samePlace_[kGrains];
  // Of the block's contacts, and as many more as the last lanes may read and write for nothing.
  static constexpr int kRows = kContacts + kWidth;
  alignas(64) Float4 apart_[kRows], moving_[kRows], turning_[kRows], spring_[kRows];
  std::uint32_t grain_[kRows], other_[kRows], entry_[kRows]; ///< slots of both, place in the neighbour list
  // Of the block's grains that wait to be booked.
  Double4 workOf_[kGrains]; ///< by axis, and what is damped
  double rubbedOf_[kGrains];
  Int4 placeOf_[kGrains];
};

template <class Some>
GROUSER_SIMD void runAndBook(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  Some some(d, f);
  some.run(first, last);
  addToBooks(d, first, some.books());
}

/// Picks the features that are known at compile time.
template <int kWidth>
GROUSER_SIMD void runSimd(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  const bool friction = d.features & contact::kFriction, ledger = d.features & kLedger;
  if (friction && ledger)
    runAndBook<GrainSimd<kWidth, true, true>>(d, f, first, last);
  else if (friction)
    GrainSimd<kWidth, true, false>(d, f).run(first, last);
  else if (ledger)
    runAndBook<GrainSimd<kWidth, false, true>>(d, f, first, last);
  else
    GrainSimd<kWidth, false, false>(d, f).run(first, last);
}

} // namespace grouser::terrain::detail
