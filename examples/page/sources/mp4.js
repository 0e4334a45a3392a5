// The index of an MP4 or MOV file: where the coded frames of its first video track lie, and how they are coded.
"use strict";

class Box {
  constructor(view, begin, end) { Object.assign(this, { view, begin, end }); }
  u8(at) { return this.view.getUint8(this.begin + at); }
  u16(at) { return this.view.getUint16(this.begin + at); }
  u32(at) { return this.view.getUint32(this.begin + at); }
  i32(at) { return this.view.getInt32(this.begin + at); }
  u64(at) { return this.u32(at) * 2 ** 32 + this.u32(at + 4); }
  kind(at) { return String.fromCharCode(this.u8(at), this.u8(at + 1), this.u8(at + 2), this.u8(at + 3)); }
  bytes() { return new Uint8Array(this.view.buffer, this.view.byteOffset + this.begin, this.end - this.begin); }
  /// The boxes inside, from `skip` on.
  * all(skip = 0) {
    for (let at = skip; this.begin + at + 8 <= this.end;) {
      const long = this.u32(at) === 1, size = long ? this.u64(at + 8) : this.u32(at) || this.end - this.begin - at;
      const head = long ? 16 : 8;
      if (size < head) return;
      yield [this.kind(at + 4), new Box(this.view, this.begin + at + head, Math.min(this.end, this.begin + at + size))];
      at += size;
    }
  }
  find(path, skip = 0) {
    const [first, ...others] = path.split("/");
    for (const [kind, box] of this.all(skip)) if (kind === first) return others.length ? box.find(others.join("/")) : box;
    return null;
  }
}

/// The boxes of the file's top level: { kind, at, read() }, which reads what is inside.
async function* top_boxes(file) {
  for (let at = 0; at + 8 <= file.size;) {
    const head = new DataView(await file.slice(at, at + 16).arrayBuffer());
    let size = head.getUint32(0), skip = 8;
    if (size === 1) [size, skip] = [head.getUint32(8) * 2 ** 32 + head.getUint32(12), 16];
    if (size === 0) size = file.size - at;
    if (size < skip) return;
    const begin = at + skip, end = at + size;
    yield { kind: String.fromCharCode(...new Uint8Array(head.buffer, 4, 4)), at, read: async () => {
      const view = new DataView(await file.slice(begin, end).arrayBuffer());
      return new Box(view, 0, view.byteLength);
    } };
    at = end;
  }
}

async function top_box(file, wanted) {
  for await (const { kind, read } of top_boxes(file)) if (kind === wanted) return read();
  return null;
}

const hex = (value) => value.toString(16).padStart(2, "0");
const two = (value) => String(value).padStart(2, "0");

/// What VideoDecoder asks of the coding, from the sample's description.
function mp4_coding(entry, kind) {
  const inside = (name) => entry.find(name, 78);
  const size = { codedWidth: entry.u16(24), codedHeight: entry.u16(26) };
  const avc = inside("avcC"), hevc = inside("hvcC"), vp = inside("vpcC"), av1 = inside("av1C");
  if (avc) return { codec: `avc1.${hex(avc.u8(1))}${hex(avc.u8(2))}${hex(avc.u8(3))}`, description: avc.bytes(), ...size };
  if (hevc) {
    let flags = 0;
    for (let i = 0; i < 32; ++i) flags = (flags << 1 | hevc.u32(2) >>> i & 1) >>> 0;
    const constraints = [6, 7, 8, 9, 10, 11].map((i) => hevc.u8(i));
    while (constraints.length && constraints[constraints.length - 1] === 0) constraints.pop();
    const first = hevc.u8(1), tier = first & 32 ? "H" : "L", space = ["", "A", "B", "C"][first >> 6];
    const tail = constraints.map((c) => `.${c.toString(16).toUpperCase()}`).join("");
    return { codec: `${kind}.${space}${first & 31}.${flags.toString(16)}.${tier}${hevc.u8(12)}${tail}`,
      description: hevc.bytes(), ...size };
  }
  if (vp) return { codec: `${kind}.${two(vp.u8(4))}.${two(vp.u8(5))}.${two(vp.u8(6) >> 4)}`, ...size };
  if (av1) {
    const b = av1.u8(2), depth = b & 64 ? (b & 32 ? 12 : 10) : 8;
    return { codec: `av01.${av1.u8(1) >> 5}.${two(av1.u8(1) & 31)}${b & 128 ? "H" : "M"}.${two(depth)}`, ...size };
  }
  throw new Error(`the coding '${kind}' is not known`);
}

