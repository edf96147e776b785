// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_simd.hpp"

#include "terrain/grain_step.cuh"

#include <algorithm>

namespace grouser::terrain {

namespace {

// Grains per task: enough to amortise its start and end, and few enough that all threads have some.
constexpr int kMaxAtATime = 256, kMinAtATime = 64;
constexpr int kBlocksPerThread = 4; // in a step
constexpr double kNanosecondsOfGrain = 50, kNanosecondsAtWall = 20;

int grainsAtATime(std::int64_t count, int threads) {
  return static_cast<int>(std::clamp<std::int64_t>(count / (kBlocksPerThread * threads), kMinAtATime, kMaxAtATime));
}

struct GrainBlockTask {
  detail::LaneStep* step;
  const GrainKernelData& d;
  const ForceData<float>& f;
  std::int64_t count;
  int atATime;
  double each; ///< estimated time per grain [ns]
  double nanoseconds() const { return each * atATime; }
  void operator()(int k) const {
    const std::int64_t first = std::int64_t{k} * atATime;
    step(d, f, static_cast<int>(first), static_cast<int>(std::min<std::int64_t>(first + atATime, count)));
  }
};

/// Processes `count` items in blocks; `nanoseconds`: estimated time of an item.
void runLanes(const base::Exec& exec, const char* name, detail::LaneStep* lanes, const GrainKernelData& d,
              const ForceData<float>& f, std::int64_t count, double nanoseconds) {
  const int some = grainsAtATime(count, exec.threads);
  base::forEach(exec, name, (count + some - 1) / some, GrainBlockTask{lanes, d, f, count, some, nanoseconds});
}

} // namespace

void runGrainSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t count,
                  int width) {
  detail::LaneStep* const step = width == 16 ? detail::stepAvx512 : width == 8 ? detail::stepAvx2 : detail::stepSse;
  runLanes(exec, "grain step in lanes", step, d, f, count, kNanosecondsOfGrain);
}

void runWallSimd(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f, std::int64_t near,
                 int width) {
  detail::LaneStep* const walls = width == 16 ? detail::wallsAvx512 : width == 8 ? detail::wallsAvx2 : detail::wallsSse;
  runLanes(exec, "walls in lanes", walls, d, f, near, kNanosecondsAtWall);
}

namespace detail {

void advanceGrain(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3d& force,
                  const base::Vec3d& torque, float deepest, const Lost& lost, GrainAccumulator& accumulator) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  const Motion m = d.motion[i];
  step.advance(i, {d.position[i], m, d.remainders[i], d.reference[i]}, step.sizeOf(m.velocity.w, m.spin.w), force,
               torque, deepest, lost, accumulator);
}

void stepAlone(const GrainKernelData& d, const ForceData<float>& f, int k, GrainAccumulator& accumulator) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  step.run(k, accumulator);
}

void addLoadsOf(const GrainKernelData& d, const ForceData<float>& f, int i, base::Vec3d& force, base::Vec3d& torque) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  step.addLoads(i, step.sizeOf(i), force, torque);
}

void raiseThrough(const GrainKernelData& d, const ForceData<float>& f, int i) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  step.raise(Fault::through, i);
}

void copyFixedGrain(const GrainKernelData& d, const ForceData<float>& f, int i, GrainAccumulator& accumulator) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  step.stay(i, d.position[i], d.motion[i], accumulator);
}

void accountFixedGrain(const GrainKernelData& d, const ForceData<float>& f, int i, const base::Vec3f& force,
                       const base::Vec3f& torque, GrainAccumulator& accumulator) {
  const GrainStep<contact::kGeneral, float> step{{d, f}};
  step.accountFixedGrain(d.position[i], {force, torque, true}, accumulator);
}

void accountPlasticWork(const GrainKernelData& d, int i, float yielded) {
  addRare(d, i, kPlasticDissipation, static_cast<double>(yielded));
}

void addToLedger(const GrainKernelData& d, int first, const GrainAccumulator& accumulator) {
  addToBank(d.ledgerSums, first / kMinAtATime, accumulator);
}

void addToLedger(const GrainKernelData& d, int first, const WallAccumulator& accumulator) {
  addToBank(d.ledgerSums, first / kMinAtATime, accumulator);
}

} // namespace detail
} // namespace grouser::terrain
