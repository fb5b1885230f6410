// The whole gear: its figures, who yields how much, and its curve.

import { differenceCell, dot, ticks } from "./charts.js";
import { el, grouped, svg, symbol } from "./dom.js";

const W = 400;
const H = 126;
const EDGE = { left: 40, right: 8, top: 8, bottom: 22 };

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
    gear.line ? curve(gear, pinned?.line) : null,
    ...gear.warnings.map((line) => el("p", { class: "fault" }, `${line}.`)),
    gear.assumed.length ? el("p", { class: "limit" }, `Assumed, as the design does not state it: ${gear.assumed.join(", ")}.`) : null,
  ].filter(Boolean);
}

function shares(parts) {
  const words = parts.map((part) => `${part.name} ${Math.round(100 * part.value)} %`).join(", ");
  const bar = svg("svg", { viewBox: "0 0 100 7", preserveAspectRatio: "none", class: "stack", role: "img", "aria-label": `Compliance: ${words}` });
  let from = 0;
  for (const part of parts) {
    bar.append(svg("rect", { x: from, y: 0.5, width: 100 * part.value, height: 6, fill: part.colour }));
    from += 100 * part.value;
  }
  const names = parts.map((part) => el("span", { class: "share" }, dot(part.colour), ` ${part.name} ${Math.round(100 * part.value)} % `));
  return el("div", { class: "budget" }, bar, el("p", { class: "limit" }, "Of the compliance at rated torque: ", ...names));
}

// θ(T) from 0 to rated torque; the other way round it is the same.
function curve({ line, marks }, pinned) {
  const { torque_Nm: torque, angle_arcsec: angle } = line;
  const reach = Math.max(torque.at(-1), pinned ? pinned.torque_Nm.at(-1) : 0);
  const top = Math.max(angle.at(-1), pinned ? pinned.angle_arcsec.at(-1) : 0) * 1.06;
  const x = (t) => EDGE.left + (t / reach) * (W - EDGE.left - EDGE.right);
  const y = (a) => EDGE.top + (1 - a / top) * (H - EDGE.top - EDGE.bottom);
  const points = (ts, as) => ts.map((t, i) => `${x(t).toFixed(1)},${y(as[i]).toFixed(1)}`).join(" ");
  const chart = svg("svg", { viewBox: `0 0 ${W} ${H}`, class: "line gearline", role: "img", "aria-label": "Angle of the whole gear over torque" });
  for (const a of ticks(top)) {
    chart.append(svg("path", { d: `M${EDGE.left} ${y(a)}H${W - EDGE.right}`, class: a ? "grid" : "axis" }),
      svg("text", { x: EDGE.left - 5, y: y(a) + 3.5, "text-anchor": "end" }, grouped(a, 0)));
  }
  chart.append(svg("path", { d: `M${EDGE.left} ${EDGE.top}V${H - EDGE.bottom}`, class: "axis" }),
    svg("text", { x: EDGE.left + 5, y: EDGE.top + 8 }, "arcsec"));
  for (const [name, t] of marks) {
    const words = `${name.replace("_", "")} ${t.toPrecision(3)}${name === "T_N" ? " N·m" : ""}`;
    chart.append(svg("path", { d: `M${x(t)} ${EDGE.top}V${H - EDGE.bottom}`, class: "load" }),
      svg("text", { x: Math.min(x(t), W - EDGE.right), y: H - 7, "text-anchor": name === "T_N" ? "end" : "middle" }, words));
  }
  if (pinned) chart.append(svg("polyline", { points: points(pinned.torque_Nm, pinned.angle_arcsec), class: "curve pinned" }));
  chart.append(svg("polyline", { points: points(torque, angle), class: "curve" }));
  return chart;
}
