// Layers: the map up to a frame, what the camera of that frame sees, and the checkboxes that show and hide it all.
"use strict";

const MOST_FRUSTA = 40;  // more key frames than these hide the map: of more, evenly spaced ones are drawn
const SESSION_COLOURS = 6;  // of style.css; more sessions use them again

const session_colour = (at) => `--session-${at % SESSION_COLOURS}`;

class MapLayers {
  /// sessions: of a map file, [{id}]. Each has a layer: its path, its key frames, and outlines of the texts it hosts.
  constructor(scene, sessions = []) {
    this.scene = scene;
    this.grid = scene.add_layer("grid", "--grid", 0, 0.6);
    this.outlines = scene.add_layer("outlines", "--estimate");
    this.normals = scene.add_layer("normals", "--normal");
    this.points = scene.add_layer("points", "--point", 3);
    this.keyframes = scene.add_layer("key frames", "--keyframe");
    this.trajectory = scene.add_layer("trajectory", "--estimate");
    this.truth = scene.add_layer("truth", "--truth");
    this.sessions = sessions.map(({ id }, i) => scene.add_layer(`session ${id}`, session_colour(i)));
    this.timed = [this.outlines, this.normals, this.points, this.keyframes, this.trajectory, this.truth, ...this.sessions];
    this.lit = scene.add_layer("texts in view", "--camera");
    this.rays = scene.add_layer("rays", "--camera", 0, 0.45);
    this.camera = scene.add_layer("camera", "--camera");
    this.chosen = scene.add_layer("chosen", "--accent");
  }

  /// The checkboxes. `view` has the rest of what they change: with_quads, with_labels, so_far, follow.
  make_toggles(view, bar) {
    const toggle = (name, colour, on, change) => {
      const label = element("label"), box = element("input", null, { type: "checkbox", checked: on });
      box.addEventListener("change", () => { change(box.checked); view.request(); });
      label.append(box);
      if (colour) label.append(Object.assign(element("i"), { style: `background: var(${colour})` }));
      label.append(name);
      bar.append(label);
      return label;
    };
    const of_layer = (layer, name = layer.name) => {
      const label = toggle(name, layer.colour, true, (on) => { layer.visible = on; });
      return { layer, label };
    };
    toggle("texts", "", true, (on) => { view.with_quads = this.outlines.visible = on; });
    toggle("words", "", true, (on) => { view.with_labels = on; });
    this.toggles = this.timed.slice(1).map((layer) => of_layer(layer));
    this.rays_toggle = toggle("rays", "--camera", true, (on) => { this.lit.visible = this.rays.visible = on; });
    this.grid_toggle = of_layer(this.grid).label;
    this.so_far_toggle = toggle("map so far", "", true, (on) => { view.so_far = on; view.set_frame(view.frame); });
    this.so_far_toggle.title = "What was in the map by the frame that is shown; else all of it";
    toggle("fly with the camera", "--camera", false, (on) => { view.follow = on; });
  }

  /// Puts the map into the layers; `small`: how long the sign of a camera is.
  fill({ texts, world, camera, sessions = [], series }, small) {
    const part = (frame, numbers) => ({ frame: frame === undefined ? -Infinity : frame, numbers });
    const lines = (corners) => corners.flatMap((c, i) => [...c, ...corners[(i + 1) % corners.length]]);
    const step = (from, to) => (from && to ? [...from.slice(0, 3), ...to.slice(0, 3)] : []);
    const path = (poses) => poses.map((pose, i) => part(i, step(poses[i - 1], pose)));
    const arrow = (t) => [...t.centre, ...add(t.centre, scaled(t.normal, 2.5 * small))];
    const { points, point_frames = [], point_greys = [] } = world, dots = [];
    for (let i = 0; 3 * i < points.length; ++i) {
      const grey = point_greys[i] >= 0 ? point_greys[i] / 255 : undefined;
      dots.push({ ...part(point_frames[i], points.slice(3 * i, 3 * i + 3)), grey });
    }
    const every = Math.ceil(world.keyframes.length / MOST_FRUSTA) || 1;
    const in_one = (parts) => (sessions.length ? [] : parts);  // else each session has its own
    const outlines = texts.map((t) => part(t.host, lines(t.corners)));
    this.outlines.set_parts(in_one(outlines));
    this.normals.set_parts(texts.map((t) => part(t.host, arrow(t))));
    this.points.set_parts(dots);
    const drawn = world.keyframes.filter((_, i) => i % every === 0);
    const frusta = drawn.map((k) => part(k.frame, frustum(camera, k.pose, small)));
    this.keyframes.set_parts(in_one(frusta));
    const steps = path(world.trajectory);
    this.trajectory.set_parts(in_one(steps));
    sessions.forEach(({ id }, i) => {
      const within = ({ frame }) => series.session[frame] === id;
      const walked = steps.filter(({ frame }) => series.session[frame - 1] === id);
      this.sessions[i].set_parts([...outlines, ...frusta, ...walked].filter(within));
    });
    this.truth.set_parts([...path(world.truth), ...world.signs.map((s) => part(-Infinity, lines(s.corners)))]);
    for (const { layer, label } of this.toggles) {
      label.hidden = layer.empty;
      if (layer === this.keyframes) label.title = every > 1 ? `One of ${every} is drawn` : "";
    }
  }

