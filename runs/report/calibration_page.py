# SPDX-License-Identifier: BSD-3-Clause
"""The report of a calibration: targets and results, all trials, the calibrated soil and its tests."""
import math

import grouser
import page as pages
from grouser.files import read_csv
from grouser.series import counted
import soil_page
import sweep_page
from page import esc, facts, folded, number, table, with_bar

#: Quantities measured by trials: (name, column heading).
MEASURED = (("phi", "phi"), ("c", "c"), ("K", "K"), ("pressure", "pressure of the small plate"),
            ("misfit", "misfit"), ("repose", "repose"), ("porosity", "porosity of the beds"), ("depth", "depth of the beds"))
MEANING = {**soil_page.MEANING,
           "misfit": "root mean square of the residuals, in standard deviations of the measured tests",
           "repose": "angle of repose of a tilted bed", "k": "k_c / b + k_phi", "b": "plate width of k",
           "pressure": "pressure of the small plate at the target sinkage, from n and k (or k_c and k_phi) at the mean "
                       "track pressure"}
VERDICTS = {"reached": "reached", "not reached": "not reached; closest value", "not sought": "not sought, result only"}


def bar_of(estimate):
    return estimate.half_width if math.isfinite(estimate.half_width) else None


def wanted_of(found):
    """{measured quantity: (target, tolerance or None)}"""
    wanted = {one["quantity"]: (one["wanted"], one["tolerance"]) for one in found.json["targets"]}
    if pressure := found.json.get("pressure"):
        wanted["pressure"] = (pressure["wanted"], pressure["tolerance"])
    return wanted


def aim(wanted, tolerance, name):
    """Target in full precision, with its tolerance."""
    within = f" \u00b1 {number(tolerance, '', f'{name} wanted bar')}" if math.isfinite(tolerance) else ""
    return f'<span class="nowrap">{number(wanted, "", f"{name} wanted")}{within}</span>'


def doubt(outcome):
    """Note on a verdict, because the verdict considers only the value, not its error bar."""
    bar = outcome.reached.half_width
    if outcome.verdict != "reached" or bar <= outcome.tolerance:
        return ""
    return "; the error bar exceeds the tolerance" if math.isfinite(bar) else "; one seed, no error bar"


def targets(found):
    if found.outcomes:
        rows = [[esc(o.what), aim(o.wanted, o.tolerance, o.what),
                 with_bar(o.reached.value, bar_of(o.reached), "", f"{o.what} reached"), esc(o.reached.unit),
                 f"<strong>{esc(VERDICTS.get(o.verdict, o.verdict))}</strong>{doubt(o)}"] for o in found.outcomes]
        return table(["quantity", "target \u00b1 tolerance", "result \u00b1 error bar", "unit", "verdict"], rows,
                     "Error bar: half width of the 95 % interval over the tests. Reached: the value is within the "
                     "tolerance. The large plate is validation only, not part of the search.", numeric=(1, 2))
    aims = [*found.json["targets"]]
    if pressure := found.json.get("pressure"):
        aims.append({"quantity": "pressure", **pressure})
    rows = [[f"<em>{esc(one['quantity'])}</em>", esc(MEANING.get(one["quantity"], "")),
             aim(one["wanted"], math.nan if one["tolerance"] is None else one["tolerance"], one["quantity"]), esc(one["unit"])] for one in aims]
    return table(["quantity", "definition", "target \u00b1 tolerance", "unit"], rows,
                 "Quantities without tolerance are only compared, or define the sinkage of the pressure target.",
                 numeric=(2,))


def state(found):
    """Warning about an unfinished search."""
    if found.status == "finished":
        return ""
    missing = found.json.get("missing")
    why = f"out of time, {esc(counted(missing['tests'], 'test'))} of {esc(missing['trial'])} missing" if missing else \
        "still running, or stopped"
    return f'<p class="bad">WARNING: this search is not finished ({why}); <code>--resume</code> continues it.</p>'


def varied(found):
    """Material keys that differ between trials, and keys that are equal in all trials."""
    keys = list(dict.fromkeys(key for trial in found for key in trial.parameters))
    values = {key: {trial.parameters.get(key) for trial in found} for key in keys}
    return [key for key in keys if len(values[key]) > 1], [key for key in keys if len(values[key]) == 1]


