# SPDX-License-Identifier: BSD-3-Clause
"""The report of one run."""
import base64
import math
import re
import tomllib
from pathlib import Path

import h5py
import numpy

import damage
import definitions
import grouser
import page as pages
import soil_fields
import soil_ground
import space
from grouser.series import counted
from page import NOTHING, esc, exact, facts, figure_with_bar, folded, number, run_name, table, term

LARGEST_FILM = 4e6  # bytes that lie in the page; larger ones stay beside it
MOST_BESIDE = 4  # ledgers that stand beside each other
FILMS = {".mp4": "video/mp4", ".webm": "video/webm", ".mov": "video/mp4", ".gif": "image/gif"}
#: How files of films begin: (place, bytes).
BEGINNINGS = ((4, b"ftyp"), (4, b"moov"), (4, b"mdat"), (4, b"wide"), (0, b"\x1aE\xdf\xa3"), (0, b"GIF8"))

# Plots of what a run has: title, label of y, names of series. SIDE: left and right.
CURVES = (
    ("Speed of the hull at each track", "speed [m/s]", ["vehicle.SIDE.speed"]),
    ("Slip", "slip [-]", ["vehicle.SIDE.slip", "vehicle.SIDE.tooth_slip"]),
    ("Drive torque of each sprocket", "torque of one sprocket [N m]", ["vehicle.SIDE.drive_torque"]),
    ("Traction and resistance", "force [N]",
     ["vehicle.gross_traction", "vehicle.drawbar_pull", "vehicle.motion_resistance"]),
    ("Ground force on the vehicle", "force [N]", ["vehicle.ground_force"]),
    ("Attitude of the hull", "angle [rad]", ["vehicle.heading", "vehicle.pitch_angle", "vehicle.roll_angle"]),
    ("Energy ledger", "energy [J]", ["ledger.drive_work", "ledger.kinetic", "ledger.potential", "ledger.elastic",
                                     "ledger.dissipated", "ledger.integration_error"]),
    ("What is lost, by cause", "energy [J]", ["ledger.dissipated_damping", "ledger.dissipated_friction",
                                               "ledger.dissipated_rolling", "ledger.dissipated_parts",
                                               "ledger.dissipated_joints", "ledger.dissipated_yielding",
                                               "ledger.dissipated_crushing", "ledger.dissipated_micro_slip",
                                               "ledger.dissipated_soil"]),
    ("Energies of deformable soil", "energy [J]", ["ledger.soil_elastic_pressure", "ledger.soil_elastic_shear",
                                                   "ledger.soil_compaction", "ledger.soil_shear", "ledger.soil_slip_sinkage",
                                                   "ledger.soil_damping",
                                                   "ledger.soil_edges", "ledger.soil_coupling"]),
    ("What the length of the steps costs", "energy [J]", ["ledger.integration_error", "ledger.residual"]),
    ("Pairs of grains in touch", "contacts [-]", ["terrain.contacts"]),
    ("Largest overlap", "overlap [grain radii]", ["terrain.max_overlap", "terrain.part_overlap"]),
    ("Squeezed contacts", "contacts [-]", ["terrain.squeezed", "terrain.squeezed_at_boundaries",
                                          "terrain.squeezed_by_parts"]),
)
LEDGER = ("drive_work", "kinetic", "potential", "elastic", "dissipated", "dissipated_damping", "dissipated_friction",
          "dissipated_micro_slip", "dissipated_rolling", "dissipated_yielding", "dissipated_crushing", "dissipated_parts", "dissipated_joints",
          "integration_error", "residual", "turnover")
ENDINGS = {unit: unit for unit in ("s", "m", "J", "kg")}  # of names in manifest.json, and their units
#: What is said of a run by its status, unless it is finished.
ENDED = {"running": "This run is still going on, or was killed: what is told here is what it had written by then.",
         "incomplete": "WARNING: this run is incomplete:", "failed": "This run has failed.",
         "stopped": "This run was stopped before its end; --resume goes on with it."}
