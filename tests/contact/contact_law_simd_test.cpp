// SPDX-License-Identifier: BSD-3-Clause
// SIMD contact law: each lane is bitwise equal to a single contact.
#include "base/random.hpp"
#include "base/simd.hpp"
#include "contact/plastic_simd.hpp"
#include "contact/rolling_resistance.hpp"
#include "contact_fixture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>

namespace grouser::contact {
namespace {

using testing::hertz, testing::linear;

template <class T> using Geometry = BasicContactGeometry<T>;

/// Bit pattern of a number: -0 differs from 0. All NaNs have one pattern, since operands may be swapped.
std::uint64_t bitsOf(double x) {
  return std::bit_cast<std::uint64_t>(x == x ? x : std::numeric_limits<double>::quiet_NaN());
}

/// Contacts of all kinds: approaching and separating, sticking and sliding, tensile and new.
template <class T> struct RandomContacts {
  std::uint64_t count = 0;
  T in(double least, double most) { return static_cast<T>(least + (most - least) * base::uniform(7, 0, count++)); }
  base::Vec3<T> vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Geometry<T> contact() {
    return {base::normalized(vector(1)), in(1e-7, 1e-3), vector(in(0, 1) < T(0.5) ? 0.01 : 3), in(0.01, 1),
            in(0.002, 0.03)};
  }
};

template <unsigned kFeatures, int kWidth, class T> void expectLanesAsAlone(const BasicLaw<T>& law) {
  using Numbers = base::Simd<T, kWidth>;
  RandomContacts<T> random;
  int sliding = 0;
  for (int round = 0; round < 200; ++round) {
    std::array<Geometry<T>, kWidth> one;
    std::array<base::Vec3<T>, kWidth> spring;
    Geometry<Numbers> all{};
    base::Vec3<Numbers> springs{};
    for (std::size_t l = 0; l < kWidth; ++l) {
      one[l] = random.contact(), spring[l] = random.vector(1e-5);
      if (round == 7 && l == 1) one[l].velocity.x = std::numeric_limits<T>::quiet_NaN();
      for (int a = 0; a < 3; ++a) {
        all.normal[a][l] = one[l].normal[a], all.velocity[a][l] = one[l].velocity[a];
        springs[a][l] = spring[l][a];
      }
      all.overlap[l] = one[l].overlap;
      all.effectiveMass[l] = one[l].effectiveMass, all.effectiveRadius[l] = one[l].effectiveRadius;
    }
    const auto together = contactForce<kFeatures>(law, all, T(1e-5), springs);
    for (std::size_t l = 0; l < kWidth; ++l) {
      const auto alone = contactForce<kFeatures>(law, one[l], T(1e-5), spring[l]);
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(bitsOf(together.force[a][l]), bitsOf(alone.force[a])) << "lane " << l << ", axis " << a;
        EXPECT_EQ(bitsOf(springs[a][l]), bitsOf(spring[l][a]));
      }
      EXPECT_EQ(bitsOf(together.damped[l]), bitsOf(alone.damped));
      EXPECT_EQ(bitsOf(together.rubbed[l]), bitsOf(alone.rubbed));
      EXPECT_EQ(bitsOf(together.slipped[l]), bitsOf(alone.slipped));
      EXPECT_EQ(bitsOf(together.pressing[l]), bitsOf(alone.pressing));
      EXPECT_EQ(bitsOf(together.normalStiffness[l]), bitsOf(alone.normalStiffness));
      const base::Vec3<T> tangential = alone.force - one[l].normal * dot(alone.force, one[l].normal);
      sliding += norm(tangential) > T(0.999) * law.friction * alone.pressing;
    }
  }
  if (law.friction > 0) { // both kinds exist, often in adjacent lanes
    EXPECT_GT(sliding, 200 * kWidth / 20);
    EXPECT_LT(sliding, 200 * kWidth * 19 / 20);
  }
}

TEST(ContactLawSimd, LinearWithAndWithoutFriction) {
  expectLanesAsAlone<kFriction, 4>(linear<float>());
  expectLanesAsAlone<kFriction, 8>(linear<float>());
  expectLanesAsAlone<kFriction, 16>(linear<float>());
  expectLanesAsAlone<kFriction, 4>(linear<double>());
  BasicLaw<float> smooth = linear<float>();
  smooth.friction = 0;
  expectLanesAsAlone<0, 8>(smooth);
  BasicLaw<float> noSpring = linear<float>();
  noSpring.tangentialStiffness = 0;
  expectLanesAsAlone<kFriction, 8>(noSpring);
}

TEST(ContactLawSimd, AttractionHertzCohesionAndManyMasses) {
  BasicLaw<float> pulling = linear<float>();
  pulling.attraction = true;
  expectLanesAsAlone<kFriction, 8>(pulling);
  expectLanesAsAlone<kFriction | kHertz, 8>(hertz<float>());
  expectLanesAsAlone<kFriction | kHertz, 4>(hertz<double>());
  BasicLaw<float> sticky = hertz<float>();
  sticky.pullPerRadius = 2;
  expectLanesAsAlone<kFriction | kHertz | kCohesion, 8>(sticky);
  BasicLaw<float> many = linear<float>();
  many.damping = many.tangentialDamping = 0, many.rootDamping = 300, many.tangentialRootDamping = 100;
  expectLanesAsAlone<kFriction | kManyMasses, 8>(many);
  expectLanesAsAlone<kGeneral, 8>(many);
}

/// Contacts loaded, unloaded and separated at random: each visits every branch of the law.
template <int kWidth> void expectYieldingAsAlone(const BasicPlasticity<float>& p, bool isHertz, bool sticks = true) {
  using Numbers = base::Simd<float, kWidth>;
  RandomContacts<float> random;
  BasicPlasticState<Numbers> states{};
  std::array<BasicPlasticState<float>, kWidth> state{};
  BasicElasticSpring<Numbers> springs{5e7f, {}, isHertz};
  Numbers overlaps{};
  for (std::size_t l = 0; l < kWidth; ++l) springs.effectiveRadius[l] = random.in(0.002, 0.03);
  int loading = 0, unloading = 0, pulling = 0;
  for (int round = 0; round < 3000; ++round) {
    for (std::size_t l = 0; l < kWidth; ++l) {
      if (random.in(0, 1) < 0.02f) { // a new contact
        state[l] = {}, states.deepest[l] = states.origin[l] = 0;
        springs.effectiveRadius[l] = random.in(0.002, 0.03), overlaps[l] = random.in(1e-7, 1e-4);
      }
      const float next = overlaps[l] * random.in(0.7, 1.38);
      overlaps[l] = next > 1e-8f && next < 1e-3f ? next : 1e-5f;
    }
    const auto together = plasticForce(p, springs, overlaps, states);
    for (std::size_t l = 0; l < kWidth; ++l) {
      const BasicElasticSpring<float> spring{5e7f, springs.effectiveRadius[l], isHertz};
      const float overlap = overlaps[l];
      const auto alone = plasticForce(p, spring, overlap, state[l]);
      ASSERT_EQ(bitsOf(together.force[l]), bitsOf(alone.force)) << "round " << round << ", lane " << l;
      ASSERT_EQ(bitsOf(together.adhesion[l]), bitsOf(alone.adhesion)) << "round " << round << ", lane " << l;
      ASSERT_EQ(bitsOf(together.yielded[l]), bitsOf(alone.yielded)) << "round " << round << ", lane " << l;
      ASSERT_EQ(bitsOf(states.deepest[l]), bitsOf(state[l].deepest));
      ASSERT_EQ(bitsOf(states.origin[l]), bitsOf(state[l].origin));
      loading += alone.force == spring.force(overlap);
      pulling += alone.force < 0 && alone.force == -alone.adhesion;
      unloading += alone.force > 0 && alone.force < spring.force(overlap);
    }
  }
  const int tenth = 3000 * kWidth / 10;
  EXPECT_GT(loading, tenth);
  EXPECT_GT(unloading, tenth);
  EXPECT_TRUE(!sticks || pulling > tenth / 5) << pulling;
}

TEST(ContactLawSimd, ContactsThatYield) {
  BasicPlasticity<float> p{0.6f, 0.711f, 0.3f, 40, 0, 0, 0, 3};
  expectYieldingAsAlone<4>(p, true);
  expectYieldingAsAlone<8>(p, true);
  expectYieldingAsAlone<16>(p, true);
  expectYieldingAsAlone<8>({0.6f, 0.6f, 0.3f, 40, 0, 0, 0, 3}, false);
  p.pull = 0, p.pullGrowth = 4e3f, p.exponent = 10;
  expectYieldingAsAlone<16>(p, true);
  p.pullGrowth = 0;
  expectYieldingAsAlone<16>(p, true, false);
}

TEST(ContactLawSimd, LudingsContacts) {
  BasicPlasticity<float> p{0.6f, 0, 0, 0, 0, 0.01f, 0.5f, 2}; // the full depth lies among the overlaps
  expectYieldingAsAlone<4>(p, false);
  expectYieldingAsAlone<8>(p, false);
  expectYieldingAsAlone<16>(p, false);
  p.adhesion = 0;
  expectYieldingAsAlone<8>(p, false, false);
}

template <int kWidth, class T> void expectRollingAsAlone(T stiffness) {
  using Numbers = base::Simd<T, kWidth>;
  BasicLaw<T> law = linear<T>();
  law.rollingFriction = T(0.1), law.rollingDamping = T(0.3);
  RandomContacts<T> random;
  int limited = 0;
  for (int round = 0; round < 200; ++round) {
    RollingMotion<Numbers> all{};
    base::Vec3<Numbers> angles{};
    Numbers pressing{}, normal{}, lost{};
    std::array<RollingMotion<T>, kWidth> one;
    std::array<base::Vec3<T>, kWidth> angle;
    for (std::size_t l = 0; l < kWidth; ++l) {
      one[l] = {base::normalized(random.vector(1)), random.vector(random.in(0, 1) < T(0.5) ? 0.1 : 300),
                random.in(0.002, 0.03), random.in(1e-8, 1e-5)};
      angle[l] = random.vector(round % 3 ? 1e-4 : 1e-2);
      if (round == 7 && l == 1) one[l].spin.x = std::numeric_limits<T>::quiet_NaN();
      for (int a = 0; a < 3; ++a) {
        all.normal[a][l] = one[l].normal[a], all.spin[a][l] = one[l].spin[a], angles[a][l] = angle[l][a];
      }
      all.radius[l] = one[l].radius, all.inertia[l] = one[l].inertia;
      pressing[l] = random.in(-1, 10), normal[l] = stiffness, lost[l] = T(1e-3);
    }
    const auto stiffens = [](const auto& way) { // Hertz: as much as adding or removing a third of a contact
      using Way = std::remove_cvref_t<decltype(way)>;
      return hertzChange(base::broadcast<Way>(T(1e-4)), way);
    };
    Numbers ways{};
    for (std::size_t l = 0; l < kWidth; ++l) ways[l] = random.in(-3e-5, 3e-5);
    const auto changes = stiffens(ways);
    const bool hertz = round % 2 == 1;
    const auto together = rollingTorque(law, all, pressing, normal, T(1e-5), angles, lost, hertz ? &changes : nullptr);
    for (std::size_t l = 0; l < kWidth; ++l) {
      T taken = T(1e-3);
      const T pressed = pressing[l];
      const T way = ways[l];
      const auto change = stiffens(way);
      const auto alone =
          rollingTorque(law, one[l], pressed, stiffness, T(1e-5), angle[l], taken, hertz ? &change : nullptr);
      for (int a = 0; a < 3; ++a) {
        EXPECT_EQ(bitsOf(together[a][l]), bitsOf(alone[a])) << "lane " << l << ", axis " << a;
        EXPECT_EQ(bitsOf(angles[a][l]), bitsOf(angle[l][a]));
      }
      EXPECT_EQ(bitsOf(lost[l]), bitsOf(taken));
      limited += norm(alone) >= T(0.9999) * law.rollingFriction * one[l].radius * pressed;
    }
  }
  if (stiffness > 0) {
    EXPECT_GT(limited, 200 * kWidth / 20);
    EXPECT_LT(limited, 200 * kWidth * 19 / 20);
  }
}

TEST(ContactLawSimd, RollingResistance) {
  expectRollingAsAlone<4>(1e5f);
  expectRollingAsAlone<8>(1e5f);
  expectRollingAsAlone<16>(1e5f);
  expectRollingAsAlone<4>(1e5);
  expectRollingAsAlone<8>(0.0f);
}

} // namespace
} // namespace grouser::contact
