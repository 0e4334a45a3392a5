// View: looks at the scene. Orbits around a target, or flies with the camera; layers on and off; words as labels.
"use strict";

const TURN = 0.006, KEY_TURN = 0.08, KEY_MOVE = 0.06, FIELD = Math.tan(25 * Math.PI / 180), MOST_LABELS = 80;

class View {
  constructor(data, on_choose) {
    this.data = data;
    this.on_choose = on_choose;
    this.box = by_id("view");
    this.canvas = by_id("canvas");
    this.chosen = -1;
    this.frame = 0;
    this.follow = false;
    this.with_quads = this.with_labels = true;
    this.moved = false;  // by the user: from then on the eye stays where it is
    this.measure();
    this.reset();
    try {
      this.scene = new Scene(this.canvas);
    } catch (error) {
      by_id("no-webgl").hidden = false;
      this.canvas.hidden = true;
      return;
    }
    this.make_layers();
    this.fill();
    this.listen();
    new ResizeObserver(() => this.request()).observe(this.box);
    this.canvas.addEventListener("webglcontextlost", () => { by_id("no-webgl").hidden = false; });
  }

  /// Centre and size of what is worth seeing, and which way is up: against the cameras' mean y.
  measure() {
    const { texts, world } = this.data, places = texts.map((t) => t.centre);
    for (let i = 0; i < world.points.length; i += 3) places.push(world.points.slice(i, i + 3));
    const poses = world.trajectory.filter((p) => p);
    places.push(...poses.map((p) => p.slice(0, 3)));
    this.centre = places.length ? [0, 1, 2].map((i) => median(places.map((p) => p[i]))) : [0, 0, 0];
    const far = places.map((p) => length(subtract(p, this.centre))).sort((a, b) => a - b);
    this.radius = (far.length && far[Math.floor(0.9 * (far.length - 1))]) || 1;
    const sum = (axis) => poses.reduce((total, p) => add(total, turned(p, axis)), [0, 0, 0]);
    this.up = poses.length && length(sum([0, -1, 0])) > 0 ? unit(sum([0, -1, 0])) : [0, -1, 0];
    const ahead = poses.length ? turned(poses[0], [0, 0, 1]) : [0, 0, 1];
    const flat = subtract(ahead, scaled(this.up, dot(ahead, this.up)));
    this.ahead = length(flat) > 1e-3 ? unit(flat) : unit(cross(this.up, [1, 0.1, 0.2]));
    this.right = cross(this.ahead, this.up);
  }

  reset() {
    this.target = this.centre;
    this.yaw = 0.3;
    this.pitch = 0.4;
    this.distance = 2 * this.radius * Math.max(1, 1.4 * this.box.clientHeight / this.box.clientWidth);
  }

  /// The layers, and what turns them on and off.
  make_layers() {
    const scene = this.scene, bar = by_id("layers");
    for (const [name, colour, points] of [["outlines", "--estimate"], ["normals", "--normal"], ["points", "--point", 2.6],
      ["key frames", "--keyframe"], ["trajectory", "--estimate"], ["truth", "--truth"]]) scene.add_layer(name, colour, points);
    this.camera_layer = scene.add_layer("camera", "--camera");
    this.chosen_layer = scene.add_layer("chosen", "--accent");
    const toggle = (name, colour, on, change) => {
      const label = element("label"), box = element("input", null, { type: "checkbox", checked: on });
      box.addEventListener("change", () => { change(box.checked); this.request(); });
      label.append(box);
      if (colour) label.append(Object.assign(element("i"), { style: `background: var(${colour})` }));
      label.append(name);
      bar.append(label);
      return label;
    };
    toggle("texts", "", true, (on) => { this.with_quads = scene.layers[0].visible = on; });
    toggle("words", "", true, (on) => { this.with_labels = on; });
    this.toggles = scene.layers.slice(1, 6).map((layer) => toggle(layer.name, layer.colour, true, (on) => { layer.visible = on; }));
    toggle("fly with the camera", "--camera", false, (on) => { this.follow = on; });
    const reset = element("button", "Reset", { type: "button" });
    reset.addEventListener("click", () => { this.moved = false; this.reset(); this.request(); });
    bar.append(reset);
  }

