// Grey values of a picture: an ImageBitmap or a VideoFrame, which is closed by its owner.
"use strict";

let canvas = null, with_colours = false;

/// The size in which a picture is looked at: its longer side at most `side` px; 0: as it is.
function fitted(width, height, side) {
  const scale = side > 0 ? Math.min(1, side / Math.max(width, height)) : 1;
  return [Math.max(1, Math.round(scale * width)), Math.max(1, Math.round(scale * height))];
}

/// By way of a canvas; `turn`: quarter turns clockwise that show the picture upright.
function by_canvas(picture, side, turn = 0) {
  const wide = picture.displayWidth || picture.width, high = picture.displayHeight || picture.height;
  const [w, h] = fitted(wide, high, side), [width, height] = turn % 2 ? [h, w] : [w, h];
  if (!canvas || canvas.width !== width || canvas.height !== height) canvas = new OffscreenCanvas(width, height);
  const pen = canvas.getContext("2d", { willReadFrequently: true, alpha: false });
  pen.setTransform(1, 0, 0, 1, width / 2, height / 2);
  pen.rotate(turn * Math.PI / 2);
  pen.drawImage(picture, -w / 2, -h / 2, w, h);
  const { data } = pen.getImageData(0, 0, width, height);
  return { width, height, pixels: engine.grey_of(data), colours: with_colours ? data : null };
}

const PLANAR = ["I420", "I420A", "I422", "I444", "NV12"];

/// The luma of a frame of a video is its grey value, once black is 0 and white 255.
async function luma(frame) {
  const { width, height } = frame.visibleRect, layout = [];
  const size = frame.allocationSize(), all = new Uint8Array(size);
  layout.push(...await frame.copyTo(all));
  const { offset, stride } = layout[0], pixels = new Uint8Array(width * height);
  for (let y = 0; y < height; ++y)
    pixels.set(all.subarray(offset + y * stride, offset + y * stride + width), y * width);
  if (!(frame.colorSpace && frame.colorSpace.fullRange))
    for (let i = 0; i < pixels.length; ++i) pixels[i] = FULL_RANGE[pixels[i]];
  return { width, height, pixels };
}
const FULL_RANGE = Uint8Array.from({ length: 256 }, (_, v) => Math.max(0, Math.min(255, Math.round((v - 16) * 255 / 219))));

/// { width, height, pixels, colours }, these where they are wanted: red, green, blue and alpha. The way of the least work
/// that the picture allows.
async function grey_picture(picture, side = 0, turn = 0) {
  const rect = picture.visibleRect;
  const as_is = rect && turn === 0 && !with_colours && PLANAR.includes(picture.format) && rect.width === picture.displayWidth &&
    rect.height === picture.displayHeight && fitted(rect.width, rect.height, side)[0] === rect.width;
  return as_is ? luma(picture) : by_canvas(picture, side, turn);
}
