// A folder of images, as the system ordered them: [{ file, time }].
"use strict";

async function* read_images({ frames, side }) {
  for (const { file, name, time } of frames) {
    if (!file) throw new Error(`${name}: the list names it, but it is not there`);
    let bitmap = null;
    try {
      bitmap = await createImageBitmap(file, { colorSpaceConversion: "none" });
    } catch (error) {
      throw new Error(`${name}: the browser cannot decode this image`);
    }
    const picture = await grey_picture(bitmap, side);
    bitmap.close();
    yield { time, picture };
  }
}