  /// Puts the map into the layers.
  fill() {
    const { texts, world } = this.data, scene = this.scene, small = 0.045 * this.radius;
    const lines = (corners) => corners.flatMap((c, i) => [...c, ...corners[(i + 1) % corners.length]]);
    const path = (poses) => poses.flatMap((p, i) => (i && p && poses[i - 1] ? [...poses[i - 1].slice(0, 3), ...p.slice(0, 3)] : []));
    by_id("no-map").hidden = world.keyframes.length > 0;
    scene.set_quads(texts, () => this.request());
    const parts = [
      texts.flatMap((t) => lines(t.corners)),
      texts.flatMap((t) => [...t.centre, ...add(t.centre, scaled(t.normal, 2.5 * small))]),
      world.points,
      world.keyframes.flatMap((k) => this.frustum(k.pose, small)),
      path(world.trajectory),
      [...path(world.truth), ...world.signs.flatMap((s) => lines(s.corners))],
    ];
    parts.forEach((numbers, i) => scene.layers[i].set(numbers));
    this.toggles.forEach((label, i) => { label.hidden = !scene.layers[i + 1].count; });
  }

  /// Shows another state of the map.
  show(data) {
    this.data = data;
    this.measure();
    if (!this.moved) this.reset();
    if (!this.scene) return;
    this.fill();
    this.request();
  }

  frustum(pose, depth) {
    const c = this.data.camera, at = (x, y) => moved(pose, [(x - c.cx) / c.fx * depth, (y - c.cy) / c.fy * depth, depth]);
    const corners = [at(0, 0), at(c.width, 0), at(c.width, c.height), at(0, c.height)], eye = pose.slice(0, 3);
    return corners.flatMap((p, i) => [...p, ...corners[(i + 1) % 4], ...eye, ...p]);
  }

  /// The camera of frame `frame` is shown, and followed where that is asked for.
  set_frame(frame) {
    this.frame = frame;
    if (!this.scene) return;
    const pose = this.data.world.trajectory[frame];
    this.camera_layer.set(pose ? this.frustum(pose, 0.11 * this.radius) : []);
    this.request();
  }

  /// Centres the text and looks at its front.
  choose(text) {
    this.chosen = text.id;
    this.moved = true;
    this.target = text.centre;
    const wide = length(subtract(text.corners[1], text.corners[0])), n = text.normal;
    this.distance = Math.max(5 * wide, 0.3 * this.radius);
    this.yaw = Math.atan2(-dot(n, this.right), -dot(n, this.ahead));
    this.pitch = Math.asin(Math.max(-1, Math.min(1, dot(n, this.up)))) + 0.15;
    if (!this.scene) return;
    this.chosen_layer.set(text.corners.flatMap((c, i) => {
      const grow = (p) => mix(text.centre, p, 1.12);
      return [...grow(c), ...grow(text.corners[(i + 1) % 4])];
    }));
    this.request();
  }

  /// Direction in which the orbiting eye looks.
  direction() {
    const flat = add(scaled(this.ahead, Math.cos(this.yaw)), scaled(this.right, Math.sin(this.yaw)));
    return subtract(scaled(flat, Math.cos(this.pitch)), scaled(this.up, Math.sin(this.pitch)));
  }

  request() {
    if (!this.scene || this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }

  draw() {
    const ratio = window.devicePixelRatio || 1, wide = this.box.clientWidth, high = this.box.clientHeight;
    const w = Math.max(1, Math.round(wide * ratio)), h = Math.max(1, Math.round(high * ratio));
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, { width: w, height: h });
    const pose = this.follow ? this.data.world.trajectory[this.frame] : null, far = 60 * this.radius;
    if (pose) {
      const c = this.data.camera, tangent = Math.max(c.height / 2 / c.fy, c.width / 2 / c.fx * high / wide);
      this.clip = view_matrix(pose.slice(0, 3), turned(pose, [0, 0, 1]), turned(pose, [0, -1, 0]), tangent, wide / high,
        0.002 * this.radius, far);
    } else {
      const ahead = this.direction();
      this.clip = view_matrix(subtract(this.target, scaled(ahead, this.distance)), ahead, this.up, FIELD, wide / high,
        0.004 * this.distance, this.distance + far);
    }
    this.camera_layer.visible = !pose;
    this.scene.draw(this.clip, this.with_quads);
    this.label(wide, high);
  }

