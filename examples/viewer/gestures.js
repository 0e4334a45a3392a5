// Gestures: mouse, fingers and keys on the 3D view. One finger scrolls the page until a tap says that it means the map.
"use strict";

const TURN = 0.006, KEY_TURN = 0.08, KEY_MOVE = 0.06, TAP_PX = 5, HINT_MS = 1800;

function listen_gestures(view) {
  const box = view.box, fingers = new Map(), hint = element("p", null, { className: "touch-hint", hidden: true });
  let travelled = 0, timer = 0;
  box.append(hint);
  const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  const is_active = () => box.classList.contains("active");
  const say = (text) => {
    hint.textContent = text;
    hint.hidden = false;
    clearTimeout(timer);
    timer = setTimeout(() => { hint.hidden = true; }, HINT_MS);
  };
  const activate = (on) => {
    if (on === is_active()) return;
    box.classList.toggle("active", on);
    say(on ? "One finger turns the map. A tap beside it lets the page scroll again." : "One finger scrolls the page");
  };
  // The browser would take two fingers for the page's.
  const keep_two = (event) => { if (event.touches.length > 1 && event.cancelable) event.preventDefault(); };
  for (const kind of ["touchstart", "touchmove"]) box.addEventListener(kind, keep_two, { passive: false });
  document.addEventListener("pointerdown", (event) => { if (!box.contains(event.target)) activate(false); });
  box.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    box.setPointerCapture(event.pointerId);
    travelled = fingers.size > 1 ? Infinity : 0;
  });
  box.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.x, dy = event.clientY - before.y, wide = fingers.size === 2 ? spread() : 0;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    travelled += Math.hypot(dx, dy);
    if (fingers.size === 2) {
      view.pan(dx / 2, dy / 2);
      view.zoom(wide / Math.max(1, spread()));
    } else if (event.pointerType === "touch" && !is_active()) {
      return;
    } else if (event.shiftKey || event.buttons & 6) {
      view.pan(dx, dy);
    } else {
      view.turn(dx * TURN, dy * TURN);
    }
    view.request();
  });
  const lift = (event) => {
    const was_here = fingers.delete(event.pointerId);
    const by_finger = event.pointerType === "touch", { left, top } = box.getBoundingClientRect();
    if (event.type === "pointercancel" && by_finger) say("Tap the map to turn it, or use two fingers");
    if (!was_here || event.type !== "pointerup" || travelled > TAP_PX) return;
    if (by_finger) activate(true);
    const text = view.text_at(event.clientX - left, event.clientY - top);
    if (text) view.on_choose(text);
  };
  box.addEventListener("pointerup", lift);
  box.addEventListener("pointercancel", lift);
  box.addEventListener("contextmenu", (event) => event.preventDefault());
  box.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.zoom(Math.exp(event.deltaY * (event.deltaMode ? 0.03 : 0.001)));
    view.request();
  }, { passive: false });
  box.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (step && event.shiftKey) view.pan(...step.map((s) => -s * KEY_MOVE * box.clientHeight));
    else if (step) view.turn(step[0] * KEY_TURN, step[1] * KEY_TURN);
    else if (event.key === "+" || event.key === "=") view.zoom(0.85);
    else if (event.key === "-") view.zoom(1 / 0.85);
    else if (event.key === "r" || event.key === "R") { view.moved = false; view.reset(); }
    else return;
    event.preventDefault();
    event.stopPropagation();
    view.request();
  });
}
