// The worker of the system: tracks and maps each frame, in order, and says what became of it.
//
// Detections come late, as with `textslam --real-time`: the detector sees the newest key frame that it has not seen, or
// else the newest frame. Of a file it gets one at every `every`-th frame, and the answer is waited for at the next such
// frame: so the same file gives the same map on any machine. A camera does not wait: the detector gets the next frame
// when it is done with one.
"use strict";

let engine = null, eyes = null, detector = null, run = null;
const FOLDER_OF_OUTPUTS = "/.outputs";
const FILES = ["report.html", "text_map.json", "text_map.ply", "trajectory.txt", "trajectory_live.txt", "keyframes.txt",
  "camera.yaml", "metrics.json", "timing.json", "text_index.json", "covariances.csv", "localisation.csv"];
const FOLDER_OF_MAPS = "/.maps";
const CALIBRATED_BY = 900;  // frames, at most: as CalibrationOptions has it
const MAP_EVERY = 300;  // ms, at least, between two maps for the page

const to_page = (message, moved = []) => self.postMessage(message, moved);

/// The small files of a sequence, as the module's folder. `map`: { name, bytes }, or null.
function open({ folder, video, files, map }) {
  const fs = engine.files;
  for (const { path, text } of files) {
    const full = `/${folder}/${path}`;
    fs.mkdirTree(full.slice(0, full.lastIndexOf("/")));
    fs.writeFile(full, text);
  }
  fs.mkdirTree(`/${folder}`);
  fs.mkdirTree(FOLDER_OF_MAPS);
  fs.chdir(FOLDER_OF_MAPS);  // so that messages name the map as the user does
  if (map) fs.writeFile(map.name, map.bytes);
  to_page({ type: "opened", sequence: engine.call("open", `/${folder}`, video, map ? map.name : "") });
}

function begin({ fov, every, live, calibrate, detector_name, reads, localise }) {
  run = { kept: calibrate ? [] : null, fov, every, live, detector_name, reads, localise, size: null, frames: 0, candidate: null, asked: null, answer: null, asked_at: 0,
    map_at: 0, maps: -1, began: 0 };
}

// The newest frame is what the detector sees next, but a key frame keeps its place. Its image: colours, else grey.
function offer(frame, image) {
  const { candidate } = run;
  if (!candidate || frame.keyframe || !candidate.keyframe)
    run.candidate = { frame: frame.frame, keyframe: frame.keyframe, image };
}

function ask() {
  if (!run.candidate) return;
  const { frame, image } = run.candidate, { width, height } = run.size;
  run.asked = frame;
  run.asked_at = run.frames;
  run.candidate = null;
  detector.postMessage({ type: "detect", frame, width, height, ...image }, [Object.values(image)[0].buffer]);
}

// What the detector answered goes into the map.
async function take_answer(wait) {
  if (run.asked === null) return;
  if (!run.answer && wait) await new Promise((done) => { run.wake = done; });
  if (!run.answer) return;
  const { frame, quads, ms } = run.answer;
  run.answer = null;
  run.asked = null;
  engine.call("add_detections", frame, JSON.stringify(quads), ms);
}

/// Frames wait until the camera is known; it is estimated from the first ones.
async function frame(message) {
  if (!run.kept) return track(message);
  delete message.colours;  // of hundreds of frames they would take a gigabyte
  run.kept.push(message);
  engine.put(message.pixels);
  engine.call("keep", message.time, message.width, message.height);
  to_page({ type: "kept", frames: run.kept.length });
  if (run.kept.length >= CALIBRATED_BY) return calibrate();
  eyes.postMessage({ type: "more" });
}

async function calibrate() {
  const { kept } = run;
  run.kept = null;
  engine.call("calibrate", run.fov);
  for (const [i, message] of kept.entries()) await track(message, i + 1 === kept.length);
}
self.calibrating = (done, total) => { if (done % 10 === 0) to_page({ type: "calibrating", done, total }); };

/// `more`: the next frame may come.
async function track({ time, width, height, pixels, colours }, more = true) {
  if (!run.size) {
    engine.call("begin", width, height, run.fov, run.detector_name, run.localise ? 1 : 0);
    run.size = { width, height };
    run.began = performance.now();
  }
  const slot = run.live ? run.frames - run.asked_at >= run.every : run.frames % run.every === 0;
  if (slot || run.live) await take_answer(!run.live);
  engine.put(pixels);
  const seen = engine.call("frame", time, width, height);
  ++run.frames;
  offer(seen, colours ? { colours } : { pixels: pixels.slice() });
  if (slot && run.asked === null) ask();
  if (more) eyes.postMessage({ type: "more" });
  const now = performance.now();
  const grown = seen.map_keyframes !== run.maps || now - run.map_at > 5 * MAP_EVERY;
  if (grown && now - run.map_at > MAP_EVERY && seen.map_keyframes > 0) {
    to_page({ type: "map", map: engine.call("map") });
    run.map_at = performance.now();
    run.maps = seen.map_keyframes;
  }
  to_page({ type: "frame", seen, width, height, pixels, ms: performance.now() - run.began }, [pixels.buffer]);
}

/// Once their planes are known, a network reads the mapped texts from the front.
async function read_texts() {
  const { pictures: count } = engine.call("unread"), pictures = [];
  for (let i = 0; i < count; ++i) {
    const { width, height, quad } = engine.call("picture", i);
    pictures.push({ width, height, quad, pixels: engine.pixels(width * height) });
  }
  const came = new Promise((done) => { run.readings_came = done; });
  detector.postMessage({ type: "read", pictures });
  const readings = await came;
  engine.call("read", JSON.stringify(readings));
  return readings.filter(({ text }) => text).length;
}

async function end({ dropped }) {
  if (run && run.kept && run.kept.length) await calibrate();
  if (!run || !run.frames) throw new Error("no frame came");
  await take_answer(true);
  const ms = performance.now() - run.began;
  to_page({ type: "finishing", frames: run.frames, ms });
  const readings = run.reads ? await read_texts() : 0;
  const result = engine.call("finish", FOLDER_OF_OUTPUTS), fs = engine.files;
  to_page({ type: "map", map: engine.call("map") });
  const files = FILES.filter((name) => fs.analyzePath(`${FOLDER_OF_OUTPUTS}/${name}`).exists)
    .map((name) => ({ name, bytes: fs.readFile(`${FOLDER_OF_OUTPUTS}/${name}`) }));
  if (result.map) files.push({ name: "map.db", bytes: fs.readFile(result.map) });
  to_page({ type: "finished", ...result, readings, frames: run.frames, ms, dropped, files }, files.map((f) => f.bytes.buffer));
}

// The detector's answers do not queue behind the frame that waits for them.
function take_detections(message) {
  run.answer = message;
  if (run.wake) run.wake();
  run.wake = null;
}

const ready = start_engine().then((started) => { engine = started; });
answer(ready, {
  open,
  begin,
  ports({ frames, detections }) {
    eyes = frames;
    answer(Promise.resolve(), { frame, end }, eyes);
    detector = detections;
    detector.onmessage = ({ data }) => data.type === "readings" ? run.readings_came(data.readings) : take_detections(data);
  },
}, self);
