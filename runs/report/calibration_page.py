# SPDX-License-Identifier: BSD-3-Clause
"""The report of a calibration: what was wanted and what was reached, every trial, the soil that was found, and all that
was measured of it."""
import math

import grouser
import page as pages
from grouser.files import read_csv
from grouser.series import counted
import soil_page
import sweep_page
from page import esc, facts, folded, number, table, with_bar

#: What trials measure: (name, what stands above its column).
MEASURED = (("phi", "phi"), ("c", "c"), ("K", "K"), ("pressure", "pressure of the small plate"),
            ("misfit", "misfit"), ("repose", "repose"), ("porosity", "porosity of the beds"), ("depth", "depth of the beds"))
MEANING = {**soil_page.MEANING, "misfit": "root mean square of the residuals, in standard deviations of a measured test",
           "repose": "angle of repose of a bed that is tilted", "k": "k_c / b + k_phi", "b": "breadth that k is meant at",
           "pressure": "of the small plate at the sinkage that n and k, or k_c and k_phi, give at the track's mean pressure"}
VERDICTS = {"reached": "reached", "not reached": "not reached: the nearest that was", "not sought": "not sought, follows"}


def bar_of(estimate):
    return estimate.half_width if math.isfinite(estimate.half_width) else None


def wanted_of(found):
    """{name of what trials measure: (wanted, tolerance or None)}"""
    wanted = {one["quantity"]: (one["wanted"], one["tolerance"]) for one in found.json["targets"]}
    if pressure := found.json.get("pressure"):
        wanted["pressure"] = (pressure["wanted"], pressure["tolerance"])
    return wanted


def aim(wanted, tolerance, name):
    """What is wanted, to all its digits, and within what."""
    within = f" \u00b1 {number(tolerance, '', f'{name} wanted bar')}" if math.isfinite(tolerance) else ""
    return f'<span class="nowrap">{number(wanted, "", f"{name} wanted")}{within}</span>'


def doubt(outcome):
    """What the bar says of a verdict that goes by the value alone."""
    bar = outcome.reached.half_width
    if outcome.verdict != "reached" or bar <= outcome.tolerance:
        return ""
    return "; the bar is wider than the tolerance" if math.isfinite(bar) else "; of one seed, without a bar"


def targets(found):
    if found.outcomes:
        rows = [[esc(o.what), aim(o.wanted, o.tolerance, o.what),
                 with_bar(o.reached.value, bar_of(o.reached), "", f"{o.what} reached"), esc(o.reached.unit),
                 f"<strong>{esc(VERDICTS.get(o.verdict, o.verdict))}</strong>{doubt(o)}"] for o in found.outcomes]
        return table(["target", "wanted \u00b1 tolerance", "reached \u00b1 bar", "unit", "verdict"], rows,
                     "Bar: half of the 95 % interval over the tests. Reached: the value lies within the tolerance. "
                     "The large plate is held back: the search never sees it.", numeric=(1, 2))
    aims = [*found.json["targets"]]
    if pressure := found.json.get("pressure"):
        aims.append({"quantity": "pressure", **pressure})
    rows = [[f"<em>{esc(one['quantity'])}</em>", esc(MEANING.get(one["quantity"], "")),
             aim(one["wanted"], math.nan if one["tolerance"] is None else one["tolerance"], one["quantity"]), esc(one["unit"])] for one in aims]
    return table(["target", "what it is", "wanted \u00b1 tolerance", "unit"], rows,
                 "What has no tolerance is compared only, or says where the pressure is wanted.", numeric=(2,))


def state(found):
    """What a reader has to know of a search that has not ended."""
    if found.status == "finished":
        return ""
    missing = found.json.get("missing")
    why = f"time was up: {counted(missing['tests'], 'test')} of {esc(missing['trial'])} {'is' if missing['tests'] == 1 else 'are'} missing" if missing else \
        "it is still going on, or was stopped"
    return f'<p class="bad">This search has not ended ({why}). <code>--resume</code> goes on with it.</p>'


def varied(found):
    """Keys of the material that trials differ in, and the others."""
    keys = list(dict.fromkeys(key for trial in found for key in trial.parameters))
    values = {key: {trial.parameters.get(key) for trial in found} for key in keys}
    return [key for key in keys if len(values[key]) > 1], [key for key in keys if len(values[key]) == 1]


