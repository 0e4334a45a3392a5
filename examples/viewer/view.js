// View: looks at the map as it was at a frame. Orbits around a target, or flies with the camera.
"use strict";

const FIELD = Math.tan(25 * Math.PI / 180);

class View {
  constructor(data, on_choose) {
    this.data = data;
    this.on_choose = on_choose;
    this.box = by_id("view");
    this.canvas = by_id("canvas");
    this.chosen = -1;
    this.frame = 0;
    this.follow = false;
    this.with_quads = this.with_labels = this.so_far = true;
    this.shown = data.texts;
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
    this.layers = new MapLayers(this.scene, data.sessions);
    this.layers.make_toggles(this, by_id("layers"));
    const reset = element("button", "Reset", { type: "button" });
    reset.addEventListener("click", () => { this.moved = false; this.reset(); this.request(); });
    by_id("layers").append(reset);
    this.guides = new Guides(this.box);
    this.fill();
    listen_gestures(this);
    new ResizeObserver(() => this.request()).observe(this.box);
    this.canvas.addEventListener("webglcontextlost", () => { by_id("no-webgl").hidden = false; });
  }

  /// Centre and size of what is worth seeing, and which way is up: against the cameras' mean y.
  measure() {
    const { texts, world } = this.data, places = texts.map((t) => t.centre);
    for (let i = 0; i < world.points.length; i += 3) places.push(world.points.slice(i, i + 3));
    const poses = world.trajectory.filter((p) => p);
    places.push(...poses.map((p) => p.slice(0, 3)));
    this.places = places;
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

  /// Puts the map into the layers.
  fill() {
    const { texts, world } = this.data;
    this.unit = unit_of(this.data);
    by_id("no-map").hidden = world.keyframes.length > 0;
    this.scene.set_quads(texts, () => this.request());
    this.layers.fill(this.data, 0.045 * this.radius);
    const { numbers, step } = ground_grid(this.places, this, this.unit);
    this.layers.set_grid(world.keyframes.length ? numbers : [], length_text(step * this.unit.factor, this.unit));
    this.set_frame(this.frame);
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

  /// Shows the map as it was at frame `frame`, and the camera there with the texts that it sees.
  set_frame(frame) {
    this.frame = frame;
    const { texts, world, frames = [] } = this.data;
    const end = frames.length ? frames[frames.length - 1].frame : world.trajectory.length - 1;
    this.until = this.so_far && frame < end ? frame : Infinity;
    this.shown = texts.filter((text) => text.host === undefined || text.host <= this.until || text.id === this.chosen);
    if (!this.scene) return;
    this.layers.until(this.until, this.shown);
    this.in_view = texts_in_view(this.data, this.shown, frame);
    this.layers.see(this.data.camera, world.trajectory[frame], this.in_view, 0.11 * this.radius);
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
    this.layers.choose(text);
    this.set_frame(this.frame);
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
    const ahead = pose ? turned(pose, [0, 0, 1]) : this.direction(), up = pose ? turned(pose, [0, -1, 0]) : this.up;
    if (pose) {
      const c = this.data.camera, tangent = Math.max(c.height / 2 / c.fy, c.width / 2 / c.fx * high / wide);
      this.clip = view_matrix(pose.slice(0, 3), ahead, up, tangent, wide / high, 0.002 * this.radius, far);
    } else {
      this.clip = view_matrix(subtract(this.target, scaled(ahead, this.distance)), ahead, up, FIELD, wide / high,
        0.004 * this.distance, this.distance + far);
    }
    this.layers.fly(Boolean(pose), () => this.scene.draw(this.clip, this.with_quads));
    show_labels(this.with_labels ? this.shown : [], this.clip, wide, high, this.chosen);
    const right = unit(cross(ahead, up));
    this.guides.show_axes(right, cross(right, ahead), this.up);
    this.guides.show_bar(pose || !this.data.world.keyframes.length ? 0 : high / (2 * FIELD * this.distance), this.unit);
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

  /// The text that covers a place of the view, in px from its upper left corner.
  text_at(x, y) {
    return text_at(this.shown, this.clip, 2 * x / this.box.clientWidth - 1, 1 - 2 * y / this.box.clientHeight);
  }
}
