// Light, dark or as the system is; and light on paper. Kept in this browser only.
import { recolour } from "./charts.js";

const KEY = "preshape-studio-theme";
const system = window.matchMedia("(prefers-color-scheme: dark)");
const names = { auto: "Theme: automatic", light: "Theme: light", dark: "Theme: dark" };

function stored() {
  try {
    return localStorage.getItem(KEY) ?? "auto";
  } catch {
    return "auto";
  }
}

function show(paper) {
  const chosen = stored();
  const dark = !paper && (chosen === "dark" || (chosen === "auto" && system.matches));
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  const button = document.getElementById("theme");
  if (button) {
    button.textContent = { auto: "◐", light: "○", dark: "●" }[chosen];
    button.setAttribute("aria-label", names[chosen]);
    button.title = names[chosen];
  }
  recolour();
}

export function startLooks() {
  document.getElementById("theme").addEventListener("click", () => {
    const order = ["auto", "light", "dark"];
    try {
      localStorage.setItem(KEY, order[(order.indexOf(stored()) + 1) % 3]);
    } catch {
      return;
    }
    show(false);
  });
  system.addEventListener("change", () => show(false));
  window.addEventListener("beforeprint", () => show(true));
  window.addEventListener("afterprint", () => show(false));
  show(false);
}
