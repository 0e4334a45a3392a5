// Plots: numbers over time as SVG, and the angle errors of the signs as bars. A click shows the frame, or the text.
"use strict";

const PLOT_HEIGHT = 170, LEFT = 46, RIGHT = 10, TOP = 8, BOTTOM = 22;

function svg(tag, attributes) {
  const out = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) out.setAttribute(name, value);
  return out;
}

/// At most about `count` round numbers from low to high.
function ticks(low, high, count) {
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough), out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(i * step);
  return out;
}
const short = (v) => String(Number(v.toPrecision(4)));

class LinePlot {
  /// lines: [{name, colour, frames (null: all), values}], null: no value. `low`: where the axis begins, 0 if not given.
  constructor(data, { title, unit, lines, low = 0 }, on_frame) {
    Object.assign(this, { time: data.series.time, state: data.series.state, lines, low });
    this.figure = element("figure");
    const caption = element("figcaption", `${title}${unit ? `, ${unit}` : ""}`);
    this.values = lines.map((line) => {
      const key = element("span"), value = element("span");
      key.append(Object.assign(element("i"), { style: `background: var(${line.colour})` }), line.name, value);
      caption.append(key);
      return value;
    });
    this.svg = svg("svg", { height: PLOT_HEIGHT, role: "img", "aria-label": title });
    this.figure.append(caption, this.svg);
    const frame_at = (event) => {
      const box = this.svg.getBoundingClientRect(), t = (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT) * this.end;
      let best = 0;
      this.time.forEach((v, i) => { if (Math.abs(v - t) < Math.abs(this.time[best] - t)) best = i; });
      return best;
    };
    this.svg.addEventListener("pointermove", (event) => this.read(frame_at(event)));
    this.svg.addEventListener("pointerleave", () => this.read(-1));
    this.svg.addEventListener("click", (event) => on_frame(frame_at(event)));
    this.frame = 0;
    new ResizeObserver(() => this.draw()).observe(this.figure);
  }

  read(frame) {
    this.lines.forEach((line, i) => {
      const at = line.frames ? line.frames.indexOf(frame) : frame, value = at >= 0 ? line.values[at] : null;
      this.values[i].textContent = value === null || value === undefined ? "" : short(value);
    });
  }

  draw() {
    const wide = this.figure.clientWidth - 20;
    if (wide <= 0) return;
    this.end = this.time.length ? this.time[this.time.length - 1] || 1 : 1;
    const all = this.lines.flatMap((line) => line.values.filter((v) => v !== null));
    const high = Math.max(all.reduce((a, b) => Math.max(a, b), -Infinity), this.low + 1e-9);
    const top = all.length ? high + 0.05 * (high - this.low) : this.low + 1, low = Math.min(this.low, all.reduce((a, b) => Math.min(a, b), Infinity));
    const x = (t) => LEFT + t / this.end * (wide - LEFT - RIGHT);
    const y = (v) => TOP + (top - v) / (top - low) * (PLOT_HEIGHT - TOP - BOTTOM), base = PLOT_HEIGHT - BOTTOM;
    const parts = [];
    const line = (x1, y1, x2, y2, style) => { const l = svg("line", { x1, y1, x2, y2 }); l.style.cssText = style; parts.push(l); return l; };
    const words = (at_x, at_y, anchor, content) => {
      const t = svg("text", { x: at_x, y: at_y, "text-anchor": anchor });
      t.textContent = content;
      parts.push(t);
    };
    for (const [from, to] of this.gaps()) {
      const r = svg("rect", { x: x(this.time[from]), y: TOP, width: Math.max(1, x(this.time[to]) - x(this.time[from])), height: base - TOP });
      r.style.cssText = "fill: var(--lost); opacity: .12";
      parts.push(r);
    }
    for (const v of ticks(low, top, 4)) {
      line(LEFT, y(v), wide - RIGHT, y(v), "stroke: var(--line)");
      words(LEFT - 6, y(v) + 4, "end", short(v));
    }
    for (const t of ticks(0, this.end, Math.max(2, wide / 90))) words(x(t), PLOT_HEIGHT - 5, "middle", `${short(t)} s`);
    for (const { frames, values, colour } of this.lines) {
      let path = "", going = false;
      values.forEach((v, i) => {
        if (v !== null) path += `${going ? "L" : "M"}${x(this.time[frames ? frames[i] : i]).toFixed(1)} ${y(v).toFixed(1)}`;
        going = v !== null;
      });
      const p = svg("path", { d: path, fill: "none", "stroke-width": 1.4, "stroke-linejoin": "round", "stroke-linecap": "round" });
      p.style.stroke = `var(${colour})`;
      parts.push(p);
    }
    const now = x(this.time[this.frame] || 0);
    this.marker = line(now, TOP, now, base, "stroke: var(--camera); stroke-dasharray: 3 2");
    this.x = x;
    this.svg.setAttribute("viewBox", `0 0 ${wide} ${PLOT_HEIGHT}`);
    this.svg.replaceChildren(...parts);
  }

