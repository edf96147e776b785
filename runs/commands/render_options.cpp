// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/command_entry.hpp"

#include "runs/commands/render_command.hpp"
#include "runs/support/option_checks.hpp"

#include <memory>

namespace grouser::commands {

namespace {

void addCamera(CLI::App& render, RenderCommand& c) {
  render.add_option("--look-at", c.lookAt,
                    "camera target: vehicle (the camera follows it), all, or a point X,Y,Z [m]; default: vehicle, or "
                    "all if the run has no vehicle");
  render
      .add_option("--azimuth", c.azimuth,
                  "azimuth of the camera about the vertical, 0 along +x [deg]; default: -55, or -140 for a vehicle on "
                  "deformable soil")
      ->check(support::between(-360.0, 360.0));
  render
      .add_option("--elevation", c.elevation,
                  "elevation of the camera above the horizon [deg]; default: 14; on deformable soil 24, for a bed "
                  "without a vehicle 30, for a flat scene 60")
      ->check(support::between(-90.0, 90.0));
  render
      .add_option(
          "--distance", c.distance,
          "distance of the camera from its target [m]; default: the distance at which the target fills the picture")
      ->check(support::positive("a length in metres"));
}

/// Options that select frames.
void addFrames(CLI::App& render, RenderCommand& c) {
  CLI::Option* frame = render.add_option("--frame", c.frame, "render only the frame with this number; may be repeated")
                           ->check(support::wholeNumber(0))
                           ->allow_extra_args(false);
  CLI::Option* every = render.add_option("--every", c.every, "render every N-th frame")
                           ->check(support::wholeNumber(1))
                           ->capture_default_str();
  CLI::Option* from = render.add_option("--from", c.from, "render frames from this time [s]")
                          ->check(support::notNegative("a time in seconds"));
  CLI::Option* to = render.add_option("--to", c.to, "render frames up to this time [s]")
                        ->check(support::notNegative("a time in seconds"));
  frame->excludes(every)->excludes(from)->excludes(to);
}

} // namespace

void addRender(CLI::App& app, const Invocation& invocation) {
  const auto command = std::make_shared<RenderCommand>();
  RenderCommand& c = *command;
  c.comm = invocation.ranks.comm();
  CLI::App* render =
      app.add_subcommand("render", "Render pictures and a film from the frames of a run; requires no display");
  render->add_option("frames", c.frames, "frames.h5 of a run, or the run's folder")
      ->required()
      ->transform(support::orItsFolder("frames.h5"));
  support::addOut(*render, c.folder, "output folder for the pictures; default: pictures/ next to the file");
  render->add_option("--film", c.film, "also write a film to this file (.mp4, .mkv or .mov); requires ffmpeg");
  render->add_option("--fps", c.framesPerSecond, "frames per second of the film")
      ->check(support::positive("a number"))
      ->capture_default_str();
  render
      ->add_option("--color", c.color,
                   "quantity shown by colour; grains: depth, speed, subdomain, role or white; deformable soil: "
                   "sinkage, pressure or shear")
      ->capture_default_str();
  render
      ->add_option("--range", c.range,
                   "lower and upper end of the colour scale [m, m/s or Pa]; default: range of the values in the file")
      ->expected(2)
      ->type_name("LOW HIGH");
  render
      ->add_option(
          "--borders", c.borders,
          "positions of the borders between subdomains [m], e.g. x=0.5 or y=-1,1; default: as stored in the file")
      ->allow_extra_args(false);
  addCamera(*render, c);
  render->add_option("--size", c.size, "picture size in pixels")->type_name("WIDTHxHEIGHT")->capture_default_str();
  addFrames(*render, c);
  render->add_flag("!--no-labels", c.labels, "omit time and colour scale");
  render->add_option("--processes", c.processes, "number of processes among which the frames are divided")
      ->check(support::wholeNumber(1, 1024))
      ->capture_default_str();
  render
      ->add_option("--threads", c.threads,
                   "number of CPU threads per process; default: all available cores (at most OMP_NUM_THREADS), divided "
                   "among the processes")
      ->check(support::wholeNumber(0, 1024));
  render->add_flag("--force", c.force, "overwrite existing pictures and film");
  render->callback([command] { renderCommand(*command); });
}

} // namespace grouser::commands
