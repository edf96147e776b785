# SPDX-License-Identifier: BSD-3-Clause
"""The report of virtual soil tests: constants with intervals next to published ones, and the curves."""
import json
import math

import numpy

import grouser
import page as pages
from page import esc, facts, folded, number, table, with_bar

MEANING = {"n": "exponent of Bekker's equation", "k_phi": "frictional modulus of deformation",
           "k_c": "cohesive modulus of deformation", "c": "cohesion", "phi": "angle of internal friction",
           "K": "shear deformation modulus of Janosi and Hanamoto"}


def known(half):
    return half if math.isfinite(half) else None


def constants(soil):
    rows = []
    for name, c in soil.constants.items():
        span = f"{number(c.span[0], '', name + ' low')} to {number(c.span[1], '', name + ' high')}" if c.span else ""
        sources = "<br>".join(f"{number(value)}: {esc(source)}" for value, source in c.published)
        rows.append([f"<em>{esc(name)}</em>", esc(MEANING.get(name, "")),
                     with_bar(c.measured.value, known(c.measured.half_width), "", name), esc(c.measured.unit), span,
                     esc(f"inconclusive: {c.inconclusive}" if c.inconclusive else c.verdict), sources])
    return table(["constant", "definition", "measured", "unit", "published", "verdict", "sources"], rows,
                 "\u00b1 half width of the 95 % interval over the tests.", numeric=(2,))


def plate_plots(made, soil):
    """Pressure over sinkage during loading, on linear and logarithmic axes."""
    curves = [c for c in soil.plates() if (c.phase == 0).any()]
    if not curves:
        return []
    drawn, logarithmic = [], []
    for c in curves:
        down = (c.phase == 0) & numpy.isfinite(c.pressure)
        order = numpy.argsort(c.sinkage[down], kind="stable")
        label = f"{c.plate}, {1000 * c.breadth:g} mm"
        x, y = c.sinkage[down][order], c.pressure[down][order]
        drawn.append((label, x, y))
        positive = (x > 0) & (y > 0)
        if positive.any():
            logarithmic.append((label, x[positive], y[positive]))
    for index, plate in enumerate(soil.json.get("plates", [])):
        n, k = soil.constants.get("n"), plate["k"]["value"]
        name = ("small", "large")[index]
        reach = [c.sinkage.max() for c in curves if c.plate == name]
        if n is None or k is None or not reach or not math.isfinite(n.measured.value):
            continue
        z = numpy.geomspace(max(reach) / 100, max(reach), 60)
        form = (f"k z^n, {name}", z, 1000 * k * z**n.measured.value)
        drawn.append(form)
        logarithmic.append(form)
    words = "Loading in all tests, one line per seed, and Bekker's equation with the fitted constants."
    return [made.plot("Plates", "sinkage [m]", "pressure [Pa]", drawn, words),
            made.plot("Plates, logarithmic", "sinkage [m]", "pressure [Pa]", logarithmic, words, log="xy")]


