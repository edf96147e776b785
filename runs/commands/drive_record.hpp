// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/output/output.hpp"
#include "runs/simulation/simulation.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::commands {

/// How far the rows of a run say that its vehicle drove, for the end of the run.
class DriveRecord {
public:
  DriveRecord() = default;
  explicit DriveRecord(const std::vector<output::Channel>& channels);
  void add(const output::Row& row);

  /// Teeth passed by the track that passed more, counting both directions [-].
  double teeth() const { return std::max(passed_[0], passed_[1]); }

private:
  std::array<std::optional<std::size_t>, 2> at_; ///< places in a row, left and right
  std::array<double, 2> last_{}, passed_{};
  bool begun_ = false;
};

/// Why the run of a vehicle that was to drive tells nothing of its driving: it did not begin, or passed fewer than
/// setup::kFewestTeeth `teeth`. Empty where it drove, and where the scene does not ask it to.
std::string incompleteText(const scene::Scene& scene, const simulation::Simulation& simulation, double teeth);
/// Prints and notes that, before all else that is said of the run; then when the vehicle drove off, and what has ended
/// the run before its time.
void describeDrive(const scene::Scene& scene, const simulation::Simulation& simulation, double teeth,
                   output::RunWriter& writer, output::Summary& summary);

} // namespace grouser::commands