#: Of quantities with a number a shoe: title, label of y, name, whether of shoes in ground contact alone.
SPREADS = (("Sinkage of the shoes in ground contact", "sinkage [m]", "sinkage", True),
           ("Track tension", "tension [N]", "tension", False),
           ("Ground pressure of the shoes in ground contact", "pressure [Pa]", "ground_pressure", True))
IN_CONTACT = "shoe in ground contact: on the ground run, between first and last road wheel, and carrying load"


def sides(names):
    return [name.replace("SIDE", side) for name in names for side in (("left", "right") if "SIDE" in name else ("",))]


def columns_of(run, name):
    """[(label, values)] of a series that has a number, or a vector, a row; none of one with a number a shoe."""
    series = run[name]
    if series.value.ndim == 1:
        return [(name, series.value, series)]
    if series.labels and len(series.labels) == series.value.shape[1]:
        return [(f"{name}.{label}", series.value[:, k], series) for k, label in enumerate(series.labels)]
    return []


def short(name):
    return re.sub(r"^(vehicle|ledger|terrain)\.", "", name).replace("_", " ").replace(".", " ")


def meanings(columns):
    """What the curves are: "speed: of the hull at this track; ..."."""
    told = {}
    for _, _, series in columns:
        # Results list its parts below it.
        help_ = re.sub("sum of the (eight|nine causes) below", "all that is lost", series.help)
        told.setdefault(re.sub(r"^(left|right) ", "", short(series.name)), help_)
    return "; ".join(f"{what}: {help_}" for what, help_ in told.items())


def within(columns, low, high):
    """The range of an axis that leaves out what lies far beyond [low, high], and what to say of it."""
    values = numpy.concatenate([values[numpy.isfinite(values)] for _, values, _ in columns])
    if values.min() >= low and values.max() <= high:
        return {}, ""
    return {"range": [max(low, values.min()), min(high, values.max())]}, \
        f" Drawn from {low:g} to {high:g}; it runs from {values.min():.3g} to {values.max():.3g}."


def tracks_of(run, name):
    """{side: series} of a quantity with a number a shoe, of the tracks that the run has."""
    return {side: run[f"vehicle.{side}.{name}"] for side in ("left", "right") if f"vehicle.{side}.{name}" in run}


def spread(values, of):
    """Mean, least and largest of each row, over the shoes that have a number and are `of` it [rows, shoes] (None: all);
    NaN where there is none."""
    counts = numpy.isfinite(values) if of is None else numpy.isfinite(values) & of
    there = counts.any(axis=1)
    mean = numpy.where(counts, values, 0.0).sum(axis=1) / numpy.maximum(1, counts.sum(axis=1))
    least, largest = (edge(numpy.where(counts, values, far), axis=1) for edge, far in
                      ((numpy.min, numpy.inf), (numpy.max, -numpy.inf)))
    return [numpy.where(there, one, numpy.nan) for one in (mean, least, largest)]


def curves(made, run):
    """The plots of what the run has."""
    rows, note = pages.thinned(len(run.time))
    time = run.time[rows]
    figures = []
    for title, axis, names in CURVES:
        found = [column for name in sides(names) if name in run for column in columns_of(run, name)]
        found = [column for column in found if numpy.isfinite(column[1]).any()]
        lively = [column for column in found if numpy.nanmax(numpy.abs(column[1])) > NOTHING]
        if not lively:
            continue
        drawn = lively
        more, cut = within(drawn, -1.0, 1.0) if title == "Slip" else ({}, "")
        figures.append(made.plot(title, "time [s]", axis,
                                 [(short(name), time, values[rows]) for name, values, _ in drawn],
                                 f"{meanings(drawn)}.{cut}{note}", about=meanings(drawn), **more))
    for title, axis, name, in_contact in SPREADS:
        drawn = []
        for side, series in tracks_of(run, name).items():
            drawn.append((side, time, *(values[rows] for values in spread(
                series.value, run[f"vehicle.{side}.on_ground"].value > 0.5 if in_contact else None))))
        if any(numpy.isfinite(curve[2]).any() for curve in drawn):
            of = "shoes in ground contact" if in_contact else "pins"
            below = name == "sinkage" and any((curve[2] < 0).any() for curve in drawn)
            figures.append(made.plot(title, "time [s]", axis, drawn, f"{series.help}; line: mean over the {of} of a "
                                     f"track, band: their range.{' ' + definitions.ABOVE_SURFACE if below else ''}{note}",
                                     about=f"{series.help}; {IN_CONTACT}" if in_contact else series.help))
    for group in ("surfaces", "obstacles"):
        for name in run.names(group + "."):
            if name.endswith(".force"):
                figures.append(made.plot(f"Force on {name.split('.')[1]}", "time [s]", "force [N]", [
                    (label.rpartition(".")[2], time, values[rows]) for label, values, _ in columns_of(run, name)],
                    run[name].help + "." + note))
    return f'<div class="plots">{"".join(figures)}</div>' if figures else ""


