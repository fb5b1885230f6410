// The whole gear: its figures, shares of the compliance, and its curve.

import { differenceCell, dot, frame, stack } from "./charts.js";
import { el, svg, symbol } from "./dom.js";

export function gearPanel(gear, pinned) {
  const rows = gear.rows.map((row) => {
    const value = el("td", { class: "value" }, row.text);
    value.dataset.value = row.value;
    return el("tr", { "data-key": row.key },
      el("td", { class: "sym" }, symbol(row.symbol)), el("td", { class: "what", title: row.name }, row.short || row.name),
      value, el("td", { class: "side" }, row.unit),
      pinned ? differenceCell(row, pinned.rows.find((other) => other.key === row.key)) : null);
  });
  return [
    el("table", {}, el("tbody", {}, ...rows)),
    shares(gear.shares),
    gear.line ? whole(gear, pinned?.line) : null,
    ...gear.warnings.map((line) => el("p", { class: "fault" }, `${line}.`)),
    gear.assumed.length ? el("p", { class: "limit" }, `Assumed, because the design does not state it: ${gear.assumed.join(", ")}.`) : null,
  ].filter(Boolean);
}

function shares(parts) {
  const words = parts.map((part) => `${part.name} ${Math.round(100 * part.value)} %`).join(", ");
  const names = parts.map((part) => el("span", { class: "share" }, dot(part.colour), ` ${part.name} ${Math.round(100 * part.value)} % `));
  return el("div", { class: "budget" }, stack(parts, 1, `Compliance: ${words}`), el("p", { class: "limit" }, "Shares of the compliance at rated torque: ", ...names));
}

// θ(T) from 0 to rated torque; the other way round it is the same.
function whole({ line, marks }, pinned) {
  const lines = pinned ? [line, pinned] : [line];
  const { chart, x, mark, curve } = frame({
    reach: Math.max(...lines.map((one) => one.torque_Nm.at(-1))),
    top: 1.06 * Math.max(...lines.map((one) => one.angle_arcsec.at(-1))),
    label: "Angle of the whole gear over torque",
    kind: "line gearline",
  });
  mark(0);
  chart.append(svg("text", { x: x(0) + 5, y: 16 }, "arcsec"));
  for (const [name, t] of marks) {
    mark(t, `${name.replace("_", "")} ${Number(t.toPrecision(3))}${name === "T_N" ? " N·m" : ""}`, name === "T_N" ? "end" : "middle");
  }
  if (pinned) curve(pinned, 1, "curve pinned");
  curve(line);
  return chart;
}