  /// Stretches of frames without a pose.
  gaps() {
    const out = [];
    for (let i = 0; i < this.state.length; ++i) {
      if (!"lw".includes(this.state[i])) continue;
      const from = i;
      while (i + 1 < this.state.length && "lw".includes(this.state[i + 1])) ++i;
      out.push([from, Math.min(i + 1, this.state.length - 1)]);
    }
    return out;
  }

  set_frame(frame) {
    this.frame = frame;
    if (!this.marker) return;
    for (const end of ["x1", "x2"]) this.marker.setAttribute(end, this.x(this.time[frame]));
  }
}

function angle_bars(texts, on_choose) {
  const figure = element("figure"), bars = element("div", null, { className: "bars" });
  const known = texts.filter((t) => t.angle_deg !== undefined && t.angle_deg !== null).sort((a, b) => b.angle_deg - a.angle_deg);
  const most = known.reduce((m, t) => Math.max(m, t.angle_deg), 1e-9);
  for (const text of known) {
    const row = element("div"), bar = element("b");
    bar.style.width = `${100 * text.angle_deg / most}%`;
    row.append(element("span", text_name(text)), bar, element("span", `${digits(text.angle_deg, 2)}\u00b0`));
    row.addEventListener("click", () => on_choose(text));
    bars.append(row);
  }
  figure.append(element("figcaption", "Angle error of each sign, degrees"), bars);
  return figure;
}

/// All plots that the run has numbers for. Returns those over time.
function make_plots(data, run, on_frame, on_choose) {
  const box = by_id("plots"), plots = [], s = data.series;
  const add_plot = (options) => {
    options.lines = options.lines.filter((l) => l.values.some((v) => v !== null));
    if (!options.lines.length) return;
    const plot = new LinePlot(data, options, on_frame);
    plots.push(plot);
    box.append(plot.figure);
  };
  const in_mm = (values) => values.map((v) => (v === null ? null : 1000 * v));
  add_plot({ title: "Position error after alignment", unit: "mm", lines: [
    { name: "live", colour: "--live", values: in_mm(s.error_live) }, { name: "final", colour: "--estimate", values: in_mm(s.error) }] });
  add_plot({ title: "Points tracked", lines: [{ name: "points", colour: "--estimate", values: s.points }] });
  add_plot({ title: "Texts tracked", lines: [{ name: "texts", colour: "--normal", values: s.texts }] });
  const frames = data.frames.map((f) => f.frame), zncc = data.frames.map((f) => f.texts.map((t) => t.zncc));
  add_plot({ title: "ZNCC of the texts in view", low: 0.5, lines: [
    { name: "median", colour: "--truth", frames, values: zncc.map(median) },
    { name: "least", colour: "--live", frames, values: zncc.map((z) => (z.length ? Math.min(...z) : null)) }] });
  add_plot({ title: "Cost: points, rms in the final map", unit: "px", lines: [
    { name: "pose before (live)", colour: "--live", values: s.cost_live }, { name: "pose after (final)", colour: "--estimate", values: s.cost }] });
  const stage = (name) => run.timing.find((t) => t.name === name).ms;
  add_plot({ title: "Time a frame", unit: "ms", lines: [
    { name: "detection", colour: "--truth", values: stage("detection") }, { name: "tracking", colour: "--estimate", values: stage("tracking") },
    { name: "mapping", colour: "--live", values: stage("mapping") }, { name: "adjustment", colour: "--normal", values: stage("mapping: adjustment") }] });
  if (data.texts.some((t) => t.angle_deg !== undefined)) box.append(angle_bars(data.texts, on_choose));
  return plots;
}
