// Plots: numbers over time as SVG, and the angle errors of the signs as bars. All tell their values where the pointer
// is in one of them, else at the frame that is shown. A click shows the frame, or the text.
"use strict";

const PLOT_HEIGHT = 170, LEFT = 46, RIGHT = 10, TOP = 8, BOTTOM = 22;

/// At most about `count` round numbers from low to high.
function ticks(low, high, count) {
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough), out = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(i * step);
  return out;
}
/// Index of the value nearest to `wanted`.
function nearest(values, wanted) {
  let best = 0;
  values.forEach((value, i) => { if (Math.abs(value - wanted) < Math.abs(values[best] - wanted)) best = i; });
  return best;
}
const short = (v) => String(Number(v.toPrecision(4)));

class LinePlot {
  /// lines: [{name, colour, frames (null: all), values}], null: no value. `low`: where the axis begins, 0 if not given.
  constructor(data, { title, unit, lines, low = 0 }, on_frame, on_point) {
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
      return nearest(this.time, t);
    };
    this.svg.addEventListener("pointermove", (event) => on_point(frame_at(event)));
    for (const end of ["pointerleave", "pointercancel"]) this.svg.addEventListener(end, () => on_point(-1));
    this.svg.addEventListener("click", (event) => on_frame(frame_at(event)));
    this.frame = 0;
    this.pointed = -1;
    new ResizeObserver(() => this.draw()).observe(this.figure);
  }

  /// The pointer is at frame `frame` of a plot; -1: at none.
  point(frame) {
    this.pointed = frame;
    this.read();
  }

  /// Tells the values at the pointer, or at the frame that is shown, and marks them.
  read() {
    const frame = this.pointed >= 0 ? this.pointed : this.frame, dots = [];
    this.lines.forEach((line, i) => {
      // Not every frame has its picture, from which some numbers are: the nearest that has.
      const at = line.frames ? nearest(line.frames, frame) : frame, value = line.values[at];
      const known = value !== null && value !== undefined;
      this.values[i].textContent = known ? short(value) : "";
      if (!known || !this.x) return;
      const dot = svg("circle", { cx: this.x(this.time[line.frames ? line.frames[at] : at]), cy: this.y(value), r: 3 });
      dot.style.fill = `var(${line.colour})`;
      dots.push(dot);
    });
    if (!this.marker || !this.time.length) return;
    const place = (mark, at) => { for (const end of ["x1", "x2"]) mark.setAttribute(end, this.x(this.time[at])); };
    place(this.marker, this.frame);
    place(this.cursor, frame);
    this.cursor.style.opacity = this.pointed >= 0 ? 1 : 0;
    this.marks.replaceChildren(...dots, ...(this.pointed >= 0 ? [this.where(frame)] : []));
  }

  /// The pointer's frame and time, beside its line on the side with more room.
  where(frame) {
    const x = this.x(this.time[frame]), right = x < this.middle;
    const anchor = right ? "start" : "end";
    const out = svg("text", { x: x + (right ? 6 : -6), y: TOP + 10, "text-anchor": anchor, class: "where" });
    out.textContent = `frame ${frame}, ${this.time[frame].toFixed(2)} s`;
    return out;
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
    this.cursor = line(LEFT, TOP, LEFT, base, "stroke: var(--quiet)");
    this.marker = line(LEFT, TOP, LEFT, base, "stroke: var(--camera); stroke-dasharray: 3 2");
    this.marks = svg("g", {});
    parts.push(this.marks);
    Object.assign(this, { x, y, middle: (LEFT + wide - RIGHT) / 2 });
    this.svg.setAttribute("viewBox", `0 0 ${wide} ${PLOT_HEIGHT}`);
    this.svg.replaceChildren(...parts);
    this.read();
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
    this.read();
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
    options.lines = options.lines.filter((l) => l.values && l.values.some((v) => v !== null));
    if (!options.lines.length) return;
    const plot = new LinePlot(data, options, on_frame, (frame) => plots.forEach((other) => other.point(frame)));
    plots.push(plot);
    box.append(plot.figure);
  };
  const in_mm = (values = []) => values.map((v) => (v === null ? null : 1000 * v));
  add_plot({ title: "Position error after alignment", unit: "mm", lines: [
    { name: "live", colour: "--live", values: in_mm(s.error_live) }, { name: "final", colour: "--estimate", values: in_mm(s.error) }] });
  const counted_in = data.sessions ? "observed" : "tracked";
  add_plot({ title: `Points ${counted_in}`, lines: [{ name: "points", colour: "--estimate", values: s.points }] });
  add_plot({ title: `Texts ${counted_in}`, lines: [{ name: "texts", colour: "--normal", values: s.texts }] });
  const frames = data.frames.map((f) => f.frame), zncc = data.frames.map((f) => f.texts.map((t) => t.zncc));
  add_plot({ title: "ZNCC of the texts in view", low: 0.5, lines: [
    { name: "median", colour: "--truth", frames, values: zncc.map(median) },
    { name: "least", colour: "--live", frames, values: zncc.map((z) => (z.length ? Math.min(...z) : null)) }] });
  add_plot({ title: "Cost: points, rms in the final map", unit: "px", lines: [
    { name: "pose before (live)", colour: "--live", values: s.cost_live }, { name: "pose after (final)", colour: "--estimate", values: s.cost }] });
  const stage = (name) => (run.timing || []).filter((t) => t.name === name).flatMap((t) => t.ms);
  add_plot({ title: "Time a frame", unit: "ms", lines: [
    { name: "detection", colour: "--truth", values: stage("detection") }, { name: "tracking", colour: "--estimate", values: stage("tracking") },
    { name: "mapping", colour: "--live", values: stage("mapping") }, { name: "adjustment", colour: "--normal", values: stage("mapping: adjustment") }] });
  if (data.texts.some((t) => t.angle_deg !== undefined)) box.append(angle_bars(data.texts, on_choose));
  return plots;
}
