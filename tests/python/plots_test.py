#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Plots: complete tick labels, legends next to the curves, no empty or duplicate panels."""
import json
import re
import sys
import unittest
from unittest import mock

import h5py
import numpy
from fixture import ROOT, FolderTest

sys.path[:0] = [str(ROOT / "runs/plots"), str(ROOT / "runs/report")]

import grouser
import bed
import check
import check_page
import compare
import drawing
import drive
import event_drawbar
import events
import figure
import ledger
import map as mobility_map
import mechanism
import page
import run_page
import series
import shoes
import single_shoes
import surface
import sweep
import sweep_page
from matplotlib.backends.backend_agg import FigureCanvasAgg

TIME = numpy.arange(0, 3, 0.02)
SHOES = 24


def pads(rise):
    """[rows, shoes]: the shoes touch the ground one after the other, then rise by this height [m]."""
    left = 0.1 * numpy.arange(SHOES)[None, :] - 0.6 * TIME[:, None]
    return numpy.clip(-left, 0, None) * rise - 0.01, left > 0


def written(file, rise=0.5, final=True, **more):
    """Results of a drive on a bed, as input of the plots."""
    values = {"vehicle/position": numpy.stack([0.3 * TIME, 0 * TIME, 0 * TIME], 1)}
    height, on_ground = pads(rise)
    for side in series.SIDES:
        values |= {f"vehicle/{side}/{name}": value for name, value in (
            ("pad_height", height), ("sinkage", numpy.where(on_ground, 0.01 + 0.001 * numpy.sin(height), numpy.nan)),
            ("sprocket_speed", TIME), ("speed", 0.2 * TIME), ("drive_torque", 100 * TIME),
            ("tension", 4000 + 0 * height), ("teeth_passed", numpy.clip(TIME - 1, 0, None)))}
    for name, _, _ in ledger.TERMS:
        values[f"ledger/{name}"] = 1e3 * TIME
    values["ledger/integration_error"] = 1e-7 * TIME
    values |= more
    with h5py.File(file, "w") as results:
        results["series/time"] = TIME
        for path, value in values.items():
            results[f"{path}/value"] = value
        results["vehicle/pitch_radius"] = numpy.array([0.25])
        x, y = numpy.linspace(0, 5, 51), numpy.linspace(-1, 1, 21)
        results["terrain/surface/x"], results["terrain/surface/y"] = x, y
        results["terrain/surface/height"] = 0.02 * numpy.sin(x)[None, :] + 0 * y[:, None]
        if final:
            results["terrain/surface/final_height"] = 0.02 * numpy.sin(x)[None, :] - 0.05 * (y[:, None] > 0.5)
        for name, curve in (("depth", [0.0, 0.1]), ("porosity_at_depth", [0.5, 0.4]), ("distance", []),
                            ("radial_distribution", []), ("porosity", [0.42]), ("order", [0.1])):
            results[f"terrain/bed/{name}"] = numpy.array(curve)
    return file


