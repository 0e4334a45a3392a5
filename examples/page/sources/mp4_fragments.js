// The samples of an MP4 file in fragments, as browsers and live recorders write them: each fragment (moof) has the index
// of its own frames.
"use strict";

const NOT_A_KEY = 0x10000;  // of a sample's flags

/// What counts for the samples of a fragment where they do not say it themselves: { begin, duration, size, flags }.
function fragment_defaults(header, usual, moof_at) {
  const flags = header.u32(0) & 0xffffff, out = { ...usual, begin: moof_at };
  let at = 8;
  const next = (bit, bytes, take) => {
    if (!(flags & bit)) return;
    take(at);
    at += bytes;
  };
  next(1, 8, (i) => { out.begin = header.u64(i); });
  next(2, 4, () => {});  // which description: a video has one
  next(8, 4, (i) => { out.duration = header.u32(i); });
  next(16, 4, (i) => { out.size = header.u32(i); });
  next(32, 4, (i) => { out.flags = header.u32(i); });
  return out;
}

/// Appends the samples of one run. `place`: { offset, time }, where and when it begins; becomes those of its end.
function take_run(run, usual, timescale, place, samples) {
  const flags = run.u32(0) & 0xffffff, count = run.u32(4);
  let at = 8;
  const next = (bit, other) => {
    if (!(flags & bit)) return other;
    at += 4;
    return run.i32(at - 4);
  };
  if (flags & 1) place.offset = usual.begin + next(1);
  const first = next(4, null);
  for (let i = 0; i < count; ++i) {
    const duration = next(0x100, usual.duration) >>> 0, size = next(0x200, usual.size) >>> 0;
    const own = next(0x400, i === 0 && first !== null ? first : usual.flags), shift = next(0x800, 0);
    samples.push({ offset: place.offset, size, time: (place.time + shift) / timescale, key: !(own & NOT_A_KEY) });
    place.offset += size;
    place.time += duration;
  }
}

/// Of the track `id`. `usual`: its entry of the movie's table of defaults (trex). What lies behind the end of the file is
/// left out: a recording may end anywhere.
async function fragment_samples(file, id, trex, timescale) {
  const usual = { duration: trex.u32(12), size: trex.u32(16), flags: trex.u32(20) }, samples = [];
  let time = 0;
  for await (const { kind, at, read } of top_boxes(file)) {
    if (kind !== "moof") continue;
    for (const [name, part] of (await read()).all()) {
      const header = name === "traf" && part.find("tfhd");
      if (!header || header.u32(4) !== id) continue;
      const own = fragment_defaults(header, usual, at), decoded = part.find("tfdt");
      if (decoded) time = decoded.u8(0) === 1 ? decoded.u64(4) : decoded.u32(4);
      const place = { offset: own.begin, time };
      for (const [inner, run] of part.all()) if (inner === "trun") take_run(run, own, timescale, place, samples);
      time = place.time;
    }
  }
  return samples.filter(({ offset, size }) => offset + size <= file.size);
}
