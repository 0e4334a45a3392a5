// The index of a WebM or Matroska file: the blocks of its first video track. The file is walked from end to end, as a
// recording of a browser has no other index.
"use strict";

const EBML = {
  segment: 0x18538067, info: 0x1549a966, scale: 0x2ad7b1, tracks: 0x1654ae6b, entry: 0xae, number: 0xd7, type: 0x83,
  codec: 0x86, private: 0x63a2, video: 0xe0, width: 0xb0, height: 0xba, cluster: 0x1f43b675, time: 0xe7, group: 0xa0,
  block: 0xa1, simple: 0xa3, reference: 0xfb,
};
const WITH_PARTS = [EBML.segment, EBML.info, EBML.tracks, EBML.entry, EBML.video, EBML.cluster, EBML.group];
const WINDOW = 1 << 20;

/// Bytes of a file by their place, read a window at a time.
class Window {
  constructor(file) { Object.assign(this, { file, begin: 0, bytes: new Uint8Array(0) }); }
  async need(at, count) {
    if (at >= this.begin && at + count <= this.begin + this.bytes.length) return;
    this.begin = at;
    this.bytes = new Uint8Array(await this.file.slice(at, at + Math.max(WINDOW, count)).arrayBuffer());
  }
  at(place) { return this.bytes[place - this.begin]; }
  part(place, count) { return this.bytes.slice(place - this.begin, place - this.begin + count); }
  /// A number of 1 to 8 bytes, whose first one says how many: [value, bytes]; value null: not known.
  number(place, with_mark) {
    const first = this.at(place), bytes = Math.clz32(first || 1) - 23;
    let value = with_mark ? first : first & (1 << 8 - bytes) - 1, ones = (first & (1 << 8 - bytes) - 1) === (1 << 8 - bytes) - 1;
    for (let i = 1; i < bytes; ++i) {
      value = value * 256 + this.at(place + i);
      ones = ones && this.at(place + i) === 255;
    }
    return [ones && !with_mark ? null : value, bytes];
  }
}

const whole_number = (bytes) => bytes.reduce((value, byte) => value * 256 + byte, 0);

function webm_coding({ codec, private: description, width, height }) {
  const size = { codedWidth: width, codedHeight: height };
  if (codec === "V_VP8") return { codec: "vp8", ...size };
  if (codec === "V_VP9") return { codec: "vp09.00.50.08", ...size };
  if (codec === "V_AV1") return { codec: "av01.0.08M.08", ...size };
  if (codec === "V_MPEG4/ISO/AVC")
    return { codec: `avc1.${hex(description[1])}${hex(description[2])}${hex(description[3])}`, description, ...size };
  throw new Error(`the coding '${codec}' is not known`);
}

/// { config, samples: [{ offset, size, time, key }], turn }
async function webm_index(file) {
  const window = new Window(file), samples = [], tracks = [];
  let scale = 1e6, cluster = 0, chosen = null, last = null;
  for (let at = 0; at + 2 < file.size;) {
    await window.need(at, Math.min(32, file.size - at));
    const [id, id_bytes] = window.number(at, true), [size, size_bytes] = window.number(at + id_bytes, false);
    const begin = at + id_bytes + size_bytes, track = tracks[tracks.length - 1];
    at = WITH_PARTS.includes(id) || size === null ? begin : begin + size;
    if (id === EBML.entry) tracks.push({});
    if (id === EBML.group) last = null;
    if (size === null || size > WINDOW && id !== EBML.simple && id !== EBML.block) continue;
    const value = async () => {
      await window.need(begin, size);
      return window.part(begin, size);
    };
    if (id === EBML.scale) scale = whole_number(await value());
    else if (id === EBML.time) cluster = whole_number(await value());
    else if (id === EBML.codec) track.codec = String.fromCharCode(...await value()).replace(/\0+$/, "");
    else if (id === EBML.private) track.private = await value();
    else if (id === EBML.reference && last) last.key = false;
    else if (id === EBML.simple || id === EBML.block) {
      chosen = chosen || tracks.find((t) => t.type === 1);
      if (!chosen) throw new Error(`${file.name}: there is no video in it`);
      await window.need(begin, 16);
      const [number, bytes] = window.number(begin, false), head = begin + bytes;
      if (number !== chosen.number) continue;
      const time = window.at(head) * 256 + window.at(head + 1), signed = time > 32767 ? time - 65536 : time;
      const key = id === EBML.block || (window.at(head + 2) & 128) !== 0;
      last = { offset: head + 3, size: begin + size - head - 3, time: (cluster + signed) * scale / 1e9, key };
      samples.push(last);
    } else {
      const name = Object.keys(EBML).find((key) => EBML[key] === id);
      if (["number", "type", "width", "height"].includes(name) && track) track[name] = whole_number(await value());
    }
  }
  if (!samples.length) throw new Error(`${file.name}: there is no video in it`);
  return { config: webm_coding(chosen), samples, turn: 0 };
}
