// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/campaigns/events/events.hpp"
#include "runs/campaigns/events/mobility_map.hpp"
#include "runs/session/output_times.hpp"
#include "runs/support/option_checks.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

namespace grouser::commands {

namespace {

/// Options for vehicle, ground, beds, execution and results, common to `events` and `map`.
void addEventRuns(CLI::App& app, events::EventsCommand& c, const std::string& defaultFolder) {
  events::EventOptions& o = c.options;
  app.add_option("--vehicle", o.vehicle, "name of a built-in vehicle, or a vehicle file (.toml)")
      ->capture_default_str();
  app.add_option("--soil", o.soil, "rigid, or the name of a soil (see `grouser soils`)")->capture_default_str();
  app.add_option_function<std::string>(
         "--ground", [&o](const std::string& word) { o.ground = base::valueOf<scene::TerrainKind>(word); },
         "kind of ground: rigid, granular, or scm (deformable soil without grains); default: rigid with --soil rigid, "
         "otherwise granular")
      ->check(CLI::IsMember(base::wordsOf<scene::TerrainKind>()));
  app.add_option("--speed", o.speed,
                 "commanded speed [m/s], doubled in the event acceleration; default: 1.2 for the light vehicle; for "
                 "other vehicles this value is scaled with the square root of the pitch radius")
      ->check(support::positive("a speed in metres per second"));
  app.add_option("--gravity", o.gravity, "gravity [m/s2]; slopes incline it; default: 9.81")
      ->check(support::positive("an acceleration in metres per second squared"));
  const events::BedCare &full = events::kFullCare, &quick = events::kQuickCare;
  app.add_option("--seeds", o.seeds,
                 fmt::format("number of seeds (random beds) per level; default: {}, or {} with --quick", full.seeds,
                             quick.seeds))
      ->check(support::wholeNumber(1, 1000));
  app.add_option("--draws", o.draws,
                 "with --ground scm: number of random samples of the soil constants, with one run per level each; "
                 "default: 0 (nominal constants)")
      ->check(support::wholeNumber(2, 1000));
  app.add_option(
         "--grain-radius", o.grainRadius,
         fmt::format(
             "mean grain radius of the bed [m]; default: {:g} grain diameters per pad width, or {:g} with --quick",
             full.grainsOnPad, quick.grainsOnPad))
      ->check(support::positive("a length in metres"));
  app.add_option("--depth", o.depth,
                 fmt::format("bed depth [m]; default: {:g} pad widths, or {:g} with --quick", full.depth, quick.depth))
      ->check(support::positive("a length in metres"));
  app.add_flag(
      "--quick", o.quick,
      "use coarse, shallow beds and fewer levels and seeds; about an hour on 16 cores for sandy loam (see --plan)");
  app.add_option("--set", o.fixed, kSetHelp)->allow_extra_args(false);
  app.add_flag("--plan", c.plan, "only print the estimated run time on this machine and on an H200 GPU");
  jobs::addPieceOptions(app, c.pieces);
  app.get_option("--seconds")->description("start no new runs after this wall time [s]; 0: no limit");
  app.add_option("--jobs", c.jobs, "number of concurrent runs; they share the CPU cores")
      ->check(support::wholeNumber(1, 1024))
      ->capture_default_str();
  support::addOut(app, c.folder, "output folder; default: " + defaultFolder);
  app.add_flag("--force", c.force, "repeat finished runs, and overwrite the results in the output folder");
}

void addLevels(CLI::App& app, events::EventOptions& o, const std::string& ofWhich) {
  app.add_option("--levels", o.levels,
                 ofWhich + ", separated by commas: tangents of slopes [-], heights, widths "
                           "and radii [m]; default: computed from the vehicle's size and friction")
      ->delimiter(',');
}

} // namespace

void addEvents(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<grouser::events::EventsCommand>();
  grouser::events::EventsCommand& c = *command;
  c.words = invocation.words, c.pieces.threads = 0;
  CLI::App* events = app.add_subcommand(
      "events",
      "Run standard mobility events of a vehicle on a ground: go or no-go, limits, and figures with 95 % intervals");
  events
      ->add_option("--only", c.options.only,
                   fmt::format("run only these events, separated by commas: {}; default: all",
                               fmt::join(base::wordsOf<events::Event>(), ", ")))
      ->delimiter(',');
  addLevels(*events, c.options, "levels of the single event given by --only");
  addEventRuns(*events, c, "out/events_VEHICLE_SOIL, with scm out/events_VEHICLE_SOIL_scm");
  events->add_flag("--films", c.films, "make a film of the first run of each level; its frames need disk space");
  events
      ->add_option("--against", c.against,
                   "results folders of other `grouser events` calls to compare with, separated by commas, e.g. for the "
                   "same soil as granular ground")
      ->delimiter(',');
  events
      ->add_option("--bar", c.percent,
                   "with --against: tolerance within which means count as equal, in percent of the larger mean (10 or "
                   "10%); default: 5")
      ->transform(support::percentSign())
      ->check(support::positive("a percentage"));
  events->callback([command] { events::eventsCommand(*command); });
}

void addMap(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<grouser::events::MapCommand>();
  events::EventsCommand& c = command->events;
  c.words = invocation.words, c.pieces.threads = 0;
  c.options.only = {std::string(base::wordOf(events::Event::grade))}, c.options.onlyOption = "--event";
  CLI::App* map = app.add_subcommand(
      "map", "Map go and no-go of a mobility event over its levels and the values of a key, as a table and a picture");
  map->add_option("--event", c.options.only[0],
                  "mobility event with several levels (all except acceleration, pivot_turn and motion_resistance)")
      ->check(CLI::IsMember(base::wordsOf<events::Event>()))
      ->capture_default_str();
  addLevels(*map, c.options, "levels of the event, the first axis");
  map->add_option("--axis", command->axis,
                  "key and values of the second axis: key=value,value..., e.g. scm.c=0,1000,2000 [Pa]")
      ->required();
  addEventRuns(*map, c, "out/map_VEHICLE_SOIL, with scm out/map_VEHICLE_SOIL_scm");
  map->callback([command] { events::mapCommand(*command); });
}

} // namespace grouser::commands
