// Live: the map as it grows, in the view of the report, and beside it the frame with what was found in it.
"use strict";

const NOTHING = { points: [], keyframes: [], trajectory: [], truth: [], signs: [] };
const SHOW_EVERY = 100;  // ms between two drawn frames: drawing must not slow tracking

class Live {
  constructor() {
    this.view = new View({ texts: [], world: NOTHING, camera: null }, (text) => this.view.choose(text));
    this.canvas = by_id("picture");
    this.small = document.createElement("canvas");
    this.shown_at = 0;
    new ResizeObserver(() => this.draw()).observe(this.canvas.parentElement);
  }

  clear() {
    this.newest = null;
    this.view.moved = false;
    this.view.show({ texts: [], world: NOTHING, camera: null });
    this.canvas.getContext("2d").clearRect(0, 0, this.canvas.width, this.canvas.height);
    by_id("frame-text").textContent = "";
  }

  show_map(map) {
    this.view.show(map);
    const path = map.world.trajectory;
    for (let last = path.length - 1; last >= 0; --last)
      if (path[last]) return this.view.set_frame(last);
  }

  /// `message`: of the mapper; grey pixels and what was found. Whether it is one of the few that are shown.
  show_frame(message) {
    this.newest = message;
    if (this.waiting) return false;
    this.waiting = setTimeout(() => {
      this.waiting = null;
      this.take_pixels();
      this.draw();
      this.describe();
    }, Math.max(0, SHOW_EVERY - (performance.now() - this.shown_at)));
    return true;
  }

  take_pixels() {
    const { width, height, pixels } = this.newest;
    if (this.small.width !== width || this.small.height !== height) Object.assign(this.small, { width, height });
    const pen = this.small.getContext("2d", { willReadFrequently: true }), image = pen.createImageData(width, height);
    const words = new Uint32Array(image.data.buffer);
    for (let i = 0; i < words.length; ++i) words[i] = 0xff000000 | pixels[i] * 0x010101;
    pen.putImageData(image, 0, 0);
    this.shown_at = performance.now();
  }

  describe() {
    const { seen } = this.newest;
    const state = { waiting: "the map has not begun", tracked: "tracked", lost: "lost" }[seen.state];
    const found = seen.state === "tracked" ? `, ${counted(seen.points, "point")}, ${counted(seen.texts, "text")}` : "";
    by_id("frame-text").textContent = `Frame ${seen.frame}: ${state}${found}`;
  }

  draw() {
    if (!this.newest || !this.small.width) return;
    const { seen, width, height } = this.newest, ratio = window.devicePixelRatio || 1;
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    const wide = this.canvas.clientWidth, scale = wide / width, px = (v) => (v + 0.5) * scale;
    const size = { width: Math.max(1, Math.round(wide * ratio)), height: Math.max(1, Math.round(wide * ratio * height / width)) };
    if (this.canvas.width !== size.width || this.canvas.height !== size.height) Object.assign(this.canvas, size);
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.drawImage(this.small, 0, 0, wide, wide * height / width);
    const outline = (quad, colour) => {
      pen.beginPath();
      for (let i = 0; i < 8; i += 2) pen.lineTo(px(quad[i]), px(quad[i + 1]));
      pen.closePath();
      pen.lineWidth = 1.6;
      pen.strokeStyle = colour;
      pen.stroke();
    };
    pen.fillStyle = css("--accent");
    for (let i = 0; i < seen.seen.length; i += 2) pen.fillRect(px(seen.seen[i]) - 1, px(seen.seen[i + 1]) - 1, 2, 2);
    for (const quad of seen.quads) if (quad) outline(quad, css("--truth"));
  }
}
