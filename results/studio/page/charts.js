// Two small charts from the same numbers and in the same colours as the report's.

import { el, grouped, signed, svg } from "./dom.js";

// The four terms end to end, the total with one standard deviation.
export function chartBudget(budget, style, pinned, solid) {
  const rows = Object.fromEntries(budget.rows.map((row) => [row.key.split(".")[1], row]));
  const total = rows.total.value;
  const most = (total + (rows.std?.value ?? 0)) * 1.02;
  const bar = svg("svg", { viewBox: "0 0 100 7", preserveAspectRatio: "none", class: "stack", role: "img",
    "aria-label": `Backlash ${rows.total.text} arcsec` });
  let from = 0;
  for (const row of budget.rows.slice(0, 4)) {
    const width = (100 * row.value) / most;
    bar.append(svg("rect", { x: from, y: 0.5, width: Math.max(width, 0), height: 6, fill: row.colour }));
    from += width;
  }
  const std = (100 * (rows.std?.value ?? 0)) / most;
  if (std) bar.append(svg("path", { d: `M${from - std} 3.5H${from + std}M${from - std} 1.5V5.5M${from + std} 1.5V5.5`,
    class: "deviation", stroke: style.accent }));
  const line = (row, swatch) => {
    const other = pinned?.rows.find((entry) => entry.key === row.key);
    const solved = solid?.rows.find((entry) => entry.key === row.key);
    const change = other ? row.value - other.value : null;
    return el("tr", { "data-key": row.key },
      el("td", { class: "sym" }, swatch ? dot(row.colour) : null), el("td", { class: "what" }, row.name.replace(", total", "")),
      withValue(row),
      el("td", { class: "share" }, swatch ? `${Math.round((100 * row.value) / total)} %` : budget.spread),
      solid ? el("td", { class: "value solid" }, solved?.text ?? "") : null,
      pinned ? el("td", { class: "delta" }, change === null ? "" : signed(change, row.decimals)) : null);
  };
  const doubt = budget.sources.map(([name, text]) => `${name} ${text}`).join(", ");
  return el("div", { class: "budget" }, bar,
    el("table", {}, el("tbody", {}, ...budget.rows.slice(0, 4).map((row) => line(row, true)), totalLine(line(rows.total, false)))),
    el("p", { class: "limit" }, rows.std ? `1σ from: ${doubt}` : "The design states no uncertainty"));
}

function totalLine(row) {
  row.classList.add("total");
  return row;
}

function withValue(row) {
  const cell = el("td", { class: "value" }, row.text);
  cell.dataset.value = row.value;
  return cell;
}

export function dot(colour) {
  return svg("svg", { viewBox: "0 0 10 10", class: "dot" }, svg("rect", { width: 10, height: 10, rx: 2, fill: colour }));
}

const W = 400;
const LOW = 126;
const HIGH = 218; // where the window has room
const EDGE = { left: 40, right: 8, top: 8, bottom: 22 };

// θ(T): two elastic branches, the gap between them, one standard deviation as a band.
export function chartLine(line, budget, style, pinned, tall) {
  const { torque_Nm: torque, angle_arcsec: angle, spread_arcsec: spread, load_Nm: load, load_text: words, gap_arcsec: gap } = line;
  const H = tall && innerWidth >= 1600 && innerHeight >= 960 ? HIGH : LOW;
  const reach = Math.max(torque.at(-1), pinned ? pinned.torque_Nm.at(-1) : 0);
  const top = Math.max(...angle.map((a, i) => a + spread[i]), ...(pinned ? pinned.angle_arcsec : [])) * 1.06;
  const x = (t) => EDGE.left + ((t / reach + 1) / 2) * (W - EDGE.left - EDGE.right);
  const y = (a) => EDGE.top + ((1 - a / top) / 2) * (H - EDGE.top - EDGE.bottom);
  const points = (ts, as, sign) => ts.map((t, i) => `${x(sign * t).toFixed(1)},${y(sign * as[i]).toFixed(1)}`).join(" ");
  const chart = svg("svg", { viewBox: `0 0 ${W} ${H}`, class: "line", role: "img",
    "aria-label": "Angle at the output over torque" });
  for (const a of ticks(top)) {
    for (const value of a ? [a, -a] : [0]) {
      chart.append(svg("path", { d: `M${EDGE.left} ${y(value)}H${W - EDGE.right}`, class: a ? "grid" : "axis" }),
        svg("text", { x: EDGE.left - 5, y: y(value) + 3.5, "text-anchor": "end" }, grouped(value, 0)));
    }
  }
  for (const [t, text] of [[-load, `\u2212${words}`], [0, "0"], [load, words]]) {
    chart.append(svg("path", { d: `M${x(t)} ${EDGE.top}V${H - EDGE.bottom}`, class: t ? "load" : "axis" }),
      svg("text", { x: x(t), y: H - 7, "text-anchor": "middle" }, text));
  }
  for (const sign of [-1, 1]) {
    const high = angle.map((a, i) => a + spread[i]);
    const low = angle.map((a, i) => a - spread[i]);
    const around = `${points(torque, high, sign)} ${points([...torque].reverse(), low.reverse(), sign)}`;
    chart.append(svg("polygon", { points: around, class: "band", fill: style.palette[1] }));
    if (pinned) chart.append(svg("polyline", { points: points(pinned.torque_Nm, pinned.angle_arcsec, sign), class: "curve pinned" }));
    chart.append(svg("polyline", { points: points(torque, angle, sign), class: "curve" }));
  }
  chart.append(svg("path", { d: `M${x(0)} ${y(-gap / 2)}V${y(gap / 2)}`, class: "curve gap" }),
    svg("text", { x: x(0) - 6, y: y(gap / 2) - 4, "text-anchor": "end" }, `gap ${grouped(gap, 1)}`));
  const total = budget.rows.find((row) => row.key.endsWith("total"));
  const std = budget.rows.find((row) => row.key.endsWith("std"));
  chart.append(svg("text", { x: W - EDGE.right - 4, y: H - EDGE.bottom - 7, "text-anchor": "end", class: "strong" },
    `backlash ${total.text}${std ? ` ± ${std.text}` : ""}`));
  return chart;
}

// How a figure stands to the pinned design's.
export function differenceCell(row, other) {
  if (other?.value === undefined || row.value === undefined) return el("td", {});
  const change = row.value - other.value;
  return el("td", { class: "delta" }, signed(change, row.decimals), el("br"),
    el("span", { class: "limit" }, `${signed((100 * change) / other.value, 1)} %`));
}

export function ticks(top) {
  const decade = 10 ** Math.floor(Math.log10(top));
  const step = [0.2, 0.5, 1, 2, 5].map((s) => s * decade).find((s) => top / s <= 3);
  return Array.from({ length: Math.floor(top / step) + 1 }, (_, i) => i * step);
}
