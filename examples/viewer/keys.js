// Keys: the list of them under `?`, and under a button beside the theme's.
"use strict";

// What is pressed, what it does, and the element without which it does nothing.
const KEYS = {
  "The page": [
    ["?", "this list", "body"],
    ["/", "search for a word", "#search"],
  ],
  "Frames": [
    ["\u2190 \u2192", "the frame before, the next", "#slider"],
    ["Home End", "the first frame, the last", "#slider"],
    ["Space", "play, pause", "#slider"],
  ],
  "In the 3D view": [
    ["\u2190 \u2192 \u2191 \u2193", "turn", "#view"],
    ["Shift + \u2190 \u2192 \u2191 \u2193", "move", "#view"],
    ["+ \u2212", "nearer, farther", "#view"],
    ["R", "the whole map again", "#view"],
  ],
  "Mouse and fingers": [
    ["Drag", "turn", "#view"],
    ["Right or Shift + drag", "move", "#view"],
    ["Wheel", "nearer, farther", "#view"],
    ["Tap", "from then on one finger turns; a tap beside the map ends it", "#view"],
    ["Two fingers", "move, nearer, farther", "#view"],
    ["Click on a text", "look at its front", "#view"],
    ["Click on a plot", "show that frame", "#plots"],
  ],
  "In the table": [["Enter", "show the text in 3D", "#texts"]],
};

/// Whether what has the focus is written into.
const WRITTEN = "input:not([type=checkbox]):not([type=range]), textarea, select";
const is_writing = (event) => Boolean(event.target.closest(WRITTEN));

function listen_keys() {
  const dialog = element("dialog", null, { id: "keys" }), close = element("button", "Close", { type: "button" });
  const open = element("button", "?", { type: "button", id: "help", title: "Keys" });
  open.setAttribute("aria-label", "Keys");
  dialog.setAttribute("aria-label", "Keys");
  for (const [title, keys] of Object.entries(KEYS)) {
    const here = keys.filter(([, , needed]) => document.querySelector(needed)), list = element("dl");
    for (const [key, what] of here) {
      const name = element("dt");
      name.append(element("kbd", key));
      list.append(name, element("dd", what));
    }
    if (here.length) dialog.append(element("h3", title), list);
  }
  dialog.append(close);
  document.body.append(dialog);
  by_id("theme").before(open);
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => { if (event.target === dialog) dialog.close(); });
  open.addEventListener("click", () => dialog.showModal());
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || is_writing(event)) return;
    if (event.key === "?" && !dialog.open) dialog.showModal();
    else if (event.key === "/" && by_id("search")) by_id("search").focus();
    else return;
    event.preventDefault();
  });
}
