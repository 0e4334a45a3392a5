// The worker of the eyes: reads frames ahead of the system, as grey values, with their colours where a network looks; and
// detects text, by the built-in detector, in those that it is sent.
"use strict";

const AHEAD = 6;  // frames that wait for the system
let engine = null, mapper = null, detections = null, credit = AHEAD, wake = null, stopped = false, dropped = 0, last_time = -Infinity;

function send(time, { width, height, pixels, colours }) {
  --credit;
  last_time = time;
  const moved = colours ? [pixels.buffer, colours.buffer] : [pixels.buffer];
  mapper.postMessage({ type: "frame", time, width, height, pixels, colours }, moved);
}

async function credited() {
  while (credit <= 0 && !stopped) await new Promise((done) => { wake = done; });
}

function detect({ frame, pixels, width, height }) {
  engine.put(pixels);
  const { quads, ms } = engine.call("detect", width, height);
  detections.postMessage({ type: "detections", frame, quads, ms });
}

/// Every frame of a file or a folder, in order. A camera sends its own: see camera().
async function read({ source }) {
  const open = { images: read_images, video: read_video }[source.kind];
  for await (const { time, picture } of open(source)) {
    await credited();
    if (stopped) break;
    if (time > last_time) send(time, picture);
  }
  mapper.postMessage({ type: "end", dropped });
}

/// The frames of a camera, until it stops. The system busy, they are dropped.
async function stream({ readable, side }) {
  const frames = readable.getReader();
  for (let next; !(next = await frames.read()).done;) await take(next.value, next.value.timestamp / 1e6, side);
}

/// One that the page took.
async function camera({ frame, time, side }) {
  try {
    await take(frame, time, side);
  } finally {
    self.postMessage({ type: "seen" });
  }
}

async function take(frame, time, side) {
  try {
    if (credit > AHEAD - 2 && time > last_time && !stopped) send(time, await grey_picture(frame, side));
    else ++dropped;
  } finally {
    frame.close();
  }
}

const ready = start_engine().then((started) => { engine = started; });
answer(ready, {
  camera,
  stop() {
    mapper.postMessage({ type: "end", dropped });
    stopped = true;
  },
}, self);
self.addEventListener("message", ({ data }) => {  // beside what waits
  if (data.type === "mapper") {
    mapper = data.port;
    with_colours = !data.detections;
    mapper.onmessage = () => {  // more, please
      ++credit;
      if (wake) wake();
      wake = null;
    };
    detections = data.detections;
    if (detections) answer(ready, { detect }, detections);
  } else if (data.type === "read") {
    ready.then(() => read(data)).catch((error) => {
      self.postMessage({ type: "error", message: error.message || String(error) });
      if (last_time > -Infinity) mapper.postMessage({ type: "end", dropped });
    });
  } else if (data.type === "stream") {
    ready.then(() => stream(data)).catch((error) => self.postMessage({ type: "error", message: error.message || String(error) }));
  } else if (data.type === "halt") {  // the rest of a file is left out
    stopped = true;
    if (wake) wake();
  }
});
