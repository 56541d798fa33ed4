// A mode's frequency as a slider over the spectrum: dragged by pointer, moved by arrow keys, read by a screen reader.
import { chartNamed, drawnOnce, onDrawn } from "./charts.js";
import { moved } from "./fields.js";
import { send } from "./studio.js";

let handles = [];
let held = null;

export function placeHandles(modes) {
  const layer = document.getElementById("handles");
  while (layer.children.length > modes.length) layer.lastChild.remove();
  modes.forEach((mode, index) => {
    const handle = layer.children[index] ?? layer.appendChild(made(index));
    if (held?.index === index) return;
    handle.dataset.frequency = mode;
  });
  handles = [...layer.children];
  settle();
}

function made(index) {
  const handle = document.createElement("button");
  handle.type = "button";
  handle.className = "handle";
  handle.setAttribute("role", "slider");
  handle.setAttribute("aria-label", `Frequency of mode ${index + 1}`);
  handle.setAttribute("aria-orientation", "horizontal");
  handle.hidden = true;
  handle.innerHTML = `<i aria-hidden="true">${index + 1}</i>`;
  handle.addEventListener("keydown", (event) => onKey(event, index));
  handle.addEventListener("pointerdown", (event) => onHold(event, index));
  return handle;
}

// The axis stays while a handle is held: it would run away from the pointer otherwise.
function settle() {
  const chart = chartNamed("spectrum");
  if (!chart || !drawnOnce("spectrum")) return;
  const axis = chart.getModel().getComponent("xAxis", 0).axis.scale.getExtent();
  for (const handle of handles) {
    const frequency = Number(handle.dataset.frequency);
    const x = chart.convertToPixel({ xAxisIndex: 0 }, frequency);
    handle.hidden = !(frequency >= axis[0] && frequency <= axis[1] * 1.0001);
    handle.style.left = `${x}px`;
    handle.setAttribute("aria-valuemin", Number(axis[0].toPrecision(4)));
    handle.setAttribute("aria-valuemax", Number(axis[1].toPrecision(4)));
    handle.setAttribute("aria-valuenow", frequency);
    handle.setAttribute("aria-valuetext", `${Number(frequency.toPrecision(5))} hertz`);
  }
}
onDrawn("spectrum", settle);

function onKey(event, index) {
  const steps = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
  const step = steps[event.key];
  if (step === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  const handle = handles[index];
  const next = moved(Number(handle.dataset.frequency), step * (event.shiftKey ? 10 : 1), "number");
  if (next !== null) move(handle, index, Number(next));
}

function onHold(event, index) {
  if (event.button !== 0) return;
  const handle = handles[index];
  event.preventDefault();
  handle.focus();
  handle.setPointerCapture(event.pointerId);
  handle.classList.add("held");
  held = { index, moved: false };
  let wanted = null;
  const onMove = (moving) => {
    if (wanted === null) requestAnimationFrame(follow);
    wanted = moving.clientX;
  };
  const follow = () => {
    if (wanted === null) return;
    const chart = chartNamed("spectrum");
    const left = chart.getDom().getBoundingClientRect().left;
    const frequency = chart.convertFromPixel({ xAxisIndex: 0 }, wanted - left);
    wanted = null;
    const axis = chart.getModel().getComponent("xAxis", 0).axis.scale.getExtent();
    const within = Math.min(Math.max(frequency, axis[0] + (axis[1] - axis[0]) / 200), axis[1]);
    held.moved = true;
    move(handle, index, Number(within.toPrecision(4)));
  };
  const release = () => {
    follow();
    handle.removeEventListener("pointermove", onMove);
    handle.classList.remove("held");
    const changed = held.moved;
    held = null;
    if (changed) send("dropped", String(index));
  };
  handle.addEventListener("pointermove", onMove);
  handle.addEventListener("lostpointercapture", release, { once: true });
}

function move(handle, index, frequency) {
  handle.dataset.frequency = frequency;
  settle();
  send("edit", `mode.${index}.frequency`, String(frequency), held ? "held" : "moved");
}