  /// A grid of cells that are `cell` wide.
  set_grid(numbers, cell) {
    this.grid.set(numbers);
    this.grid_toggle.lastChild.textContent = `grid, ${cell}`;
    this.grid_toggle.hidden = this.grid.empty;
  }

  /// Shows what was in the map at frame `until`.
  until(until, texts) {
    for (const layer of this.timed) layer.until(until);
    const shown = new Set(texts.map((text) => text.id));
    for (const quad of this.scene.quads) quad.hidden = !shown.has(quad.id);
  }

  /// Draws the camera, and its rays to the corners of the texts that it sees.
  see(camera, pose, texts, size) {
    this.camera.set(pose ? frustum(camera, pose, size) : []);
    const seen = pose ? texts : [], eye = pose ? pose.slice(0, 3) : null;
    this.rays.set(seen.flatMap((t) => t.corners.flatMap((c) => [...eye, ...c])));
    this.lit.set(seen.flatMap((t) => ring(t, 1.06)));
  }

  choose(text) { this.chosen.set(ring(text, 1.12)); }

  /// Through the eyes of the camera its own sign would be in the way, and so would those of its neighbours.
  fly(flying, shown) {
    this.camera.visible = !flying;
    const hidden = [this.keyframes, this.rays, ...this.sessions].filter(() => flying), before = hidden.map((layer) => layer.visible);
    for (const layer of hidden) layer.visible = false;
    shown();
    hidden.forEach((layer, i) => { layer.visible = before[i]; });
  }
}

/// Lines of a camera: its image at `depth`, and the edges from the eye to it.
function frustum(camera, pose, depth) {
  const { width, height, fx, fy, cx, cy } = camera, eye = pose.slice(0, 3);
  const at = (x, y) => moved(pose, [(x - cx) / fx * depth, (y - cy) / fy * depth, depth]);
  const corners = [at(0, 0), at(width, 0), at(width, height), at(0, height)];
  return corners.flatMap((p, i) => [...p, ...corners[(i + 1) % 4], ...eye, ...p]);
}

/// Lines around a text, `share` of its size.
function ring(text, share) {
  const at = text.corners.map((c) => mix(text.centre, c, share));
  return at.flatMap((c, i) => [...c, ...at[(i + 1) % 4]]);
}

/// The texts among `texts` that frame `frame` shows: as the report found, or those whose centre its image holds.
function texts_in_view({ frames = [], camera, world }, texts, frame) {
  const found = frames.find((f) => f.frame === frame);
  if (found) return texts.filter((text) => found.texts.some((seen) => seen.id === text.id));
  const pose = world.trajectory[frame];
  if (!pose) return [];
  const axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) => turned(pose, axis));
  return texts.filter((text) => {
    const way = subtract(text.centre, pose.slice(0, 3)), [x, y, z] = axes.map((axis) => dot(axis, way));
    const px = camera.fx * x / z + camera.cx, py = camera.fy * y / z + camera.cy;
    return z > 0 && px >= 0 && py >= 0 && px < camera.width && py < camera.height && dot(way, text.normal) < 0;
  });
}
