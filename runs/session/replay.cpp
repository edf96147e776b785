// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/replay.hpp"

#include "runs/output/result_fields.hpp"
#include "runs/support/hdf5_file.hpp"

#include <algorithm>
#include <string>

namespace grouser::session {

RecordedRun recordedRun(const std::filesystem::path& folder) {
  const support::Hdf5File results = support::Hdf5File::open(folder / "results.h5");
  RecordedRun run;
  run.folder = folder, run.stateHash = results.text("/", "state_hash"), run.scene = results.text("/", "scene");
  if (const std::vector<double> steps = results.numbers("/series/step"); !steps.empty())
    run.steps = static_cast<std::int64_t>(steps.back());
  if (const std::string taken = results.text("/", "steps_taken"); !taken.empty()) run.steps = std::stoll(taken);
  if (!results.has(output::kInputs.path)) return run;
  const std::vector<double> numbers = results.numbers(output::kInputs.path);
  for (std::size_t k = 0; k + coupling::Input::kNumbers <= numbers.size(); k += coupling::Input::kNumbers)
    run.inputs.push_back(coupling::Input::of(numbers.data() + k));
  return run;
}

std::int64_t Replay::apply(coupling::Simulation& simulation, std::int64_t most) {
  std::vector<coupling::Input> due;
  for (; next_ < inputs_.size() && inputs_[next_].step <= simulation.steps(); ++next_)
    if (inputs_[next_].step == simulation.steps()) // a resumed run has already applied earlier inputs
      due.push_back(inputs_[next_]);
  if (!due.empty()) simulation.set(due);
  return next_ < inputs_.size() ? std::min(most, inputs_[next_].step - simulation.steps()) : most;
}

} // namespace grouser::session
