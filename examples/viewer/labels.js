// Labels: the words of the texts over the 3D view, and which text lies at a place of it.
"use strict";

const MOST_LABELS = 80;

/// The word of a text, or its number where nobody could read it.
const text_name = (text) => (text.word === "###" ? `unread (${text.id})` : text.word);

/// Where the text's upper end is in view: the highest of its corners, above its centre.
function top_of(text, clip) {
  const at = to_clip(clip, text.centre), corners = text.corners.map((c) => to_clip(clip, c));
  return [at[0], corners.every((c) => c[2] > 0) ? Math.max(...corners.map((c) => c[1])) : at[1], at[2]];
}

/// The nearest texts get their labels, above them; one that would lie on another's is left out.
function show_labels(texts, clip, wide, high, chosen) {
  const spans = [], taken = [], seen = texts.map((text) => ({ text, at: top_of(text, clip) }));
  const order = ({ text, at }) => (text.id === chosen ? 0 : at[2]);
  for (const { text, at } of seen.sort((a, b) => order(a) - order(b))) {
    const here = text.id === chosen;
    if (at[2] <= 0 || Math.abs(at[0]) > 1 || Math.abs(at[1]) > 1.2 || spans.length >= MOST_LABELS) continue;
    if (text.word === "###" && !here) continue;
    const name = text_name(text), x = (at[0] + 1) / 2 * wide, y = Math.max(10, (1 - at[1]) / 2 * high - 11);
    const half = Math.min(80, 3.6 * name.length + 6), box = [x - half, y - 9, x + half, y + 9];
    if (taken.some((t) => box[0] < t[2] && t[0] < box[2] && box[1] < t[3] && t[1] < box[3])) continue;
    taken.push(box);
    const span = element("span", name, { className: here ? "chosen" : "" });
    span.style.transform = `translate(calc(${x}px - 50%), calc(${y}px - 50%))`;
    spans.push(span);
  }
  by_id("labels").replaceChildren(...spans);
}

/// The nearest text whose quad covers a place of the view, -1 to 1 from left to right and from below to above.
function text_at(texts, clip, px, py) {
  let best = null, nearest = Infinity;
  for (const text of texts) {
    const c = text.corners.map((p) => to_clip(clip, p));
    if (c.some((p) => p[2] <= 0)) continue;
    const side = c.map((p, i) => {
      const q = c[(i + 1) % 4];
      return (q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0]);
    });
    const inside = side.every((s) => s >= 0) || side.every((s) => s <= 0);
    if (inside && c[0][2] < nearest) [best, nearest] = [text, c[0][2]];
  }
  return best;
}
