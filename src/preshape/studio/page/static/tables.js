// The same numbers as the chart, for eyes and readers that a picture does not serve; written only when it is opened.
const MOST_ROWS = 41;

export function showTable(one) {
  const details = one.box.querySelector("details");
  if (!details?.open) return;
  const place = details.querySelector(".scroll");
  const option = one.chart.getOption();
  const shown = option.series.filter((series) => one.data.get(series.id)?.length && !/\.(stems|area)$/.test(series.id));
  const axes = [option.xAxis[0].name || "x", option.yAxis[0].name || "y"];
  const table = document.createElement("table");
  table.className = "numbers";
  const head = table.createTHead().insertRow();
  for (const text of ["Curve", ...axes]) {
    const cell = document.createElement("th");
    cell.scope = "col";
    cell.textContent = text;
    head.append(cell);
  }
  const body = table.createTBody();
  for (const series of shown) {
    const all = one.data.get(series.id).map((point) => point.value ?? point).filter(([, y]) => y !== "-");
    const every = Math.max(1, Math.ceil(all.length / MOST_ROWS));
    all.forEach(([x, y], index) => {
      if (index % every && index !== all.length - 1) return;
      const row = body.insertRow();
      const name = document.createElement("th");
      name.scope = "row";
      name.textContent = series.name || series.id;
      row.append(name);
      for (const number of [x, y]) row.insertCell().textContent = String(Number(number.toPrecision(5)));
    });
  }
  place.replaceChildren(table);
}
