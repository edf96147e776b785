# SPDX-License-Identifier: BSD-3-Clause
"""Definitions of the figures in tables and plots, shown as tooltips on all pages; wording as in docs/reports.md."""
import re

#: {figure, without its unit: (label on the page, definition)}
FIGURES = {
    "steady from": ("start of the steady part", "time after which means are taken"),
    "teeth passed": ("teeth passed", "sprocket teeth passed in the steady part, mean of both sprockets"),
    "speed": ("speed", "speed of the hull at its tracks, mean of both tracks"),
    "slip": ("slip", "1 - hull travel / track travel, each along the running direction of its track, over both tracks"),
    "sinkage mean": ("mean sinkage", "mean over the shoes in ground contact: distance along the normal of the "
                     "undisturbed surface down to the underside of the pad plate (not of its grousers); negative if "
                     "grousers hold the pads "
                     "above the surface"),
    "sinkage max": ("largest sinkage", "sinkage of the deepest shoe in ground contact at any output time"),
    "drive torque": ("drive torque, both sprockets", "torque of the hull on the sprockets, sum over both; "
                     "plots and series show each sprocket separately"),
    "drive power": ("drive power, both sprockets", "sum over both sprockets of torque x sprocket speed"),
    "tension mean": ("mean track tension", "pull along the chain in the pin joints, mean over all pins of both tracks"),
    "tension peak": ("peak track tension", "largest pull along the chain in any pin joint at any output time"),
    "gross traction": ("gross traction", "drive torque of both sprockets / pitch radius"),
    "drawbar pull": ("drawbar pull", "force of the vehicle on its hitch in the direction of motion; without a hitch "
                     "mass x acceleration"),
    "motion resistance": ("motion resistance", "gross traction - net thrust along the ground: soil resistance, losses "
                          "in the running gear, inertia of rotating parts; undefined in a pivot turn"),
    "drive work": ("drive work", "work of all drives up to the end of the run"),
    "integration error": ("integration error", "energy lost by time integration during the run (negative: gained)"),
    "impulse residual": ("impulse residual", "impulse on the vehicle minus its change of momentum (rounding error)"),
    "pull over weight": ("pull over weight", "drawbar pull / weight of the vehicle"),
    "mu W": ("mu W", "friction coefficient x weight of the vehicle: maximum friction force"),
    "rate of turn": ("rate of turn", "rate of turn of the hull about the vertical, left positive"),
    "rate over commanded": ("rate over commanded", "rate of turn / rate of turn without slip"),
    "moment of the drives": ("turning moment of the drives", "difference of both drive torques / pitch radius x half tread"),
    "drift to the left": ("drift to the left", "displacement of the hull across the course, left positive"),
    "lateral acceleration": ("lateral acceleration", "speed x rate of turn, in g"),
}
#: Figures of the scene's surfaces, by name pattern.
SURFACES = (
    (r"(.+) force ([xyz])", "force of the grains on {0} along {1}, mean of the steady part"),
    (r"(.+) torque ([xyz])", "torque of the grains on {0} about its centre, component {1}, mean of the steady part"),
    (r"(.+) power", "power of the motion of {0}, mean of the steady part"),
    (r"(.+) position ([xyz]) at the end", "position of {0} at the end of the run, component {1}"),
)


ABOVE_SURFACE = "Negative sinkage: the grousers hold the pads above the undisturbed surface."


def note(figures):
    """Note on unexpected values of {figure: values}; "" if all values are as expected."""
    return f" {ABOVE_SURFACE}" if any(value < 0 for value in figures.get("sinkage mean", ())) else ""


def label(name):
    """Label of the figure `name` on a page."""
    return FIGURES[name][0] if name in FIGURES else name


def definition(name):
    """Definition of the figure `name`; "" if it has none."""
    if name in FIGURES:
        return FIGURES[name][1]
    for pattern, words in SURFACES:
        if found := re.fullmatch(pattern, name):
            return words.format(*found.groups())
    return ""