  /// The nearest texts get their labels, above them; one that would lie on another's is left out.
  label(wide, high) {
    const spans = [], taken = [];
    const seen = this.with_labels ? this.data.texts.map((text) => ({ text, at: this.top_of(text) })) : [];
    const order = ({ text, at }) => (text.id === this.chosen ? 0 : at[2]);
    for (const { text, at } of seen.sort((a, b) => order(a) - order(b))) {
      const chosen = text.id === this.chosen;
      if (at[2] <= 0 || Math.abs(at[0]) > 1 || Math.abs(at[1]) > 1.2 || spans.length >= MOST_LABELS) continue;
      if (text.word === "###" && !chosen) continue;
      const name = text_name(text), x = (at[0] + 1) / 2 * wide, y = Math.max(10, (1 - at[1]) / 2 * high - 11);
      const half = Math.min(80, 3.6 * name.length + 6), box = [x - half, y - 9, x + half, y + 9];
      if (taken.some((t) => box[0] < t[2] && t[0] < box[2] && box[1] < t[3] && t[1] < box[3])) continue;
      taken.push(box);
      const span = element("span", name, { className: chosen ? "chosen" : "" });
      span.style.transform = `translate(calc(${x}px - 50%), calc(${y}px - 50%))`;
      spans.push(span);
    }
    by_id("labels").replaceChildren(...spans);
  }

  /// Where the text's upper end is in view: the highest of its corners, above its centre.
  top_of(text) {
    const at = to_clip(this.clip, text.centre), corners = text.corners.map((c) => to_clip(this.clip, c));
    return [at[0], corners.every((c) => c[2] > 0) ? Math.max(...corners.map((c) => c[1])) : at[1], at[2]];
  }

  pan(dx, dy) {
    this.moved = true;
    const ahead = this.direction(), right = unit(cross(ahead, this.up)), up = cross(right, ahead);
    const unit_a_px = 2 * FIELD * this.distance / Math.max(1, this.box.clientHeight);
    this.target = add(this.target, add(scaled(right, -dx * unit_a_px), scaled(up, dy * unit_a_px)));
  }

  turn(yaw, pitch) {
    this.moved = true;
    this.yaw += yaw;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + pitch));
  }

  zoom(factor) {
    this.moved = true;
    this.distance = Math.max(0.02 * this.radius, Math.min(40 * this.radius, this.distance * factor));
  }

  /// The nearest text whose quad covers a place of the view.
  text_at(x, y) {
    const px = 2 * x / this.box.clientWidth - 1, py = 1 - 2 * y / this.box.clientHeight;
    let best = null, nearest = Infinity;
    for (const text of this.data.texts) {
      const c = text.corners.map((p) => to_clip(this.clip, p));
      if (c.some((p) => p[2] <= 0)) continue;
      const side = c.map((p, i) => { const q = c[(i + 1) % 4]; return (q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0]); });
      if ((side.every((s) => s >= 0) || side.every((s) => s <= 0)) && c[0][2] < nearest) [best, nearest] = [text, c[0][2]];
    }
    return best;
  }

  listen() {
    const fingers = new Map();
    let travelled = 0;
    const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
    this.box.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      this.box.setPointerCapture(event.pointerId);
      travelled = fingers.size > 1 ? Infinity : 0;
    });
    this.box.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const dx = event.clientX - before.x, dy = event.clientY - before.y, wide = fingers.size === 2 ? spread() : 0;
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      travelled += Math.hypot(dx, dy);
      if (fingers.size === 2) {
        this.pan(dx / 2, dy / 2);
        this.zoom(wide / Math.max(1, spread()));
      } else if (event.shiftKey || event.buttons & 6) {
        this.pan(dx, dy);
      } else {
        this.turn(dx * TURN, dy * TURN);
      }
      this.request();
    });
    const lift = (event) => {
      const was_here = fingers.delete(event.pointerId);
      if (!was_here || event.type !== "pointerup" || travelled > 5) return;
      const box = this.box.getBoundingClientRect(), text = this.text_at(event.clientX - box.left, event.clientY - box.top);
      if (text) this.on_choose(text);
    };
    this.box.addEventListener("pointerup", lift);
    this.box.addEventListener("pointercancel", lift);
    this.box.addEventListener("contextmenu", (event) => event.preventDefault());
    this.box.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(event.deltaY * (event.deltaMode ? 0.03 : 0.001)));
      this.request();
    }, { passive: false });
    this.box.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (step && event.shiftKey) this.pan(...step.map((s) => -s * KEY_MOVE * this.box.clientHeight));
      else if (step) this.turn(step[0] * KEY_TURN, step[1] * KEY_TURN);
      else if (event.key === "+" || event.key === "=") this.zoom(0.85);
      else if (event.key === "-") this.zoom(1 / 0.85);
      else if (event.key === "r" || event.key === "R") { this.moved = false; this.reset(); }
      else return;
      event.preventDefault();
      event.stopPropagation();
      this.request();
    });
  }
}

/// The word of a text, or its number where nobody could read it.
const text_name = (text) => (text.word === "###" ? `unread (${text.id})` : text.word);
