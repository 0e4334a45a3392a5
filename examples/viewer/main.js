// Puts the parts together: one chosen frame, one chosen text.
"use strict";

const read = (id) => { const text = by_id(id).textContent; return text.startsWith("@") ? null : JSON.parse(text); };

/// Scrolls the page to what a row, a hit or a bar changes, unless most of it can be seen.
function bring_into_sight(box) {
  const { top, bottom, height } = box.getBoundingClientRect();
  if (Math.min(bottom, window.innerHeight) - Math.max(top, 0) > 0.8 * height) return;
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  box.scrollIntoView({ block: "center", behavior: still ? "auto" : "smooth" });
}

function start(data, run) {
  by_id("part").textContent = data.sessions ? "Key frames" : "Run";
  const name = run.sequence.replace(/\/+$/, "").split("/").slice(-2).join("/");
  by_id("sequence-name").textContent = name;
  document.title = `textslam: ${name}`;
  let plots = [], view = null, table = null;
  const choose = (text) => { view.choose(text); table.choose(text); };
  const choose_afar = (text) => { choose(text); bring_into_sight(view.box); };
  view = new View(data, choose);
  table = new TextTable(data, choose_afar);
  const search = new Search(data, choose_afar, (found) => table.show(found));
  const playback = new Playback(data, (frame) => {
    view.set_frame(frame);
    for (const plot of plots) plot.set_frame(frame);
  });
  show_tiles(data);
  show_notice(data);
  show_sessions(data);
  show_provenance(data, run);
  plots = make_plots(data, run, (frame) => playback.select_frame(frame), choose_afar);
  if (data.frames.length) playback.select(data.frames.length - 1);  // where the map is whole
  const recolour = () => { view.request(); playback.draw(); };
  listen_theme(recolour);
  listen_keys();
  view.request();
  window.report = { data, run, view, playback, table, search, plots };
}

if (read("data")) start(read("data"), read("run"));
else by_id("sequence-name").textContent = "(a template: no run is in it)";
