// A measurement: chosen, or dropped anywhere on the page. It goes up as it is, and what is wrong with it is said in the drop zone.
let send;
let inside = 0;

export function startDrops(sender) {
  send = sender;
  document.addEventListener("change", (event) => {
    if (event.target.id !== "measurement-file" || !event.target.files.length) return;
    carry(event.target.files);
    event.target.value = "";
  });
  for (const kind of ["dragenter", "dragover", "dragleave", "drop"]) document.addEventListener(kind, onDrag);
}

function onDrag(event) {
  if (!event.dataTransfer?.types.includes("Files")) return;
  event.preventDefault();
  if (event.type === "dragenter") inside += 1;
  if (event.type === "dragleave") inside -= 1;
  if (event.type === "drop") inside = 0;
  document.body.classList.toggle("dropping", inside > 0);
  if (event.type === "drop") carry(event.dataTransfer.files);
}

export function showDrop(note, trouble) {
  const place = document.getElementById("drop-note");
  place.dataset.before ??= place.textContent;
  place.textContent = note || place.dataset.before;
  document.getElementById("drop-trouble").textContent = trouble;
}

async function carry(files) {
  const zone = document.getElementById("drop");
  const most = Number(zone.dataset.most);
  if (files.length !== 1) return showDrop("", `${files.length} files were dropped: drop one, with one measurement.`);
  const file = files[0];
  if (file.size > most) {
    const sizes = [file.size, most].map((bytes) => (bytes / 1e6).toFixed(1));
    return showDrop("", `${file.name} has ${sizes[0]} MB, and at most ${sizes[1]} MB are read here: cut out a shorter stretch.`);
  }
  showDrop(`Reading ${file.name} …`, "");
  try {
    const address = new URL(zone.dataset.address, window.location.href);
    address.searchParams.set("name", file.name);
    const answer = await fetch(address, { method: "POST", body: file, headers: { "Content-Type": "application/octet-stream" } });
    const told = await answer.json();
    if (!answer.ok || told.trouble) return showDrop("", told.trouble ?? told.detail ?? `The server refused the file (${answer.status}).`);
    showDrop("", "");
    send("measured", told.key);
  } catch {
    showDrop("", "The file did not reach the server: is the studio still running? Drop it again when the connection is back.");
  }
}
