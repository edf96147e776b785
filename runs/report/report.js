// SPDX-License-Identifier: BSD-3-Clause
// Unpacks the arrays of the page, draws the plots with dygraphs, and handles keyboard input of the plots.
"use strict";

const report = { arrays: {}, plots: [], space: null, ready: false };
window.report = report;

report.palette = {
  light: ["#0072b2", "#c44e00", "#007a58", "#a8457d", "#7a6000", "#1a1a1a", "#3b6fd8"],
  dark: ["#56b4e9", "#f09a3e", "#2bc79a", "#e78fc0", "#f0e442", "#ffffff", "#9db8ff"],
};
// One dash pattern fewer than colours, so that more curves differ in colour or dash.
report.dashes = [null, [7, 3], [2, 2], [9, 3, 2, 3], [12, 4], [5, 2, 2, 2, 2, 2]];

report.isDark = function () {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
};

/** A typed array from `{kind, shape, data}` (deflate, base64). */
report.unpack = async function (packed) {
  const bytes = Uint8Array.from(atob(packed.data), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const buffer = await new Response(stream).arrayBuffer();
  const kinds = { f8: Float64Array, f4: Float32Array, u4: Uint32Array, u2: Uint16Array, u1: Uint8Array };
  const array = new kinds[packed.kind](buffer);
  array.shape = packed.shape;
  return array;
};

/** Text as HTML: dygraphs interprets axis labels as HTML. */
report.escaped = function (text) {
  const codes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
  return String(text).replace(/[&<>"']/g, (c) => codes[c]);
};

report.shown = function (value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "none";
  return Number(value.toPrecision(5)).toString().replace(/-/g, "\u2212");
};

/** Rows of all curves for dygraphs: [x, y...], or [x, [low, y, high]...] with bars. */
report.rows = function (curves) {
  const bars = curves.some((c) => c.columns.length > 2);
  const rows = new Map();
  curves.forEach((curve, k) => {
    const [x, y, half, high] = curve.columns;
    for (let i = 0; i < x.length; ++i) {
      if (!rows.has(x[i])) rows.set(x[i], [x[i], ...curves.map(() => (bars ? [null, null, null] : null))]);
      const at = rows.get(x[i]);
      if (!bars) at[k + 1] = y[i];
      else if (high) at[k + 1] = [half[i], y[i], high[i]];
      else at[k + 1] = [y[i] - (half ? half[i] || 0 : 0), y[i], y[i] + (half ? half[i] || 0 : 0)];
    }
  });
  return { bars, rows: [...rows.values()].sort((a, b) => a[0] - b[0]) };
};

/** Tick label of an axis with maximum `most`: digits as needed by the ticks, uniform format. */
function tick(value, most) {
  const size = most || Math.abs(value), rounded = Number(value.toPrecision(6));
  const isPlain = rounded === 0 || (size < 1e6 && size >= 1e-3);
  const text = isPlain ? rounded.toString() : Number(value.toPrecision(3)).toExponential().replace("e+", "e");
  return text.replace(/-/g, "\u2212");
}

/** Largest magnitude. */
function greatest(values) {
  return values.reduce((most, v) => (Number.isFinite(v) ? Math.max(most, Math.abs(v)) : most), 0);
}

/** Tick label of an axis with integers. */
function wholeTick(value) {
  return Number.isInteger(value) ? tick(value) : "";
}

function sample(colour, dash, points, marked) {
  const ns = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(ns, "svg");
  svg.setAttribute("width", 34);
  svg.setAttribute("height", 10);
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(ns, points ? "circle" : "line");
  const set = points ? { cx: 17, cy: 5, r: 3.5, fill: colour } : { x1: 0, y1: 5, x2: 34, y2: 5 };
  for (const [key, value] of Object.entries(set)) line.setAttribute(key, value);
  if (!points) line.setAttribute("stroke", colour);
  line.setAttribute("stroke-width", 2);
  if (dash && !points) line.setAttribute("stroke-dasharray", dash.join(" "));
  svg.append(line);
  if (marked) {
    const mark = document.createElementNS(ns, "circle");
    for (const [key, value] of Object.entries({ cx: 17, cy: 5, r: 3.5, fill: colour })) mark.setAttribute(key, value);
    svg.append(mark);
  }
  return svg;
}

/** Separate points, with vertical bars if they have any. */
function drawMarked(e) {
  const pen = e.drawingContext;
  pen.save();
  pen.strokeStyle = e.color;
  pen.lineWidth = 1.3;
  for (const point of e.points) {
    const ends = [point.y_top, point.y_bottom].map((y) => e.plotArea.y + y * e.plotArea.h);
    if (!ends.every(Number.isFinite) || ends[0] === ends[1]) continue;
    pen.beginPath();
    pen.moveTo(point.canvasx, ends[0]);
    pen.lineTo(point.canvasx, ends[1]);
    for (const y of ends) {
      pen.moveTo(point.canvasx - 4, y);
      pen.lineTo(point.canvasx + 4, y);
    }
    pen.stroke();
  }
  pen.restore();
  Dygraph.Plotters.linePlotter(e);
}

class Plot {
  constructor(entry, index) {
    this.entry = entry;
    this.place = document.getElementById("plot" + index);
    this.legend = document.getElementById("plot" + index + "-legend");
    this.curves = entry.curves.map((c) => ({ label: c.label, columns: c.columns.map((n) => report.arrays[n]) }));
    this.place.addEventListener("keydown", (event) => this.key(event));
    this.draw();
  }

  /** Whether a curve has separate point marks with vertical bars. */
  isMarked(label) {
    return this.entry.marks === true || (this.entry.marks || []).includes(label);
  }

  draw() {
    const kept = this.graph && this.graph.isZoomed() ? this.graph.xAxisRange() : null;
    if (this.graph) this.graph.destroy();
    const { bars, rows } = report.rows(this.curves);
    this.count = rows.length;
    this.table = rows;
    const colours = report.palette[report.isDark() ? "dark" : "light"];
    const style = getComputedStyle(document.documentElement);
    const line = style.getPropertyValue("--grid").trim();
    const series = {};
    // Curves with the same name look the same; dygraphs requires unique names.
    this.names = [...new Set(this.curves.map((c) => c.label))];
    this.looks = this.names.map((_, k) => (
      { colour: colours[k % colours.length], marked: this.isMarked(this.names[k]),
        dash: this.isMarked(this.names[k]) ? [2, 2] : report.dashes[k % report.dashes.length] }));
    const labels = ["x", ...this.curves.map((c, k) => c.label + "\u200b".repeat(k))];
    this.curves.forEach((c, k) => {
      const look = this.looks[this.names.indexOf(c.label)];
      series[labels[k + 1]] = { color: look.colour, strokePattern: look.dash };
      if (this.isMarked(c.label))
        Object.assign(series[labels[k + 1]], { drawPoints: true, strokeWidth: 1, strokePattern: [2, 2],
          plotter: drawMarked });
    });
    const log = this.entry.log || "";
    const most = { x: log.includes("x") ? 0 : greatest(rows.map((row) => row[0])),
                   y: log.includes("y") ? 0 : greatest(this.entry.range || rows.flatMap((row) => row.slice(1).flat())) };
    const window_ = kept || (log.includes("x") && rows.length ? [rows[0][0], rows[rows.length - 1][0]] : null);
    this.graph = new Dygraph(this.place, rows, {
      labels, series, customBars: bars, xlabel: report.escaped(this.entry.x), ylabel: report.escaped(this.entry.y),
      gridLineColor: line, axisLineColor: line, strokeWidth: this.entry.points ? 0 : 1.6, drawPoints: !!this.entry.points,
      pointSize: 3.5, rightGap: 30, highlightCircleSize: 5, connectSeparatedPoints: true, fillAlpha: 0.22, legend: "never",
      yRangePad: 8, xRangePad: log.includes("x") ? 0 : this.entry.marks ? 16 : 4,
      logscale: log.includes("y"), dateWindow: window_, animatedZooms: false,
      valueRange: this.entry.range || null,
      axes: { x: { logscale: log.includes("x"), axisLabelWidth: 60, axisLabelFormatter: this.entry.whole ? wholeTick : (v) => tick(v, most.x) },
              y: { axisLabelWidth: 78, axisLabelFormatter: (v) => tick(v, most.y) } },
      highlightCallback: (event, x, points, row) => this.tell(row),
      unhighlightCallback: () => this.tell(-1),
    });
    this.tell(-1);
  }

  /** The legend, with the values of the selected row, if any. */
  tell(row) {
    const at = row >= 0 && row < this.count ? this.table[row] : null;
    this.legend.replaceChildren();
    const add = (text, look) => {
      const entry = document.createElement("span");
      entry.className = "entry";
      if (look) entry.append(sample(look.colour, look.dash, this.entry.points, look.marked));
      entry.append(text);
      this.legend.append(entry);
    };
    if (at) add(this.entry.x.replace(/ \[.*/, "") + " = " + report.shown(at[0]) + ":");
    this.names.forEach((name, n) => {
      const values = [];
      this.curves.forEach((curve, k) => {
        const value = at && curve.label === name ? at[k + 1] : null;
        if (Array.isArray(value) && value[1] !== null && value[0] === value[2]) values.push(report.shown(value[1]));
        else if (Array.isArray(value) && value[1] !== null)
          values.push(`${report.shown(value[1])} (${report.shown(value[0])} to ${report.shown(value[2])})`);
        else if (value !== null && !Array.isArray(value)) values.push(report.shown(value));
      });
      add(values.length ? `${name}: ${values.join("; ")}` : name, this.looks[n]);
    });
    this.row = row;
  }

  select(row) {
    row = Math.max(0, Math.min(this.count - 1, row));
    this.graph.setSelection(row);
    this.tell(row);
  }

  zoom(factor) {
    const [low, high] = this.graph.xAxisRange();
    const about = this.row >= 0 ? this.table[this.row][0] : 0.5 * (low + high);
    this.graph.updateOptions({ dateWindow: [about - factor * (about - low), about + factor * (high - about)] });
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const far = event.shiftKey ? 10 : 1;
    const does = {
      ArrowRight: () => this.select((this.row < 0 ? -1 : this.row) + far), Home: () => this.select(0),
      ArrowLeft: () => this.select((this.row < 0 ? this.count : this.row) - far), End: () => this.select(this.count - 1),
      "+": () => this.zoom(0.5), "-": () => this.zoom(2),
      Escape: () => { this.graph.resetZoom(); this.graph.clearSelection(); this.tell(-1); },
    }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  }
}

/** A plot of a column of the run, selected from a list. */
function explorer(list) {
  const choice = document.getElementById("any-series");
  if (!choice) return;
  const index = list.plot;
  choice.addEventListener("change", () => {
    const one = list.series[choice.selectedIndex];
    const plot = report.plots[index];
    const x = report.arrays[list.time];
    plot.entry.y = one.axis;
    plot.curves = [{ label: one.name, columns: [x, report.arrays[one.array]] }];
    plot.draw();
    document.getElementById("any-help").textContent = one.help;
  });
}

report.theme = function (name) {
  if (name) document.documentElement.dataset.theme = name;
  else delete document.documentElement.dataset.theme;
  for (const plot of report.plots) plot.draw();
};

async function begin() {
  const data = JSON.parse(document.getElementById("data").textContent);
  report.data = data;
  await Promise.all(Object.entries(data.arrays).map(async ([name, packed]) => {
    report.arrays[name] = await report.unpack(packed);
  }));
  // Without rounding digits: 0.59 for 0.5900000000000001.
  for (const number of document.querySelectorAll("main data"))
    number.title = number.value === "" || Number.isNaN(Number(number.value)) ? number.value : String(Number(Number(number.value).toPrecision(15)));
  // The page has its own legends; the legends of dygraphs have style attributes, which the policy of the page blocks.
  if (data.plots.length) Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);
  report.plots = data.plots.map((entry, index) => new Plot(entry, index));
  if (data.explorer) explorer(data.explorer);
  if (data.spaces) report.openSpaces(data.spaces);
  const choice = document.getElementById("theme");
  choice.addEventListener("change", () => report.theme(choice.value));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => report.theme(choice.value));
  window.addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll("details[data-print]")) part.open = true;
    report.theme("light");
  });
  window.addEventListener("afterprint", () => report.theme(choice.value));
  report.ready = true;
  document.documentElement.dataset.ready = "yes";
}

window.addEventListener("DOMContentLoaded", begin);
