// Vectors as arrays, matrices as column-major arrays of 16, poses as [x, y, z, qx, qy, qz, qw], camera to world.
"use strict";

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => { const l = length(a); return l > 0 ? scaled(a, 1 / l) : [0, 0, 1]; };
const mix = (a, b, s) => add(scaled(a, 1 - s), scaled(b, s));
const median = (values) => {
  const sorted = values.filter((v) => v !== null).sort((a, b) => a - b);
  return sorted.length ? sorted[sorted.length >> 1] : null;
};

/// `1 text`, `3 texts`.
const counted = (count, thing) => `${count} ${thing}${count === 1 ? "" : "s"}`;

/// v turned by the pose's quaternion.
function turned(pose, v) {
  const u = [pose[3], pose[4], pose[5]], t = scaled(cross(u, v), 2);
  return add(add(v, scaled(t, pose[6])), cross(u, t));
}
const moved = (pose, v) => add(turned(pose, v), pose.slice(0, 3));

/// World to clip coordinates of an eye that looks along `ahead`, with `up` upwards; `tangent`: of half the vertical angle.
function view_matrix(eye, ahead, up, tangent, aspect, near, far) {
  const z = scaled(unit(ahead), -1), x = unit(cross(up, z)), y = cross(z, x);
  const f = 1 / tangent, a = (far + near) / (near - far), b = 2 * far * near / (near - far);
  const row = (axis) => [axis[0], axis[1], axis[2], -dot(axis, eye)];
  const rx = row(x), ry = row(y), rz = row(z), out = new Float32Array(16);
  for (let i = 0; i < 4; ++i) {
    out[4 * i] = rx[i] * f / aspect;
    out[4 * i + 1] = ry[i] * f;
    out[4 * i + 2] = rz[i] * a + (i === 3 ? b : 0);
    out[4 * i + 3] = -rz[i];
  }
  return out;
}

/// [x, y, w] of a world point: x and y in [-1, 1] where it is in view and w > 0.
function to_clip(m, p) {
  const at = (r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r], w = at(3);
  return [at(0) / w, at(1) / w, w];
}

/// `#rrggbb` as three numbers of 0 to 1.
const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);

/// Colour of a ZNCC: red where an observation counts against the text, then yellow, and green where it fits well.
function zncc_colour(zncc, low) {
  const s = Math.max(0, Math.min(1, (zncc - low) / (1 - low)));
  return `hsl(${Math.round(130 * s)} 85% 45%)`;
}

/// An element with text, never markup: words of a sequence may hold anything.
function element(tag, text, properties) {
  const out = document.createElement(tag);
  if (text !== undefined && text !== null) out.textContent = text;
  return Object.assign(out, properties);
}
/// An element of SVG.
function svg(tag, attributes) {
  const out = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) out.setAttribute(name, value);
  return out;
}
const by_id = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const digits = (value, count) => (value === null || value === undefined ? "" : value.toFixed(count));
