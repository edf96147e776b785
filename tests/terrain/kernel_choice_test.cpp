// SPDX-License-Identifier: BSD-3-Clause
// Kernel selection for grains, and whether a CPU computes several of their contacts in SIMD lanes.
#include "terrain/kernel_choice.hpp"

#include "terrain/detail/kernel_lists.hpp"

#include <gtest/gtest.h>

namespace grouser::terrain {
namespace {

using contact::kCohesion;
using contact::kFriction;
using contact::kGeneral;
using contact::kHertz;
using contact::kPlastic;
using contact::kRollingFriction;

constexpr unsigned kRoughBed = kFriction | kBoundaries | kLedger, kUnderVehicle = kRoughBed | kLoads,
                   kYielding = kUnderVehicle | kHertz | kRollingFriction | kPlastic;

/// Model of grains with friction; they yield by the EEPA law if their features include it.
GrainModel roughModel() {
  GrainModel m;
  m.law.friction = 0.5;
  m.law.plastic.share = 0.5;
  return m;
}

/// Whether such grains have a specialised SIMD kernel.
bool ownSimd(unsigned features) {
  const KernelChoice choice = stepKernel(features, roughModel());
  EXPECT_EQ(choice.noSimd, nullptr) << featureText(features);
  return !choice.simdGeneral();
}

TEST(KernelChoice, AllKernelsThatAreCompiledAreTaken) {
  const GrainModel m = roughModel();
  for (const unsigned features : detail::kStepKernels)
    for (const unsigned floor : {0u, kFloor})
      EXPECT_EQ(stepKernel(features | floor, m).compiledFor, features) << featureText(features);
  for (const unsigned features : detail::kBoundaryKernels)
    EXPECT_EQ(boundaryKernel(features | kBoundaries | kLoads | kFixed | kLedger, m).compiledFor, features)
        << featureText(features);
  for (const unsigned features : detail::kSimdKernels) {
    EXPECT_EQ(stepKernel(features, m).simdFor, features) << featureText(features);
    EXPECT_EQ(stepKernel(features | detail::kSimdAsked, m).simdFor, features) << featureText(features);
  }
}

TEST(KernelChoice, SoilsAndSurfacesHaveTheirOwn) {
  const GrainModel m = roughModel();
  for (const unsigned features :
       {kUnderVehicle | kManyRadii | kFixed, kUnderVehicle | kHertz | kManyRadii | kRollingFriction | kFixed,
        kRoughBed | kSurfaces | kRollingFriction, kRoughBed | kPeriodic | kManyRadii, kYielding | kManyRadii | kFixed})
    EXPECT_FALSE(stepKernel(features, m).general()) << featureText(features);
  for (const unsigned features : {kUnderVehicle | kManyRadii | kManyMaterials, kRoughBed | kCohesion,
                                  kUnderVehicle | kHertz | kGeneral, kRoughBed | kPeriodic | kSurfaces})
    EXPECT_TRUE(stepKernel(features, m).general()) << featureText(features);
}

TEST(KernelChoice, DoublePrecisionTakesTheGeneralKernelOneContactAtATime) {
  GrainModel m = roughModel();
  m.precision = Precision::double_;
  for (const KernelChoice& choice : {stepKernel(kUnderVehicle, m), boundaryKernel(kUnderVehicle, m)}) {
    EXPECT_TRUE(choice.general());
    EXPECT_EQ(choice.lanes, 1);
    EXPECT_STREQ(choice.noSimd, "double precision");
  }
  m = roughModel();
  m.specialised = false;
  EXPECT_TRUE(stepKernel(kUnderVehicle, m).general());
  EXPECT_TRUE(boundaryKernel(kUnderVehicle, m).general());
  EXPECT_EQ(stepKernel(kUnderVehicle, m).lanes, 1);
}

TEST(KernelChoice, WallsWithoutBooksAreCompiledForTheBenchAlone) {
  const GrainModel m = roughModel();
  EXPECT_FALSE(boundaryKernel(kFriction | kBoundaries, m).general());
  EXPECT_FALSE(boundaryKernel(kRoughBed | kRollingFriction, m).general());
  EXPECT_TRUE(boundaryKernel(kFriction | kBoundaries | kRollingFriction, m).general());
}

TEST(KernelChoice, LanesAreTheProcessorsAndAtMostThoseAllowed) {
  GrainModel m = roughModel();
#if defined(__x86_64__)
  EXPECT_GE(stepKernel(kUnderVehicle, m).lanes, 4);
  EXPECT_GE(boundaryKernel(kUnderVehicle, m).lanes, 4) << "planes alone";
  EXPECT_EQ(boundaryKernel(kUnderVehicle | kFloor, m).lanes, 1);
  m.maxSimdLanes = 4;
  EXPECT_EQ(stepKernel(kUnderVehicle, m).lanes, 4);
#endif
  m.maxSimdLanes = 1;
  EXPECT_EQ(stepKernel(kUnderVehicle, m).lanes, 1);
  EXPECT_EQ(stepKernel(kUnderVehicle, m).noSimd, nullptr);
}

TEST(KernelChoice, SimdHasItsOwnForCommonBedsAndTheGeneralOneForTheRest) {
  for (const unsigned feature : {0u, kHertz, kRollingFriction, kManyRadii, kPeriodic, kSurfaces, kFixed, kFloor,
                                 kHertz | kRollingFriction | kManyRadii | kPeriodic | kSurfaces | kFixed})
    EXPECT_TRUE(ownSimd(kUnderVehicle | feature));
  for (const unsigned features : {kUnderVehicle | kHertz | kCohesion, kLedger | kBoundaries, kYielding,
                                  kYielding | kCohesion | kManyRadii | kFixed, kYielding & ~kHertz})
    EXPECT_TRUE(ownSimd(features)) << featureText(features);
  for (const unsigned features :
       {kUnderVehicle | kCohesion, kUnderVehicle | kHertz | kGeneral, kUnderVehicle | kManyRadii | kManyMaterials,
        kYielding & ~kRollingFriction, kLedger | kBoundaries | kHertz})
    EXPECT_FALSE(ownSimd(features)) << featureText(features);
}

TEST(KernelChoice, WordsNameTheFeatureThatHasNoKernel) {
  GrainModel m = roughModel();
  const auto has = [&](unsigned features, const std::string& words) {
    const std::string text = stepKernelText(features, m);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  has(kRoughBed | kFloor, "linear, friction, planes or floor, ledger; single precision: specialised kernel; ");
  has(kRoughBed | kManyRadii | kManyMaterials, "general kernel, same results but slower; a specialised kernel exists "
                                               "without many materials; ");
#if defined(__x86_64__)
  has(kRoughBed | kManyRadii | kManyMaterials, "), general kernel");
  has(kRoughBed | kPeriodic | kSurfaces | kFixed | kCohesion, "slower; on this CPU"); // two changes are not suggested
#endif
  has(kUnderVehicle | kHertz | kGeneral, "linear and hertz, friction");
  has(kUnderVehicle | kHertz | kGeneral, "; a specialised kernel exists if all contacts are hertz;");
  m.precision = Precision::double_;
  has(kRoughBed, "double precision: general kernel; single precision has a specialised kernel; no SIMD");
  const std::string walls = boundaryKernelText(kUnderVehicle | kPeriodic | kFloor, roughModel());
  EXPECT_EQ(walls.find("linear, friction, height-map floor; single precision: specialised kernel; no SIMD on a CPU: "),
            0u)
      << walls;
}

} // namespace
} // namespace grouser::terrain
