// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/simulation.hpp"
#include "runs/output/channels.hpp"
#include "runs/setup/record_setup.hpp"

#include <functional>
#include <vector>

namespace grouser::session {

/// Ordered columns of a run's rows, and the values of a row. Only features of the simulation have columns.
class RowColumns {
public:
  /// `simulation` outlives it.
  RowColumns(coupling::Simulation& simulation, const setup::OutputSetup& output);

  const std::vector<output::Channel>& channels() const { return channels_; }
  /// The current values of all channels. All ranks call it.
  output::Row row() const;

private:
  /// Data for several groups of columns, measured once per row.
  struct Now {
    vehicle::Observation vehicle; ///< in scenes with a vehicle
    coupling::Ledger ledger;
  };
  using Append = std::function<void(const Now&, std::vector<double>&)>;

  void addVehicle(bool shoeForces);
  void addProbes();
  void addSurfaces();
  void add(const std::vector<output::Channel>& channels, Append append);
  /// Adds columns; `find` returns their source for each row.
  template <class Source, class Find> void add(const output::Columns<Source>& columns, Find find) {
    add(columns.channels(),
        [columns, find](const Now& now, std::vector<double>& values) { columns.append(find(now), values); });
  }

  coupling::Simulation& simulation_;
  std::vector<output::Channel> channels_;
  std::vector<Append> groups_;
};

} // namespace grouser::session
