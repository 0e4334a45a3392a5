// Puts the parts together: choose, run, results.
"use strict";

const live = new Live(), results = new Results(), maps = new Maps();
let run = null;

function notice(text) {
  by_id("notice").textContent = text || "";
  by_id("notice").hidden = !text;
}

async function settings() {
  const number = (id, low, high, usual) => {
    const value = Number(by_id(id).value);
    return Number.isFinite(value) && value >= low && value <= high ? value : usual;
  };
  return { fov: number("fov", 10, 170, 60), every: Math.round(number("every", 1, 100, 10)), calibrate: by_id("calibrate").checked,
    map: await maps.bytes(), localise: by_id("localise").checked };
}

function show_choice() {
  if (run) run.end();
  run = null;
  by_id("choose").hidden = false;
  by_id("work").hidden = by_id("report-part").hidden = true;
  by_id("run-name").textContent = "in the browser";
  by_id("open-files").focus();
}

/// Begins a run; `open(run)` gives it its frames, and returns how many there are: 0 where nobody knows.
async function begin(name, open) {
  if (run) run.end();
  notice("");
  results.clear();
  live.clear();
  by_id("choose").hidden = true;
  by_id("work").hidden = false;
  by_id("stop").hidden = false;
  by_id("stop").disabled = by_id("again").hidden = true;
  by_id("run-name").textContent = name;
  by_id("no-map").textContent = "The map begins once the camera has moved sideways.";
  by_id("progress").removeAttribute("value");
  by_id("progress-text").textContent = "Starting";
  let total = 0;
  const now = new Run({
    map: ({ map }) => live.show_map(map),
    kept({ frames }) {
      if (total) by_id("progress").value = frames / total;
      by_id("progress-text").textContent = `Reading for the camera's estimate: ${frames} frames`;
    },
    calibrating({ done, total: all }) {
      by_id("progress").value = done / all;
      by_id("progress-text").textContent = `Estimating the camera: ${done} of ${all} frames of a pass`;
    },
    frame(message) {
      if (!live.show_frame(message)) return;
      const done = message.seen.frame + 1, rate = (1000 * done / message.ms).toFixed(1);
      if (total) by_id("progress").value = done / total;
      by_id("progress-text").textContent = `${done}${total ? ` of ${total}` : ""} frames, ${rate} a second`;
    },
    finishing({ frames }) {
      by_id("stop").disabled = true;
      by_id("progress").removeAttribute("value");
      by_id("progress-text").textContent = `${frames} frames; adjusting the whole map, writing the report`;
    },
    finished(message) {
      finish();
      if (!message.metrics.keyframes) by_id("no-map").textContent = "There is no map: no frame could be tracked.";
      const missed = message.dropped + (now.webcam ? now.webcam.missed : 0);
      by_id("progress-text").textContent = `${message.frames} frames${missed ? `, ${missed} left out as the system was busy` : ""}`;
      results.show(message, name);
      const map = message.files.find((file) => file.name === "map.db");
      if (map) maps.add(`the map of ${name}`, new Blob([map.bytes]));
    },
    error(message) {
      notice(message);
      if (!live.newest) finish();
    },
  }, by_id("detector").value === "network" ? window.textslam_network : null);
  const finish = () => {
    by_id("progress").value = 1;
    by_id("stop").hidden = true;
    by_id("again").hidden = false;
    by_id("again").focus();
  };
  run = now;
  window.page = { run, live, results };
  try {
    total = await open(now);
    by_id("stop").disabled = false;
    by_id("stop").focus();
  } catch (error) {
    notice(error.message);
    show_choice();
  }
}

async function open_files(files) {
  try {
    const given = await files, map = given.find(({ path }) => MAP_FILE.test(path));
    if (map) maps.open(map.file);
    if (map && given.length === 1) return notice("");
    const sequence = await sequence_of(given);
    const name = sequence.video ? sequence.video.name : sequence.folder;
    await begin(name, async (now) => now.open_files(sequence, await settings()));
  } catch (error) {
    notice(error.message);
  }
}

/// detector.js beside the page brings a network (scripts/get-detector --page). It is large: it is loaded when it is chosen.
function choose_detector() {
  if (by_id("detector").value !== "network" || window.textslam_network) return notice("");
  const script = document.createElement("script");
  script.src = "detector.js";
  by_id("choose").inert = true;
  script.onload = () => { by_id("choose").inert = false; };
  script.onerror = () => {
    by_id("choose").inert = false;
    by_id("detector").value = "classical";
    notice("There is no detector.js beside this page. scripts/get-detector --page writes it.");
  };
  document.head.append(script);
}
by_id("detector").addEventListener("change", choose_detector);

for (const [button, input] of [["open-files", "files"], ["open-folder", "folder"]]) {
  by_id(button).addEventListener("click", () => by_id(input).click());
  by_id(input).addEventListener("change", () => {
    if (by_id(input).files.length) open_files(files_of_input(by_id(input)));
    by_id(input).value = "";
  });
}
by_id("open-camera").addEventListener("click", () => begin("camera", async (now) => {
  await now.open_camera(await settings());
  return 0;
}));
by_id("stop").addEventListener("click", () => { if (run.stop) run.stop(); });
by_id("again").addEventListener("click", show_choice);
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  by_id("choose").classList.add("over");
});
document.addEventListener("dragleave", () => by_id("choose").classList.remove("over"));
document.addEventListener("drop", (event) => {
  event.preventDefault();
  by_id("choose").classList.remove("over");
  if (by_id("choose").hidden) return;
  open_files(files_of_drop(event.dataTransfer));
});
listen_keys();
listen_theme(() => { live.view.request(); live.draw(); });
window.page = { run, live, results };