def any_series(made, run):
    """A plot of whichever column is chosen, and a table of all of them."""
    rows, note = pages.thinned(len(run.time))
    if len(run.time) < 2:
        return ""
    columns = [column for name in run.names() for column in columns_of(run, name)]
    listed, lines, start = [], [], None  # start: the first that changes, of the vehicle if there is one
    for k, (name, values, series) in enumerate(columns):
        array = made.array(f"series.{name}", numpy.asarray(values, dtype=float)[rows])
        listed.append({"name": name, "array": array, "axis": f"{short(name)} [{series.unit}]", "help": series.help})
        there = values[numpy.isfinite(values)]
        changes = len(there) and numpy.ptp(there) > NOTHING
        if changes and (start is None or name.startswith("vehicle.") and not columns[start][0].startswith("vehicle.")):
            start = k
        marks = [values[0], values[-1], *([there.min(), there.mean(), there.max()] if len(there) else [math.nan] * 3)]
        lines.append([f"<code>{esc(name)}</code>", esc(series.unit),
                      *(number(float(mark), "", f"{name} {what}") for mark, what in
                        zip(marks, ("first", "last", "least", "mean", "largest"))), esc(series.help)])
    options = [f"<option{' selected' if k == start else ''}>{esc(name)} [{esc(series.unit)}]</option>"
               for k, (name, _, series) in enumerate(columns)]
    time = made.array("series.time", run.time[rows])
    shown = listed[start or 0]
    figure = made.plot("Any series", "time [s]", shown["axis"], [
        (shown["name"], run.time[rows], numpy.asarray(columns[start or 0][1], dtype=float)[rows])],
        "Of all columns of timeseries.csv." + note)
    made.data["explorer"] = {"plot": len(made.data["plots"]) - 1, "time": time, "series": listed}
    chosen = (f'<div class="controls"><label>Series <select id="any-series">{"".join(options)}</select></label>'
              f'<span id="any-help">{esc(shown["help"])}</span></div>{figure}')
    return chosen + folded("All series in numbers", table(
        ["series", "unit", "first", "last", "least", "mean", "largest", "what it is"], lines,
        "Over all rows of results.h5; of vectors each component.", numeric=range(2, 7)))


def part_told(run, since):
    """Over which part of the run its figures are taken, which begins at `since` [s]; None: there is none such."""
    end = run.manifest.get("simulated_time_s", run.time[-1] if len(run.time) else 0.0)
    planned = run.scene.get("run", {}).get("duration", end)
    if since is None:
        words = "Of the end of the run, and of all of it: it has no steady part to take means over."
    elif since >= end:
        words = f"Of the end of the run, and of all of it: it has not come to the steady part, which would begin at " \
                f"{number(since, 's', 'steady from')}."
    else:
        words = (f"Means and extremes from {number(since, 's', 'steady from')} on, as the summary of a sweep has them; "
                 "works, errors and what is \u201cat the end\u201d are of the end.")
    by, step = run.manifest.get("ended_by"), end / max(1, run.manifest.get("steps", 1))
    if by or end < planned - 1.001 * step:  # the last step may end before the duration of the scene
        words += f" The run ended at {number(end, 's', 'end')}, before the {number(planned, 's', 'duration')} of its scene"
        words += f", by {esc(by)}." if by else "."
    return words


