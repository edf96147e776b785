// SPDX-License-Identifier: BSD-3-Clause
#include "base/device_graph.hpp"

#if defined(__CUDACC__)
#include "base/cuda_check.cuh"
#endif

namespace grouser::base {

#if defined(__CUDACC__)

namespace {

cudaStream_t streamOf(const Exec& exec) { return static_cast<cudaStream_t>(exec.stream); }
cudaGraphExec_t graphOf(void* graph) { return static_cast<cudaGraphExec_t>(graph); }
cudaEvent_t eventOf(void* event) { return static_cast<cudaEvent_t>(event); }

void* makeEvent() {
  cudaEvent_t event = nullptr;
  checkCuda(cudaEventCreateWithFlags(&event, cudaEventDisableTiming), "cudaEventCreate");
  return event;
}

} // namespace

DeviceGraph::~DeviceGraph() {
  if (graph_) cudaGraphExecDestroy(graphOf(graph_));
}

void DeviceGraph::begin() {
  checkCuda(cudaStreamBeginCapture(streamOf(exec_), cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
}

void DeviceGraph::end() {
  cudaGraph_t graph = nullptr;
  checkCuda(cudaStreamEndCapture(streamOf(exec_), &graph), "cudaStreamEndCapture");
  // If the topology is the same, update the graph in place, which is faster than a new instantiation.
  cudaGraphExecUpdateResultInfo unused{};
  cudaError_t code = cudaErrorGraphExecUpdateFailure;
  if (graph_) code = cudaGraphExecUpdate(graphOf(graph_), graph, &unused);
  if (code != cudaSuccess) {
    cudaGetLastError(); // clears the error: a failed update is expected
    if (graph_) cudaGraphExecDestroy(graphOf(graph_));
    graph_ = nullptr;
    cudaGraphExec_t fresh = nullptr;
    // The flag preserves each stream's priority; otherwise all nodes run at the priority of the launching stream.
    code = cudaGraphInstantiate(&fresh, graph, cudaGraphInstantiateFlagUseNodePriority);
    graph_ = fresh;
  }
  cudaGraphDestroy(graph);
  checkCuda(code, "cudaGraphInstantiate");
  recorded_ = true;
}

void DeviceGraph::abandon() noexcept {
  cudaGraph_t graph = nullptr;
  if (cudaStreamEndCapture(streamOf(exec_), &graph) == cudaSuccess && graph) cudaGraphDestroy(graph);
  cudaGetLastError(); // clears the error: the exception that ended the recording is being thrown
}

void DeviceGraph::start() { checkCuda(cudaGraphLaunch(graphOf(graph_), streamOf(exec_)), "cudaGraphLaunch"); }

SideStream::SideStream(const Exec& main, bool first) : main_(main), side_(main) {
  if (main.onCpu()) return;
  int last = 0, greatest = 0;
  checkCuda(cudaDeviceGetStreamPriorityRange(&last, &greatest), "cudaDeviceGetStreamPriorityRange");
  cudaStream_t stream = nullptr;
  checkCuda(cudaStreamCreateWithPriority(&stream, cudaStreamNonBlocking, first ? greatest : last), "cudaStreamCreate");
  side_.stream = stream;
  forked_ = makeEvent(), joined_ = makeEvent();
}

SideStream::~SideStream() {
  if (!forked_) return;
  cudaStreamSynchronize(streamOf(side_));
  cudaStreamDestroy(streamOf(side_));
  cudaEventDestroy(eventOf(forked_));
  cudaEventDestroy(eventOf(joined_));
}

void SideStream::fork() {
  if (!forked_) return;
  checkCuda(cudaEventRecord(eventOf(forked_), streamOf(main_)), "cudaEventRecord");
  checkCuda(cudaStreamWaitEvent(streamOf(side_), eventOf(forked_), 0), "cudaStreamWaitEvent");
}

void SideStream::join() {
  if (!forked_) return;
  checkCuda(cudaEventRecord(eventOf(joined_), streamOf(side_)), "cudaEventRecord");
  checkCuda(cudaStreamWaitEvent(streamOf(main_), eventOf(joined_), 0), "cudaStreamWaitEvent");
}

#else

// Without CUDA every Exec is a CPU: no recording, no stream.
DeviceGraph::~DeviceGraph() = default;
void DeviceGraph::begin() {}
void DeviceGraph::end() {}
void DeviceGraph::abandon() noexcept {}
void DeviceGraph::start() {}
SideStream::SideStream(const Exec& main, bool) : main_(main), side_(main) {}
SideStream::~SideStream() = default;
void SideStream::fork() {}
void SideStream::join() {}

#endif

} // namespace grouser::base
