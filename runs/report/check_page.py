# SPDX-License-Identifier: BSD-3-Clause
"""The report of a check: figures with error bars, their causes, series with bands, cost of each case."""
import math

import numpy

import damage
import definitions
import grouser
import page as pages
import run_page
from grouser.series import counted
from page import esc, facts, figure_with_bar, folded, number, table, term, with_bar

MOST_FIGURES = 24  # maximum number shown, headline figures first; the others are folded
VERDICTS = {"not shown": "inconclusive"}  # page text by verdict of check.json


def known(half):
    return half if math.isfinite(half) else None


def axis_words(error):
    order = f", order {error.order:.1f}" if math.isfinite(error.order) else ""
    return (f'{with_bar(error.change.value, known(error.change.half_width), "", f"{error.change.name} {error.axis}")}<br>'
            f'<em>{esc(VERDICTS.get(error.verdict, error.verdict))}</em>{order}')


def headlines(check):
    """Names of the headline figures."""
    return {grouser.series.split_unit(f["name"])[0] for f in check.json["figures"] if f.get("headline", True)}


def main_figures(check):
    """The headline figures, or all figures if no headline figures exist."""
    return [figure for figure in check if figure.name in headlines(check)] or list(check)


def figures(check):
    axes = list(dict.fromkeys(axis for figure in check for axis in figure.errors))
    headline = headlines(check)
    rows = [(figure.name in headline, [
        term(figure.name), figure_with_bar(figure.bar.value, known(figure.bar.half_width), "", figure.name,
                                          figure.inconclusive),
        esc(figure.bar.unit), f"\u00b1 {number(known(figure.by_seeds.half_width), '', figure.name + ' seeds', 2)}",
        esc(figure.seeds), *(axis_words(figure.errors[a]) if a in figure.errors else "not run" for a in axes)])
        for figure in check]
    headings = ["figure", "value and 95 % error bar", "unit", "bar of the seeds", "seeds",
                *(a.replace("_", " ") for a in axes)]
    words = ("The error bar combines the seeds and all axes that were run. Further columns: change by each axis, \u00b1 "
             "half width of its 95 % interval, and whether the change is within "
             f"{number(check.json.get('bar_percent'))} % of the value.")
    words += definitions.note({figure.name: [figure.bar.value] for figure in check})
    first = [row for is_headline, row in rows if is_headline][:MOST_FIGURES]
    rest = [row for _, row in rows if row not in first]
    inner = table(headings, first or rest, words, numeric=(1, 3, 4))
    return inner + (folded(counted(len(rest), "more figure"), table(headings, rest, numeric=(1, 3, 4)))
                    if first and rest else "")


def goals(check):
    """Error bars requested by --of, and the largest contribution to each."""
    rows = []
    for one in check.json.get("of", []):
        name, unit = grouser.series.split_unit(one["figure"])
        largest = max(one["parts"], key=lambda part: math.inf if part["bar"] is None else part["bar"], default=None)
        rows.append([term(name), number(one["bar"], digits=3), number(one["wanted"], digits=3), esc(unit), esc(one["state"]),
                     esc(largest["part"].replace("_", " ")) if largest else "", number(largest["bar"], digits=3) if largest else ""])
    words = f"Target error bar: {number(check.json.get('bar_percent'))} % of the value."
    return table(["figure", "error bar", "target", "unit", "state", "largest part", "bar of that part"], rows, words,
                 numeric=(1, 2, 6)) if rows else ""


def shares(made, check):
    """Error bars in percent of the values, by cause."""
    told_errors = {grouser.series.split_unit(one["name"])[0]: one["errors"] for one in check.json["figures"]}
    found = [f for f in main_figures(check) if f.bar.value and math.isfinite(f.bar.value)][:MOST_FIGURES]
    if not found:
        return ""
    def percent(figure, half):
        return 100 * half / abs(figure.bar.value) if math.isfinite(half) else math.nan
    rows = []
    for figure in found:
        parts = [("seeds", percent(figure, figure.by_seeds.half_width))]
        parts += [(e["axis"], percent(figure, grouser.series.number(e.get("bar")))) for e in told_errors[figure.name]
                  if e["axis"] != "precision" or not check.json.get("seeds_matter")]  # the seeds include its effect
        parts = [(name, value) for name, value in parts if math.isfinite(value)]
        if not parts:
            continue
        name, most = max(parts, key=lambda part: part[1])
        total = percent(figure, figure.bar.half_width)
        rows.append([term(figure.name), number(total, digits=3), f"{esc(name.replace('_', ' '))} ({number(most, digits=3)} %)"])
    return table(["figure", "error bar [% of the value]", "largest part"], rows, numeric=(1,))


def bands(made, check):
    """Main series with error bands: vehicle and ledger first."""
    if not (check.folder / "series.csv").is_file() or not check.series:
        return ""
    wanted = ("vehicle.position.x", "vehicle.position.z", "vehicle.velocity.x", "vehicle.left.speed",
              "vehicle.left.slip", "vehicle.left.drive_torque", "vehicle.gross_traction", "ledger.drive_work",
              "ledger.integration_error")
    names = [n for n in wanted if n in check.series] or list(check.series)[:8]
    inner = []
    for name in names:
        s = check.series[name]
        there = numpy.isfinite(s.value)
        if not there.any() or not numpy.any(s.value[there]):
            continue
        rows, note = pages.thinned(len(s.time))
        rows = rows[there[rows]]
        half = numpy.where(numpy.isfinite(s.bar), s.bar, 0.0)
        ends = numpy.concatenate([s.value[rows] - half[rows], s.value[rows] + half[rows]])
        low, high = numpy.quantile(ends, (0.01, 0.99))
        reach = 0.3 * (high - low)
        more, cut = run_page.within([(name, ends, s)], low - reach, high + reach)
        inner.append(made.plot(name, "time [s]", f"{name.rpartition('.')[2].replace('_', ' ')} [{s.unit}]",
                               [(name, s.time[rows], s.value[rows], half[rows])],
                               f"Band: 95 % interval from seeds and time step, if they were run.{cut}{note}", **more))
    return f'<div class="plots">{"".join(inner)}</div>'


