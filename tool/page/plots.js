// The live plots of the selected finger.

import uPlot from "./vendor/uplot.js";
import { colour, onColours } from "./theme.js";

const SECONDS = 10;
const DEGREES = 180 / Math.PI;
const HEIGHT_LEAST = 116;

const of = (names, label, options = {}) =>
  names.map((name, index) => ({ name, label: label(index), stroke: `series-${index + 1}`, ...options }));

/// The plots: title, unit, and their series. `stroke` is a colour of style.css.
const PLOTS = [
  {
    title: "Joints",
    unit: "°",
    scale: DEGREES,
    decimals: 1,
    series: [
      ...of(["q0", "q1", "q2"], (index) => `${index}`, { width: 1.75 }),
      ...of(["d0", "d1", "d2"], (index) => `set point ${index}`, { dash: [4, 4], width: 1, quiet: true }),
    ],
  },
  {
    title: "Tensions",
    unit: "N",
    scale: 1,
    decimals: 1,
    bounds: (finger) => finger.tension,
    series: of(["t0", "t1", "t2", "t3"], (index) => `${index + 1}`, { width: 1.5 }),
  },
  {
    title: "Tip force",
    unit: "N",
    scale: 1,
    decimals: 2,
    series: of(["f0", "f1", "f2"], (index) => "xyz"[index], { width: 1.5 }),
  },
  {
    title: "Largest wake-up delay in each 1/60 s",
    unit: "µs",
    scale: 1,
    decimals: 0,
    fromZero: true,
    series: [{ name: "wake", label: "wake-up", stroke: "series-1", width: 1.25, fill: true }],
  },
];

/// A range that rarely changes, so that the axis does not jitter.
function calmRange(low, high, fromZero) {
  if (low === null || high === null || !Number.isFinite(low + high)) return [0, 1];
  const least = Math.max(Math.abs(high), 1) * 0.05;
  const room = Math.max(high - low, least) * 0.12;
  const step = 10 ** Math.floor(Math.log10(Math.max(high - low, least))) / 2;
  const from = fromZero ? 0 : Math.floor((low - room) / step) * step;
  return [from, Math.ceil((high + room) / step) * step];
}

/// Draws t_min and t_max. A bound above the range is named at the upper edge.
function boundLines(plot, bounds) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = colour("bound");
  ctx.font = `${10 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.setLineDash([2, 4]);
  ctx.lineWidth = devicePixelRatio;
  const right = bbox.left + bbox.width - 4 * devicePixelRatio;
  for (const [name, bound] of [
    ["t_min", bounds.low],
    ["t_max", bounds.high],
  ]) {
    const y = plot.valToPos(bound, "y", true);
    const inside = y >= bbox.top;
    ctx.textAlign = "right";
    ctx.textBaseline = inside ? "bottom" : "top";
    ctx.fillText(
      inside ? name : `${name} ${bound} ↑`,
      right,
      Math.max(y, bbox.top) + (inside ? -2 : 2) * devicePixelRatio,
    );
    if (!inside) continue;
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
  }
  ctx.restore();
}

class Plot {
  /// `pointed(time)` is called while the cursor is over the plot, with null when it leaves.
  constructor(parent, kind, pointed) {
    this.kind = kind;
    this.pointed = pointed;
    this.box = document.createElement("figure");
    const caption = `<b>${kind.title}</b> <small>${kind.unit}</small><span></span>`;
    this.box.innerHTML = `<figcaption>${caption}</figcaption><div></div>`;
    parent.append(this.box);
    this.legend = this.box.querySelector("span");
    this.body = this.box.querySelector("div");
    this.box.addEventListener("mouseleave", () => this.pointed(null));
    new ResizeObserver(() => this.resize()).observe(this.body);
  }

  size() {
    return { width: Math.max(this.body.clientWidth, 60), height: Math.max(this.body.clientHeight, HEIGHT_LEAST) };
  }

  resize() {
    this.plot?.setSize(this.size());
  }

  build() {
    this.plot?.destroy();
    const axis = {
      stroke: colour("quiet"),
      font: "11px system-ui, sans-serif",
      ticks: { show: false },
      grid: { stroke: colour("plot-grid"), width: 1 },
    };
    const { kind } = this;
    const series = kind.series.map((one) => ({
      stroke: colour(one.stroke),
      width: one.width,
      dash: one.dash,
      points: { show: false },
      fill: one.fill ? `${colour(one.stroke)}30` : undefined,
    }));
    const options = {
      ...this.size(),
      legend: { show: false },
      padding: [6, 8, 0, 0],
      cursor: { y: false, drag: { x: false, y: false }, points: { size: 5 } },
      scales: {
        x: { time: false, range: (_, low, high) => [low, high] },
        y: { range: (_, low, high) => this.range(low, high) },
      },
      axes: [
        { ...axis, size: 25, gap: 7, values: (_, ticks) => ticks.map((tick) => `${tick} s`), space: 60 },
        { ...axis, size: 44, gap: 4, space: 26 },
      ],
      series: [{}, ...series],
      hooks: {
        draw: [(plot) => this.bounds && boundLines(plot, this.bounds)],
        setCursor: [
          (plot) => plot.cursor.idx != null && plot.cursor.left >= 0 && this.pointed(plot.data[0][plot.cursor.idx]),
        ],
      },
    };
    this.plot = new uPlot(options, [[], ...series.map(() => [])], this.body);
    this.legend.replaceChildren(
      ...kind.series
        .filter((one) => !one.quiet && kind.series.length > 1)
        .map((one) => {
          const entry = document.createElement("em");
          entry.textContent = one.label;
          entry.style.setProperty("--own", colour(one.stroke));
          return entry;
        }),
    );
  }

  range(low, high) {
    if (this.bounds && low !== null) [low, high] = [Math.min(low, this.bounds.low), high];
    return calmRange(low, high, this.kind.fromZero);
  }

  /// Draws the last seconds before `time`. `time` is 0 on the time axis.
  show(samples, finger, time) {
    if (!this.plot) this.build();
    this.bounds = this.kind.bounds?.(finger);
    const names = ["t", ...this.kind.series.map((one) => one.name)];
    const [times, ...values] = samples.window(
      time - SECONDS,
      time,
      names.map((name) => samples.columns[name]),
    );
    const { scale } = this.kind;
    const scaled = values.map((column) => column.map((value) => (Number.isNaN(value) ? null : value * scale)));
    this.plot.setData([times.map((at) => at - time), ...scaled], false);
    this.plot.batch(() => {
      this.plot.setScale("x", { min: -SECONDS, max: 0 });
    });
  }
}

export class Plots {
  constructor(parent, pointed) {
    this.time = 0;
    this.plots = PLOTS.map((kind) => new Plot(parent, kind, (at) => pointed(at === null ? null : at + this.time)));
    onColours(() => this.plots.forEach((plot) => plot.plot && plot.build()));
  }

  show(samples, finger, time) {
    this.time = time;
    this.plots.forEach((plot) => plot.show(samples, finger, time));
  }
}
