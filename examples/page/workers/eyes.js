// The worker of the eyes: reads frames ahead of the system, as grey values, and detects text in those that it is sent.
"use strict";

const AHEAD = 6;  // frames that wait for the system
let engine = null, mapper = null, credit = AHEAD, wake = null, stopped = false, dropped = 0, last_time = -Infinity;

function send(time, { width, height, pixels }) {
  --credit;
  last_time = time;
  mapper.postMessage({ type: "frame", time, width, height, pixels }, [pixels.buffer]);
}

async function credited() {
  while (credit <= 0 && !stopped) await new Promise((done) => { wake = done; });
}

function detect({ frame, pixels, width, height }) {
  engine.put(pixels);
  const { quads, ms } = engine.call("detect", width, height);
  mapper.postMessage({ type: "detections", frame, quads, ms });
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

/// A frame of the camera. The system busy, it is dropped.
async function camera({ frame, time, side }) {
  try {
    if (credit > AHEAD - 2 && time > last_time && !stopped) send(time, await grey_picture(frame, side));
    else ++dropped;
  } finally {
    frame.close();
    self.postMessage({ type: "seen" });
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
    const queue = new MessageChannel();
    answer(ready, { detect }, queue.port2);
    mapper.onmessage = (message) => {
      if (message.data.type !== "more") return queue.port1.postMessage(message.data, [message.data.pixels.buffer]);
      ++credit;
      if (wake) wake();
      wake = null;
    };
  } else if (data.type === "read") {
    ready.then(() => read(data)).catch((error) => {
      self.postMessage({ type: "error", message: error.message || String(error) });
      if (last_time > -Infinity) mapper.postMessage({ type: "end", dropped });
    });
  } else if (data.type === "halt") {  // the rest of a file is left out
    stopped = true;
    if (wake) wake();
  }
});
