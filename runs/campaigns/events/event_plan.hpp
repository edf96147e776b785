// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/events/event_table.hpp"
#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// The runs of a set of events.
namespace grouser::events {

/// Resolution, depth and width of beds, relative to the pad width, and seeds per level.
struct BedCare {
  double grainsOnPad; ///< mean diameters per pad width
  double depth;
  double margin; ///< bed width beside the tracks
  int seeds;
};
inline constexpr BedCare kFullCare{10.4, 1.6, 4, 3}, kQuickCare{3, 1.1, 2, 2};

/// Options of the user.
struct EventOptions {
  std::string vehicle = "light_tracked";    ///< name of a file in assets/vehicles, or a path that ends in .toml
  std::string soil = "rigid";               ///< "rigid", or the name of a soil
  std::optional<scene::TerrainKind> ground; ///< empty: rigid for the soil "rigid", else granular
  std::vector<std::string> only;            ///< events; empty: all
  std::string onlyOption = "--only";        ///< command-line option of `only`, for messages
  std::vector<double> levels;               ///< levels of the single event in `only`; empty: its default levels
  std::vector<std::string> fixed;           ///< "key=value" for all runs
  std::optional<double> speed;              ///< commanded speed [m/s]; empty: 1.2 for the light vehicle, else by Froude
  std::optional<double> gravity;            ///< [m/s2]; empty: run.gravity in `fixed`, or 9.81
  std::optional<double> grainRadius;        ///< mean radius [m]
  std::optional<double> depth;              ///< bed depth [m]
  std::optional<int> seeds;                 ///< number of seeds per level; empty: default, depends on `quick`
  int draws = 0;                            ///< samples of the soil constants, one run each; 0: nominal constants
  bool quick = false;
  bool frames = false; ///< write frames for films
  const BedCare& care() const { return quick ? kQuickCare : kFullCare; }
};

/// Kind of ground of these options.
scene::TerrainKind groundOf(const EventOptions& options);
/// Name of the soil; "rigid" on rigid ground.
std::string soilWord(const EventOptions& options);

/// A level of an event and its runs.
struct PlannedTrial {
  Event event{};
  double level = 0;
  Trial trial;
  std::vector<std::size_t> runs; ///< indices of its runs in the plan, one per seed or draw
};

struct EventPlan {
  Course course;
  std::string vehicleFile; ///< absolute path
  double grainRadius = 0;  ///< [m]; 0 without grains
  int seeds = 1;           ///< 1 without grains
  int draws = 0;           ///< samples of the soil constants, one run each
  sweeps::SweepPlan sweep; ///< all runs, each with its scene
  std::vector<PlannedTrial> trials;
  std::map<Event, std::string> omitted;                          ///< requested events without runs, with the reason
  bool random() const { return course.granular() || draws > 0; } ///< whether the runs of a level differ by seed or draw
  bool shoesAlone() const;                                       ///< soil contact: track shoes only
  std::string groundText() const; ///< "rigid", "lete_sand", "lete_sand (deformable soil)"
};

/// Reads vehicle and soil; loads and checks the scene of each run as `grouser plan` does. Throws
/// base::InputError for an invalid vehicle, soil, event, level or key.
EventPlan planEvents(const EventOptions& options);

/// Scene file of an event: runs/scenes/event_NAME.toml of this installation.
std::filesystem::path sceneOf(Event event);

} // namespace grouser::events