def costs(made, check):
    if not (check.folder / "costs.json").is_file():
        return ""
    cost = check.costs
    rows = []
    for case in check.json["cases"]:
        c = cost.get(case["name"], {})
        rows.append([esc(case["name"].replace("_", " ")), esc(case["what"]), esc(case["status"]),
                     number(c.get("wall_s"), "", f"{case['name']} wall"), number(c.get("cpu_s"), "", f"{case['name']} cpu"),
                     number(c.get("steps")), esc("; ".join(case["overrides"])), esc(case.get("message", ""))])
    inner = cheapest(check) + table(
        ["case", "description", "status", "wall time [s]", "CPU time [s]", "steps", "changed keys", "message"], rows,
        "Medians over the runs of each case.", numeric=(3, 4, 5))
    return inner + error_over_time(made, check, cost)


def cheapest(check):
    """Cheapest settings for error bars of 10, 5 and 1 %, and the total wall time of the runs they require."""
    file = check.folder / "costs.json"
    told = grouser.files.read_json(file, "costs of a check").get("cheapest", [])
    percents = list(dict.fromkeys(key for row in told for key in row if key != "figure"))
    if not percents:
        return ""
    def cell(row, percent):
        one = row.get(percent)
        if not one:
            return "none of the tested settings"
        seeds = f", {counted(one['seeds'], 'seed')}" if check.json.get("seeds_matter") else ""
        name = f"{row['figure']} {percent}"
        return f"{esc(one['case'].replace('_', ' '))}{seeds}: {number(one['wall_s'], 's', name, 3)}"
    rows = [[esc(grouser.series.split_unit(row["figure"])[0]), *(cell(row, percent) for percent in percents)]
            for row in told]
    return table(["figure", *(f"error bar {percent}" for percent in percents)], rows,
                 "Cheapest settings for each error bar (percent of the value), and the total wall time of the runs "
                 "they require.")


def error_over_time(made, check, cost):
    """Error bar of the time step over wall time, one curve per figure."""
    drawn, names = [], {figure.name for figure in main_figures(check)}
    for one in check.json["figures"]:
        if grouser.series.split_unit(one["name"])[0] not in names:  # e.g. figures that differ only by rounding
            continue
        value = one["value"]
        points = sorted((cost[name]["wall_s"], 100 * abs(bar / value)) for name, bar in
                        zip(check.json.get("step_cases", []), one.get("bar_of_step", []))
                        if bar and value and cost.get(name, {}).get("wall_s"))
        if len(points) > 1 and len(drawn) < 7:
            drawn.append((grouser.series.split_unit(one["name"])[0], *map(list, zip(*points))))
    return made.plot("Error over run time", "wall time of a run [s]", "error bar of the time step [% of the value]",
                     drawn, "One point per time step.", log="xy", marks=True) if drawn else ""


def runs_of(check, case):
    """Folders of the finished runs of a case."""
    def folder(name):
        return grouser.files.inside(check.folder, name, check.folder / "check.json")
    plain = folder(case["name"])  # folder of a case without seeds
    return [plain if plain.is_dir() and not seeded.is_dir() else seeded for run in case["runs"]
            if run.get("status", "finished") in ("finished", "incomplete")
            for seeded in [folder(f"{case['name']},seed={run['seed']}")]]


def machine_of(check):
    file = check.folder / "costs.json"
    return grouser.files.read_json(file, "costs of a check").get("machine", "") if file.is_file() else ""


def provenance(check):
    j, program = check.json, check.json.get("program", {})
    seeds = sorted({run["seed"] for case in j["cases"] for run in case["runs"]})
    return facts([("scene", f"<code>{esc(j.get('scene', ''))}</code>"),
                  ("overridden", ", ".join(f"<code>{esc(o)}</code>" for o in j.get("overrides", []))),
                  ("program", f"grouser {esc(program.get('version', ''))}, commit "
                              f"<code>{esc(program.get('commit', ''))}</code>"),
                  ("machine", esc(machine_of(check))),
                  ("seeds", ", ".join(map(esc, seeds))), ("origin", f"<code>{esc(j.get('origin', ''))}</code>"),
                  ("same bits with a different skin", esc(str(j.get("skin", "")))),
                  ("not run", "; ".join(f"{esc(axis.replace('_', ' '))}: {esc(why)}"
                                        for axis, why in check.not_run.items()))])


def page(folder, options):
    import sweep_page
    check = grouser.open_check(folder)
    made = pages.Page(f"{check.folder.resolve().name} (check)", "check", folder)
    if check.json.get("inconclusive"):
        made.warnings.append(f"<p>WARNING: all figures are inconclusive: {esc(check.json['inconclusive'])}</p>")
    notes = damage.add_notices(made, [(n["kind"] == "warning", n["text"], len(n["runs"])) for n in check.json.get("notices", [])])
    made.section("figures", "Figures with error bars", goals(check) + figures(check) + notes)
    made.section("shares", "Causes of the error bars", shares(made, check))
    made.section("plots", "Series with error bands", bands(made, check))
    made.section("costs", "Cost", costs(made, check))
    folders, faults = sweep_page.first_whole([runs_of(check, case) for case in check.json["cases"]])
    damage.warn(made, faults)
    sweep_page.add_runs(made, folders, options, "First run of each case.")
    made.section("provenance", "Provenance", provenance(check))
    return made
