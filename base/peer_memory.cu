// SPDX-License-Identifier: BSD-3-Clause
#include "base/peer_memory.hpp"

#include "base/array.hpp"
#include "base/for_each.cuh"
#include "base/shared_memory.hpp"

#include <algorithm>
#include <exception>
#include <set>
#include <stdexcept>
#include <unistd.h>
#include <utility>

namespace grouser::base {

namespace {

constexpr std::size_t kPage = std::size_t{2} << 20; // CUDA shares whole pages, including other data in them

#if defined(__CUDACC__)
using Handle = cudaIpcMemHandle_t;
#else
struct Handle {};
#endif

/// Handle with which other ranks map a rank's memory.
struct Offer {
  std::uint64_t device;
  std::uint32_t given;
  int process, file; ///< CPU: process and file descriptor
  Handle handle;
};

struct WriteWord {
  std::uint32_t *at, value;
  GROUSER_HD void operator()(int) const { *at = value; }
};

struct ReadWord {
  const std::uint32_t* from;
  std::uint32_t* to;
  GROUSER_HD void operator()(int) const { *to = *from; }
};

std::uint32_t markOf(int rank) { return 0x67726f75u + static_cast<std::uint32_t>(rank); }

} // namespace

PeerMemory::PeerMemory(const Exec& exec, const Comm& comm, PeerUse use, std::size_t bytes)
    : exec_(exec), comm_(comm), use_(use),
      shares_(!comm.alone() && (use == PeerUse::always || (use == PeerUse::automatic && !exec.onCpu()))),
      views_(static_cast<std::size_t>(comm.size()), nullptr) {
  // Allocate at least one page, so that mutual access of the ranks can be tested immediately.
  if (shares_ || bytes > 0) allocate(bytes);
  checkUse();
}

PeerMemory::~PeerMemory() {
  // Skip this during exception unwinding: other ranks may still read this memory, and release() would wait in
  // closeAll() for ranks that never call it. The error ends all ranks.
  if (shares_ && std::uncaught_exceptions() > 0) return;
  release();
}

/// Throws if peer memory is required but not all ranks can access each other.
void PeerMemory::checkUse() {
  if (use_ != PeerUse::always || comm_.alone() || allSeeAll_) return;
  release();
  throw InputError(
      "peer memory \"always\", but not all ranks can access each other's memory: GPUs must be on one machine and "
      "support peer access (nvidia-smi topo -p2p r); CPU ranks require enough shared memory and access to /proc/PID/fd "
      "of the others (same user, same container); otherwise use \"auto\"");
}

void PeerMemory::reserve(std::size_t bytes) {
  if (bytes <= size_) return;
  release();
  allocate(bytes + bytes / 4);
  checkUse();
}

void PeerMemory::release() noexcept {
  closeAll();
  if (ownIsShared_)
    closeShared(own_, size_);
  else
    releaseForMessages(exec_, own_);
  own_ = nullptr, size_ = 0, ownIsShared_ = false;
}

void PeerMemory::allocate(std::size_t bytes) {
  const std::size_t size = shares_ ? std::max(kPage, (bytes + kPage - 1) / kPage * kPage) : bytes;
  SharedBlock block;
  if (shares_ && exec_.onCpu()) {
    block = createShared(size);
    // CPUs share memory only on request, without fallback to private memory, which could be far too large.
    if (comm_.sumOf(block.memory ? 0 : 1) > 0) {
      closeShared(block.memory, size);
      endSharing(block);
      allSeeAll_ = false;
      return;
    }
    own_ = block.memory, ownIsShared_ = true;
  }
  if (!own_) own_ = allocateForMessages(exec_, size);
  size_ = size;
  setZero(exec_, own_, size_);
  synchronize(exec_);
  if (shares_) share(block.file);
  endSharing(block); // every rank has opened the block by now
}

/// Exports this rank's memory to the other ranks on its machine, and maps their memory.
void PeerMemory::share(int file) {
  Offer mine{};
  mine.device = deviceId(exec_);
  mine.given = ownIsShared_, mine.process = getpid(), mine.file = file;
#if defined(__CUDACC__)
  if (!exec_.onCpu()) mine.given = cudaIpcGetMemHandle(&mine.handle, own_) == cudaSuccess;
  if (!exec_.onCpu()) cudaGetLastError(); // not an error: some GPUs cannot export their memory
#endif
  const std::vector<Offer> offers = comm_.gatherValue(mine);
  std::set<std::pair<int, std::uint64_t>> devices;
  for (int r = 0; r < comm_.size(); ++r) {
    const Offer& offer = offers[static_cast<std::size_t>(r)];
    devices.emplace(comm_.hostOf(r), offer.device);
    const bool here = r != comm_.rank() && comm_.hostOf(r) == comm_.hostOf(comm_.rank());
    if (!here || !offer.given) continue;
    views_[static_cast<std::size_t>(r)] =
        exec_.onCpu() ? openShared(offer.process, offer.file, size_) : opened(&offer.handle);
  }
  deviceShared_ = static_cast<int>(devices.size()) < comm_.size();

  std::vector<Bytes> mineOf;
  const std::vector<bool> goodViews = tryViews();
  for (const bool good : goodViews) mineOf.push_back(Comm::bytesOf(std::vector<std::uint8_t>{good}));
  const std::vector<Bytes> theirs = comm_.allToAll(mineOf);
  std::uint64_t missing = 0;
  for (int r = 0; r < comm_.size(); ++r) {
    const auto k = static_cast<std::size_t>(r);
    if (!Comm::valuesOf<std::uint8_t>(mineOf[k]).front() || !Comm::valuesOf<std::uint8_t>(theirs[k]).front()) close(r);
    if (r != comm_.rank() && !views_[k]) missing = 1;
  }
  allSeeAll_ = comm_.maximumOf(missing) == 0;
  setZero(exec_, own_, views_.size() * sizeof(std::uint32_t));
  synchronize(exec_);
  comm_.wait();
}

/// Tests for each rank whether data written through its mapping arrive, in both directions. A mapping may open and yet
/// be wrong, e.g. in some virtual machines. wait() ensures that all ranks have written before any rank reads.
std::vector<bool> PeerMemory::tryViews() const {
  const auto word = [](void* memory, int r) { return static_cast<std::uint32_t*>(memory) + r; };
  const int me = comm_.rank();
  for (int r = 0; r < comm_.size(); ++r)
    if (of(r)) forEach(exec_, "write to a peer", 1, WriteWord{word(of(r), me), markOf(me)});
  synchronize(exec_);
  comm_.wait();
  Array<std::uint32_t> readBack(exec_, views_.size());
  for (int r = 0; r < comm_.size(); ++r)
    if (of(r)) forEach(exec_, "read from a peer", 1, ReadWord{word(of(r), me), readBack.data() + r});
  const std::vector<std::uint32_t> back = readBack.toHost();
  const std::vector<std::uint32_t> arrived = toHost(exec_, static_cast<const std::uint32_t*>(own_), views_.size());
  std::vector<bool> good;
  for (int r = 0; r < comm_.size(); ++r) {
    const auto k = static_cast<std::size_t>(r);
    good.push_back(of(r) && back[k] == markOf(me) && arrived[k] == markOf(r));
  }
  return good;
}

void* PeerMemory::opened([[maybe_unused]] const void* handle) {
  void* view = nullptr;
#if defined(__CUDACC__)
  const cudaError_t code =
      cudaIpcOpenMemHandle(&view, *static_cast<const Handle*>(handle), cudaIpcMemLazyEnablePeerAccess);
  cudaGetLastError(); // not an error: some GPU pairs have no peer path
  if (code != cudaSuccess) view = nullptr;
#endif
  return view;
}

void PeerMemory::close(int rank) noexcept {
  void*& view = views_[static_cast<std::size_t>(rank)];
  if (exec_.onCpu()) closeShared(view, size_);
#if defined(__CUDACC__)
  if (view && !exec_.onCpu()) cudaIpcCloseMemHandle(view);
#endif
  view = nullptr;
}

/// Waits for the work of this device, unmaps the memory of other ranks, and waits until all ranks have done so.
/// Afterwards no other rank reads the memory of this rank, and it can be freed.
void PeerMemory::closeAll() noexcept {
  if (!shares_ || !own_) return;
#if defined(__CUDACC__)
  if (!exec_.onCpu()) cudaDeviceSynchronize();
#endif
  for (int r = 0; r < comm_.size(); ++r) close(r);
  comm_.wait();
}

} // namespace grouser::base
