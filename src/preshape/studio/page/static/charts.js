// The charts: NiceGUI's ECharts, fed with what changed only. Colours and dashes are told here, once for all of them.
import { showTable } from "./tables.js";

const known = new Map();
const listeners = new Map();

const DASHES = { A: "solid", B: [7, 3], C: [2, 3], D: [9, 3, 2, 3] };
const SYMBOLS = { A: "circle", B: "rect", C: "triangle", D: "diamond" };
const SIZES = { A: 12, B: 10, C: 8, D: 6 };
const WIDTHS = { unshaped: 1.2, measured: 2, fitted: 1.4, command: 1, limit: 1 };

export const chartNamed = (name) => known.get(name)?.chart;

export const drawnOnce = (name) => known.get(name)?.draws > 0;

export function onDrawn(name, callback) {
  listeners.set(name, callback);
}

// Numbers come as 32-bit floats, x and y apart; a gap in a line is a NaN.
function numbers(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

function points([xs, ys]) {
  const x = numbers(xs);
  const y = numbers(ys);
  const pairs = new Array(x.length);
  for (let i = 0; i < x.length; i++) pairs[i] = [x[i], Number.isNaN(y[i]) ? "-" : y[i]];
  return pairs;
}

export function startCharts(wanted, then) {
  const found = Object.entries(wanted).map(([name, id]) => [name, getElement(id)]);
  if (!found.every(([, element]) => element?.chart)) return requestAnimationFrame(() => startCharts(wanted, then));
  const watcher = new IntersectionObserver(onSeen, { rootMargin: "150px" });
  for (const [name, element] of found) {
    const box = document.getElementById("chart-" + name);
    const one = { name, chart: element.chart, box, data: new Map(), waiting: null, seen: near(box), draws: 0 };
    // In its own space the chart is a picture; what it shows is in the label, and in the table below it.
    const drawing = box.querySelector(".drawing > .nicegui-echart");
    drawing.setAttribute("role", "img");
    one.drawing = drawing;
    known.set(name, one);
    one.chart.on("rendered", () => {
      listeners.get(name)?.();
      box.dataset.rendered = one.draws;
    });
    box.querySelector("details")?.addEventListener("toggle", () => showTable(one));
    watcher.observe(box);
  }
  window.addEventListener("beforeprint", () => known.forEach(flush));
  recolour();
  then();
}

function near(box) {
  const place = box.getBoundingClientRect();
  return place.top < window.innerHeight + 150 && place.bottom > -150;
}

function onSeen(entries) {
  for (const entry of entries) {
    const one = known.get(entry.target.id.replace("chart-", ""));
    one.seen = entry.isIntersecting;
    if (one.seen) flush(one);
  }
}

export function drawCharts(charts) {
  for (const [name, message] of Object.entries(charts)) {
    const one = known.get(name);
    if (!one) continue;
    tell(one, message);
    const series = Object.entries(message.series ?? {}).map(([id, packed]) => {
      const named = message.names?.[id];
      const data = (packed ? points(packed) : []).map((value, index) => (named ? { value, name: named[index] } : value));
      one.data.set(id, data);
      // Many impulses are a comb, not a crowd of marks.
      return name === "impulses" && id in SIZES ? { id, data, symbolSize: data.length > 30 ? 3 : SIZES[id] } : { id, data };
    });
    if (!series.length && !message.option) continue;
    one.waiting = merged(one.waiting, series, message.option);
    if (one.seen) flush(one);
  }
}

// A chart that nobody sees is drawn when it comes into view.
function flush(one) {
  if (!one.waiting) return;
  const { series, option } = one.waiting;
  one.waiting = null;
  one.chart.setOption({ ...option, series: [...series.values()] });
  one.draws += 1;
  one.box.dataset.draws = one.draws;
  listeners.get(one.name)?.();
  showTable(one);
}

function merged(waiting, series, option) {
  const all = waiting ?? { series: new Map(), option: {} };
  for (const one of series) all.series.set(one.id, one);
  return { series: all.series, option: { ...all.option, ...option } };
}

function tell(one, message) {
  if (message.label !== undefined) one.drawing.setAttribute("aria-label", message.label);
  if (message.detail !== undefined) one.box.querySelector("h2 small").textContent = message.detail;
  if (message.note !== undefined) one.box.querySelector(".note").textContent = message.note;
  if (message.trouble !== undefined) one.box.querySelector(".trouble").textContent = message.trouble;
}

export function recolour() {
  const colours = getComputedStyle(document.documentElement);
  const colour = (name) => colours.getPropertyValue("--" + name).trim();
  for (const { chart, name } of known.values()) {
    const option = chart.getOption();
    const axis = {
      axisLine: { lineStyle: { color: colour("control") } },
      axisTick: { lineStyle: { color: colour("control") } },
      axisLabel: { color: colour("soft") },
      nameTextStyle: { color: colour("soft") },
      splitLine: { lineStyle: { color: colour("grid") } },
    };
    chart.setOption({
      xAxis: option.xAxis.map(() => axis),
      yAxis: option.yAxis.map(() => axis),
      tooltip: {
        backgroundColor: colour("paper"),
        borderColor: colour("line"),
        textStyle: { color: colour("ink") },
      },
      series: option.series.map((one) => ({ id: one.id, ...looks(one, colour) })),
    });
    listeners.get(name)?.();
  }
}

function looks(one, colour) {
  const [who, part] = one.id.split(".");
  const paint = colour({ A: "a", B: "b", C: "c", D: "d", command: "soft", poles: "ink", limit: "soft", fitted: "a", model: "measured", optimum: "ink", families: "unshaped" }[who] ?? who);
  if (who === "families") return { itemStyle: { color: paint }, label: { color: colour("soft") } };
  if (part === "area") return { areaStyle: { color: paint, opacity: 0.13 }, lineStyle: { width: 0 }, itemStyle: { color: paint } };
  return {
    itemStyle: { color: one.type === "scatter" && part === "hollow" ? "transparent" : paint, borderColor: paint, borderWidth: 1.6 },
    ...(one.type === "line"
      ? {
          lineStyle: {
            color: paint,
            width: WIDTHS[who] ?? 1.8,
            type: part === "stems" ? "solid" : who === "command" || who === "limit" || who === "fitted" ? [4, 3] : (DASHES[who] ?? "solid"),
          },
        }
      : { symbol: one.symbol && one.symbol !== "circle" ? one.symbol : (SYMBOLS[who] ?? one.symbol) }),
  };
}
