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

LARGEST_FILM = 4e6  # maximum size of embedded films [bytes]; larger ones are only listed
MOST_BESIDE = 4  # maximum number of ledgers side by side
FILMS = {".mp4": "video/mp4", ".webm": "video/webm", ".mov": "video/mp4", ".gif": "image/gif"}
#: Signatures of film files: (offset, bytes).
BEGINNINGS = ((4, b"ftyp"), (4, b"moov"), (4, b"mdat"), (4, b"wide"), (0, b"\x1aE\xdf\xa3"), (0, b"GIF8"))

# Plots of a run: title, label of y, names of series. SIDE: left and right.
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
    ("Dissipation by mechanism", "energy [J]", ["ledger.dissipated_damping", "ledger.dissipated_friction",
                                                "ledger.dissipated_rolling", "ledger.dissipated_parts",
                                                "ledger.dissipated_joints", "ledger.dissipated_yielding",
                                                "ledger.dissipated_crushing", "ledger.dissipated_micro_slip",
                                                "ledger.dissipated_soil"]),
    ("Energies of deformable soil", "energy [J]", ["ledger.soil_elastic_pressure", "ledger.soil_elastic_shear",
                                                   "ledger.soil_compaction", "ledger.soil_shear", "ledger.soil_slip_sinkage",
                                                   "ledger.soil_damping",
                                                   "ledger.soil_edges", "ledger.soil_coupling"]),
    ("Time-integration error", "energy [J]", ["ledger.integration_error", "ledger.residual"]),
    ("Grain-grain contacts", "contacts [-]", ["terrain.contacts"]),
    ("Largest overlap", "overlap [grain radii]", ["terrain.max_overlap", "terrain.part_overlap"]),
    ("Squeezed contacts", "contacts [-]", ["terrain.squeezed", "terrain.squeezed_at_boundaries",
                                          "terrain.squeezed_by_parts"]),
)
LEDGER = ("drive_work", "kinetic", "potential", "elastic", "dissipated", "dissipated_damping", "dissipated_friction",
          "dissipated_micro_slip", "dissipated_rolling", "dissipated_yielding", "dissipated_crushing", "dissipated_parts", "dissipated_joints",
          "integration_error", "residual", "turnover")
ENDINGS = {unit: unit for unit in ("s", "m", "J", "kg")}  # unit by name ending in manifest.json
#: First words of the warning about a run that has not finished, by status.
ENDED = {"running": "WARNING: this run is still running or was killed; the page shows the data written so far.",
         "incomplete": "WARNING: this run is incomplete:", "failed": "WARNING: this run failed:",
         "stopped": "WARNING: this run was stopped before its end; --resume continues it."}
#: Quantities with a value per shoe: title, label of y, name, whether only shoes in ground contact count.
SPREADS = (("Sinkage of the shoes in ground contact", "sinkage [m]", "sinkage", True),
           ("Track tension", "tension [N]", "tension", False),
           ("Ground pressure of the shoes in ground contact", "pressure [Pa]", "ground_pressure", True))
IN_CONTACT = "shoe in ground contact: between the first and last road wheel, and carrying load"


def sides(names):
    return [name.replace("SIDE", side) for name in names for side in (("left", "right") if "SIDE" in name else ("",))]


def columns_of(run, name):
    """[(label, values, series)] of a series with a number or vector per row; [] for one with a value per shoe."""
    series = run[name]
    if series.value.ndim == 1:
        return [(name, series.value, series)]
    if series.labels and len(series.labels) == series.value.shape[1]:
        return [(f"{name}.{label}", series.value[:, k], series) for k, label in enumerate(series.labels)]
    return []


def short(name):
    return re.sub(r"^(vehicle|ledger|terrain)\.", "", name).replace("_", " ").replace(".", " ")


def meanings(columns):
    """Definitions of the curves: "speed: speed of the hull at this track; ..."."""
    told = {}
    for _, _, series in columns:
        # This help text refers to other rows of results.h5, in older files to the rows below it.
        help_ = re.sub(r"sum of the ((eight|nine|\w+ \w+) below|datasets dissipated_\*)", "total dissipation", series.help)
        told.setdefault(re.sub(r"^(left|right) ", "", short(series.name)), help_)
    return "; ".join(f"{what}: {help_}" for what, help_ in told.items())


