// Results: the numbers of a run, its report, and its files to save.
"use strict";

const MAIN_FILES = [["report.html", "Save the report"], ["map.db", "Save the map"], ["text_map.json", "Save the text map"],
  ["text_map.ply", "Save as PLY"], ["trajectory.txt", "Save the trajectory"]];
const KINDS = { html: "text/html", json: "application/json", txt: "text/plain", csv: "text/csv", ply: "application/octet-stream",
  db: "application/vnd.sqlite3" };

class Results {
  constructor() { this.urls = []; }

  clear() {
    by_id("tiles").hidden = by_id("results").hidden = by_id("report-part").hidden = true;
    by_id("report").removeAttribute("src");
    for (const url of this.urls) URL.revokeObjectURL(url);
    this.urls = [];
    this.files = new Map();
    this.message = null;
  }

  show(message, name) {
    const { metrics, warnings, frames, ms, files } = message;
    this.clear();
    for (const { name, bytes } of files) this.files.set(name, this.url_of(name, bytes));
    const ate = metrics.trajectory && metrics.trajectory.ate_rmse, signs = metrics.text;
    const tiles = [["Frames tracked", `${metrics.tracked} of ${metrics.frames}`], ["Frames a second", (1000 * frames / ms).toFixed(1)],
      ["Key frames", metrics.keyframes], ["Points", metrics.points], ["Texts", metrics.texts]];
    if (Number.isFinite(ate)) tiles.push(["ATE", `${(1000 * ate).toFixed(2)} mm`]);
    if (signs) tiles.push(["Signs mapped", `${signs.signs_mapped} of ${signs.signs_visible}`]);
    by_id("tiles").replaceChildren(...tiles.map(([what, value]) => {
      const box = element("div");
      box.append(element("dt", what), element("dd", String(value)));
      return box;
    }));
    by_id("tiles").hidden = by_id("results").hidden = false;
    const notice = by_id("notice");
    if (warnings.length && notice.hidden) Object.assign(notice, { textContent: warnings.join(". "), hidden: false });
    this.offer(name);
    this.message = message;
  }

  url_of(name, bytes) {
    const url = URL.createObjectURL(new Blob([bytes], { type: KINDS[name.split(".").pop()] }));
    this.urls.push(url);
    return url;
  }

  offer(name) {
    const bar = by_id("results"), button = (text, act) => {
      const out = element("button", text, { type: "button" });
      out.addEventListener("click", act);
      return out;
    };
    const has_report = this.files.has("report.html");
    const open = button("Show the report", () => this.show_report());
    open.id = "show-report";
    open.classList.add("main");
    const others = [...this.files.keys()].filter((file) => !MAIN_FILES.some(([main]) => main === file));
    const all = button("Save the other files", () => others.forEach((file) => this.save(file, name)));
    bar.replaceChildren(...(has_report ? [open] : []),
      ...MAIN_FILES.filter(([file]) => this.files.has(file)).map(([file, text]) => {
        const out = button(text, () => this.save(file, name));
        out.dataset.file = file;
        return out;
      }), all);
  }

  save(file, name) {
    element("a", null, { href: this.files.get(file), download: `${name}_${file}`.replace(/[^\w.-]+/g, "_") }).click();
  }

  show_report() {
    by_id("report-part").hidden = false;
    by_id("report").onload = () => { this.shown = true; };
    by_id("report").src = this.files.get("report.html");
    by_id("report-part").scrollIntoView({ behavior: "smooth" });
  }
}
