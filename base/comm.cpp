// SPDX-License-Identifier: BSD-3-Clause
#include "base/comm.hpp"

#include <mpi.h>
#if defined(OPEN_MPI)
#include <mpi-ext.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>

namespace grouser::base {

namespace {

constexpr std::size_t kLargestPart = std::size_t{1} << 30; // MPI counts are int
constexpr int kTag = 7;                                    // tag of blocking messages

using Clock = std::chrono::steady_clock;

/// Scope timer: adds its lifetime to the waiting time.
class Waiting {
public:
  explicit Waiting(const std::shared_ptr<double>& total) : total_(total) {}
  ~Waiting() {
    if (total_) *total_ += std::chrono::duration<double>(Clock::now() - start_).count();
  }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

private:
  std::shared_ptr<double> total_;
  Clock::time_point start_ = Clock::now();
};

template <class T> void reduce(T* values, std::size_t count, MPI_Datatype type, MPI_Op operation) {
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(count), type, operation, MPI_COMM_WORLD);
}

/// Calls `part(offset, bytes)` for pieces small enough for MPI's int counts.
template <class Part> void inParts(std::size_t bytes, const Part& part) {
  for (std::size_t at = 0; at < bytes; at += kLargestPart) part(at, std::min(kLargestPart, bytes - at));
}

/// True if a launcher has started several processes; does not call MPI.
bool launchedWithOthers() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"})
    if (const char* size = std::getenv(name)) return std::atoi(size) > 1;
  // SLURM's srun uses PMIx, and sets the number of tasks of the step.
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  return tasks && std::getenv("PMIX_RANK") && std::atoi(tasks) > 1;
}

} // namespace

void Comm::sum(std::int64_t* values, std::size_t count) const {
  if (alone()) return;
  const Waiting waiting(waited_);
  reduce(values, count, MPI_INT64_T, MPI_SUM);
}
void Comm::minimum(std::uint64_t* values, std::size_t count) const {
  if (alone()) return;
  const Waiting waiting(waited_);
  reduce(values, count, MPI_UINT64_T, MPI_MIN);
}
void Comm::maximum(std::uint64_t* values, std::size_t count) const {
  if (alone()) return;
  const Waiting waiting(waited_);
  reduce(values, count, MPI_UINT64_T, MPI_MAX);
}
void Comm::maximum(double* values, std::size_t count) const {
  if (alone()) return;
  const Waiting waiting(waited_);
  reduce(values, count, MPI_DOUBLE, MPI_MAX);
}

std::int64_t Comm::sumBelow(std::int64_t value) const {
  if (alone()) return 0;
  std::int64_t below = 0;
  const Waiting waiting(waited_);
  MPI_Exscan(&value, &below, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return first() ? 0 : below;
}

void Comm::wait() const {
  if (alone()) return;
  const Waiting waiting(waited_);
  MPI_Barrier(MPI_COMM_WORLD);
}

std::vector<Bytes> Comm::gather(const Bytes& mine) const {
  return allToAll(std::vector<Bytes>(static_cast<std::size_t>(size_), mine));
}

std::vector<Bytes> Comm::allToAll(const std::vector<Bytes>& to) const {
  if (alone()) return to;
  const auto n = static_cast<std::size_t>(size_);
  std::vector<std::uint64_t> sent(n), coming(n);
  for (std::size_t r = 0; r < n; ++r) sent[r] = to[r].size();
  {
    const Waiting waiting(waited_);
    MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, coming.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  }
  std::vector<Bytes> from(n);
  Messages messages(*this);
  for (std::size_t r = 0; r < n; ++r) {
    from[r].resize(coming[r]);
    messages.receive(static_cast<int>(r), from[r].data(), from[r].size(), kTag);
  }
  for (std::size_t r = 0; r < n; ++r) messages.send(static_cast<int>(r), to[r].data(), to[r].size(), kTag);
  messages.waitAll();
  return from;
}

Bytes Comm::broadcast(const Bytes& bytes, int root) const {
  if (alone()) return bytes;
  const Waiting waiting(waited_);
  std::uint64_t size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, root, MPI_COMM_WORLD);
  Bytes all = rank_ == root ? bytes : Bytes(size);
  inParts(size, [&](std::size_t at, std::size_t part) {
    MPI_Bcast(all.data() + at, static_cast<int>(part), MPI_BYTE, root, MPI_COMM_WORLD);
  });
  return all;
}