class Readable(FolderTest):
    def figure_of(self, plot, **values):
        with h5py.File(written("results.h5", **values)) as file:
            return self.drawn(plot(series.Run(file)))

    def drawn(self, figure):
        """Draws the figure as it is saved, and checks it for forbidden content."""
        drawing.save(figure, "picture.png", 80)
        FigureCanvasAgg(figure).draw()
        for axes in figure.axes:
            self.assertTrue(axes.has_data() or axes.texts, "an empty panel")
            inside = axes.get_window_extent()
            if legend := axes.get_legend():
                covers = legend.get_window_extent()
                self.assertFalse(covers.overlaps(inside) and covers.y0 < inside.y1 - 2 and covers.y1 > inside.y0 + 2 and
                                 covers.x0 < inside.x1 - 2, f"a legend covers the curves: {axes.get_ylabel()}")
            for axis in (axes.xaxis, axes.yaxis):
                self.assertEqual(axis.get_offset_text().get_text(), "", "a power of ten or an offset apart from its numbers")
                for text in axis.get_ticklabels():
                    self.assertNotRegex(text.get_text(), r"e\N{MINUS SIGN}[3-9]\d", "finer than rounding")
        return figure

    def test_of_a_vehicle(self):
        for plot in (shoes.heights, shoes.sinkage, surface.plot, bed.plot, drive.plot, ledger.plot):
            self.figure_of(plot)

    def test_map_and_section_have_one_x_axis(self):
        for final in (True, False):
            plan, section, *_ = self.figure_of(surface.plot, final=final).axes
            self.assertEqual(plan.get_xlim(), section.get_xlim())
            one, other = plan.get_window_extent(), section.get_window_extent()
            self.assertAlmostEqual(one.x0, other.x0)
            self.assertAlmostEqual(one.x1, other.x1)

    def test_deformable_soil_has_the_map_of_its_sinkage(self):
        sinkage = numpy.zeros((21, 51))
        sinkage[15:18] = 0.012
        file = written("results.h5", final=False)
        with h5py.File(file, "r+") as results:
            results["terrain/soil/sinkage"], results["terrain/soil/origin"] = sinkage, numpy.array([0.0, -1.0])
            results["terrain/soil/spacing"] = numpy.array([0.1])
        with h5py.File(file) as results:
            plan, section, bar, *_ = self.drawn(surface.plot(series.Run(results))).axes
        self.assertEqual(plan.get_xlim(), section.get_xlim())
        self.assertAlmostEqual(plan.collections[0].get_array().max(), 12)
        self.assertEqual(bar.get_ylabel(), "sinkage [mm]")
        self.assertTrue(numpy.allclose(section.lines[0].get_ydata(), -12), "along the deepest rut")
        self.assertIn("y = 0.50 m", section.get_ylabel())

    def test_a_close_up_is_drawn_where_it_shows_something_else(self):
        self.assertEqual(len(self.figure_of(shoes.heights).axes), 2)
        self.assertEqual(len(self.figure_of(shoes.heights, rise=0.002).axes), 1)

    def test_a_bed_too_thin_for_a_radial_distribution_has_no_panel_of_it(self):
        self.assertEqual(len(self.figure_of(bed.plot).axes), 1)

    def test_mechanisms_whose_joints_stay_closed(self):
        tiny = 1e-63 * numpy.exp(-TIME)
        bodies = {f"bodies/b{k}/position": numpy.stack([numpy.cos(TIME + k), numpy.sin(TIME + k), 0 * TIME], 1) for k in range(8)}
        error = {"ledger/integration_error": tiny, "ledger/elastic": tiny}
        for joints, panels in ((tiny, 3), (1e-16 * numpy.exp(-TIME), 3), (1e-12 * numpy.exp(-40 * TIME), 4)):
            figure = self.figure_of(mechanism.plot, **bodies, **error, **{"constraints/position_error": joints})
            self.assertEqual(len(figure.axes), panels)
            over_time = {axes.get_xlim() for axes in figure.axes if axes.get_xlabel() == "time [s]"}
            self.assertEqual(len(over_time), 1)

    def test_single_shoes_have_the_time_of_the_table(self):
        """The sprockets start at 1 s: the first shoe in the plot starts at 0 s, as in sinkage_shoes.csv."""
        written("results.h5")
        kept = []
        with mock.patch.object(drawing, "save", lambda figure, *_, **__: kept.append(figure)), \
                mock.patch.object(sys, "argv", ["single_shoes.py", "results.h5", "left:10,11", "picture.png"]):
            single_shoes.main()
        figure, = kept
        self.assertEqual([axes.get_title() for axes in figure.axes], ["left track", ""])
        self.assertEqual(list(figure.axes[0].lines[0].get_xdata()), list(TIME))


SUMMARY = """run,k,status,message,inconclusive,wall time [s],steps,simulated time [s],slip [-],drawbar pull [N],state hash
k=1,1,incomplete,never drove,see message,1,1,1,0.9,50,x
k=2,2,finished,,,1,1,1,0.1,60,y
k=3,3,finished,,1.2 teeth in the steady part,1,1,1,0.8,70,z
k=4,4,finished,,"direction of motion changes: gross traction, drawbar pull, motion resistance",1,1,1,0.2,80,w
"""
INTERVALS = """k,figure,seeds,mean,half width,difference to the first,half width of the difference,inconclusive
1,slip [-],3,0.9,0.1,0,0,never drove
2,slip [-],3,0.1,0.01,0,0,
3,slip [-],1,0.2,,0,,
"""


