// The page's own half: it takes one message a change, and sends one event an edit. The server holds the state.
import { drawCharts, startCharts } from "./charts.js";
import { placeHandles } from "./handles.js";
import { showErrors, showFields, startFields } from "./fields.js";
import { startDrops } from "./drop.js";
import { startLooks } from "./looks.js";

const studio = window.preshapeStudio;

export const send = (name, ...values) => emitEvent("studio_" + name, values);

let silence;
export function say(sentence) {
  const place = document.getElementById("saying");
  place.textContent = sentence;
  place.classList.add("shown");
  clearTimeout(silence);
  silence = setTimeout(() => place.classList.remove("shown"), 2500);
}

function receive(message) {
  for (const [name, html] of Object.entries(message.html ?? {})) replace(name, html);
  if (message.fields) showFields(message.fields, message.forced);
  if (message.errors) showErrors(message.errors);
  if (message.charts) drawCharts(message.charts);
  if (message.handles) placeHandles(message.handles);
  if (message.link !== undefined) keepLink(message.link, message.measurement);
  if (message.status !== undefined) document.getElementById("status").textContent = message.status;
  if (message.summary !== undefined) summarise(message.summary);
  if (message.can) for (const [id, can] of Object.entries(message.can)) enable(document.getElementById(id), can);
  if (message.say) say(message.say);
}

// Read out when the changes have come to rest, not at each of them.
let resting;
function summarise(sentence) {
  clearTimeout(resting);
  const place = document.getElementById("summary");
  resting = setTimeout(() => place.textContent !== sentence && (place.textContent = sentence), 900);
}

// A panel is written anew only when its shape changes; whoever had the focus keeps it.
function replace(name, html) {
  const panel = document.getElementById("panel-" + name);
  const focused = panel.contains(document.activeElement) ? document.activeElement : null;
  const opened = [...panel.querySelectorAll("details[open][id]")].map((one) => one.id);
  panel.innerHTML = html;
  for (const id of opened) document.getElementById(id)?.setAttribute("open", "");
  if (!focused) return;
  const same = focused.id && document.getElementById(focused.id);
  (same || panel.querySelector("input, select, button"))?.focus();
}

// A disabled button would lose the focus, and with it the place of whoever works by keyboard.
function enable(button, can) {
  button.setAttribute("aria-disabled", String(!can));
}

// The state lives in the address: a reload, a second tab and a lost server find it there.
function keepLink(text, measurement) {
  const address = new URL(window.location.href);
  address.searchParams.set("s", text);
  if (measurement) address.searchParams.set("m", measurement);
  else address.searchParams.delete("m");
  if (address.href !== window.location.href) history.replaceState(null, "", address);
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Without https and away from loopback there is no clipboard; the old way still works.
    const area = Object.assign(document.createElement("textarea"), { value: text });
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  say(what + " copied");
}

// The link leaves out what opens the door: the token is for whom the owner gives it to.
function copyLink() {
  const address = new URL(window.location.href);
  address.searchParams.delete("token");
  copy(address.href, "Link");
}

function onClick(event) {
  const button = event.target.closest("[data-do]");
  if (!button || button.getAttribute("aria-disabled") === "true") return;
  const [verb, ...rest] = button.dataset.do.split(" ");
  if (verb === "copy-link") copyLink();
  else if (verb === "copy-text") copy(document.getElementById(rest[0]).textContent, "Text");
  else send(verb, ...rest);
}

function onKey(event) {
  if (event.isComposing || !(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  const redo = key === "y" || (key === "z" && event.shiftKey);
  if (key !== "z" && !redo) return;
  event.preventDefault();
  send(redo ? "redo" : "undo");
}

// Tabs as the pattern has them: arrow keys move between them, Home and End to the ends.
function onTabKey(event) {
  const tab = event.target.closest('[role="tab"]');
  const step = { ArrowRight: 1, ArrowLeft: -1, Home: "first", End: "last" }[event.key];
  if (!tab || step === undefined) return;
  const tabs = [...tab.parentElement.querySelectorAll('[role="tab"]')];
  const at = tabs.indexOf(tab);
  const next = step === "first" ? 0 : step === "last" ? tabs.length - 1 : (at + step + tabs.length) % tabs.length;
  event.preventDefault();
  tabs[next].focus();
  tabs[next].click();
}

function start() {
  if (!document.getElementById("panel-modes") || typeof emitEvent === "undefined") return requestAnimationFrame(start);
  document.addEventListener("click", onClick);
  document.addEventListener("keydown", onKey);
  document.addEventListener("keydown", onTabKey);
  startFields(send);
  startDrops(send);
  startLooks();
  if (window.innerWidth <= 820) document.getElementById("trial-plant").removeAttribute("open");
  startCharts(JSON.parse(document.getElementById("first-charts").textContent), () => {
    studio.receive = receive;
    for (const message of studio.queue.splice(0)) receive(message);
    document.documentElement.dataset.ready = "true";
    performance.mark("studio-drawn");
  });
}
start();