std::string Comm::broadcast(const std::string& text, int root) const {
  const std::vector<char> all = valuesOf<char>(broadcast(bytesOf(std::vector<char>(text.begin(), text.end())), root));
  return {all.begin(), all.end()};
}

void Comm::send(int to, const Bytes& bytes) const {
  Messages messages(*this);
  const std::uint64_t size = bytes.size();
  messages.send(to, &size, sizeof size, kTag);
  messages.send(to, bytes.data(), bytes.size(), kTag);
  messages.waitAll();
}

Bytes Comm::receive(int from) const {
  Messages messages(*this);
  std::uint64_t size = 0;
  messages.receive(from, &size, sizeof size, kTag);
  messages.waitAll();
  Bytes bytes(size);
  messages.receive(from, bytes.data(), bytes.size(), kTag);
  messages.waitAll();
  return bytes;
}

struct Messages::Impl {
  std::vector<MPI_Request> requests;
  std::shared_ptr<double> waited;
};

Messages::Messages(const Comm& comm) : impl_(std::make_unique<Impl>()) { impl_->waited = comm.waited_; }
Messages::~Messages() {
  // Skip this during exception unwinding: the other ranks may never send, and the error ends all ranks.
  if (impl_ && std::uncaught_exceptions() == 0) waitAll();
}
Messages::Messages(Messages&&) noexcept = default;
Messages& Messages::operator=(Messages&&) noexcept = default;

void Messages::receive(int from, void* memory, std::size_t bytes, int tag) {
  inParts(bytes, [&](std::size_t at, std::size_t part) {
    MPI_Irecv(static_cast<std::byte*>(memory) + at, static_cast<int>(part), MPI_BYTE, from, tag, MPI_COMM_WORLD,
              &impl_->requests.emplace_back());
  });
}

void Messages::send(int to, const void* memory, std::size_t bytes, int tag) {
  inParts(bytes, [&](std::size_t at, std::size_t part) {
    MPI_Isend(static_cast<const std::byte*>(memory) + at, static_cast<int>(part), MPI_BYTE, to, tag, MPI_COMM_WORLD,
              &impl_->requests.emplace_back());
  });
}

void Messages::waitAll() {
  if (impl_->requests.empty()) return;
  const Waiting waiting(impl_->waited);
  MPI_Waitall(static_cast<int>(impl_->requests.size()), impl_->requests.data(), MPI_STATUSES_IGNORE);
  impl_->requests.clear();
}

bool Messages::deviceMemoryTravels() {
#if defined(MPIX_CUDA_AWARE_SUPPORT) && MPIX_CUDA_AWARE_SUPPORT
  return MPIX_Query_cuda_support() == 1;
#else
  return false;
#endif
}

Ranks::Ranks(int& argc, char**& argv) {
  if (!launchedWithOthers()) return;
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided); // for use with OpenMP; only the main thread calls MPI
  MPI_Comm_rank(MPI_COMM_WORLD, &comm_.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &comm_.size_);
  comm_.waited_ = std::make_shared<double>(0.0);
  MPI_Comm host;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, comm_.rank_, MPI_INFO_NULL, &host);
  MPI_Comm_rank(host, &rankOnHost_);
  MPI_Comm_size(host, &ranksOnHost_);
  int firstOfHost = comm_.rank_;
  MPI_Bcast(&firstOfHost, 1, MPI_INT, 0, host);
  comm_.hosts_ = std::make_shared<const std::vector<int>>(comm_.gatherValue(firstOfHost));
  MPI_Comm_free(&host);
}

Ranks::~Ranks() {
  if (!comm_.alone()) MPI_Finalize();
}

void Ranks::abort(int code) const {
  if (!comm_.alone()) MPI_Abort(MPI_COMM_WORLD, code);
}

} // namespace grouser::base
