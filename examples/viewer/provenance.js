// The numbers at the top, and where it all comes from: version, CPU, command, parameters.
"use strict";

function show_tiles(data) {
  const brief = (v) => String(Number(v.toPrecision(2)));
  const s = data.summary, tiles = [];
  const tile = (name, value) => { if (value !== "") tiles.push([name, value]); };
  if (data.sessions) tile("Sessions", String(data.sessions.length));
  else tile("Frames tracked", `${s.tracked} of ${s.frames}`);
  tile("Key frames", String(s.keyframes));
  tile("Points", String(s.points));
  if (s.reprojection_px) tile("Reprojection error", `${brief(s.reprojection_px)} px`);
  tile("Texts", String(s.texts));
  if (s.loops) tile("Loops closed", String(s.loops));
  if (s.ate_rmse !== undefined) {
    tile("ATE, rmse", `${brief(1000 * s.ate_rmse)} mm`);
    if (s.path_length > 0) tile("ATE, share of path", `${brief(100 * s.ate_rmse / s.path_length)} %`);
  }
  if (s.signs_visible !== undefined) tile("Signs mapped", `${s.signs_mapped} of ${s.signs_visible}`);
  if (s.signs_mapped) tile("Angle error, median", `${brief(s.angle_median_deg)}\u00b0`);
  for (const [name, value] of tiles) {
    const box = element("div");
    box.append(element("dt", name), element("dd", value));
    by_id("tiles").append(box);
  }
}

function show_notice(data) {
  const s = data.summary, fov = data.camera.approximate_fov_deg, words = [];
  if (!data.series.time.length) words.push("No frame was processed.");
  else if (s.tracked === 0) words.push("No frame could be tracked, so there is no map: the images show too little, or move too little.");
  if (s.map_frames && s.map_frames.length > 1)
    words.push(`The sequence was mapped in ${s.map_frames.length} parts, of ${s.map_frames.join(", ")} frames, which were never joined. This is the first of them.`);
  if (fov !== undefined) {
    words.push(`The camera is approximate, a pinhole of ${fov}\u00b0 without lens distortion:`);
    words.push("take angles and shapes with care.");
  }
  if (s.calibration) words.push(s.calibration);
  by_id("notice").textContent = words.join(" ");
  by_id("notice").hidden = !words.length;
}

/// The sessions of a map file; their colours are those of the 3D view.
function show_sessions(data) {
  const rows = data.sessions || [], table = by_id("sessions"), head = element("tr");
  table.closest("section").hidden = rows.length === 0;
  const columns = [
    ["Session", (s) => String(s.id)], ["Started, UTC", (s) => s.started], ["Sequence", (s) => s.sequence],
    ["Frames tracked", (s) => `${s.tracked} of ${s.frames}`], ["Key frames", (s) => String(s.keyframes)],
    ["Texts", (s) => String(s.texts)], ["Mode", (s) => s.mode], ["textslam", (s) => s.version]];
  head.append(...columns.map(([name]) => element("th", name, { scope: "col" })));
  table.append(head);
  rows.forEach((session, i) => {
    const row = element("tr", null, { title: session.command });
    row.append(...columns.map(([, show]) => element("td", show(session))));
    row.firstChild.prepend(Object.assign(element("i"), { style: `background: var(${session_colour(i)})` }));
    table.append(row);
  });
}

/// The word as a shell takes it.
const quoted = (word) => (/^[\w./:=,+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

function show_provenance(data, run) {
  const kind = data.sessions ? "Map file" : "Sequence";
  const facts = [["Program", `textslam ${data.version}`], ["SIMD target", run.target], [kind, run.sequence]];
  if (Number.isFinite(data.start)) {
    const end = data.start + data.series.time[data.series.time.length - 1];
    facts.push(["Frames", `${run.first} to ${run.last}${run.every > 1 ? `, one of ${run.every}` : ""}`]);
    // Time stamps that count from 1970 are dates.
    const date = data.start > 1e8 ? `, ${new Date(1000 * data.start).toISOString().replace(/\.\d+Z/, " UTC").replace("T", " ")}` : "";
    facts.push(["Time stamps", `${data.start} to ${Number(end.toFixed(6))} s${date}`]);
  }
  const detection = run.detect_ms > 0 ? `, and ${digits(run.detect_ms, 1)} ms of detection` : "";
  if (run.timing) facts.push(["Time a frame, median", `${digits(run.frame_ms, 1)} ms${detection}`]);
  const c = data.camera;
  const fov = c.approximate_fov_deg;
  const guess = fov === undefined ? "" : `: approximate, a pinhole of ${fov}\u00b0 (--fov), not calibrated`;
  const { readout_s, readout_estimated } = data.summary;
  if (readout_s) {
    const how = readout_estimated ? "estimated from the images" : "as given";
    facts.push(["Rolling shutter", `from the first row to the last ${digits(1000 * readout_s, 1)} ms, ${how}`]);
  }
  facts.push(["Camera", `${c.width} x ${c.height} px, fx ${c.fx}, fy ${c.fy}, cx ${c.cx}, cy ${c.cy}${guess}`]);
  const { factor, name, why } = unit_of(data);
  facts.push(["Unit of the map", name === "m" ? `${factor} m, ${why}` : `not known: ${why}`]);
  for (const [fact, value] of facts) by_id("provenance").append(element("dt", fact), element("dd", value));
  by_id("command").textContent = run.command.map(quoted).join(" ");

  by_id("parameters").parentElement.hidden = !data.parameters;
  by_id("stages").closest("details").hidden = !run.timing;
  const sections = new Map();
  for (const [section, name, value, comment] of data.parameters || []) {
    if (!sections.has(section)) {
      sections.set(section, element("section"));
      sections.get(section).append(element("h4", section || "Run"));
    }
    const row = element("div", null, { title: comment });
    row.append(element("span", name), element("span", String(value)));
    sections.get(section).append(row);
  }
  by_id("parameters").append(...sections.values());

  const table = by_id("stages"), head = element("tr");
  head.append(...["Stage", "Median, ms", "95th percentile, ms"].map((name) => element("th", name)));
  table.append(head);
  for (const stage of run.timing || []) {
    const row = element("tr");
    row.append(element("td", stage.name), element("td", digits(stage.median, 2)), element("td", digits(stage.p95, 2)));
    table.append(row);
  }
}
