// Puts the parts together: one chosen frame, one chosen text.
"use strict";

const read = (id) => { const text = by_id(id).textContent; return text.startsWith("@") ? null : JSON.parse(text); };

function start(data, run) {
  const name = run.sequence.replace(/\/+$/, "").split("/").slice(-2).join("/");
  by_id("sequence-name").textContent = name;
  document.title = `textslam: ${name}`;
  let plots = [], view = null, table = null;
  const choose = (text) => { view.choose(text); table.choose(text); };
  view = new View(data, choose);
  table = new TextTable(data, choose);
  const playback = new Playback(data, (frame) => {
    view.set_frame(frame);
    for (const plot of plots) plot.set_frame(frame);
  });
  show_tiles(data);
  show_notice(data);
  show_provenance(data, run);
  plots = make_plots(data, run, (frame) => playback.select_frame(frame), choose);
  if (data.frames.length) playback.select(0);
  const recolour = () => { view.request(); playback.draw(); };
  listen_theme(recolour);
  view.request();
  window.report = { data, run, view, playback, table };
}

if (read("data")) start(read("data"), read("run"));
else by_id("sequence-name").textContent = "(a template: no run is in it)";