def parameter(value, unit="", name=""):
    """HTML of a parameter; `unit` applies to numbers only."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number(value, unit, name) if is_number else esc("" if value is None else str(value))


def trials_table(found, program):
    changed, same = varied(found)
    units = {key: sweep_page.unit_of(f"material.{key}", program) for key in changed + same}
    there = [(name, words) for name, words in MEASURED if any(name in trial.measured for trial in found)]
    unit_of = {name: trial.measured[name].unit for trial in found for name, _ in there if name in trial.measured}
    rows = [[f"<code>{esc(trial.name)}</code>",
             *(parameter(trial.parameters.get(key), "", f"{trial.name} {key}") for key in changed),
             *(with_bar(trial.measured[name].value, bar_of(trial.measured[name]), "", f"{trial.name} {name}")
               if name in trial.measured else "" for name, _ in there)] for trial in found]
    headings = ["trial", *(f"{key.replace('_', ' ')} [{units[key]}]" for key in changed),
                *(f"{words} [{unit_of[name]}]" for name, words in there)]
    sinkages = {round(trial.measured["sinkage"].value, 9) for trial in found if "sinkage" in trial.measured}
    words = "In chronological order; \u00b1 half width of the 95 % interval over the seeds."
    if len(sinkages) == 1:
        words += f" Pressure of the small plate at a sinkage of {number(sinkages.pop(), 'mm', 'sinkage')}."
    told = facts([(key.replace("_", " "), parameter(found.trials[0].parameters[key], units[key], f"all {key}"))
                  for key in same])
    return table(headings, rows, words, numeric=range(1, len(headings))) + \
        (folded("Parameters common to all trials", told) if same else "")


def over_trials(found, value):
    """(trial numbers, `value` of each), for trials that have this value."""
    points = [(k + 1, value(trial)) for k, trial in enumerate(found)]
    return zip(*[(k, v) for k, v in points if v is not None]) if any(v is not None for _, v in points) else ((), ())


def search_plots(made, found, program):
    """Plots of measured and changed quantities over the trial number."""
    inner, wanted, count = [], wanted_of(found), len(found)
    across = [0.5, count + 0.5]
    for name, words in MEASURED:
        numbers, values = over_trials(found, lambda trial: trial.measured.get(name))
        if not numbers:
            continue
        curves = [("measured", list(numbers), [v.value for v in values], [bar_of(v) or 0.0 for v in values])]
        told = "Bars: 95 % intervals over the seeds."
        if name in wanted:
            aim, tolerance = wanted[name]
            curves.append(("wanted", across, [aim] * 2, [tolerance or 0.0] * 2))
            told += " Band: tolerance." if tolerance else " Only compared, not a target."
        title = f"{name}: {MEANING[name]}" if name == words else words[:1].upper() + words[1:]
        inner.append(made.plot(title, "trial [-]", f"{words} [{values[0].unit}]", curves, told, marks=["measured"],
                               whole=True))
    for key in varied(found)[0]:
        numbers, values = over_trials(found, lambda trial: trial.parameters.get(key)
                                      if isinstance(trial.parameters.get(key), (int, float)) else None)
        if numbers:
            name = key.replace("_", " ")
            inner.append(made.plot(name[:1].upper() + name[1:], "trial [-]",
                                   f"{name} [{sweep_page.unit_of(f'material.{key}', program)}]",
                                   [(name, list(numbers), list(values))], "Values of the trials.", marks=True,
                                   whole=True))
    return f'<p>{count} trials: {", ".join(f"{k + 1} is <code>{esc(t.name)}</code>" for k, t in enumerate(found))}.</p>' \
           f'<div class="plots">{"".join(inner)}</div>' if inner else ""


def measured_plates(made, found):
    """Pressure over sinkage of each plate on the calibrated soil, one curve per bed, with the measured tests."""
    final = found.folder / "final"
    if found.status != "finished" or not (final / "curves.csv").is_file():
        return ""
    curves, points, plots = read_csv(final / "curves.csv"), read_csv(final / "points.csv"), []
    for diameter in sorted({row["diameter [m]"] for row in points}, key=float):
        lines, means = {}, {}
        for row in curves:
            if row["diameter [m]"] == diameter:
                lines.setdefault(row["seed"], []).append((1e3 * float(row["sinkage [m]"]), 1e-3 * float(row["pressure [Pa]"])))
        for row in points:
            if row["diameter [m]"] == diameter:
                means[1e3 * float(row["sinkage [m]"])] = (1e-3 * float(row["measured mean [Pa]"]),
                                                          1e-3 * float(row["measured deviation [Pa]"]))
        drawn = [(f"bed {seed}", *map(list, zip(*line))) for seed, line in lines.items()]
        drawn.append(("measured", list(means), [m for m, _ in means.values()], [d for _, d in means.values()]))
        plots.append(made.plot(f"Plate of {1e3 * float(diameter):g} mm", "sinkage [mm]", "pressure [kPa]", drawn,
                               "Measured: mean of the tests; bars: one standard deviation.", marks=["measured"],
                               whole=True))
    return f'<div class="plots">{"".join(plots)}</div>'


def soil_file(found):
    file = found.soil_file
    if file is None or not file.is_file():
        return ""
    text = grouser.files.read_text(file)
    return f"<p><code>{esc(file.name)}</code>: to use it in a scene in the same folder, set <code>soil = " \
           f"\"{esc(file.name)}\"</code> in <code>[material.NAME]</code> (docs/soils.md).</p><pre>{esc(text)}</pre>"


def page(folder, options):
    found = grouser.open_calibration(folder)
    if not len(found):
        raise grouser.FileError(f"{folder}: no trial of this calibration has finished; --resume continues it")
    made = pages.Page(f"{found.name} (calibration)", "calibration of a soil", folder)
    care = '<p class="bad">WARNING: coarse settings (<code>--quick</code>).</p>' if found.coarse else ""
    made.section("targets", "Targets and results", state(found) + care + targets(found))
    if len(found):
        made.section("trials", "Trials", trials_table(found, options.program))
        made.section("search", "Search history", search_plots(made, found, options.program))
    if plates := measured_plates(made, found):
        made.section("plates", "Measured plates", plates)
    made.section("soil", "Calibrated soil", soil_file(found))
    j = found.json
    provenance = [("command", f"<code>{esc(j.get('command', ''))}</code>"),
                  ("targets", f"<code>{esc(j.get('targets_file', ''))}</code>")]
    if found.status == "finished":
        soil_page.add_tests(made, found.soil(), provenance)
    else:
        made.section("provenance", "Provenance", facts([
            *provenance, ("soil", esc(found.name)), ("grain radius", number(found.grain_radius, "m", "grain_radius_m")),
            ("care", esc(j.get("care", ""))),
            ("program", f"grouser {esc(j.get('version', ''))}, commit <code>{esc(j.get('commit', ''))}</code>"),
            ("machine", esc(j.get("machine", "")))]))
    return made
