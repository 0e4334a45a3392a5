// Playback: the frames with what was found in them. Slider, play button, arrow keys.
"use strict";

class Playback {
  constructor(data, on_frame) {
    this.data = data;
    this.on_frame = on_frame;
    this.canvas = by_id("picture");
    this.slider = by_id("slider");
    this.words = new Map(data.texts.map((text) => [text.id, text_name(text)]));
    this.marks = { detections: true, points: true, texts: true };
    this.at = 0;
    this.image = new Image();
    this.image.onload = () => this.draw();
    by_id("playback").hidden = data.frames.length === 0;
    if (!data.frames.length) return;
    this.slider.max = data.frames.length - 1;
    this.slider.addEventListener("input", () => this.select(Number(this.slider.value)));
    by_id("play").addEventListener("click", () => this.play(!this.timer));
    const colours = { detections: "--live", points: "--accent", texts: "" };
    for (const name of Object.keys(this.marks)) {
      const label = element("label"), box = element("input", null, { type: "checkbox", checked: true });
      box.addEventListener("change", () => { this.marks[name] = box.checked; this.draw(); });
      label.append(box);
      if (colours[name]) label.append(Object.assign(element("i"), { style: `background: var(${colours[name]})` }));
      label.append({ detections: "detected", points: "points", texts: "mapped texts" }[name]);
      by_id("marks").append(label);
    }
    document.addEventListener("keydown", (event) => {
      if (event.target.closest("input, button, summary, select, textarea, tr[tabindex], #view") || event.ctrlKey || event.altKey || event.metaKey)
        return;
      const last = data.frames.length - 1, to = { ArrowLeft: this.at - 1, ArrowRight: this.at + 1, Home: 0, End: last }[event.key];
      if (event.key === " ") this.play(!this.timer);
      else if (to !== undefined) this.select(Math.max(0, Math.min(last, to)));
      else return;
      event.preventDefault();
    });
    this.draw_scale();
    new ResizeObserver(() => this.draw()).observe(this.canvas.parentElement);
  }

  /// Shows picture `at`.
  select(at) {
    this.at = at;
    const frame = this.data.frames[at];
    this.slider.value = at;
    this.image.src = frame.image;
    this.describe(frame);
    this.on_frame(frame.frame);
  }

  /// Shows the picture nearest to a frame.
  select_frame(index) {
    let best = 0;
    this.data.frames.forEach((f, i) => {
      if (Math.abs(f.frame - index) < Math.abs(this.data.frames[best].frame - index)) best = i;
    });
    if (this.data.frames.length) this.select(best);
  }

  describe(frame) {
    const s = this.data.series, i = frame.frame;
    const by_state = { w: "before the map", t: "tracked", f: "filled in afterwards", l: "lost" }[s.state[i]];
    const state = s.session ? `session ${s.session[i]}` : by_state;
    const drawn = frame.texts.filter((t) => t.quad), zncc = drawn.map((t) => t.zncc);
    let text = `${s.session ? "Key frame" : "Frame"} ${i} of ${s.time.length}, ${s.time[i].toFixed(2)} s: ${state}`;
    // The texts that the picture shows: tracking may have used fewer when the frame came.
    if (s.points[i] || drawn.length) text += `, ${counted(s.points[i], "point")}, ${counted(drawn.length, "text")}`;
    if (zncc.length) text += `; ZNCC ${Math.min(...zncc).toFixed(2)} to ${Math.max(...zncc).toFixed(2)}`;
    by_id("frame-text").textContent = text;
  }

  play(on) {
    clearTimeout(this.timer);
    this.timer = null;
    by_id("play").textContent = on ? "Pause" : "Play";
    if (!on) return;
    const frames = this.data.frames, time = this.data.series.time;
    if (this.at >= frames.length - 1) this.select(0);
    const step = () => {
      if (this.at >= frames.length - 1) return this.play(false);
      const wait = 1000 * (time[frames[this.at + 1].frame] - time[frames[this.at].frame]);
      this.timer = setTimeout(() => { this.select(this.at + 1); step(); }, Math.max(15, Math.min(500, wait)));
    };
    step();
  }

  draw() {
    const frame = this.data.frames[this.at], camera = this.data.camera;
    if (!frame || !this.image.naturalWidth) return;
    const ratio = window.devicePixelRatio || 1, wide = this.canvas.clientWidth, high = wide * camera.height / camera.width;
    const size = { width: Math.max(1, Math.round(wide * ratio)), height: Math.max(1, Math.round(high * ratio)) };
    if (this.canvas.width !== size.width || this.canvas.height !== size.height) Object.assign(this.canvas, size);
    const pen = this.canvas.getContext("2d"), scale = wide / camera.width, px = (v) => (v + 0.5) * scale;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.drawImage(this.image, 0, 0, wide, high);
    const outline = (quad, colour, width, dash) => {
      if (!quad) return;
      pen.beginPath();
      for (let i = 0; i < quad.length; i += 2) pen.lineTo(px(quad[i]), px(quad[i + 1]));
      pen.closePath();
      pen.setLineDash(dash);
      pen.lineWidth = width;
      pen.strokeStyle = colour;
      pen.stroke();
    };
    if (this.marks.points) {
      pen.fillStyle = css("--accent");
      for (let i = 0; i < frame.points.length; i += 2) pen.fillRect(px(frame.points[i]) - 1, px(frame.points[i + 1]) - 1, 2, 2);
    }
    if (this.marks.detections) for (const d of frame.detections) outline(d.quad, css("--live"), 1.2, [4, 3]);
    if (!this.marks.texts) return;
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "bottom";
    for (const text of frame.texts) {
      const colour = zncc_colour(text.zncc, this.data.cull_zncc);
      outline(text.quad, colour, 2, []);
      if (!text.quad) continue;
      const name = this.words.get(text.id), x = Math.max(2, px(text.quad[0])), y = Math.max(14, px(text.quad[1]) - 2);
      pen.fillStyle = "rgba(0, 0, 0, .65)";
      pen.fillRect(x - 2, y - 13, pen.measureText(name).width + 4, 13);
      pen.fillStyle = "#fff";
      pen.fillText(name, x, y);
    }
  }

  draw_scale() {
    const canvas = by_id("zncc-scale"), pen = canvas.getContext("2d"), low = this.data.cull_zncc;
    for (let x = 0; x < canvas.width; ++x) {
      pen.fillStyle = zncc_colour(low + (1 - low) * x / canvas.width, low);
      pen.fillRect(x, 0, 1, canvas.height);
    }
    by_id("zncc-range").textContent = `${low} to 1`;
  }
}