def why_ended(manifest):
    """What a run that has failed or was stopped says of it, in words."""
    return str(manifest.get({"failed": "error", "stopped": "stopped", "incomplete": "incomplete"}.get(manifest.get("status")), ""))


def figures(run, options):
    """Figures of the steady part, with the bars of the last check of this scene where there is one."""
    told = options.figures
    check = told.get("check") or {}
    barred = {figure["name"]: figure for figure in check.get("check", {}).get("figures", [])}
    rows, values = [], {}
    for figure in told.get("figures", []):
        name, value = figure["name"], figure["value"]
        plain, unit = grouser.series.split_unit(name)
        if plain == "steady from":  # which is said above the figures
            continue
        checked = barred.get(name)
        bar = "none"
        if checked and checked["bar"] is not None:
            parts = ", ".join([*(e["axis"].replace("_", " ") for e in checked["errors"]), counted(checked["seeds"], "seed")])
            bar = f'{figure_with_bar(checked["value"], checked["bar"], "", f"{plain} checked")} ({esc(parts)})'
        if value is not None:
            values[plain] = [value]
        if value is not None or checked:
            rows.append([term(plain), number(value, "", plain), esc(unit), *([bar] if check else [])])
    if not rows:
        return f'<p>{esc(told["note"])}</p>' if told.get("note") else ""
    words = part_told(run, told.get("steady_from")) + definitions.note(values)
    if doubt := told.get("inconclusive"):
        reason = "see the warning at the top" if doubt == run.manifest.get("incomplete") else doubt
        words = f'<strong class="bad">Inconclusive: {esc(reason)}.</strong> {words}'
    if check:
        words += (f" Error bars: of the last check of this scene, in <code>{esc(check['folder'])}</code>, commit "
                  f"<code>{esc(check['check']['program']['commit'])}</code>, over its own seeds.")
    else:
        words += " This scene has not been checked: <code>grouser check</code> finds error bars."
    headings = ["figure", "this run", "unit", *(["checked value and its 95 % bar"] if check else [])]
    return table(headings, rows, words, numeric=(1,))


def constants(run):
    rows = []
    for name, q in run.constants.items():
        if q.value.shape == () and q.value.dtype.kind in "fiu" and not name.startswith("terrain.soil."):
            rows.append([f"<code>{esc(name)}</code>", number(float(q), "", name), esc(q.unit), esc(q.help)])
    begun = run.manifest.get("resumed_from_step")
    of = "of the run" if begun is None else f"of its last part, resumed from step {begun}"
    rows += [[f"<code>{esc(key)}</code>", number(float(value), "", key), ENDINGS.get(key.rpartition("_")[2], ""),
              f"{esc(of)}; from manifest.json"] for key, value in run.manifest.get("figures", {}).items()]
    return table(["what", "value", "unit", ""], rows, numeric=(1,)) if rows else ""


def ledger(runs):
    """The energy ledger at the end of a run, or of several: beside each other, many of them below each other. Does it
    close?"""
    runs = [run for run in runs if len(run.time)]
    ends = [{name: run[name] for name in run.names("ledger.") if run[name].value.ndim == 1} for run in runs]
    names = list(dict.fromkeys(name for end in ends for name in end))
    first = [f"ledger.{word}" for word in LEDGER if f"ledger.{word}" in names]
    names = first + [name for name in names if name not in first]
    if not names:
        return ""

    def cell(run, end, name):
        of = f"{run.folder.name} " if len(runs) > 1 else ""
        return number(float(end[name].value[-1]), "", f"{of}{name} at the end") if name in end else ""

    words = ("Changes since the first step of the run, at its end. Kinetic, potential, elastic and dissipated energy with "
             "the integration error make the work of the drives, to the residual.")
    series = {name: next(end[name] for end in ends if name in end) for name in names}
    if len(runs) > MOST_BESIDE:
        rows = [[run_name(run.folder.name), *(cell(run, end, name) for name in names)]
                for run, end in zip(runs, ends)]
        return table(["run", *(f"{short(name)} [{series[name].unit}]" for name in names)], rows, words,
                     numeric=range(1, 1 + len(names)))
    rows = [[term(short(name), series[name].help), *(cell(run, end, name) for run, end in zip(runs, ends)), esc(series[name].unit),
             esc(series[name].help)] for name in names]
    headings = [run.folder.name for run in runs] if len(runs) > 1 else ["at the end"]
    return table(["term", *headings, "unit", "what it is"], rows, words, numeric=range(1, 1 + len(runs)))


