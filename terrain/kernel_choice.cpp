// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/kernel_choice.hpp"

#include "terrain/detail/kernel_lists.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace grouser::terrain {

namespace {

using contact::kGeneral;
using detail::kCohesion;
using detail::kFriction;
using detail::kHertz;
using detail::kPlastic;
using detail::kRollingFriction;

/// SIMD lanes of the processor, at most `most`.
int processorLanes([[maybe_unused]] int most) {
#if defined(__x86_64__)
  // All instruction sets that the files are compiled for (CMakeLists.txt), not only the wide registers.
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  if (most >= 16 && avx2 && avx512) return 16;
  if (most >= 8 && avx2) return 8;
  if (most >= 4) return 4;
#endif
  return 1;
}

/// Selects a kernel from a list. `simd`: features of the SIMD kernel; `noSimd`: reason for its absence, or null.
template <class List>
KernelChoice chosen(const List& list, unsigned features, const GrainModel& model, unsigned simd, const char* noSimd) {
  if (!model.specialised) return {kGeneral, 1, "the general kernel is requested"};
  if (model.precision != Precision::single) return {kGeneral, 1, "double precision"};
  return {detail::isListed(list, features) ? features : kGeneral, noSimd ? 1 : processorLanes(model.maxSimdLanes),
          noSimd, simd};
}

struct FeatureName {
  unsigned feature;
  const char* name;
};
constexpr FeatureName kNames[] = {{kFriction, "friction"},
                                  {kRollingFriction, "rolling friction"},
                                  {kCohesion, "cohesion"},
                                  {kPlastic, "plastic"},
                                  {kManyRadii, "many radii"},
                                  {kManyMaterials, "many materials"},
                                  {kPeriodic, "periodic boundaries"},
                                  {kBoundaries, "planes or floor"},
                                  {kFloor, "height-map floor"},
                                  {kSurfaces, "moving surfaces"},
                                  {kFixed, "fixed grains"},
                                  {kLoads, "rigid parts"},
                                  {kLedger, "ledger"}};

const char* nameOf(unsigned feature) {
  return std::find_if(std::begin(kNames), std::end(kNames), [&](const FeatureName& n) { return n.feature == feature; })
      ->name;
}

/// Features that a scene may drop, the most likely first.
constexpr unsigned kDispensable[] = {kManyMaterials, kManyRadii,       kFixed,    kSurfaces,
                                     kPeriodic,      kRollingFriction, kCohesion, kPlastic};

/// Single change of features that permits a specialised kernel; empty if there is none.
template <class List> std::string remedy(const List& list, unsigned features, const GrainModel& model) {
  if (model.precision != Precision::single)
    return detail::isListed(list, features) ? "; single precision has a specialised kernel" : "";
  for (const unsigned law : {features & ~kGeneral, features & ~(kGeneral | kHertz)})
    if (features & kGeneral && detail::isListed(list, law))
      return fmt::format("; a specialised kernel exists if all contacts are {}", law & kHertz ? "hertz" : "linear");
  for (const unsigned feature : kDispensable)
    if (features & feature && detail::isListed(list, features & ~feature))
      return fmt::format("; a specialised kernel exists without {}", nameOf(feature));
  return "";
}

std::string simdText(const KernelChoice& choice) {
  if (choice.noSimd) return fmt::format("no SIMD on a CPU: {}", choice.noSimd);
  if (choice.lanes == 1) return "no SIMD on this CPU";
  const char* set = choice.lanes == 16 ? "AVX-512" : choice.lanes == 8 ? "AVX2" : "SSE2";
  return fmt::format("on this CPU SIMD, {} lanes ({}){}", choice.lanes, set,
                     choice.simdGeneral() ? ", general kernel" : "");
}

template <class List>
std::string kernelText(const List& list, unsigned features, const GrainModel& model, const KernelChoice& choice) {
  const bool single = model.precision == Precision::single;
  std::string kernel = "specialised kernel";
  if (choice.general())
    kernel =
        std::string("general kernel") + (single ? ", same results but slower" : "") + remedy(list, features, model);
  return fmt::format("{}; {} precision: {}; {}", featureText(features), single ? "single" : "double", kernel,
                     simdText(choice));
}

unsigned atStep(unsigned features) { return features & ~kFloor; }

unsigned atBoundaries(unsigned features) { return features & detail::kAtBoundaries; }

} // namespace

KernelChoice stepKernel(unsigned features, const GrainModel& model) {
  const unsigned own = atStep(features);
  return chosen(detail::kStepKernels, own, model, detail::simdKernel(own), nullptr);
}

KernelChoice boundaryKernel(unsigned features, const GrainModel& model) {
  const unsigned own = atBoundaries(features);
  KernelChoice choice = chosen(detail::kBoundaryKernels, own, model, own,
                               own & ~kFriction ? "only for planes with linear contacts of equal grains" : nullptr);
  if (!(features & kLedger) && !detail::withoutLedger(choice.compiledFor, false)) choice.compiledFor = kGeneral;
  return choice;
}

std::string featureText(unsigned features) {
  std::string text = !(features & kHertz) ? "linear" : features & kGeneral ? "linear and hertz" : "hertz";
  for (const auto& [feature, name] : kNames)
    if (features & feature) text += std::string(", ") + name;
  return text;
}

std::string stepKernelText(unsigned features, const GrainModel& model) {
  return kernelText(detail::kStepKernels, atStep(features), model, stepKernel(features, model));
}

std::string boundaryKernelText(unsigned features, const GrainModel& model) {
  return kernelText(detail::kBoundaryKernels, atBoundaries(features), model, boundaryKernel(features, model));
}

} // namespace grouser::terrain
