// The compiled system in a worker: calls with JSON, pixels in its memory. Every worker begins with it, and gets it
// compiled from the page.
"use strict";

/// engine.call(name, ...numbers and strings) returns the parsed answer; throws where it is an error.
async function start_engine() {
  const compiled = await new Promise((done) => {
    self.addEventListener("message", ({ data }) => { if (data.type === "engine") done(data.compiled); });
  });
  const module = await new Promise((done, fail) => {
    textslam_engine({
      instantiateWasm(imports, begin) {
        WebAssembly.instantiate(compiled, imports).then((instance) => begin(instance, compiled), fail);
        return {};
      },
    }).then(done, fail);
  });
  return {
    files: module.FS,
    call(name, ...values) {
      const kinds = values.map((v) => (typeof v === "number" ? "number" : "string"));
      const out = JSON.parse(module.ccall(`page_${name}`, "string", kinds, values));
      if (out.error !== undefined) throw new Error(out.error);
      return out;
    },
    /// Copies pixels to where frame and detect look for them.
    put(pixels) { module.HEAPU8.set(pixels, module._page_pixels(pixels.length)); },
    /// A copy of the pixels that the module left there.
    pixels(count) {
      const at = module._page_pixels(count);
      return module.HEAPU8.slice(at, at + count);
    },
    /// Grey values of red, green, blue and alpha.
    grey_of(colours) {
      const at = module._page_pixels(colours.length), count = colours.length / 4;
      module.HEAPU8.set(colours, at);
      module._page_grey(count);
      return module.HEAPU8.slice(at, at + count);
    },
    /// `count` values of a network, in the module's memory: good until the next call.
    values(count) {
      const at = module._page_network_values(count) / 4;
      return module.HEAPF32.subarray(at, at + count);
    },
  };
}

/// Answers messages one after the other, by the functions of their names; others are passed over. What a function throws
/// goes to the page.
function answer(ready, handlers, port) {
  let last = ready;
  port.onmessage = ({ data }) => {
    if (!handlers[data.type]) return;
    last = last.then(() => handlers[data.type](data)).catch((error) => {
      self.postMessage({ type: "error", message: error.message || String(error) });
    });
  };
}