def switches(manifest):
    rows = []
    for line in manifest.get("switches", "").split("\n"):
        word, what, why = line[2:7].strip(), line[7:33].strip(), line[33:].strip()
        if len(line) > 33 and line[32:34].strip():  # no column between them
            what, why = line[7:].strip(), ""
        if what:
            rows.append([f'<span class="{word}">{word}</span>' if word else "", esc(what), esc(why)])
    if not rows:
        return "<p>The version that ran this did not record it; <code>grouser plan</code> tells it of a scene.</p>"
    return table(["", "feature", "why, or how"], rows, "A feature that is off is not built, not allocated and not run.")


def provenance(run):
    m, program = run.manifest, run.manifest.get("program", {})
    inputs = [line.rpartition(" ") for line in m.get("inputs", "").strip().split("\n") if line]
    rows = [("status", f"<strong>{esc(run.status)}</strong>"), ("why", esc(why_ended(m))),
            ("branched from", esc(m.get("branched_from", ""))), ("ended by", esc(m.get("ended_by", ""))),
            ("command", f"<code>{esc(m['command_line'])}</code>" if "command_line" in m else ""),
            ("scene", f"<code>{esc(m.get('scene', ''))}</code>"),
            ("overridden", ", ".join(f"<code>{esc(o)}</code>" for o in m.get("overrides", []))),
            ("seed", number_text(run.scene.get("run", {}).get("seed"))),
            ("program", esc(" ".join(str(program.get(k, "")) for k in ("name", "version"))) +
             f", commit <code>{esc(program.get('commit', run.facts.get('commit', '')))}</code>, "
             f"{esc(program.get('compiler', ''))}{', CUDA ' + esc(program['cuda']) if program.get('cuda') else ''}"),
            ("machine", esc(m.get("machine", run.facts.get("machine", "")))), ("device", esc(m.get("device", ""))),
            ("ranks", esc(m.get("ranks", ""))), ("begun", esc(m.get("started", ""))), ("ended", esc(m.get("ended", ""))),
            ("steps", number_text(m.get("steps"))),
            ("simulated time", number(m["simulated_time_s"], "s", "simulated_time_s") if "simulated_time_s" in m else ""),
            ("wall time", wall_time(m)),
            ("state hash", f"<code>{esc(m['state_hash'])}</code>" if "state_hash" in m else ""),
            ("input files", ", ".join(f"{esc(what)} <code>{esc(mark)}</code>" for what, _, mark in inputs))]
    soils = [(f"soil of {material}", f"{esc(use['soil'])}, {esc(use['file'])} <code>{esc(use['hash'])}</code>, grains of "
              f"{number(use['grain_radius_m'], 'm')}, scaled by {number(use['scale'])}")
             for material, use in m.get("soils", {}).items()]
    files = table(["file", "bytes"], [[f"<code>{esc(name)}</code>", str(f["bytes"])]
                                      for name, f in m.get("files", {}).items()], numeric=(1,))
    return facts(rows + soils) + folded("Files of the run", files)


