// Search: texts by a word as `textslam-map query` finds them, also with letters misread. The hits under the field lead
// to the text; the table shows the same ones.
"use strict";

const NO_MATCH = 6, MOST_HITS = 8, UNREAD = "###";

function edit_distance(a, b) {
  const row = [...Array(b.length + 1).keys()];
  for (let i = 0; i < a.length; ++i) {
    let diagonal = row[0];
    row[0] = i + 1;
    for (let j = 0; j < b.length; ++j) {
      const changed = diagonal + (a[i] === b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = Math.min(changed, row[j] + 1, row[j + 1] + 1);
    }
  }
  return row[b.length];
}

/// 1 for the same word, less by twice the share of letters to change, add or leave out, at least 0.
function word_similarity(a, b) {
  const longer = Math.max(a.length, b.length);
  return longer ? Math.max(0, 1 - 2 * edit_distance(a, b) / longer) : 1;
}

/// 0 is best: the word itself, its beginning, that of a later word in it, a part, a part of another reading, a similar
/// reading.
function match_rank(text, asked, same_word) {
  const word = text.word.toLowerCase(), readings = (text.readings || [text.word]).map((r) => r.toLowerCase());
  if (word === asked) return 0;
  if (word === UNREAD) return text_name(text).includes(asked) ? 3 : NO_MATCH;
  if (word.startsWith(asked)) return 1;
  if (word.includes(` ${asked}`)) return 2;
  if (word.includes(asked)) return 3;
  if (readings.some((reading) => reading.includes(asked))) return 4;
  return readings.some((reading) => word_similarity(reading, asked) >= same_word) ? 5 : NO_MATCH;
}

class Search {
  /// `on_search`: called with the hits, the best first, or null where nothing is asked for.
  constructor(data, on_choose, on_search) {
    Object.assign(this, { data, on_choose, on_search, hits: [], at: 0 });
    this.field = by_id("search");
    this.list = by_id("hits");
    this.field.addEventListener("input", () => this.search());
    this.field.addEventListener("focus", () => this.show());
    this.field.addEventListener("blur", () => this.open(false));
    // A press on a hit must not take the focus, which would hide the hits before the click.
    this.list.addEventListener("mousedown", (event) => event.preventDefault());
    this.field.addEventListener("keydown", (event) => {
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key], count = Math.min(MOST_HITS, this.hits.length);
      if (step && count) { this.at = (this.at + step + count) % count; this.show(); }
      else if (event.key === "Enter" && count) this.choose(this.hits[this.at]);
      else if (event.key === "Escape") { this.field.value = ""; this.search(); }
      else return;
      event.preventDefault();
    });
  }

  search() {
    const asked = this.field.value.trim().toLowerCase(), { texts, same_word = 0.5 } = this.data;
    const ranked = texts.map((text) => ({ text, rank: match_rank(text, asked, same_word) }));
    const found = ranked.filter(({ rank }) => asked && rank < NO_MATCH).sort((a, b) => a.rank - b.rank);
    this.hits = found.map(({ text }) => text);
    this.at = 0;
    this.on_search(asked ? this.hits : null);
    this.show();
  }

  show() {
    const rows = this.hits.slice(0, MOST_HITS).map((text, i) => {
      const row = element("li", null, { id: `hit-${i}`, role: "option" });
      if (text.image) row.append(element("img", null, { src: text.image, alt: "" }));
      row.append(element("span", text_name(text)));
      row.setAttribute("aria-selected", String(i === this.at));
      row.addEventListener("click", () => this.choose(text));
      return row;
    });
    const more = this.hits.length - rows.length;
    if (more > 0) rows.push(element("li", `and ${more} more in the table`, { className: "quiet" }));
    else if (!rows.length) rows.push(element("li", "No text reads so", { className: "quiet" }));
    this.list.replaceChildren(...rows);
    this.open(this.field.value.trim() !== "" && document.activeElement === this.field);
  }

  open(on) {
    this.list.hidden = !on;
    this.field.setAttribute("aria-expanded", String(on));
    if (on && this.hits.length) this.field.setAttribute("aria-activedescendant", `hit-${this.at}`);
    else this.field.removeAttribute("aria-activedescendant");
  }

  choose(text) {
    this.open(false);
    this.on_choose(text);
  }
}
