// Fields: each edit goes to the server as it is typed, and arrow keys move a number by a step.
let send;

export function startFields(sender) {
  send = sender;
  document.addEventListener("input", (event) => {
    const field = event.target.closest("[data-field]");
    if (field) send("edit", field.dataset.field, value(field));
  });
  document.addEventListener("keydown", onArrow);
}

function value(field) {
  return field.type === "checkbox" ? String(field.checked) : field.value;
}

// A step is one unit of the third digit, ten with Shift: 47.3 goes to 47.4, 0.0450 to 0.0451.
function onArrow(event) {
  const field = event.target.closest("input[data-step]");
  if (!field || (event.key !== "ArrowUp" && event.key !== "ArrowDown") || event.ctrlKey || event.altKey || event.metaKey) return;
  const was = Number(field.value.replace(",", "."));
  if (!Number.isFinite(was)) return;
  event.preventDefault();
  const direction = event.key === "ArrowUp" ? 1 : -1;
  const stepped = moved(was, direction * (event.shiftKey ? 10 : 1), field.dataset.step);
  if (stepped === null) return;
  field.value = stepped;
  send("edit", field.dataset.field, field.value);
}

export function moved(was, count, kind) {
  if (kind === "whole") return String(Math.round(was + count));
  if (kind === "ratio") return String(Number(Math.max(0, was + 0.001 * count).toFixed(6)));
  const digit = Math.floor(Math.log10(Math.abs(was) || 1));
  const places = Math.max(0, 2 - digit);
  const next = was + count * 10 ** (digit - 2);
  if (was > 0 && next <= 0) return null;
  return String(Number(next.toFixed(places + 1)));
}

// What the server changed (undo, a drag) is written into every field; of an edit, into all but the one being typed in.
export function showFields(fields, forced) {
  for (const [name, text] of Object.entries(fields)) {
    const field = document.querySelector(`[data-field="${CSS.escape(name)}"]`);
    if (!field || (field === document.activeElement && !forced)) continue;
    if (field.type === "checkbox") field.checked = text === "true";
    else if (field.value !== text) field.value = text;
  }
}

export function showErrors(errors) {
  for (const place of document.querySelectorAll("[data-error]")) {
    const sentence = errors[place.dataset.error] ?? "";
    if (place.textContent !== sentence) place.textContent = sentence;
    const field = document.querySelector(`[data-field="${CSS.escape(place.dataset.error)}"]`);
    field?.setAttribute("aria-invalid", String(Boolean(sentence)));
  }
}
