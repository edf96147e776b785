# SPDX-License-Identifier: BSD-3-Clause
"""The section of deformable soil: constants, map of the ruts, profiles, pressure under the tracks, energies."""
import base64
import io
import math

import numpy

import soil_fields
from page import esc, folded, number, pictures, table, term

MOST_PIXELS = 1600  # maximum width and height of a map


def png(colours):
    """A picture of [rows, columns, 3] bytes as a data URI."""
    import matplotlib.image  # only this page requires it
    file = io.BytesIO()
    matplotlib.image.imsave(file, numpy.ascontiguousarray(colours, dtype=numpy.uint8), format="png",
                            metadata={"Software": None})
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode()


class Soil:
    """Maps of deformable soil at the end of a run; with a vehicle also the places of the nodes along and across its
    heading, from the middle of the sprocket axle."""

    def __init__(self, run):
        def of(name):
            return numpy.asarray(run.constants[f"terrain.soil.{name}"].value, dtype=float)
        self.spacing, self.origin = float(of("spacing")), of("origin")
        self.maps = {name: of(name) for name in ("sinkage", "pressure", "shear", "max_pressure")}
        rows, columns = self.maps["sinkage"].shape
        self.x = self.origin[0] + self.spacing * numpy.arange(columns)
        self.y = self.origin[1] + self.spacing * numpy.arange(rows)
        self.section = [of(f"section_{name}") for name in ("offset", "sinkage")] \
            if "terrain.soil.section_offset" in run.constants else None
        self.has_vehicle = "vehicle.position" in run
        if not self.has_vehicle:
            return
        place, heading = run["vehicle.position"].value[-1], float(run["vehicle.heading"].value[-1])
        east, north = numpy.meshgrid(self.x - place[0], self.y - place[1])
        self.along = east * math.cos(heading) + north * math.sin(heading)
        self.across = north * math.cos(heading) - east * math.sin(heading)

    def track(self, side):
        """Whether each node is on this side of the vehicle."""
        return self.across > 0 if side == "left" else self.across < 0

    def profile(self, name, nodes):
        """(along, mean): means of a map over the nodes of strips across the heading, one spacing long."""
        place = numpy.round(self.along[nodes] / self.spacing).astype(int)
        first = place.min()
        count = numpy.bincount(place - first)
        total = numpy.bincount(place - first, self.maps[name][nodes])
        there = count > 0
        return (numpy.arange(len(count)) + first)[there] * self.spacing, total[there] / count[there]

    def loaded(self, side):
        return self.track(side) & (self.maps["pressure"] > 0)


def constants(run):
    rows = [[f"<code>{esc(name.rpartition('.')[2])}</code>", number(float(q.value), "", name), esc(q.unit), esc(q.help)]
            for name, q in run.constants.items()
            if name.startswith("terrain.soil.") and q.value.shape == ()]
    return table(["constant", "value", "unit", "definition"], rows, "Constants of the soil contact model in this run.",
                 numeric=(1,))


def rut_map(soil):
    """Map of the sinkage, true to scale, x to the right."""
    step = max(1, math.ceil(max(soil.maps["sinkage"].shape) / MOST_PIXELS))
    sinkage = soil.maps["sinkage"][::-step, ::step]
    low, high = min(0.0, float(sinkage.min())), max(float(sinkage.max()), 1e-6)
    share = (sinkage - low) / (high - low) * (len(soil_fields.RAMP) - 1)
    at = numpy.minimum(share.astype(int), len(soil_fields.RAMP) - 2)
    colours = soil_fields.RAMP[at] + (share - at)[..., None] * (soil_fields.RAMP[at + 1] - soil_fields.RAMP[at])
    bar = f'<div>{number(low, "m", "sinkage least")}{soil_fields.RAMP_BAR}{number(high, "m", "sinkage largest")}</div>'
    words = (f"Sinkage of the surface at the end, x from {soil.x[0]:.2f} m to {soil.x[-1]:.2f} m to the right, y from "
             f"{soil.y[0]:.2f} m to {soil.y[-1]:.2f} m upwards; nodes {number(soil.spacing, 'm')} apart.")
    return (f'<figure><strong>Map of the ruts</strong><br><img src="{png(colours.round())}" alt="Map of the ruts" '
            f'class="map">{bar}<figcaption>{words}</figcaption></figure>')


