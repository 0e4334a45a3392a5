// Theme: light, dark, or as the system has it, by the button `theme`.
"use strict";

const THEMES = ["system", "light", "dark"];

function set_theme(name) {
  if (name === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = name;
  by_id("theme").textContent = `Theme: ${name}`;
}

/// `recolour` draws again what has its colours from a canvas.
function listen_theme(recolour) {
  let theme = 0;
  by_id("theme").addEventListener("click", () => {
    theme = (theme + 1) % THEMES.length;
    set_theme(THEMES[theme]);
    recolour();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
}
