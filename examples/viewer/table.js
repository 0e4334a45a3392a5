// Table: the text map, or what the search found of it, sorted by any column. A row shows its text in the 3D view.
"use strict";

class TextTable {
  constructor(data, on_choose) {
    const vector = (v, count) => v.map((c) => c.toFixed(count)).join(", "), known = data.texts.some((t) => t.sign !== undefined);
    // name, value to sort by, text to show
    this.columns = [
      ["Word", (t) => text_name(t).toLowerCase(), text_name],
      ["Centre", (t) => length(t.centre), (t) => vector(t.centre, 3)],
      ["Normal", (t) => t.normal[2], (t) => vector(t.normal, 3)],
      ["Sigma of normal", (t) => t.sigma_deg, (t) => `${digits(t.sigma_deg, 2)}\u00b0`],
      ["Observations", (t) => t.observations, (t) => String(t.observations)],
      ["ZNCC", (t) => t.zncc, (t) => digits(t.zncc, 3)],
    ];
    if (data.sessions) this.columns.push(["Session", (t) => data.series.session[t.host], (t) => String(data.series.session[t.host])]);
    if (known) this.columns.push(["Angle error", (t) => (t.sign < 0 ? 1e9 : t.angle_deg), (t) => (t.sign < 0 ? "no such sign" : `${digits(t.angle_deg, 2)}\u00b0`)]);
    this.data = data;
    this.on_choose = on_choose;
    this.found = null;  // by the search, the best first
    this.sorted = 0;
    this.rising = true;
    this.chosen = -1;
    const head = element("tr");
    this.heads = this.columns.map(([name], i) => {
      const cell = element("th", null, { scope: "col" }), button = element("button", name, { type: "button" });
      button.addEventListener("click", () => {
        this.rising = this.sorted === i ? !this.rising : true;
        this.sorted = i;
        this.by_rank = false;
        this.draw();
      });
      cell.append(button);
      head.append(cell);
      return { cell, button, name };
    });
    document.querySelector("#texts thead").append(head);
    this.body = document.querySelector("#texts tbody");
    this.draw();
  }

  /// Shows these texts, in their order until a column is asked for; null: all.
  show(found) {
    this.found = found;
    this.by_rank = found !== null;
    this.draw();
  }

  choose(text) {
    this.chosen = text.id;
    this.draw();
  }

  draw() {
    const value = this.columns[this.sorted][1], sign = this.rising ? 1 : -1;
    const before = (a, b) => { const x = value(a), y = value(b); return sign * (x < y ? -1 : x > y ? 1 : a.id - b.id); };
    const texts = [...(this.found || this.data.texts)];
    if (!this.by_rank) texts.sort(before);
    const focused = document.activeElement && document.activeElement.dataset ? document.activeElement.dataset.text : undefined;
    const rows = texts.map((text) => {
      const row = element("tr", null, { tabIndex: 0, className: text.id === this.chosen ? "chosen" : "" });
      row.dataset.text = text.id;
      for (const [, , show] of this.columns) row.append(element("td", show(text)));
      const choose = () => this.on_choose(text);
      row.addEventListener("click", choose);
      row.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        choose();
      });
      return row;
    });
    this.body.replaceChildren(...rows);
    if (focused !== undefined) rows.filter((row) => row.dataset.text === focused).forEach((row) => row.focus({ preventScroll: true }));
    this.heads.forEach(({ cell, button, name }, i) => {
      const here = i === this.sorted && !this.by_rank;
      cell.setAttribute("aria-sort", here ? (this.rising ? "ascending" : "descending") : "none");
      button.textContent = here ? `${name} ${this.rising ? "\u2191" : "\u2193"}` : name;
    });
    const all = this.data.texts.length;
    const of_all = counted(all, "text");
    by_id("count").textContent = this.found ? `${texts.length} of ${of_all}, by the search` : of_all;
  }
}