class Doubtful(FolderTest):
    """Plots mark the results of runs that hardly drove or are incomplete."""

    def written(self, intervals=""):
        (self.folder / "summary.csv").write_text(SUMMARY)
        if intervals:
            (self.folder / "intervals.csv").write_text(intervals)
        return grouser.open_sweep(self.folder)

    def slips(self, table, label="slip [-]"):
        figure = sweep.draw(table)
        panel = next(axes for axes in figure.axes if axes.get_ylabel() == label)
        bars = [bar for container in panel.containers for bar in container[2]]
        found = {}
        for line in panel.lines:
            if line.get_marker() in "ox":
                found.setdefault(line.get_marker(), []).extend(zip(map(float, line.get_xdata()), line.get_ydata()))
        return found, figure.get_suptitle() if hasattr(figure, "get_suptitle") else figure._suptitle.get_text(), bars

    def test_are_crosses_in_plots_of_a_sweep(self):
        self.written()
        marks, title, _ = self.slips("summary.csv")
        self.assertEqual(marks, {"o": [(2, 0.1), (4, 0.2)], "x": [(1, 0.9), (3, 0.8)]})
        self.assertIn("crosses: inconclusive", title)

    def test_a_pull_has_a_panel_with_the_crosses_of_a_reversed_run(self):
        def table(traction):
            text = SUMMARY.replace("pull [N],", "pull [N],gross traction [N],", 1)
            (self.folder / "pull.csv").write_text(re.sub(r"(\d\d),([xyzw])\n", rf"\1,{traction},\2\n", text))
            return "pull.csv"
        marks, title, _ = self.slips(table(100), "drawbar pull [N]")
        self.assertEqual(marks, {"o": [(2, 60)], "x": [(1, 50), (3, 70), (4, 80)]})
        self.assertEqual(len(sweep.draw(table(100)).axes), 6)
        self.assertEqual(len(sweep.draw(table(10000)).axes), 4, "without a hitch the pull is close to zero")

    def test_means_have_no_bar_where_the_interval_is_not_known(self):
        self.written(INTERVALS)
        marks, title, bars = self.slips("intervals.csv")
        self.assertEqual(marks["x"], [(1, 0.9)])
        self.assertIn("95 % intervals", title)
        (self.folder / "one.csv").write_text("\n".join([INTERVALS.split("\n")[0], INTERVALS.split("\n")[3]]) + "\n")
        marks, title, bars = self.slips("one.csv")
        self.assertEqual((marks, bars), ({"o": [(3, 0.2)]}, []))
        self.assertEqual(title, "Means over the steady part, without intervals: one seed each")

    def test_are_left_out_of_a_reports_curves_and_marked_in_its_table(self):
        opened = self.written()
        def curve(name):
            return sweep_page.curves_of(opened, name, lambda keys: float(keys["k"]), lambda keys: "")
        self.assertEqual(curve("slip"), ({"": [(2.0, 0.1), (4.0, 0.2)]}, 2))
        self.assertEqual(curve("drawbar pull"), ({"": [(2.0, 60.0)]}, 3))
        rows = sweep_page.runs_table(opened, {}).split("<tr>")[2:]
        self.assertEqual([row.count(page.INCONCLUSIVE) for row in rows], [2, 0, 2, 1])
        opened = self.written(INTERVALS)
        groups, left_out = curve("slip")
        self.assertEqual(([point[:2] for point in groups[""]], left_out), ([(2.0, 0.1), (3.0, 0.2)], 1))

    def test_stand_open_in_the_plot_of_a_check(self):
        def drawn(doubtful, status):
            figure = {"name": "slip [-]", "value": 0.5, "bar": 0.1, "bar_of_step": [0.1, 0.05], "errors": [], "seeds": 1,
                      "inconclusive": doubtful, "seeds_half_width": None}
            cases = [{"name": name, "axis": "step", "status": status} for name in ("base", "step_over_2")]
            costs = {"cases": [{"name": "base", "wall_s": 3.0}, {"name": "step_over_2", "wall_s": 6.0}]}
            axes = drawing.Figure().subplots()
            check.panel(axes, figure, {"step_cases": ["base", "step_over_2"], "cases": cases, "seeds_matter": False}, costs)
            return axes.get_title(), sum(line.get_markerfacecolor() == "none" for line in axes.lines)
        self.assertEqual(drawn(False, "finished"), ("slip [-]", 0))
        self.assertEqual(drawn(True, "finished"), ("slip [-] (inconclusive)", 2))
        self.assertEqual(drawn(False, "incomplete"), ("slip [-]", 2))

    def test_ticks_of_run_times_have_room_for_their_numbers(self):
        self.assertEqual(check.ticks_between(0.6, 21.0), [1, 2, 5, 10, 20])
        self.assertEqual(check.ticks_between(0.02, 3000.0), [0.1, 1, 10, 100, 1000])
        for low, high in ((3.1, 3.4), (11, 19), (0.02, 3e9), (4.5, 5.5)):
            places = check.ticks_between(low, high)
            self.assertTrue(2 <= len(places) <= 5, (low, high, places))
            self.assertTrue(all(low <= place <= high for place in places), (low, high, places))

    def test_what_is_0_in_all_runs_is_sure(self):
        self.assertNotIn("inconclusive", page.figure_with_bar(0.0, 0.0, "", "", True))
        self.assertIn("inconclusive", page.figure_with_bar(0.2, 0.0, "", "", True))

    def test_incomplete_runs_of_a_check_have_films_and_ledgers(self):
        class Check:
            folder = self.folder
        case = {"name": "base", "runs": [{"seed": 1, "status": status} for status in ("incomplete", "failed", "finished")]}
        self.assertEqual(len(check_page.runs_of(Check, case)), 2)

    def test_a_resumed_runs_wall_time_is_that_of_all_steps(self):
        def seconds(**figures):
            return float(re.search(r'value="([^"]+)"', run_page.wall_time({"wall_time_s": 10.0, "steps": 3000, "figures": figures}))[1])
        self.assertEqual([seconds(), seconds(resumed_at_step=1500), seconds(resumed_at_step=3000)], [10, 20, 10])