def within(columns, low, high):
    """Axis range that excludes values far beyond [low, high], and a note if values are excluded."""
    values = numpy.concatenate([values[numpy.isfinite(values)] for _, values, _ in columns])
    if values.min() >= low and values.max() <= high:
        return {}, ""
    return {"range": [max(low, values.min()), min(high, values.max())]}, \
        f" The axis covers {low:g} to {high:g}; values range from {values.min():.3g} to {values.max():.3g}."


def tracks_of(run, name):
    """{side: series} of a quantity with a value per shoe, for the tracks of the run."""
    return {side: run[f"vehicle.{side}.{name}"] for side in ("left", "right") if f"vehicle.{side}.{name}" in run}


def spread(values, of):
    """Mean, minimum and maximum of each row, over the shoes with a value that are `of` it [rows, shoes] (None: all);
    NaN if there are none."""
    counts = numpy.isfinite(values) if of is None else numpy.isfinite(values) & of
    there = counts.any(axis=1)
    mean = numpy.where(counts, values, 0.0).sum(axis=1) / numpy.maximum(1, counts.sum(axis=1))
    least, largest = (edge(numpy.where(counts, values, far), axis=1) for edge, far in
                      ((numpy.min, numpy.inf), (numpy.max, -numpy.inf)))
    return [numpy.where(there, one, numpy.nan) for one in (mean, least, largest)]


def curves(made, run):
    """The plots of the run's series."""
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
            of = "shoes in ground contact" if in_contact else "pin joints"
            below = name == "sinkage" and any((curve[2] < 0).any() for curve in drawn)
            figures.append(made.plot(title, "time [s]", axis, drawn, f"{series.help}; line: mean over the {of} of a "
                                     "track; band: minimum to maximum."
                                     f"{' ' + definitions.ABOVE_SURFACE if below else ''}{note}",
                                     about=f"{series.help}; {IN_CONTACT}" if in_contact else series.help))
    for group in ("surfaces", "obstacles"):
        for name in run.names(group + "."):
            if name.endswith(".force"):
                figures.append(made.plot(f"Force on {name.split('.')[1]}", "time [s]", "force [N]", [
                    (label.rpartition(".")[2], time, values[rows]) for label, values, _ in columns_of(run, name)],
                    run[name].help + "." + note))
    return f'<div class="plots">{"".join(figures)}</div>' if figures else ""


def any_series(made, run):
    """A plot of a selectable column, and a table of all columns."""
    rows, note = pages.thinned(len(run.time))
    if len(run.time) < 2:
        return ""
    columns = [column for name in run.names() for column in columns_of(run, name)]
    listed, lines, start = [], [], None  # start: the first that changes, preferably of the vehicle
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
        "Any column of timeseries.csv." + note)
    made.data["explorer"] = {"plot": len(made.data["plots"]) - 1, "time": time, "series": listed}
    chosen = (f'<div class="controls"><label>Series <select id="any-series">{"".join(options)}</select></label>'
              f'<span id="any-help">{esc(shown["help"])}</span></div>{figure}')
    return chosen + folded("Statistics of all series", table(
        ["series", "unit", "first", "last", "minimum", "mean", "maximum", "definition"], lines,
        "Over all rows of results.h5; one line per component of a vector.", numeric=range(2, 7)))


def part_caption(run, since):
    """Caption: the part of the run that the figures cover. since: start of this part [s]; None: no steady part."""
    end = run.manifest.get("simulated_time_s", run.time[-1] if len(run.time) else 0.0)
    planned = run.scene.get("run", {}).get("duration", end)
    if since is None:
        words = "Values at the end and over the whole run, because this run has no steady part."
    elif since >= end:
        words = "Values at the end and over the whole run: the run ended before the steady part, which would start at " \
                f"{number(since, 's', 'steady from')}."
    else:
        words = (f"Means and extremes from {number(since, 's', 'steady from')} on, as in the summary of a sweep; work, "
                 "errors and values \u201cat the end\u201d are from the last row.")
    by, step = run.manifest.get("ended_by"), end / max(1, run.manifest.get("steps", 1))
    if by or end < planned - 1.001 * step:  # the last step may end before run.duration
        words += f" The run ended at {number(end, 's', 'end')}, before the {number(planned, 's', 'duration')} of its scene"
        words += f", by {esc(by)}." if by else "."
    return words