def wall_time(manifest):
    """Of all steps: a run that went on has measured that of its last part."""
    if "wall_time_s" not in manifest:
        return ""
    steps, before = manifest.get("steps", 0), manifest.get("figures", {}).get("resumed_at_step", 0)
    if not 0 < before < steps:
        return number(manifest["wall_time_s"], "s", "wall_time_s")
    return (f'{number(manifest["wall_time_s"] * steps / (steps - before), "s", "wall_time_s")}, by that of the steps since '
            f"step {before:.0f}, at which it was resumed")


def number_text(value):
    return "" if value is None else f'<data value="{exact(value)}">{value:.0f}</data>'


def is_film(file):
    """Whether a browser shows it, by its name and its first bytes."""
    if file.suffix.lower() not in FILMS or not file.is_file():
        return False
    with open(file, "rb") as opened:
        head = opened.read(16)
    return any(head[place:].startswith(mark) for place, mark in BEGINNINGS)


def films(folders, options, most=LARGEST_FILM):
    """The films that lie in the folders, or the one that was named: in the page as long as they are small, and where
    the others lie."""
    files = [options.film] if options.film else [f for folder in folders for f in sorted(folder.iterdir())
                                                 if is_film(f)]
    shown, beside, taken = [], [], 0
    for file in files:
        size = file.stat().st_size
        if not options.film and (taken + size > most):
            beside.append(f"<code>{esc(file.name)}</code> ({size / 1e6:.1f} MB)")
            continue
        taken += size
        data = base64.b64encode(file.read_bytes()).decode()
        source, words = f'src="data:{FILMS[file.suffix.lower()]};base64,{data}"', f"film {esc(file.name)}"
        inner = f'<img {source} alt="{words}">' if file.suffix.lower() == ".gif" else \
            f'<video controls {source} aria-label="{words}"></video>'
        shown.append(f"<figure>{inner}<figcaption>{esc(file.name)}</figcaption></figure>")
    if beside:
        shown.append(f"<p>Too large to be in this page, beside it: {', '.join(beside)}; <code>--film</code> puts one "
                     "in.</p>")
    return "".join(shown)


def page(folder, options):
    run = damage.open_whole(Path(folder))
    made = pages.Page(f"{run.folder.resolve().name} (run)", "run", folder)
    if run.status != "finished":
        made.warnings.append(f"<p>{esc(ENDED.get(run.status, run.status))} {esc(why_ended(run.manifest))}</p>")
    if warnings := run.manifest.get("bed_warnings"):
        made.warnings.append(f"<p>WARNING: {esc(warnings)}</p>")
    made.section("figures", "Figures", figures(run, options) + folded("Constants of the run", constants(run)))
    made.section("space", "In space", space.section(made, [run], options))
    made.section("pictures", "Pictures", pages.pictures([
        films([run.folder], options), pages.picture(run.folder / "picture.png", "The end of the run"),
        pages.picture(run.folder / "surface.png", "The ground's surface, with the path of the vehicle")]))
    made.section("fields", "Fields of the soil", soil_fields.section(run))
    made.section("deformable", "Deformable soil", soil_ground.section(made, run))
    made.section("plots", "Plots", curves(made, run))
    made.section("ledger", "Energy ledger", ledger([run]))
    made.section("series", "All series", any_series(made, run))
    made.section("switches", "What was on and off", switches(run.manifest))
    made.section("scene", "Scene", scene(run, "The resolved scene"))
    made.section("provenance", "Where it comes from", provenance(run))
    return made


def scene(run, title):
    """The scene of a run, from scene.toml, or where that is none any more from results.h5."""
    text, words = (run.folder / "scene.toml").read_text(encoding="utf-8"), ""
    try:
        whole = bool(tomllib.loads(text))
    except tomllib.TOMLDecodeError:
        whole = False
    if not whole:
        with h5py.File(run.file, "r", locking=False) as results:
            text = grouser.run.text_of(results.attrs["scene"])
        words = '<p class="bad">scene.toml is damaged: it holds no scene. This one is from results.h5.</p>'
    return words + folded(f"{title}: every key with its value", f"<pre>{esc(text)}</pre>")