class Texts(FolderTest):
    """Names, titles and values are drawn as they are: $ does not start a formula, and _ does not hide a label."""

    BAD = (r"$\frac$", "$x", "_arm", r"a\$b$c", "<b>&amp;</b>", "50 % $_{", "100 $ to 200 $")

    def texts(self, figure):
        drawing.save(figure, "picture.png", 80)
        return [text.get_text().lstrip("\u200b") for text in figure.findobj(drawing.matplotlib.text.Text)]

    def test_of_selected_columns(self):
        for bad in self.BAD[:5]:
            title = bad.replace("<b>", "b")
            scene = "[[output.plot]]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in (
                ("x", "time"), ("y", ["ledger.kinetic"]), ("labels", [bad]), ("title", title), ("x_label", bad), ("y_label", bad),
                ("levels", [1.0]), ("level_labels", [bad + "1"]), ("sum", False), *(
                    (f"{axis}_{what}", value) for axis in "xy" for what, value in (("scale", 1.0), ("offset", 0.0), ("from_start", False)))))
            with h5py.File(written("results.h5"), "r+") as results:
                results.attrs["scene"] = scene
                results["ledger/kinetic"].attrs["unit"] = bad
            with h5py.File("results.h5") as results:
                texts = self.texts(figure.plot(series.Run(results)))
            self.assertEqual([text for text in (bad, bad + "1", title) if text not in texts], [])

    def test_of_bodies(self):
        bodies = {f"bodies/{name.replace('/', '')}/position": numpy.stack([TIME + k, TIME, 0 * TIME], 1)
                  for k, name in enumerate(self.BAD)}
        error = 1e-12 * numpy.exp(-TIME)
        with h5py.File(written("results.h5", **bodies, **{"ledger/elastic": error, "constraints/position_error": error})) as file:
            drawn = mechanism.plot(series.Run(file))
        texts = self.texts(drawn)
        self.assertEqual([name for name in self.BAD if name.replace("/", "") not in texts], [])
        self.assertFalse([text for text in texts if "mathdefault" in text], "tick labels of a logarithmic axis")

    def test_of_tables_and_campaigns(self):
        def put(value, name="in.json"):
            (self.folder / name).write_text(value if isinstance(value, str) else json.dumps(value), encoding="utf-8")
            return name
        for bad in self.BAD[:2]:
            row = {"event": bad, "level": 1.0, "verdict": bad, "why": bad, "figures": [
                {"name": "speed [m/s]", "mean": 1.0, "half_width": 0.1}, {"name": "drawbar pull [N]", "mean": 1.0, "half_width": 0.1}]}
            told = {"vehicle": bad, "soil": bad, "seeds": 3, "commit": bad, "rows": [row, {**row, "level": 2.0}]}
            shown = [self.texts(events.draw(put(told)))]
            told["rows"] = [{**one, "event": "drawbar"} for one in told["rows"]]
            shown.append(self.texts(event_drawbar.draw(put(told))))
            columns = [{"value": bad + n, "speed_m_s": 1.0, "limits": [], "rows": told["rows"]} for n in "12"]
            shown.append(self.texts(mobility_map.draw(put({"columns": columns, "key": bad, "level_is": bad, "title": bad, "vehicle": bad,
                                                           "soil": bad, "ground": bad, "commit": bad}))))
            means = [{"mean": 1.0, "half_width": 0.1}] * 2
            shown.append(self.texts(compare.draw(put({"scene": f"{bad.replace('/', '')}.toml", "variants": [
                {"variant": bad + n, "wall_time_per_second": 1.0} for n in "12"], "rows": [{"figure": f"{bad} force x", "means": means}]}))))
            table = f'run,"{bad}",status,slip [-]\na,"{bad}",finished,0.1\nb,"{bad}2",finished,0.2\n'
            shown.append(self.texts(sweep.draw(put(table, "summary.csv"))))
            plain = str.maketrans("_", " ", "/")
            self.assertTrue(all(any(bad.translate(plain) in text.translate(plain) for text in texts) for texts in shown), bad)


