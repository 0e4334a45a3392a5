// What the user gave: chosen files, a chosen folder, or what was dropped, as one list of { path, file }.
"use strict";

const SMALL = 32 << 20;  // bytes, of a text file that may belong to a sequence
const VIDEO = /\.(mp4|m4v|mov|webm|mkv)$/i, PICTURE = /\.(png|jpe?g|webp|avif|bmp|gif)$/i;
const READ = /\.(png|jpe?g|pgm|ppm)$/i;  // names by which the system knows an image
const TEXT = /\.(ya?ml|txt|csv|json|xml)$/i;

/// Of <input type=file>; a folder's files have paths.
const files_of_input = (input) =>
  [...input.files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));

/// Of a drop: folders are walked.
async function files_of_drop(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry && item.webkitGetAsEntry()).filter((e) => e);
  const out = [];
  const walk = async (entry) => {
    if (entry.isFile) {
      const file = await new Promise((done, fail) => entry.file(done, fail));
      out.push({ path: entry.fullPath.slice(1), file });
      return;
    }
    const reader = entry.createReader();
    for (let part; (part = await new Promise((done, fail) => reader.readEntries(done, fail))).length;)
      for (const inside of part) await walk(inside);
  };
  for (const entry of entries) await walk(entry);
  return out.length ? out : [...transfer.files].map((file) => ({ path: file.name, file }));
}

/// The sequence in these files: { folder, video, texts: [{ path, text }], by_path }. Paths are from the folder. Throws an
/// Error that says what was expected.
async function sequence_of(files) {
  const rooted = files.every(({ path }) => path.includes("/"));
  const roots = new Set(files.map(({ path }) => path.split("/")[0]));
  const one = rooted && roots.size === 1, folder = one ? [...roots][0] : "files";
  const inside = files.map(({ path, file }) => ({ path: one ? path.slice(path.indexOf("/") + 1) : path, file }))
    .filter(({ path }) => !path.split("/").some((part) => part.startsWith(".")));
  const videos = inside.filter(({ path }) => VIDEO.test(path)), images = inside.filter(({ path }) => PICTURE.test(path));
  if (videos.length > 1) throw new Error(`There are ${videos.length} videos; give one.`);
  if (videos.length && images.length) throw new Error("There are a video and images; give one of them.");
  if (!videos.length && !images.length) throw new Error("There is neither a video (MP4, MOV, WebM, Matroska) nor an image (PNG, JPEG, WebP, AVIF) in it.");
  const texts = [];
  for (const { path, file } of inside)
    if (TEXT.test(path) && file.size < SMALL) texts.push({ path, text: await file.text() });
  const by_path = new Map();
  for (const { path, file } of images) {
    // A format that the system does not know by its name is one that the browser decodes all the same.
    const name = READ.test(path) ? path : `${path}.png`;
    by_path.set(name, file);
    texts.push({ path: name, text: "" });
  }
  return { folder, video: videos.length ? videos[0].file : null, texts, by_path };
}