def why_ended(manifest):
    """The reason why a run failed, was stopped or is incomplete."""
    return str(manifest.get({"failed": "error", "stopped": "stopped", "incomplete": "incomplete"}.get(manifest.get("status")), ""))


def figures(run, options):
    """Figures of the steady part, with the error bars of the last check of this scene, if any."""
    told = options.figures
    check = told.get("check") or {}
    barred = {figure["name"]: figure for figure in check.get("check", {}).get("figures", [])}
    rows, values = [], {}
    for figure in told.get("figures", []):
        name, value = figure["name"], figure["value"]
        plain, unit = grouser.series.split_unit(name)
        if plain == "steady from":  # shown in the caption
            continue
        checked = barred.get(name)
        bar = "none"
        if checked and checked["bar"] is not None:
            parts = ", ".join([*(e["axis"].replace("_", " ") for e in checked["errors"]),
                               *([counted(checked["seeds"], "seed")] if check["check"].get("seeds_matter") else [])])
            bar = f'{figure_with_bar(checked["value"], checked["bar"], "", f"{plain} checked")} ({esc(parts)})'
        if value is not None:
            values[plain] = [value]
        if value is not None or checked:
            rows.append([term(plain), number(value, "", plain), esc(unit), *([bar] if check else [])])
    if not rows:
        return f'<p>{esc(told["note"])}</p>' if told.get("note") else ""
    words = part_caption(run, told.get("steady_from")) + definitions.note(values)
    if doubt := told.get("inconclusive"):
        reason = "see the warning at the top" if doubt == run.manifest.get("incomplete") else doubt
        words = f'<strong class="bad">Inconclusive: {esc(reason)}.</strong> {words}'
    if check:
        words += (f" Error bars: last check of this scene, in <code>{esc(check['folder'])}</code>, commit "
                  f"<code>{esc(check['check']['program']['commit'])}</code>.")
    else:
        words += " No error bars yet: run <code>grouser check</code> on this scene."
    headings = ["figure", "this run", "unit", *(["checked value and its 95 % bar"] if check else [])]
    return table(headings, rows, words, numeric=(1,))


def constants(run):
    rows = []
    for name, q in run.constants.items():
        if q.value.shape == () and q.value.dtype.kind in "fiu" and not name.startswith("terrain.soil."):
            rows.append([f"<code>{esc(name)}</code>", number(float(q), "", name), esc(q.unit), esc(q.help)])
    begun = run.manifest.get("resumed_from_step")
    of = "the whole run" if begun is None else f"since the resume at step {begun}"
    rows += [[f"<code>{esc(key)}</code>", number(float(value), "", key), ENDINGS.get(key.rpartition("_")[2], ""),
              f"{esc(of)}; from manifest.json"] for key, value in run.manifest.get("figures", {}).items()]
    return table(["constant", "value", "unit", "definition"], rows, numeric=(1,)) if rows else ""


def ledger(runs):
    """The energy ledger at the end of one or several runs: side by side, or one row per run if there are many."""
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

    words = ("Changes from the first step to the end of the run. Drive work = kinetic + potential + elastic + "
             "dissipated energy + integration error + residual.")
    series = {name: next(end[name] for end in ends if name in end) for name in names}
    if len(runs) > MOST_BESIDE:
        rows = [[run_name(run.folder.name), *(cell(run, end, name) for name in names)]
                for run, end in zip(runs, ends)]
        return table(["run", *(f"{short(name)} [{series[name].unit}]" for name in names)], rows, words,
                     numeric=range(1, 1 + len(names)))
    rows = [[term(short(name), series[name].help), *(cell(run, end, name) for run, end in zip(runs, ends)), esc(series[name].unit),
             esc(series[name].help)] for name in names]
    headings = [run.folder.name for run in runs] if len(runs) > 1 else ["at the end"]
    return table(["term", *headings, "unit", "definition"], rows, words, numeric=range(1, 1 + len(runs)))


