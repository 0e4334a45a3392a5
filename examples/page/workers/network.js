// The worker of a network: PP-OCR's detector and recogniser, run by ONNX Runtime; the page got them by detector.js.
"use strict";

const LONG_SIDE = 960;  // px of the detector's input: at 640 it is twice as fast, and misses small texts
const MOST_READ = 3;  // lines of a frame: each takes an eighth of the time of the detector
const ENOUGH = 4;  // readings of a line that is found again and again
const SAME = 0.3;  // of two boxes' common area: one line in two frames
let engine = null, detector = null, reader = null, before = [];

/// The files come as base64, by their names in detector.js.
async function start(parts) {
  const bytes = async (name) =>
    new Uint8Array(await (await fetch(`data:application/octet-stream;base64,${parts[name]}`)).arrayBuffer());
  const script = async (name) => URL.createObjectURL(new Blob([await bytes(name)], { type: "text/javascript" }));
  importScripts(await script("runtime"));
  Object.assign(ort.env.wasm, { numThreads: 1, wasmBinary: await bytes("wasm"), wasmPaths: { mjs: await script("glue") } });
  detector = await ort.InferenceSession.create(await bytes("detector"));
  reader = await ort.InferenceSession.create(await bytes("reader"));
  engine.call("network_letters", new TextDecoder().decode(await bytes("letters")));
}

/// The session's only output, left where the engine looks for it; returns its shape.
async function infer(session, shape) {
  const count = shape.reduce((a, b) => a * b, 1);
  const input = new ort.Tensor("float32", engine.values(count).slice(), shape);
  const output = (await session.run({ [session.inputNames[0]]: input }))[session.outputNames[0]];
  engine.values(output.data.length).set(output.data);
  return output.dims;
}

function box_of(quad) {
  const x = [0, 2, 4, 6].map((i) => quad[i]), y = [1, 3, 5, 7].map((i) => quad[i]);
  return { left: Math.min(...x), right: Math.max(...x), top: Math.min(...y), bottom: Math.max(...y) };
}

function overlap(a, b) {
  const area = ({ left, right, top, bottom }) => Math.max(0, right - left) * Math.max(0, bottom - top);
  const common = area({ left: Math.max(a.left, b.left), right: Math.min(a.right, b.right),
    top: Math.max(a.top, b.top), bottom: Math.min(a.bottom, b.bottom) });
  return common / (area(a) + area(b) - common || 1);
}

/// The word in a quad of the image that the engine looks at; "" where the network is not sure.
async function word_in(quad) {
  const { width, height } = engine.call("network_line", JSON.stringify(quad));
  if (!width) return { text: "", score: 0 };
  const [, steps, classes] = await infer(reader, [1, 3, height, width]);
  return engine.call("network_word", steps, classes);
}

/// The lines that were read least often go first, so that in time all are read.
async function read_lines(quads) {
  const lines = quads.map((quad) => {
    const box = box_of(quad), again = before.filter((other) => overlap(other.box, box) > SAME);
    return { quad, box, read: Math.max(0, ...again.map((other) => other.read)) };
  });
  for (const line of lines.filter(({ read }) => read < ENOUGH).sort((a, b) => a.read - b.read).slice(0, MOST_READ)) {
    ++line.read;
    const { text, score } = await word_in(line.quad);
    if (text) line.quad.splice(8, 1, score, text);
  }
  before = lines;
}

function in_colour(grey) {
  const colours = new Uint8Array(4 * grey.length);
  grey.forEach((value, i) => colours.fill(value, 4 * i, 4 * i + 3));
  return colours;
}

async function quads_of({ width, height, pixels, colours }) {
  engine.put(colours || in_colour(pixels));
  const size = engine.call("network_image", width, height, LONG_SIDE);
  await infer(detector, [1, 3, size.height, size.width]);
  const { quads } = engine.call("network_boxes");
  await read_lines(quads);
  return quads;
}

const engine_ready = start_engine().then((started) => { engine = started; });
self.onmessage = ({ data: { port, parts } }) => {
  if (!port) return;
  const ready = engine_ready.then(() => start(parts));
  ready.catch(() => {});  // told with the first frame
  async function detect(message) {
    const begin = performance.now();
    let quads = [];
    try {
      await ready;
      quads = await quads_of(message);
    } catch (error) {  // the run goes on without
      self.postMessage({ type: "error", message: `PP-OCRv4 does not run: ${error.message || error}` });
    }
    port.postMessage({ type: "detections", frame: message.frame, quads, ms: performance.now() - begin });
  }
  async function read({ pictures }) {
    const readings = [];
    try {
      await ready;
      for (const { width, height, pixels, quad } of pictures) {
        engine.put(pixels);
        engine.call("network_picture", width, height);
        readings.push(await word_in(quad));
      }
    } catch (error) {  // told with the frames
      while (readings.length < pictures.length) readings.push({ text: "", score: 0 });
    }
    port.postMessage({ type: "readings", readings });
  }
  answer(Promise.resolve(), { detect, read }, port);
};