def shear_plots(made, soil):
    curves = soil.shear()
    if not curves:
        return []
    drawn = [(f"{c.load / 1000:g} kPa", c.displacement, c.shear_stress) for c in curves]
    half = [slice(len(c.displacement) // 2, None) for c in curves]
    normal = [float(c.normal_stress[h].mean()) for c, h in zip(curves, half)]
    shear = [float(c.shear_stress[h].mean()) for c, h in zip(curves, half)]
    strength = [("mean of the second half of each test", normal, shear)]
    inner = [made.plot("Shear", "displacement [m]", "shear stress [Pa]", drawn, "All shear tests, one line per seed."),
             made.plot("Strength", "normal stress [Pa]", "shear stress [Pa]", strength, line_words(soil), points=True)]
    return inner


def line_words(soil):
    c, phi = soil.constants.get("c"), soil.constants.get("phi")
    if c is None or phi is None or not math.isfinite(phi.measured.value):
        return ""
    return (f"Mohr-Coulomb line: c = {c.measured.value:.3g} {c.measured.unit}, "
            f"phi = {phi.measured.value:.3g} {phi.measured.unit}.")


def present(plot, made, soil):
    try:
        return plot(made, soil)
    except grouser.FileError:  # without this test
        return []


def details(soil):
    rows = []
    for test in soil.json.get("tests", []):
        p = test["porosity"]
        # In the file, 0 means that a test does not record the quantity.
        rows.append([esc(test["name"]), esc(test["tests"]),
                     with_bar(p["value"], p["half_width"], "", test["name"] + " porosity"),
                     *(number(test[what]) if test[what] else "" for what in ("grains", "steps", "seconds"))])
    return table(["test", "tests", "porosity", "grains", "steps", "wall time [s]"], rows,
                 "Means per test.", numeric=range(1, 6)) if rows else ""


#: Further measured quantities, by key of soil.json.
BESIDE = {"k": "modulus of the plate", "k_n": "exponent fitted together with this modulus",
          "k_at_published_n": "modulus of the plate with the published n",
          "n_alone": "exponent fitted to this plate only",
          "goodness": "goodness of fit", "origin": "depth of the fit's origin below the mean surface",
          "line_begins_at": "start of the line fitted for the bedding, fraction of the maximum pressure",
          "n_from_first_contact": "exponent of this plate, fitted from first contact, without bedding correction",
          "k_u": "unloading stiffness", "k_reloading": "reloading stiffness",
          "unloaded_from": "pressure before unloading", "peak_phi": "phi at the peak", "peak_c": "c at the peak",
          "peak_over_residual": "peak over residual strength", "janosi_misfit": "misfit of 1 - exp(-j / K)"}


def beside(soil):
    """Further measured quantities, with error bars."""
    j, rows = soil.json, []

    def add(of, what, one, name):
        if one.get("value") is not None:
            rows.append([esc(of), esc(what), with_bar(one["value"], one.get("half_width"), "", name),
                         esc(one.get("unit", ""))])

    for plate, breadth in zip(j.get("plates", []), j.get("breadth_m", [])):
        for key, one in plate.items():
            add(f"plate of {1000 * breadth:g} mm", BESIDE.get(key, key), one, f"plate {breadth} {key}")
    for key, one in j.get("shear", {}).items():
        if isinstance(one, dict):
            add("shear", BESIDE.get(key, key), one, f"shear {key}")
    if j.get("tests_with_shorter_steps"):
        rows.append(["tests", "repeated with shorter time steps after an unsound result",
                     esc(", ".join(j["tests_with_shorter_steps"])), ""])
    if isinstance(j.get("track_sinkage"), dict):
        add("track", "sinkage by Bekker's equation at 47.5 kPa, width 0.28 m", j["track_sinkage"], "track sinkage")
    return folded("Further measurements", table(
        ["test", "quantity", "measured", "unit"], rows, "\u00b1 half width of the 95 % interval over the tests (if "
        "several).", numeric=(2,)), opened=True) if rows else ""


def add_tests(made, soil, provenance=()):
    """Adds the sections of a soil's tests; `provenance`: facts listed before those of the tests."""
    folder, j = soil.folder, soil.json
    care = '<p class="bad">WARNING: coarse settings (<code>--quick</code>).</p>' if soil.coarse else ""
    made.section("figures", "Constants", care + constants(soil) + beside(soil))
    inner = present(plate_plots, made, soil) + present(shear_plots, made, soil)
    made.section("plots", "Plots", f'<div class="plots">{"".join(inner)}</div>' if inner else "")
    made.section("tests", "Tests", details(soil))
    made.section("scene", "Test set-up", folded("Grains, contact law and tests", "<pre>" + esc(json.dumps(
        {key: value for key, value in j.items() if key in ("recipe", "shear", "plates", "track_sinkage")}, indent=2)) +
        "</pre>"))
    seeds = sorted({c.seed for c in [*(soil.plates() if (folder / "plates.csv").is_file() else []),
                                     *(soil.shear() if (folder / "shear.csv").is_file() else [])]})
    made.section("provenance", "Provenance", facts([
        *provenance, ("soil", esc(soil.name)), ("grain radius", number(soil.grain_radius, "m", "grain_radius_m")),
        ("care", esc(j["care"])), ("seeds", ", ".join(map(str, seeds))),
        ("program", f"grouser {esc(j.get('version', ''))}, commit <code>{esc(j.get('commit', ''))}</code>"),
        ("machine", esc(j.get("machine", "")))]))


def page(folder, options):
    soil = grouser.open_soil(folder)
    made = pages.Page(f"{soil.name} (soil)", "soil test", folder)
    add_tests(made, soil)
    return made
