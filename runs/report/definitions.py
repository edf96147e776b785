# SPDX-License-Identifier: BSD-3-Clause
"""What the figures of tables and plots are: one table for all pages, shown when a figure's name is pointed at. The words
are those of docs/reports.md."""
import re

#: {figure, without its unit: (what the page calls it, definition)}
FIGURES = {
    "steady from": ("steady from", "time from which the run counts as steady; means are taken from there on"),
    "teeth passed": ("teeth passed", "sprocket teeth that passed in the steady part, mean of both sprockets"),
    "speed": ("speed", "of the hull at its tracks, mean of both"),
    "slip": ("slip", "1 - way of the hull / way of the tracks, both where each track runs to, of both tracks"),
    "sinkage mean": ("mean sinkage", "mean over the shoes in ground contact: from the undisturbed surface, along its normal, "
                     "down to the underside of the pad plate, not of its grousers; negative where grousers carry the pads "
                     "above the surface"),
    "sinkage max": ("largest sinkage", "of the deepest shoe in ground contact at any output time"),
    "drive torque": ("drive torque, both sprockets", "sum over both sprockets of the torque of the hull on the sprocket; "
                     "plots and series show each sprocket by itself"),
    "drive power": ("drive power, both sprockets", "sum over both sprockets of torque x sprocket speed"),
    "tension mean": ("mean track tension", "force in the pin joints, mean over all pins of both tracks"),
    "tension peak": ("peak track tension", "largest force in any pin joint at any output time"),
    "gross traction": ("gross traction", "drive torque of both sprockets / pitch radius"),
    "drawbar pull": ("drawbar pull", "force of the vehicle on its hitch in the direction of motion; without one mass x "
                     "acceleration"),
    "motion resistance": ("motion resistance", "gross traction - net thrust along the ground: soil, losses in the running "
                          "gear, inertia of turning parts; none in a pivot turn"),
    "drive work": ("drive work", "work of all drives up to the end of the run"),
    "integration error": ("integration error", "energy that the length of the time steps has added or lost by the end"),
    "impulse residual": ("impulse residual", "impulses on the vehicle that its change of momentum does not show: rounding"),
    "pull over weight": ("pull over weight", "drawbar pull / weight of the vehicle"),
    "mu W": ("mu W", "friction coefficient x weight of the vehicle: the most that friction can carry"),
    "rate of turn": ("rate of turn", "of the hull about the vertical, to the left positive"),
    "rate over commanded": ("rate over commanded", "rate of turn / that of tracks without slip"),
    "moment of the drives": ("turning moment of the drives", "difference of both drive torques / pitch radius x half tread"),
    "drift to the left": ("drift to the left", "of the hull, across the course"),
    "lateral acceleration": ("lateral acceleration", "speed x rate of turn, in g"),
}
#: What surfaces of a scene add, by their names.
SURFACES = (
    (r"(.+) force ([xyz])", "force of the grains on {0} along {1}, mean of the steady part"),
    (r"(.+) torque ([xyz])", "torque of the grains on {0} about its centre, component {1}, mean of the steady part"),
    (r"(.+) power", "power of what moves {0}, mean of the steady part"),
    (r"(.+) position ([xyz]) at the end", "place of {0} at the end of the run, component {1}"),
)


ABOVE_SURFACE = "Negative sinkage: the grousers carry the pads above the undisturbed surface."


def note(figures):
    """What to say of {figure: its values} that a reader would stumble over; "" where there is nothing."""
    return f" {ABOVE_SURFACE}" if any(value < 0 for value in figures.get("sinkage mean", ())) else ""


def label(name):
    """What a page calls the figure `name`."""
    return FIGURES[name][0] if name in FIGURES else name


def definition(name):
    """What it is; "" where the table has none of this name."""
    if name in FIGURES:
        return FIGURES[name][1]
    for pattern, words in SURFACES:
        if found := re.fullmatch(pattern, name):
            return words.format(*found.groups())
    return ""
