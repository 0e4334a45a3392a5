// Guides: the unit of the map, a grid on the ground, a bar of a round length, and the axes with the way up.
"use strict";

const GRID_REACH = 2, BAR_PX = 130, COMPASS = 36;

/// What lengths of the map are shown in: `factor` of them make one of the map, `why` is where that is known from.
function unit_of({ summary = {} }) {
  const { metric, scale } = summary;
  if (metric) {
    const by_file = `to ${digits(100 * metric.sigma_share, 2)} %, as the map file says`;
    return { factor: 1, name: "m", why: metric.texts ? `by the known widths of ${counted(metric.texts, "text")}` : by_file };
  }
  if (scale !== undefined) return { factor: scale, name: "m", why: "by the alignment with the ground truth" };
  const why = "one camera knows no metres; 1 is about how far away the first view's points were";
  return { factor: 1, name: "map units", why };
}

/// The largest of 1, 2, 5, 10, ... that is at most `value`.
function round_length(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((m) => m * power).find((length) => length <= value * (1 + 1e-9)) || power;
}

function length_text(value, { name }) {
  const number = (v) => String(Number(v.toPrecision(3)));
  if (name !== "m" || value >= 1) return `${number(value)} ${value === 1 && name === "map units" ? "map unit" : name}`;
  return value >= 0.01 ? `${number(100 * value)} cm` : `${number(1000 * value)} mm`;
}

/// Lines of a grid at the foot of `places`: {numbers, step}, the step in the map's unit.
function ground_grid(places, { centre, radius, up, ahead, right }, unit) {
  const step = round_length(radius * unit.factor / 2) / unit.factor;
  const heights = places.map((p) => dot(p, up)).sort((a, b) => a - b);
  const foot = heights.length ? heights[Math.floor(0.03 * (heights.length - 1))] : dot(centre, up);
  const reach = Math.ceil(GRID_REACH * radius / step) * step, numbers = [];
  const from = (axis) => Math.round(dot(centre, axis) / step) * step;
  const at = (a, r) => add(add(scaled(ahead, from(ahead) + a), scaled(right, from(right) + r)), scaled(up, foot));
  for (let k = -reach; k <= reach + step / 2; k += step)
    numbers.push(...at(k, -reach), ...at(k, reach), ...at(-reach, k), ...at(reach, k));
  return { numbers, step };
}

class Guides {
  constructor(box) {
    this.bar = element("p", null, { className: "scale-bar" });
    this.bar.append(element("span"), element("i"));
    this.compass = svg("svg", { viewBox: "-50 -50 100 100", class: "compass", role: "img" });
    this.axes = [["x", "--camera"], ["y", "--truth"], ["z", "--estimate"], ["up", "--quiet"]].map(([name, colour]) => {
      const line = svg("line", { x1: 0, y1: 0 }), text = svg("text", { "text-anchor": "middle", dy: 4 });
      line.style.stroke = text.style.fill = `var(${colour})`;
      if (name === "up") line.style.strokeDasharray = "3 3";
      text.textContent = name;
      this.compass.append(line, text);
      return { line, text };
    });
    this.compass.setAttribute("aria-label", "Axes of the map, and the way up");
    box.append(this.bar, this.compass);
  }

  /// `px_a_unit`: of the map, where the eye looks at; 0 hides the bar.
  show_bar(px_a_unit, unit) {
    this.bar.hidden = !(px_a_unit > 0 && Number.isFinite(px_a_unit));
    if (this.bar.hidden) return;
    const value = round_length(BAR_PX / px_a_unit * unit.factor);
    this.bar.firstChild.textContent = length_text(value, unit);
    this.bar.lastChild.style.width = `${value / unit.factor * px_a_unit}px`;
    this.bar.title = `In the middle of the view; ${unit.why}`;
  }

  /// `right`, `above`: axes of the view in the world.
  show_axes(right, above, up) {
    const ways = [[1, 0, 0], [0, 1, 0], [0, 0, 1], up];
    ways.forEach((way, i) => {
      const x = COMPASS * dot(way, right), y = -COMPASS * dot(way, above), { line, text } = this.axes[i];
      // An axis towards the eye has its letter where the others begin: it would be on theirs.
      const long = Math.hypot(x, y), out = long > 12 ? 1 + 9 / long : 0;
      for (const [name, value] of [["x2", x], ["y2", y]]) line.setAttribute(name, value.toFixed(1));
      for (const [name, value] of [["x", out * x], ["y", out * y]]) text.setAttribute(name, value.toFixed(1));
      text.style.display = out ? "" : "none";
    });
  }
}
