// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/exec.hpp"
#include "coupling/simulation.hpp"

#include <array>
#include <cstdint>

namespace grouser::coupling {

/// Steps a simulation and times each stage. It waits for the device after each stage: same results, but slower.
class StageTimer : private StepObserver {
public:
  StageTimer(Simulation& simulation, const base::Exec& exec) : simulation_(simulation), exec_(exec) {}
  void step();

  struct Part {
    const char* name;
    double microseconds = 0; ///< sum over all steps
  };
  const std::array<Part, kStages>& parts() const { return parts_; }
  const Part& part(Stage stage) const { return parts_[static_cast<std::size_t>(stage)]; }
  std::int64_t steps() const { return steps_; }
  std::int64_t rebuilds() const { return rebuilds_; } ///< rebuilds of the neighbour list, while measured

private:
  void after(Stage stage) override;

  Simulation& simulation_;
  base::Exec exec_;
  std::array<Part, kStages> parts_{{{"place surfaces"},
                                    {"neighbours"},
                                    {"lists of parts"},
                                    {"walls and floor"},
                                    {"poses to device"},
                                    {"track contacts"},
                                    {"ground contacts"},
                                    {"loads to host"},
                                    {"grain kernel"},
                                    {"multibody"},
                                    {"flags to host"},
                                    {"alarm"}}};
  std::int64_t steps_ = 0, rebuilds_ = 0;
  std::int64_t last_ = 0; ///< end of the previous stage [ns]
};

} // namespace grouser::coupling
