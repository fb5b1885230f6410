// Two small charts from the same numbers and in the same colours as the report's.

import { el, grouped, signed, svg } from "./dom.js";

// Parts end to end in a bar that is `most` long.
export function stack(parts, most, label) {
  const bar = svg("svg", { viewBox: "0 0 100 7", preserveAspectRatio: "none", class: "stack", role: "img", "aria-label": label });
  let from = 0;
  for (const part of parts) {
    const width = (100 * part.value) / most;
    bar.append(svg("rect", { x: from, y: 0.5, width: Math.max(width, 0), height: 6, fill: part.colour }));
    from += width;
  }
  return bar;
}

// The four terms end to end, the total with one standard deviation.
export function chartBudget(budget, style, pinned, solid) {
  const rows = Object.fromEntries(budget.rows.map((row) => [row.key.split(".")[1], row]));
  const total = rows.total.value;
  const most = (total + (rows.std?.value ?? 0)) * 1.02;
  const bar = stack(budget.rows.slice(0, 4), most, `Backlash ${rows.total.text} arcsec`);
  const end = (100 * total) / most;
  const std = (100 * (rows.std?.value ?? 0)) / most;
  if (std) bar.append(svg("path", { d: `M${end - std} 3.5H${end + std}M${end - std} 1.5V5.5M${end + std} 1.5V5.5`,
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

// An empty chart of angles up to `top` over torques up to `reach`, where `both` also as far below 0, and what
// draws in it: `x` and `y` give places, `mark` a line at a torque, `curve` a torque-angle line.
export function frame({ reach, top, both = false, height = LOW, label, kind = "line" }) {
  const halves = both ? 2 : 1;
  const x = (t) => EDGE.left + ((t / reach + halves - 1) / halves) * (W - EDGE.left - EDGE.right);
  const y = (a) => EDGE.top + ((1 - a / top) / halves) * (height - EDGE.top - EDGE.bottom);
  const points = (ts, as, sign = 1) => ts.map((t, i) => `${x(sign * t).toFixed(1)},${y(sign * as[i]).toFixed(1)}`).join(" ");
  const chart = svg("svg", { viewBox: `0 0 ${W} ${height}`, class: kind, role: "img", "aria-label": label });
  const mark = (t, words, anchor = "middle") => {
    chart.append(svg("path", { d: `M${x(t)} ${EDGE.top}V${height - EDGE.bottom}`, class: t ? "load" : "axis" }));
    if (words) chart.append(svg("text", { x: Math.min(x(t), W - EDGE.right), y: height - 7, "text-anchor": anchor }, words));
  };
  const curve = ({ torque_Nm: ts, angle_arcsec: as }, sign = 1, of = "curve") =>
    chart.append(svg("polyline", { points: points(ts, as, sign), class: of }));
  for (const a of ticks(top)) {
    for (const value of a && both ? [a, -a] : [a]) {
      chart.append(svg("path", { d: `M${EDGE.left} ${y(value)}H${W - EDGE.right}`, class: a ? "grid" : "axis" }),
        svg("text", { x: EDGE.left - 5, y: y(value) + 3.5, "text-anchor": "end" }, grouped(value, 0)));
    }
  }
  return { chart, x, y, points, mark, curve };
}

// θ(T): two elastic branches, the gap between them, one standard deviation as a band.
export function chartLine(line, budget, style, pinned, tall) {
  const { torque_Nm: torque, angle_arcsec: angle, spread_arcsec: spread, load_Nm: load, load_text: words, gap_arcsec: gap } = line;
  const top = Math.max(...angle.map((a, i) => a + spread[i]), ...(pinned ? pinned.angle_arcsec : [])) * 1.06;
  const { chart, x, y, points, mark, curve } = frame({
    reach: Math.max(torque.at(-1), pinned ? pinned.torque_Nm.at(-1) : 0),
    top,
    both: true,
    height: tall && innerWidth >= 1600 && innerHeight >= 960 ? HIGH : LOW,
    label: "Angle at the output over torque",
  });
  mark(-load, `\u2212${words}`);
  mark(0, "0");
  mark(load, words);
  for (const sign of [-1, 1]) {
    const high = angle.map((a, i) => a + spread[i]);
    const low = angle.map((a, i) => a - spread[i]);
    const around = `${points(torque, high, sign)} ${points([...torque].reverse(), low.reverse(), sign)}`;
    chart.append(svg("polygon", { points: around, class: "band", fill: style.palette[1] }));
    if (pinned) curve(pinned, sign, "curve pinned");
    curve(line, sign);
  }
  chart.append(svg("path", { d: `M${x(0)} ${y(-gap / 2)}V${y(gap / 2)}`, class: "curve gap" }),
    svg("text", { x: x(0) - 6, y: y(gap / 2) - 4, "text-anchor": "end" }, `gap ${grouped(gap, 1)}`));
  const total = budget.rows.find((row) => row.key.endsWith("total"));
  const std = budget.rows.find((row) => row.key.endsWith("std"));
  chart.append(svg("text", { x: W - EDGE.right - 4, y: y(-top) - 7, "text-anchor": "end", class: "strong" },
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

function ticks(top) {
  const decade = 10 ** Math.floor(Math.log10(top));
  const step = [0.2, 0.5, 1, 2, 5].map((s) => s * decade).find((s) => top / s <= 3);
  return Array.from({ length: Math.floor(top / step) + 1 }, (_, i) => i * step);
}
