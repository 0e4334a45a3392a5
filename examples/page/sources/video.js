// Every frame of a video file, in the order of time: the file's own index (mp4.js, webm.js) through the browser's
// decoder. An element <video> would show frames at its own pace, and leave some out.
"use strict";

const IN_WORK = 8;  // frames in the decoder, and decoded ones that wait

async function index_of(file) {
  const head = new Uint8Array(await file.slice(0, 12).arrayBuffer());
  if (head[0] === 0x1a && head[1] === 0x45 && head[2] === 0xdf && head[3] === 0xa3) return webm_index(file);
  const kind = String.fromCharCode(...head.slice(4, 8));
  if (["ftyp", "moov", "mdat", "free", "wide", "skip"].includes(kind)) return mp4_index(file);
  throw new Error(`${file.name}: neither MP4, MOV, WebM nor Matroska`);
}

async function* read_video({ file, side }) {
  if (!self.VideoDecoder) throw new Error("this browser has no WebCodecs: give it a folder of images");
  const { config, samples, turn } = await index_of(file);
  const known = await VideoDecoder.isConfigSupported(config).catch(() => ({ supported: false }));
  if (!known.supported) throw new Error(`${file.name}: this browser does not decode ${config.codec}`);
  const frames = [];
  let failure = null, wake = null, done = false, first = null;
  const change = () => { if (wake) wake(); wake = null; };
  const decoder = new VideoDecoder({
    output: (frame) => { frames.push(frame); change(); },
    error: (error) => { failure = new Error(`${file.name}: ${error.message}`); change(); },
  });
  decoder.ondequeue = change;
  decoder.configure(config);
  const feed = async () => {
    for (const { offset, size, time, key } of samples) {
      while (!failure && !done && decoder.decodeQueueSize + frames.length >= IN_WORK)
        await Promise.race([new Promise((go) => setTimeout(go, 20)), new Promise((go) => { wake_feed = go; })]);
      if (failure || done) return;
      const data = new Uint8Array(await file.slice(offset, offset + size).arrayBuffer());
      decoder.decode(new EncodedVideoChunk({ type: key ? "key" : "delta", timestamp: Math.round(1e6 * time), data }));
    }
    await decoder.flush();
    done = true;
    change();
  };
  let wake_feed = null;
  feed().catch((error) => { failure = failure || error; change(); });
  try {
    while (true) {
      if (failure && !frames.length) throw failure;
      if (!frames.length && done) return;
      if (!frames.length) {
        await new Promise((go) => { wake = go; });
        continue;
      }
      const frame = frames.shift();
      if (wake_feed) wake_feed();
      if (first === null) first = frame.timestamp;
      const time = (frame.timestamp - first) / 1e6;
      try {
        yield { time, picture: await grey_picture(frame, side, turn) };
      } finally {
        frame.close();
      }
    }
  } finally {
    done = true;
    for (const frame of frames) frame.close();
    if (decoder.state !== "closed") decoder.close();
  }
}
