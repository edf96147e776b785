// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/campaigns/events/events.hpp"
#include "runs/session/output_times.hpp"
#include "runs/support/option_checks.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

namespace grouser::commands {

void addEvents(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<grouser::events::EventsCommand>();
  grouser::events::EventsCommand& c = *command;
  c.words = invocation.words, c.pieces.threads = 0;
  events::EventOptions& o = c.options;
  CLI::App* events = app.add_subcommand(
      "events", "Standard mobility events of a vehicle on a ground: go or no-go, limits, figures with intervals");
  events->add_option("--vehicle", o.vehicle, "a ready vehicle by name, or a vehicle file that ends in .toml")
      ->capture_default_str();
  events->add_option("--soil", o.soil, "rigid, or a soil by its name (`grouser soils`)")->capture_default_str();
  events
      ->add_option_function<std::string>(
          "--ground", [&o](const std::string& word) { o.ground = base::valueOf<scene::TerrainKind>(word); },
          "rigid, granular, or scm: deformable soil without grains; default: rigid with --soil rigid, else granular")
      ->check(CLI::IsMember(base::wordsOf<scene::TerrainKind>()));
  events
      ->add_option("--only", o.only,
                   fmt::format("events, separated by commas, of {}; default: all",
                               fmt::join(base::wordsOf<events::Event>(), ", ")))
      ->delimiter(',');
  events
      ->add_option("--levels", o.levels,
                   "of the one event that --only names, separated by commas: tangents of slopes [-], heights, widths "
                   "and radii [m]; default: by the vehicle's size and friction")
      ->delimiter(',');
  events
      ->add_option("--speed", o.speed,
                   "commanded [m/s], but twice that in acceleration; default: 1.2 of the light vehicle, others by the "
                   "root of their pitch radius")
      ->check(support::positive("a speed in metres a second"));
  const events::BedCare &full = events::kFullCare, &quick = events::kQuickCare;
  events
      ->add_option("--seeds", o.seeds,
                   fmt::format("beds of each level; default: {}; with --quick {}", full.seeds, quick.seeds))
      ->check(support::wholeNumber(1, 1000));
  events
      ->add_option(
          "--grain-radius", o.grainRadius,
          fmt::format(
              "mean radius of the bed's grains [m]; default: {:g} of them on the width of a pad; with --quick {:g}",
              full.grainsOnPad, quick.grainsOnPad))
      ->check(support::positive("a length in metres"));
  events
      ->add_option(
          "--depth", o.depth,
          fmt::format("of the bed [m]; default: {:g} widths of a pad; with --quick {:g}", full.depth, quick.depth))
      ->check(support::positive("a length in metres"));
  events->add_flag(
      "--quick", o.quick,
      "coarse and shallow beds, fewer levels and seeds: on sandy loam about an hour of 16 cores, see --plan");
  events->add_option("--set", o.fixed, kSetHelp)->allow_extra_args(false);
  events->add_flag("--plan", c.plan, "only say how long all of it will take, here and on an H200");
  events->add_flag("--films", c.films, "a film of the first run of each level; frames take room on the disk");
  jobs::addPieceOptions(*events, c.pieces);
  events->get_option("--seconds")->description("no further run is begun after so many, 0: no limit");
  events->add_option("--jobs", c.jobs, "runs at the same time, which share the cores")
      ->check(support::wholeNumber(1, 1024))
      ->capture_default_str();
  support::addOut(*events, c.folder,
                  "folder of the results; default: out/events_VEHICLE_SOIL, with scm out/events_VEHICLE_SOIL_scm");
  events->add_flag("--force", c.force, "run again what has been run, and overwrite what is in that folder");
  events->callback([command] { events::eventsCommand(*command); });
}

} // namespace grouser::commands
