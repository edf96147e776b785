// SPDX-License-Identifier: BSD-3-Clause
#include "base/peer_reduction.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

namespace {

constexpr int kMaxRanks = 32; // one lane of a warp per rank

/// Message of one rank in one run, written to the memory of another rank: `least` and `bits`, then a system-wide fence,
/// then `run`. The reader spins until `run` equals the number of this run, executes a fence, and reads `least` and
/// `bits`. The fence of the writer also publishes earlier writes of its stream, such as packed ghosts.
struct alignas(16) Word {
  std::uint64_t least, bits;
  std::uint32_t run;
};

/// Memory of one rank, written by all others. Double-buffered by the parity of the run: a rank that has finished run n
/// may write its message of n + 1 while a slower rank still reads messages of n. A rank overwrites its message of n
/// with n + 2 only after it has received all messages of n + 1, each sent by a rank that has finished n.
struct Table {
  Word said[2][kMaxRanks]; ///< by rank
  std::uint64_t waited;    ///< [ns]
  std::uint32_t runs;      ///< number of runs finished by this rank
};

struct Tables {
  Table* of[kMaxRanks];
};

/// Version for CPUs: release and acquire of `run` replace the fences.
void agreeOnHost(const Tables& tables, int me, int size, std::uint64_t* words) {
  Table& mine = *tables.of[me];
  const std::uint32_t run = mine.runs + 1;
  for (int r = 0; r < size; ++r) {
    Word& out = tables.of[r]->said[run & 1][me];
    out.least = words[0], out.bits = words[1];
    __atomic_store_n(&out.run, run, __ATOMIC_RELEASE);
  }
  for (int r = 0; r < size; ++r) {
    const Word& in = mine.said[run & 1][r];
    while (__atomic_load_n(&in.run, __ATOMIC_ACQUIRE) != run) std::this_thread::yield();
    words[0] = std::min(words[0], in.least), words[1] |= in.bits;
  }
  mine.runs = run;
}

#if defined(__CUDACC__)

__device__ std::uint64_t nanoseconds() {
  std::uint64_t now;
  asm volatile("mov.u64 %0, %globaltimer;" : "=l"(now));
  return now;
}

__global__ void agree(Tables tables, int me, int size, std::uint64_t* words) {
  const int lane = static_cast<int>(threadIdx.x);
  Table& mine = *tables.of[me];
  const std::uint32_t run = mine.runs + 1;
  std::uint64_t least = words[0], bits = words[1], waited = 0;
  if (lane < size && lane != me) {
    volatile Word& out = tables.of[lane]->said[run & 1][me];
    out.least = least, out.bits = bits;
    __threadfence_system();
    out.run = run;
    const volatile Word& in = mine.said[run & 1][lane];
    const std::uint64_t from = nanoseconds();
    while (in.run != run) __nanosleep(20);
    __threadfence_system();
    least = in.least, bits = in.bits, waited = nanoseconds() - from;
  }
  for (int other = kMaxRanks / 2; other > 0; other /= 2) {
    const std::uint64_t l = __shfl_xor_sync(~0u, least, other);
    least = l < least ? l : least;
    bits |= __shfl_xor_sync(~0u, bits, other);
    const std::uint64_t w = __shfl_xor_sync(~0u, waited, other);
    waited = w > waited ? w : waited;
  }
  if (lane == 0) words[0] = least, words[1] = bits, mine.waited += waited, mine.runs = run;
}

#endif

} // namespace

PeerReduction::PeerReduction(const Exec& exec, const Comm& comm, PeerUse use)
    : exec_(exec), memory_(exec, comm, use, sizeof(Table)), rank_(comm.rank()), size_(comm.size()),
      possible_(memory_.allSeeAll() && size_ <= kMaxRanks && (use == PeerUse::always || !memory_.deviceShared())) {}

double PeerReduction::waited() const {
  if (!possible_) return 0;
  std::uint64_t waited = 0;
  copyToHost(exec_, &waited, &static_cast<const Table*>(memory_.own())->waited, sizeof waited);
  return 1e-9 * static_cast<double>(waited);
}

void PeerReduction::run(const Exec& exec, std::uint64_t* words) {
  if (!possible_) throw std::logic_error("a reduction among ranks that do not see each other's memory");
  Tables tables{};
  for (int r = 0; r < size_; ++r) tables.of[r] = static_cast<Table*>(r == rank_ ? memory_.own() : memory_.of(r));
  if (exec.onCpu()) return agreeOnHost(tables, rank_, size_, words);
#if defined(__CUDACC__)
  agree<<<1, kMaxRanks, 0, static_cast<cudaStream_t>(exec.stream)>>>(tables, rank_, size_, words);
  checkCuda(cudaGetLastError(), "launch of a peer reduction");
#endif
}

} // namespace grouser::base
