// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/detail/lane_vectors.hpp"
#include "terrain/grain_simd.hpp"

namespace grouser::terrain::detail {

/// The step of grains k in [first, last) of a launch, kWidth contacts side by side. It takes the grains in blocks whose
/// contacts fit into the processor's first cache, and each block in four sweeps:
///
///   find     which candidates touch, several of one grain at a time;
///   collect  what the law needs of each contact, as rows of four numbers;
///   press    the law, kWidth contacts at a time, without a branch: nobody can foresee which of them slide;
///   advance  grain by grain: the sum of its contacts in the order of the neighbours' ids, and the step, with the three
///            axes side by side.
///
/// GrainStep, contactForce() and addCompensated() say what is computed and why. Here the same operations act on the
/// same numbers in the same order; where those functions branch, both sides are computed and one is taken. So the bits
/// are theirs. What is rare goes to GrainStep itself.
///
/// This is compiled for processors that may not be there: it calls nothing that is not inlined, lest a copy made for
/// wide registers serve the whole program.
template <int kWidth, bool kWithFriction, bool kWithLedger> class GrainSimd {
public:
  GROUSER_LANE_FUNCTION GrainSimd(const GrainKernelData& data, const ForceData<float>& forces) : d(data), f(forces) {}

  GROUSER_LANE_FUNCTION void run(int first, int last) {
    for (int k = first; k < last;) {
      const int from = k;
      grains_ = contacts_ = 0;
      do find(k++);
      while (k < last && grains_ < kGrains && contacts_ + candidatesOf(k) <= kContacts);
      begin_[grains_] = contacts_;
      for (int c = 0; c < contacts_; ++c) collect(c);
      for (int c = 0; c < contacts_; c += kWidth) press(c);
      if (kWithFriction)
        for (int c = 0; c < contacts_; ++c) store3(d.neighbours.history + 3 * std::size_t{entry_[c]}, spring_[c]);
      for (int g = 0; g < grains_; ++g) advance(g, slotOf(from + g));
    }
  }

private:
  using Float = Lanes<kWidth>;
  using Vec = base::Vec3<Float>;
  static constexpr int kGrains = 64, kContacts = 192; ///< of a block
  static constexpr int kFound = kWidth < 8 ? 4 : 8;   ///< candidates that are tried side by side
  using Found = IntLanes<kFound>;

  GROUSER_LANE_FUNCTION int slotOf(int k) const { return d.active ? static_cast<int>(d.active[k]) : k; }
  GROUSER_LANE_FUNCTION int candidatesOf(int k) const { return static_cast<int>(d.neighbours.count[slotOf(k)]); }

  /// Appends the contacts of the k-th grain to the block.
  GROUSER_LANE_FUNCTION void find(int k) {
    const int i = slotOf(k), n = candidatesOf(k);
    const std::uint32_t row = d.neighbours.start[i]; // its places follow each other
    const std::uint32_t* const slot = d.neighbours.slot + row;
    const Int4 p = load<Int4>(d.position + i);
    // Squares of distances in float are right to 5 roundings, 3e-7: beyond this margin they decide.
    const auto reach2 = static_cast<float>(d.diameterUnits2);
    const float surely2 = reach2 * (1 - 2e-6f), perhaps2 = reach2 * (1 + 2e-6f);
    Found lane;
    for (int l = 0; l < kFound; ++l) lane[l] = l;

    std::uint64_t now = 0;
    int c = contacts_;
    begin_[grains_] = c;
    samePlace_[grains_] = false;
    for (int m = 0; m < n; m += kFound) {
      Found other[4];
      gatherRows<kFound>(d.position, slot + m, other);
      const auto x = __builtin_convertvector(other[0] - p[0], Lanes<kFound>);
      const auto y = __builtin_convertvector(other[1] - p[1], Lanes<kFound>);
      const auto z = __builtin_convertvector(other[2] - p[2], Lanes<kFound>);
      const auto distance2 = x * x + y * y + z * z;
      const unsigned inRow = n - m < kFound ? (1u << (n - m)) - 1 : (1u << kFound) - 1;
      const auto open = ((distance2 < perhaps2) & (distance2 >= surely2)) | (distance2 == 0.0f);
      unsigned touching = bitsSet(distance2 < surely2) & inRow;
      if (const unsigned undecided = bitsSet(open) & inRow) [[unlikely]]
        touching = decide(i, slot + m, touching, undecided);
      storeMarked<kFound>(other_ + c, load<Found>(slot + m), touching);
      storeMarked<kFound>(entry_ + c, lane + static_cast<std::int32_t>(row + m), touching);
      store(grain_ + c, Found{} + i);
      now |= std::uint64_t{touching} << m;
      c += __builtin_popcount(touching);
    }
    std::uint64_t& before = d.neighbours.touching[i];
    if (kWithFriction) // springs of contacts that begin are not stretched yet
      for (std::uint64_t begun = now & ~before; begun != 0; begun &= begun - 1)
        store3(d.neighbours.history + 3 * (row + __builtin_ctzll(begun)), Float4{});
    before = now;
    contacts_ = c;
    ++grains_;
  }

  /// Corrects those bits of `touching` that are set in `open`, by exact squares.
  GROUSER_LANE_FUNCTION unsigned decide(int i, const std::uint32_t* slot, unsigned touching, unsigned open) {
    const Int4 p = load<Int4>(d.position + i);
    for (; open != 0; open &= open - 1) {
      const int l = __builtin_ctz(open);
      const std::int64_t distance2 = squareOf(load<Int4>(d.position + slot[l]) - p);
      touching &= ~(1u << l);
      if (distance2 == 0)
        samePlace_[grains_] = true;
      else if (distance2 < d.diameterUnits2)
        touching |= 1u << l;
    }
    return touching;
  }
  GROUSER_LANE_FUNCTION static std::int64_t squareOf(const Int4& v) {
    const std::int64_t x = v[0], y = v[1], z = v[2];
    return x * x + y * y + z * z;
  }

  /// The rows of contact c: what tells the two grains apart.
  GROUSER_LANE_FUNCTION void collect(int c) {
    const std::uint32_t i = grain_[c], j = other_[c];
    store(apart_ + c, load<Int4>(d.position + j) - load<Int4>(d.position + i));
    store(moving_ + c, load<Float4>(d.velocity + i) - load<Float4>(d.velocity + j));
    store(turning_ + c, load<Float4>(d.spin + i) + load<Float4>(d.spin + j));
    if (kWithFriction) spring_[c] = load3(d.neighbours.history + 3 * std::size_t{entry_[c]});
  }

  GROUSER_LANE_FUNCTION static Vec firstThree(const Float (&r)[4]) { return {r[0], r[1], r[2]}; }

  /// contactForce() of linear springs on the contacts from c on; see there for the formulas. Rows of forces and torques
  /// replace those of motion.
  GROUSER_LANE_FUNCTION void press(int c) {
    Float apart[4], moving[4], turning[4];
    loadRows<kWidth>(apart_ + c, apart);
    loadRows<kWidth>(moving_ + c, moving), loadRows<kWidth>(turning_ + c, turning);
    const contact::BasicLaw<float>& law = f.law;
    const Float zero{};

    const auto x = __builtin_convertvector(bitsOf<IntLanes<kWidth>>(apart[0]), LongLanes<kWidth>);
    const auto y = __builtin_convertvector(bitsOf<IntLanes<kWidth>>(apart[1]), LongLanes<kWidth>);
    const auto z = __builtin_convertvector(bitsOf<IntLanes<kWidth>>(apart[2]), LongLanes<kWidth>);
    const LongLanes<kWidth> distance2 = x * x + y * y + z * z;
    const Float distance = squareRoot(__builtin_convertvector(distance2, Float));
    const Float gap2 = __builtin_convertvector(d.diameterUnits2 - distance2, Float);
    const Float overlap = gap2 / (f.diameterUnits + distance) * f.unit;
    const auto wholeUnits = [](const Float& bits) {
      return __builtin_convertvector(bitsOf<IntLanes<kWidth>>(bits), Float);
    };
    const Vec n = Vec{wholeUnits(apart[0]), wholeUnits(apart[1]), wholeUnits(apart[2])} * (1.0f / distance);
    const Vec arm = n * (0.5f * (distance * f.unit));
    const Vec velocity = firstThree(moving) + cross(firstThree(turning), arm);

    const Float approach = dot(velocity, n);
    const Float elastic = law.stiffness * overlap;
    Float dashpot = law.damping * f.halfMass * approach;
    if (!law.attraction) dashpot = elastic + dashpot < 0.0f ? -elastic : dashpot;
    const Float pressing = elastic + dashpot;
    const float halfStepPerMass = 0.5f * f.timeStep / f.halfMass;
    Vec force = n * -pressing;
    Float dissipated = dashpot * (approach - pressing * halfStepPerMass) * f.timeStep;
    if (kWithFriction) {
      Float spring[4];
      loadRows<kWidth>(spring_ + c, spring);
      Vec shear = firstThree(spring);
      const float kt = law.tangentialStiffness, ct = law.tangentialDamping * f.halfMass;
      const Vec slip = velocity - n * approach;
      shear -= n * dot(shear, n);
      const Float storedBefore = kt * dot(shear, shear);
      shear += slip * Float(zero + f.timeStep);
      Vec tangential = shear * Float(zero - kt) - slip * Float(zero + ct);
      const Float limit = law.friction * (pressing > 0.0f ? pressing : zero);
      const Float size2 = dot(tangential, tangential);
      const auto slides = size2 > limit * limit;
      const Vec onCone = tangential * (limit / squareRoot(size2));
      const Vec shortened = kt > 0 ? onCone * Float(zero - 1.0f / kt) : Vec{};
      for (int a = 0; a < 3; ++a) {
        tangential[a] = slides ? onCone[a] : tangential[a];
        shear[a] = slides ? shortened[a] : shear[a];
        spring[a] = shear[a];
      }
      dissipated -= dot(tangential, slip) * f.timeStep + 0.5f * (kt * dot(shear, shear) - storedBefore);
      force += tangential;
      storeRows<kWidth>(spring_ + c, spring);
    }
    Float forces[4] = {force.x, force.y, force.z, 0.5f * dissipated};
    const Vec torque = cross(arm, force);
    Float torques[4] = {torque.x, torque.y, torque.z, overlap};
    storeRows<kWidth>(moving_ + c, forces), storeRows<kWidth>(turning_ + c, torques);
  }

  GROUSER_LANE_FUNCTION void advance(int g, int i) {
    Float4 force{}, torque{}, most{};
    for (int c = begin_[g]; c < begin_[g + 1]; ++c) {
      force += moving_[c];
      torque += turning_[c];
      most = turning_[c] > most ? turning_[c] : most;
    }
    float dissipated = force[3], deepest = samePlace_[g] ? d.diameter : most[3];
    if (const std::uint32_t place = d.features & kBoundaries ? d.boundaryOf[i] : 0) {
      const BoundaryLoad<float>& load = f.boundaryLoads[place - 1];
      force += load3(&load.force), torque += load3(&load.torque);
      dissipated += load.dissipated;
      if (load.deepest > deepest) deepest = load.deepest;
    }
    Double4 f4 = toDouble(force), t4 = toDouble(torque);
    if (!kWithFriction) t4 = Double4{};
    if (d.features & kLoads && d.loads.range[i] != 0) {
      base::Vec3d f3{f4[0], f4[1], f4[2]}, t3{t4[0], t4[1], t4[2]};
      addLoadsOf(d, f, i, f3, t3, dissipated, deepest);
      f4 = Double4{f3.x, f3.y, f3.z, 0}, t4 = Double4{t3.x, t3.y, t3.z, 0};
    }
    if (kWithLedger) d.dissipated[i] += static_cast<double>(dissipated);
    if (!advanceSimd(i, f4, t4, deepest)) advanceGrain(d, f, i, {f4[0], f4[1], f4[2]}, {t4[0], t4[1], t4[2]}, deepest);
  }

  /// addCompensated() of the axes. Remainders are counted in 2^-39 of the value's binade, both powers of two: dividing
  /// by one is multiplying by its inverse, to the last bit.
  GROUSER_LANE_FUNCTION static Double4 addKeepingOf(Float4& value, Int4& remainder, const Double4& increment) {
    const Double4 sum =
        toDouble(value) + toDouble(remainder) * (toDouble(bitsOf<Float4>(binadeOf(value))) * 0x1p-39) + increment;
    value = toFloat(sum);
    const Float4 perBinade = bitsOf<Float4>((254 << 23) - binadeOf(value));
    const Double4 rest = (sum - toDouble(value)) * (toDouble(perBinade) * 0x1p39);
    remainder = clamped(toInt(roundedDown(rest + 0.5)), -32768, 32767);
    return sum;
  }
  GROUSER_LANE_FUNCTION static Int4 binadeOf(const Float4& v) {
    const Int4 bits = bitsOf<Int4>(v) & 0x7F800000, least = Int4{} + (27 << 23);
    return bits < least ? least : bits;
  }

  /// GrainStep::advance() where nothing is out of the ordinary; else false, and nothing is done.
  GROUSER_LANE_FUNCTION bool advanceSimd(int i, const Double4& force, const Double4& torque, float deepest) {
    Float4 v = load<Float4>(d.velocity + i), w = load<Float4>(d.spin + i);
    const Int4 kept = load<Int4>(d.remainders + i);
    Int4 rv = kept << 16 >> 16, rw = kept >> 16;
    const Double4 gravity{d.gravityStep.x, d.gravityStep.y, d.gravityStep.z, 0};
    const Double4 speed = addKeepingOf(v, rv, force * d.stepPerMass + gravity);
    if (kWithFriction || d.features & kLoads) addKeepingOf(w, rw, torque * d.stepPerInertia);
    const Double4 displacement = speed * d.unitsPerSpeed;

    const float speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    // advanceKeeping()
    const Int4 places = Int4{kept[3], kept[3], kept[3], 0} << Int4{22, 12, 2, 0} >> 22; // ten bits each
    const Double4 wanted = displacement + toDouble(places) * (1.0 / 1024);
    const Double4 whole = roundedDown(wanted + 0.5);
    const Int4 r = clamped(toInt(roundedDown((wanted - whole) * 1024.0 + 0.5)), -512, 511) & 0x3FF;
    const Int4 p = load<Int4>(d.position + i);
    const Int4 units = toInt(whole) & Int4{-1, -1, -1, 0};
    const Int4 q = p + units;
    // The high words change where a low word passes its end.
    const Int4 passes = (bitsOf<Word4>(q) < bitsOf<Word4>(p)) ^ (units < 0);
    const auto near = (displacement > -1e9) & (displacement < 1e9);
    const bool ordinary = speed2 <= d.maxSpeed2 && speed2 < 1e30f && !(deepest > d.maxOverlap) &&
                          bitsSet(passes) == 0 && (bitsSet(near) & 7) == 7;
    if (!ordinary) return false;

    Int4 keep = (rv & 0xFFFF) | rw << 16;
    keep[3] = (kept[3] & ~0x3FFFFFFF) | r[0] | r[1] << 10 | r[2] << 20;
    v[3] = 0, w[3] = 0;
    store(d.nextPosition + i, q), store(d.nextVelocity + i, v), store(d.nextSpin + i, w);
    store(d.remainders + i, keep);
    if (squareOf(q - bitsOf<Int4>(load3(d.reference + i))) > d.halfSkinUnits2)
      __atomic_store_n(&d.flags->stale, 1u, __ATOMIC_RELAXED);
    return true;
  }

  const GrainKernelData& d;
  const ForceData<float>& f;
  int grains_ = 0, contacts_ = 0;
  int begin_[kGrains + 1];
  bool samePlace_[kGrains];
  // Of the block's contacts, and as many more as the last lanes may read and write for nothing.
  static constexpr int kRows = kContacts + kWidth;
  alignas(64) Float4 apart_[kRows], moving_[kRows], turning_[kRows], spring_[kRows];
  std::uint32_t grain_[kRows], other_[kRows], entry_[kRows]; ///< slots of both, place in the neighbour list
};

/// Picks the features that are known at compile time.
template <int kWidth>
GROUSER_LANE_FUNCTION void runLanes(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  const bool friction = d.features & contact::kFriction, ledger = d.features & kLedger;
  if (friction && ledger)
    GrainSimd<kWidth, true, true>(d, f).run(first, last);
  else if (friction)
    GrainSimd<kWidth, true, false>(d, f).run(first, last);
  else if (ledger)
    GrainSimd<kWidth, false, true>(d, f).run(first, last);
  else
    GrainSimd<kWidth, false, false>(d, f).run(first, last);
}

} // namespace grouser::terrain::detail