def parameter(value, unit="", name=""):
    """`unit`: with a number only."""
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
    words = "In the order in which they were made; \u00b1 half of the 95 % interval over the seeds."
    if len(sinkages) == 1:
        words += f" The small plate's pressure is that at a sinkage of {number(sinkages.pop(), 'mm', 'sinkage')}."
    told = facts([(key.replace("_", " "), parameter(found.trials[0].parameters[key], units[key], f"all {key}"))
                  for key in same])
    return table(headings, rows, words, numeric=range(1, len(headings))) + \
        (folded("What all trials have in common", told) if same else "")


def over_trials(found, value):
    """(numbers of the trials, what `value` has of them), of those that have one."""
    points = [(k + 1, value(trial)) for k, trial in enumerate(found)]
    return zip(*[(k, v) for k, v in points if v is not None]) if any(v is not None for _, v in points) else ((), ())


def search_plots(made, found, program):
    """How the search went: what was measured and what was changed, over the number of the trial."""
    inner, wanted, count = [], wanted_of(found), len(found)
    across = [0.5, count + 0.5]
    for name, words in MEASURED:
        numbers, values = over_trials(found, lambda trial: trial.measured.get(name))
        if not numbers:
            continue
        curves = [("measured", list(numbers), [v.value for v in values], [bar_of(v) or 0.0 for v in values])]
        told = "Bars: 95 % over the seeds."
        if name in wanted:
            aim, tolerance = wanted[name]
            curves.append(("wanted", across, [aim] * 2, [tolerance or 0.0] * 2))
            told += " Band: the tolerance." if tolerance else " It is compared only, not sought."
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
                                   [(name, list(numbers), list(values))], "What was tried.", marks=True, whole=True))
    return f'<p>{count} trials: {", ".join(f"{k + 1} is <code>{esc(t.name)}</code>" for k, t in enumerate(found))}.</p>' \
           f'<div class="plots">{"".join(inner)}</div>' if inner else ""


def measured_plates(made, found):
    """Pressure over sinkage of every plate with what was found: a curve a bed, and the measured tests."""
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
                               "Measured: mean of the tests, bars of one standard deviation of a test.", marks=["measured"],
                               whole=True))
    return f'<div class="plots">{"".join(plots)}</div>'


def soil_file(found):
    file = found.soil_file
    if file is None or not file.is_file():
        return ""
    text = file.read_text(encoding="utf-8")
    return f"<p><code>{esc(file.name)}</code>: a scene beside it takes it as <code>soil = \"{esc(file.name)}\"</code> of one " \
           f"of its <code>[material.NAME]</code> (docs/soils.md).</p><pre>{esc(text)}</pre>"


def page(folder, options):
    found = grouser.open_calibration(folder)
    if not len(found):
        raise grouser.FileError(f"{folder}: no trial of this calibration has ended yet; --resume goes on with it")
    made = pages.Page(f"{found.name} (calibration)", "calibration of a soil", folder)
    care = '<p class="bad">Coarse: made with <code>--quick</code>.</p>' if found.coarse else ""
    made.section("targets", "Wanted and reached", state(found) + care + targets(found))
    if len(found):
        made.section("trials", "Trials", trials_table(found, options.program))
        made.section("search", "How the search went", search_plots(made, found, options.program))
    if plates := measured_plates(made, found):
        made.section("plates", "Measured plates", plates)
    made.section("soil", "The soil that was found", soil_file(found))
    j = found.json
    provenance = [("command", f"<code>{esc(j.get('command', ''))}</code>"),
                  ("targets", f"<code>{esc(j.get('targets_file', ''))}</code>")]
    if found.status == "finished":
        soil_page.add_tests(made, found.soil(), provenance)
    else:
        made.section("provenance", "Where it comes from", facts([
            *provenance, ("soil", esc(found.name)), ("grain radius", number(found.grain_radius, "m", "grain_radius_m")),
            ("care", esc(j.get("care", ""))),
            ("program", f"grouser {esc(j.get('version', ''))}, commit <code>{esc(j.get('commit', ''))}</code>"),
            ("machine", esc(j.get("machine", "")))]))
    return made