/// Quarter turns clockwise by which the track says that it is to be shown.
function mp4_turn(header) {
  const at = header.u8(0) === 1 ? 52 : 40, [a, b, c] = [header.i32(at), header.i32(at + 4), header.i32(at + 12)];
  if (a === 0 && b > 0 && c < 0) return 1;
  if (a < 0 && b === 0) return 2;
  return a === 0 && b < 0 && c > 0 ? 3 : 0;
}

/// One sample a coded frame, in the order of the file's index, which is that of decoding.
function mp4_samples(table, timescale) {
  const [sizes, chunks, runs] = [table.find("stsz"), table.find("stsc"), table.find("stts")];
  const short = table.find("stco"), long = table.find("co64"), shifts = table.find("ctts"), keys = table.find("stss");
  const count = sizes.u32(8), samples = [];
  for (let i = 0; i < count; ++i) samples.push({ offset: 0, size: sizes.u32(4) || sizes.u32(12 + 4 * i), time: 0, key: !keys });
  const each = (box, visit) => {  // of a table of (count, value)
    for (let i = 0, at = 0; box && i < box.u32(4); ++i)
      for (let k = box.u32(8 + 8 * i); k > 0 && at < count; --k) visit(samples[at++], box.i32(12 + 8 * i));
  };
  let time = 0;
  each(runs, (sample, step) => { sample.time = time / timescale; time += step; });
  each(shifts, (sample, shift) => { sample.time += shift / timescale; });
  for (let i = 0; keys && i < keys.u32(4); ++i) samples[keys.u32(8 + 4 * i) - 1].key = true;
  const places = (short || long).u32(4), entries = chunks.u32(4);
  for (let chunk = 0, entry = 0, at = 0; chunk < places; ++chunk) {
    while (entry + 1 < entries && chunks.u32(8 + 12 * (entry + 1)) <= chunk + 1) ++entry;
    let offset = short ? short.u32(8 + 4 * chunk) : long.u64(8 + 8 * chunk);
    for (let k = chunks.u32(12 + 12 * entry); k > 0 && at < count; --k) {
      samples[at].offset = offset;
      offset += samples[at++].size;
    }
  }
  return samples;
}

/// { config, samples: [{ offset, size, time, key }], turn }
async function mp4_index(file) {
  const movie = await top_box(file, "moov");
  if (!movie) throw new Error(`${file.name}: the file has no index (moov); it is not whole`);
  for (const [kind, track] of movie.all()) {
    if (kind !== "trak" || track.find("mdia/hdlr").kind(8) !== "vide") continue;
    const header = track.find("mdia/mdhd"), table = track.find("mdia/minf/stbl");
    const timescale = header.u8(0) === 1 ? header.u32(20) : header.u32(12);
    const id = track.find("tkhd").u32(track.find("tkhd").u8(0) === 1 ? 20 : 12);
    let samples = mp4_samples(table, timescale);
    const fragments = movie.find("mvex");
    for (const [name, trex] of fragments && !samples.length ? fragments.all() : [])
      if (name === "trex" && trex.u32(4) === id) samples = await fragment_samples(file, id, trex, timescale);
    if (!samples.length) throw new Error(`${file.name}: there is no frame in it`);
    const [[name, entry]] = table.find("stsd").all(8);
    return { config: mp4_coding(entry, name), samples, turn: mp4_turn(track.find("tkhd")) };
  }
  throw new Error(`${file.name}: there is no video in it`);
}