class Numbers(unittest.TestCase):
    def test_at_axes_are_whole(self):
        def ticks(*places):
            formatter = drawing.Ticks()
            formatter.locs = list(places)
            return [formatter(place) for place in places]
        self.assertEqual(ticks(0, 0.25, 0.5), ["0", "0.25", "0.50"])
        self.assertEqual(ticks(1000.0, 1000.5), ["1000.0", "1000.5"])
        self.assertEqual(ticks(-1e-5, 0, 1e-5), ["\N{MINUS SIGN}1e\N{MINUS SIGN}5", "0", "1e\N{MINUS SIGN}5"])
        self.assertEqual(ticks(0, 5e6), ["0", "5e6"])

    def test_have_no_more_digits_than_their_interval_allows(self):
        def text(*given):
            return re.sub("<[^>]+>", "", page.with_bar(*given))
        self.assertEqual(text(0.27056, 4e-12), "0.27056 (exact)")
        self.assertEqual(text(0.07294, 0.00903), "0.0729 \N{PLUS-MINUS SIGN} 0.0090")
        self.assertEqual(text(12345.6, 780.0), "12350 \N{PLUS-MINUS SIGN} 780")
        self.assertEqual(text(1234567.0, 21000.0), "(1.235 \N{PLUS-MINUS SIGN} 0.021) \N{MULTIPLICATION SIGN} 106")

    def test_of_a_track_are_of_its_shoes_in_ground_contact(self):
        """Four of six shoes carry 100 kPa; two on the upper run are pulled by -102 and 20 kPa: the mean of all is 53."""
        pressure = numpy.array([[1e5, 1e5, 1e5, 1e5, -1.02e5, 2e4], [numpy.nan] * 6])
        on_ground = numpy.array([[1, 1, 1, 1, 0, 0], [0] * 6]) > 0
        mean, least, largest = run_page.spread(pressure, on_ground)
        self.assertEqual((mean[0], least[0], largest[0]), (1e5, 1e5, 1e5))
        self.assertTrue(numpy.isnan([mean[1], least[1], largest[1]]).all())
        self.assertEqual(run_page.spread(pressure, None)[1][0], -1.02e5)


if __name__ == "__main__":
    unittest.main()
