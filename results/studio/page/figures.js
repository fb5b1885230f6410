// The right side: stiffnesses, peaks and the backlash sum; what a pinned design and the solid model say.

import { chartBudget, chartLine } from "./charts.js";
import { el, signed, symbol } from "./dom.js";

const SHORT = {
  K_b_Nm_per_rad: "flexspline, uniform",
  K_b_lobes_Nm_per_rad: "load at two lobes",
  K_b_lobes_contact_Nm_per_rad: "lobes, rim may lift",
  K_b_lobes_unsupported_Nm_per_rad: "lobes, rim free",
  K_e_Nm_per_rad: "output shaft",
  K_series_Nm_per_rad: "both in series",
  wave_generator_peak_mises_MPa: "wave generator",
  torque_peak_mises_MPa: "flexspline, load torque",
  shaft_torque_peak_mises_MPa: "shaft, load torque",
};

export class Figures {
  constructor(root, looks) {
    Object.assign(this, { root, looks, now: null, pinned: null, solid: null, fresh: new Set(), numbers: {} });
    this.stiffness = el("section", {});
    this.work = el("section", { id: "solid" });
    this.agreement = el("p", { id: "agreement", class: "limit" });
    this.peaks = el("section", { class: "peaks" });
    this.backlash = el("section", {});
    root.append(this.stiffness, this.work, this.peaks, this.backlash);
  }

  // What an answer does not hold keeps its older figures, marked. One that is not of the design as it
  // stands (`current`) is shown where nothing newer is, and marked too.
  show(answer, current) {
    const merged = { ...this.now, ...answer };
    const newer = (key) => answer.number >= (this.numbers[key] ?? 0);
    const taken = (key) => (this.numbers[key] = answer.number);
    if (current) this.fresh = new Set(answer.budget ? ["backlash"] : []);
    for (const part of ["stiffness", "peaks"]) {
      merged[part] = answer[part].map((row, i) => {
        if (row.text === undefined || !newer(row.key)) return this.now?.[part][i] ?? row;
        taken(row.key);
        if (current) this.fresh.add(row.key);
        return row;
      });
    }
    if (answer.budget && newer("backlash")) taken("backlash");
    else if (this.now) Object.assign(merged, { budget: this.now.budget, line: this.now.line });
    this.now = merged;
    this.draw();
  }

  stale() {
    this.fresh = new Set();
    this.draw();
  }

  draw() {
    if (!this.now) return;
    this.root.classList.toggle("narrow", this.narrow);
    this.root.classList.toggle("crowded", Boolean(this.solid && this.pinned));
    const unit = (rows) => rows.find((row) => row.unit)?.unit ?? "";
    this.stiffness.replaceChildren(
      this.heading("Stiffness", unit(this.now.stiffness)),
      el("table", {}, this.head("bounds"), el("tbody", {}, ...this.now.stiffness.map((row) => this.row(row, "stiffness")))),
    );
    this.peaks.replaceChildren(
      this.heading("Peak von Mises stress", unit(this.now.peaks)),
      el("table", {}, this.head("of fatigue limit"), el("tbody", {}, ...this.now.peaks.map((row) => this.row(row, "peaks")))),
    );
    const busy = this.fresh.has("backlash") ? "" : "stale";
    this.backlash.className = busy;
    const now = this.now.budget;
    this.backlash.replaceChildren(this.heading("Backlash between −T and +T", "arcsec"));
    if (now) {
      this.backlash.append(
        chartBudget(now, this.looks, this.pinned?.budget, this.solidFresh() ? this.solid.budget : null),
        this.heading("Output angle, wave generator locked", "arcsec over N·m"),
        chartLine(this.now.line, now, this.looks, this.pinned?.line, !this.narrow),
      );
    }
  }

  heading(text, unit) {
    return el("h2", {}, text, el("span", { class: "unit" }, unit));
  }

  // Beside other columns, bounds and places stand below their figure.
  get narrow() {
    return Boolean(this.solid || this.pinned);
  }

  head(third) {
    const cells = [el("th", { colspan: 2 }), el("th", {}, "fast model")];
    if (!this.narrow) cells.push(el("th", {}, third));
    if (this.solid) cells.push(el("th", {}, this.solid.old ? "solid, of earlier" : "solid"));
    if (this.pinned) cells.push(el("th", {}, "to pinned"));
    return el("thead", {}, el("tr", {}, ...cells));
  }

  row(row, part) {
    const busy = row.text !== undefined && this.fresh.has(row.key) ? "" : "stale";
    const value = el("td", { class: `value ${row.rough ? "rough" : ""}` }, row.text ? `${row.rough ? "≈\u2009" : ""}${row.text}` : "…");
    value.dataset.value = row.value ?? "";
    const cells = [el("td", { class: "sym" }, symbol(row.symbol)), el("td", { class: "what", title: row.name }, SHORT[row.key] ?? row.name), value];
    const below = (cell, text) => text && cell.append(el("br"), el("span", { class: "limit" }, text));
    const side = row.bounds ?? row.limit;
    if (this.narrow) below(value, side);
    else cells.push(el("td", { class: "side", title: row.half_pct }, side ?? ""));
    below(cells[1], row.at);
    if (this.solid) cells.push(this.solidCell(row, part));
    if (this.pinned) cells.push(this.pinnedCell(row, part));
    const line = el("tr", { class: busy, "data-key": row.key }, ...cells);
    line.classList.toggle("over", Boolean(row.over));
    return line;
  }

  solidFresh() {
    return this.solid && !this.solid.old;
  }

  solidCell(row, part) {
    const found = this.solid[part].find((other) => other.key === row.key);
    const cell = el("td", { class: `value solid ${this.solid.old ? "stale" : ""}`, title: found?.bounds }, found?.text ?? "");
    if (found?.bounds) cell.append(el("br"), el("span", { class: "limit" }, found.bounds));
    return cell;
  }

  pinnedCell(row, part) {
    const other = this.pinned[part].find((entry) => entry.key === row.key);
    if (other?.value === undefined || row.value === undefined) return el("td", {});
    const change = row.value - other.value;
    return el("td", { class: "delta" }, signed(change, row.decimals), el("br"),
      el("span", { class: "limit" }, `${signed((100 * change) / other.value, 1)} %`));
  }
}