def road_wheels(run, side):
    """Positions of the road wheels of a track along the heading in the last frame; [] without frames."""
    if run.frames is None or not len(run.frames):
        return []
    last = run.frames[-1]
    place, heading = run["vehicle.position"].value[-1], float(run["vehicle.heading"].value[-1])
    ahead = numpy.array([math.cos(heading), math.sin(heading)])
    names = [name for name in run.frames.parts if name.startswith(f"{side} road wheel")]
    return sorted(float((last.pose(name)[0][:2] - place[:2]) @ ahead) for name in names)


def peaks(along, pressure, wheels):
    """Maximum pressure around each road wheel, within half the distance to its neighbours."""
    edges = [-math.inf, *((a + b) / 2 for a, b in zip(wheels, wheels[1:])), math.inf]
    found = [pressure[(along >= low) & (along < high)] for low, high in zip(edges, edges[1:])]
    return [float(values.max()) for values in found if len(values)]


def pressures(made, run, soil):
    """Pressure under the tracks at the end: a plot, and a table with the mean maximum pressure."""
    curves, rows = [], []
    for side in ("left", "right"):
        nodes = soil.loaded(side)
        if not nodes.any():
            continue
        along, mean = soil.profile("pressure", nodes)
        curves.append((side, along, mean))
        area, force = soil.spacing**2 * nodes.sum(), soil.spacing**2 * soil.maps["pressure"][nodes].sum()
        rows.append([esc(side), *(number(float(v), "", f"{side} {what}") for what, v in (
            ("normal force", force), ("pressed area", area), ("mean pressure", force / area), ("maximum", mean.max())))])
        wheels = road_wheels(run, side)
        found = peaks(along, mean, wheels) if len(wheels) > 1 else []
        rows[-1].append(number(sum(found) / len(found), "", f"{side} mean maximum pressure") if found else "none")
    if not curves:
        return "", ""
    words = ("Pressure on the soil at the end of the run, mean over the width of a track, without damping. Distance: "
             "from the middle of the sprocket axle, forward positive.")
    caption = ("Mean maximum pressure: mean over the road wheels of the maximum under each"
               f"{'' if run.frames else '; requires output.frames = true'}.")
    return made.plot("Pressure under the tracks", "distance along the vehicle [m]", "pressure [Pa]", curves, words,
                     about=words), table(
        ["track", "normal force [N]", "contact area [m2]", "mean pressure [Pa]", "maximum [Pa]",
         "mean maximum pressure [Pa]"], rows, caption, numeric=range(1, 6))


def profiles(made, soil):
    figures = []
    if soil.section is not None:
        words = "mean over the last 0.5 m of the rut behind the tracks, across the heading, left positive"
        figures.append(made.plot("Rut across", "offset from the middle of the vehicle [m]", "height [m]",
                                 [("surface", soil.section[0], -soil.section[1])], f"{words}.", about=words))
    curves = []
    for side in ("left", "right"):
        nodes = soil.track(side) & (soil.maps["max_pressure"] > 0)
        if nodes.any():
            along, mean = soil.profile("sinkage", nodes)
            curves.append((side, along, -mean))
    if curves:
        words = "mean over the contact width of each track, along the heading from the middle of the sprocket axle"
        figures.append(made.plot("Rut along", "distance along the vehicle [m]", "height [m]", curves, f"{words}.", about=words))
    return "".join(figures)


def energies(run):
    names = run.names("ledger.dissipated_soil") + run.names("ledger.soil_")
    rows = [[term(name.removeprefix("ledger.").replace("_", " "), run[name].help),
             number(float(run[name].value[-1]), "", f"soil energy {name.removeprefix('ledger.')}"), "J", esc(run[name].help)]
            for name in names if len(run.time)]
    return table(["energy", "at the end", "unit", "definition"], rows, "Elastic energies of the soil at the end, "
                 "dissipation since the start.", numeric=(1,)) if rows else ""


def section(made, run):
    """HTML of the section; "" for a run without deformable soil."""
    if "terrain.soil.n" not in run.constants:
        return ""
    inner = folded("Constants in use", constants(run), opened=True)
    if "terrain.soil.sinkage" in run.constants and len(run.time):
        soil = Soil(run)
        inner += pictures([rut_map(soil)])
        if soil.has_vehicle:
            plot, figures = pressures(made, run, soil)
            inner += f'<div class="plots">{profiles(made, soil)}{plot}</div>{figures}'
    return inner + energies(run)