def switches(manifest):
    rows = []
    for line in manifest.get("switches", "").split("\n"):
        word, what, why = line[2:7].strip(), line[7:33].strip(), line[33:].strip()
        if len(line) > 33 and line[32:34].strip():  # no column boundary here
            what, why = line[7:].strip(), ""
        if what:
            rows.append([f'<span class="{esc(word)}">{esc(word)}</span>' if word else "", esc(what), esc(why)])
    if not rows:
        return "<p>The version that wrote this run did not record its features; <code>grouser plan</code> lists the " \
               "features of a scene.</p>"
    return table(["", "feature", "reason or method"], rows, "Features that are off use neither memory nor time.")


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
    files = table(["file", "bytes"], [[f"<code>{esc(name)}</code>", esc(f["bytes"])]
                                      for name, f in m.get("files", {}).items()], numeric=(1,))
    return facts(rows + soils) + folded("Files of the run", files)


def wall_time(manifest):
    """Wall time of all steps; extrapolated for a resumed run, which measures only the steps since its resume."""
    if "wall_time_s" not in manifest:
        return ""
    steps, before = manifest.get("steps", 0), manifest.get("figures", {}).get("resumed_at_step", 0)
    if not 0 < before < steps:
        return number(manifest["wall_time_s"], "s", "wall_time_s")
    return (f'{number(manifest["wall_time_s"] * steps / (steps - before), "s", "wall_time_s")}, extrapolated from the '
            f"steps since the resume at step {before:.0f}")


def number_text(value):
    return "" if value is None else f'<data value="{exact(value)}">{value:.0f}</data>'


def is_film(file):
    """Whether a browser can show the file, according to its name and first bytes."""
    if file.suffix.lower() not in FILMS or not file.is_file():
        return False
    with open(file, "rb") as opened:
        head = opened.read(16)
    return any(head[place:].startswith(mark) for place, mark in BEGINNINGS)


def films(folders, options, most=LARGEST_FILM):
    """The films in the folders, or the film of --film: embedded up to `most` bytes in total; others listed by name."""
    files = [options.film] if options.film else [f for folder in folders if folder.is_dir()
                                                 for f in sorted(folder.iterdir())
                                                 if is_film(f) and not grouser.files.leads_out(folder, f)]
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
        shown.append(f"<p>Too large to embed: {', '.join(beside)}; <code>--film FILE</code> embeds one.</p>")
    return "".join(shown)


def page(folder, options):
    run = damage.open_whole(Path(folder))
    made = pages.Page(f"{run.folder.resolve().name} (run)", "run", folder)
    if run.status != "finished":
        made.warnings.append(f"<p>{esc(ENDED.get(run.status, run.status))} {esc(why_ended(run.manifest))}</p>")
    for key in ("bed_warnings", "energy_warning", "soil_warning"):
        if warnings := run.manifest.get(key):
            made.warnings.append(f"<p>WARNING: {esc(warnings)}</p>")
    made.section("figures", "Figures", figures(run, options) + folded("Constants of the run", constants(run)))
    made.section("space", "3-D view", space.section(made, [run], options))
    made.section("pictures", "Pictures", pages.pictures([
        films([run.folder], options), pages.picture(run.folder / "picture.png", "End of the run"),
        pages.picture(run.folder / "surface.png", "Surface of the ground, with the path of the vehicle or bodies")]))
    made.section("fields", "Soil fields", soil_fields.section(run))
    made.section("deformable", "Deformable soil", soil_ground.section(made, run))
    made.section("plots", "Plots", curves(made, run))
    made.section("ledger", "Energy ledger", ledger([run]))
    made.section("series", "All series", any_series(made, run))
    made.section("switches", "Active features", switches(run.manifest))
    made.section("scene", "Scene", scene(run, "Resolved scene"))
    made.section("provenance", "Provenance", provenance(run))
    return made


def scene(run, title):
    """The scene of a run, from scene.toml, or from results.h5 if that is damaged."""
    text, words = grouser.files.read_text(run.folder / "scene.toml"), ""
    try:
        whole = tomllib.loads(text) == run.scene
    except tomllib.TOMLDecodeError:
        whole = False
    if not whole:
        with h5py.File(run.file, "r", locking=False) as results:
            text = grouser.files.long_text(results, "scene")
        words = '<p class="bad">scene.toml is damaged; this is the copy in results.h5.</p>'
    return words + folded(f"{title}: all keys with their values", f"<pre>{esc(text)}</pre>")
