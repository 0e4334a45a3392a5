// The maps that a run can begin in: files that were chosen or dropped, and those that runs of this page made.
"use strict";

const MAP_FILE = /\.(db|sqlite3?)$/i;

class Maps {
  constructor() {
    this.known = [];
    this.chosen = null;
    this.select = by_id("map");
    this.file = by_id("map-file");
    this.select.addEventListener("change", () => this.choose());
    this.file.addEventListener("change", () => {
      if (this.file.files.length) this.open(this.file.files[0]);
      this.file.value = "";
    });
    this.show();
  }

  /// A map's name and bytes, as a Blob, for those who want it.
  add(name, blob) {
    this.known.push({ name, blob });
    this.show();
  }

  /// A file that the user gave is what the next run begins in.
  open(file) {
    this.chosen = { name: file.name, blob: file };
    this.known.push(this.chosen);
    this.show();
  }

  show() {
    const option = (value, text) => element("option", text, { value });
    this.select.replaceChildren(option("none", "none: begin a new one"), ...this.known.map(({ name }, i) => option(String(i), name)),
      option("file", "from a file…"));
    this.select.value = this.chosen ? String(this.known.indexOf(this.chosen)) : "none";
    by_id("localise").disabled = !this.chosen;
    if (!this.chosen) by_id("localise").checked = false;
  }

  choose() {
    const { value } = this.select;
    this.chosen = this.known[value] || null;
    this.show();
    if (value === "file") this.file.click();
  }

  /// { name, bytes } for the module; null where a run begins its own.
  async bytes() {
    if (!this.chosen) return null;
    return { name: this.chosen.name.replace(/[^\w.-]+/g, "_"), bytes: new Uint8Array(await this.chosen.blob.arrayBuffer()) };
  }
}
