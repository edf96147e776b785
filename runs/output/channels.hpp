// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "coupling/gear_contacts.hpp"
#include "coupling/ledger.hpp"
#include "coupling/pressed_grain.hpp"
#include "coupling/surfaces.hpp"
#include "coupling/towing.hpp"
#include "runs/output/records.hpp"

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Quantities of a time series: one list for both the writer and the reader of results.h5.
namespace grouser::output {

inline const std::vector<std::string> kAxes = {"x", "y", "z"}; ///< columns of a vector

/// One number per shoe, in the order along the track; `side`: "left" or "right".
inline std::string shoeSinkage(const std::string& side) { return "vehicle/" + side + "/sinkage"; }

/// A quantity defined in another folder of the sources (vehicle::Quantity has the same members).
template <class Quantity> Channel channelOf(const Quantity& q) { return {q.path, q.unit, q.help, q.width, q.columns}; }

inline void appendTo(std::vector<double>& values, double number) { values.push_back(number); }
inline void appendTo(std::vector<double>& values, const base::Vec3d& v) {
  values.insert(values.end(), {v.x, v.y, v.z});
}
inline void appendTo(std::vector<double>& values, const base::Quat& q) {
  values.insert(values.end(), {q.w, q.x, q.y, q.z});
}

/// Channels with values that are read from one `Source`, in the order in which a row stores them.
template <class Source> class Columns {
public:
  /// `group`: start of all paths, such as "ledger/".
  explicit Columns(std::string group = "") : group_(std::move(group)) {}

  /// `read`: member of a source, or function of a source, that returns a number, vector or quaternion. `columns`:
  /// names of the components of a vector.
  template <class Read> void add(const std::string& name, const std::string& unit, const std::string& help, Read read,
                                 std::vector<std::string> columns = kAxes) {
    using Value = std::decay_t<std::invoke_result_t<Read, const Source&>>;
    if constexpr (std::is_arithmetic_v<Value>) {
      channels_.push_back({group_ + name, unit, help, 1, {}});
      readers_.push_back([read](const Source& source, std::vector<double>& values) {
        values.push_back(static_cast<double>(std::invoke(read, source)));
      });
    } else {
      channels_.push_back({group_ + name, unit, help, static_cast<int>(columns.size()), std::move(columns)});
      readers_.push_back(
          [read](const Source& source, std::vector<double>& values) { appendTo(values, std::invoke(read, source)); });
    }
  }

  const std::vector<Channel>& channels() const { return channels_; }
  /// Appends the numbers of all channels to a row.
  void append(const Source& source, std::vector<double>& values) const {
    for (const auto& read : readers_) read(source, values);
  }

private:
  std::string group_;
  std::vector<Channel> channels_;
  std::vector<std::function<void(const Source&, std::vector<double>&)>> readers_;
};

/// State of the bed at the time of a row.
struct TerrainReading {
  coupling::Ledger ledger;
  double radius{};         ///< radius of the grain model, the unit of overlaps [m]
  double crushed{};        ///< number of crushed grains removed since the start
  std::int64_t rebuilds{}; ///< number of neighbour-list rebuilds
  std::optional<coupling::DeepestPartOverlap> deepestPartOverlap; ///< empty if grains touch no part
};
/// Columns of the bed and its contacts.
Columns<TerrainReading> terrainColumns();
/// Loads on a rigid surface and power of its drive, in surfaces/NAME. `hasPivot`: also the torque about its pivot.
Columns<coupling::Surfaces::Observation> surfaceColumns(const std::string& name, bool hasPivot = false);
/// Mean force of a vehicle on a surface at rest, in obstacles/NAME.
Columns<base::Vec3d> obstacleColumns(const std::string& name);

struct HitchReading {
  coupling::HitchObservation hitch;
  double drawbarPull{}; ///< [N]
};
/// Loads at the hitch of a vehicle.
Columns<HitchReading> hitchColumns();
/// Contacts of grains with the parts of a vehicle.
Columns<coupling::GearContacts> gearColumns();
/// Features of a scene that add columns to the ledger.
struct LedgerParts {
  bool touching = true; ///< whether vehicle and bed can touch
  bool deforms = false; ///< whether the soil is deformable, which adds its energies
  bool wet = false;     ///< whether the scene has a fluid
  bool solved = false;  ///< whether the scene has complementarity contacts
};
/// Energy and momentum.
Columns<coupling::Ledger> ledgerColumns(const LedgerParts& parts = {});

/// Solver statistics of the last step, and of all steps since the start.
struct SolverReading {
  terrain::ImpulseReport last;
  terrain::ImpulseTotals all;
};
Columns<SolverReading> solverColumns();

} // namespace grouser::output
