// The right side: stiffnesses, peaks and the backlash sum; what a pinned design and the solid model say.

import { chartBudget, chartLine, differenceCell } from "./charts.js";
import { el, symbol } from "./dom.js";
import { gearPanel } from "./gear.js";
import { state } from "./state.js";

const BRIEF = ["K_b_Nm_per_rad", "K_e_Nm_per_rad", "wave_generator_peak_mises_MPa"];
const GEAR = "gear"; // its figures and its curve come together
const SMALL = matchMedia("(max-width: 419px)"); // name, figure and bounds of a row do not fit beside one another
const DRAWN = "backlash"; // the sum and its line come together, and so have one number

export class Figures {
  constructor(root, style) {
    Object.assign(this, { root, style, now: null, pinned: null, solid: null, numbers: {} });
    this.whose = el("p", { id: "whose", class: "note", role: "status", hidden: true });
    this.stiffness = el("section", {});
    this.work = el("section", { id: "solid" });
    this.agreement = el("p", { id: "agreement", class: "limit" });
    this.peaks = el("section", { class: "peaks" });
    this.backlash = el("section", {});
    this.gear = el("section", { id: "gear" });
    SMALL.addEventListener("change", () => this.draw());
    root.append(this.whose, this.stiffness, this.work, this.peaks, this.backlash, this.gear);
  }

  // Every figure keeps the number of the design that it belongs to; an older one never replaces a newer.
  show(answer) {
    const newer = (key) => answer.number >= (this.numbers[key] ?? 0);
    const merged = { ...this.now };
    for (const part of ["stiffness", "peaks"]) {
      merged[part] = answer[part].map((row, i) => {
        if (row.text === undefined || !newer(row.key)) return this.now?.[part][i] ?? row;
        this.numbers[row.key] = answer.number;
        return row;
      });
    }
    if (answer.budget && newer(DRAWN)) {
      this.numbers[DRAWN] = answer.number;
      Object.assign(merged, { budget: answer.budget, line: answer.line });
    }
    if (answer.gear && newer(GEAR)) {
      this.numbers[GEAR] = answer.number;
      merged.gear = answer.gear;
    }
    this.now = merged;
    this.draw();
  }

  // The answers that belong to one design, and no other's.
  of(number) {
    const known = (row) => (this.numbers[row.key] === number ? row : waiting(row));
    const whole = this.numbers[DRAWN] === number ? this.now : { budget: null, line: null };
    const gear = this.numbers[GEAR] === number ? this.now.gear : null;
    return { stiffness: this.now.stiffness.map(known), peaks: this.now.peaks.map(known), budget: whole.budget, line: whole.line, gear };
  }

  stale(key) {
    return this.numbers[key] !== state.number;
  }

  // If the design cannot be built, only figures of the last design that can be built are shown.
  shown() {
    const { now, pinned, solid } = this;
    if (!state.broken) return { now, pinned, solid };
    return { now: this.of(state.goodNumber), pinned: null, solid: solid?.old ? null : solid };
  }

  draw() {
    if (!this.now) return;
    this.seen = this.shown();
    const { now, pinned, solid } = this.seen;
    this.whose.hidden = !state.broken;
    this.whose.replaceChildren("Figures of the last design that can be built: ", el("bdi", {}, state.good?.name ?? ""));
    this.root.classList.toggle("narrow", this.narrow);
    this.root.classList.toggle("crowded", Boolean(solid && pinned));
    const unit = (rows) => rows.find((row) => row.unit)?.unit ?? "";
    this.stiffness.replaceChildren(
      this.heading("Stiffness", unit(now.stiffness)),
      el("table", {}, this.head("bounds (≈ estimated)"), el("tbody", {}, ...now.stiffness.map((row) => this.row(row, "stiffness")))),
    );
    this.peaks.replaceChildren(
      this.heading("Peak von Mises stress", unit(now.peaks)),
      el("table", {}, this.head("of fatigue limit"), el("tbody", {}, ...now.peaks.map((row) => this.row(row, "peaks")))),
    );
    this.writeBrief(now);
    this.backlash.className = this.stale(DRAWN) ? "stale" : "";
    this.backlash.replaceChildren(this.heading("Backlash between −T and +T", "arcsec"));
    if (now.budget) {
      this.backlash.append(
        chartBudget(now.budget, this.style, pinned?.budget, solid && !solid.old ? solid.budget : null),
        this.heading("Output angle, wave generator locked", "arcsec over N·m"),
        chartLine(now.line, now.budget, this.style, pinned?.line, !this.narrow),
      );
    }
    this.drawGear(now.gear, pinned?.gear);
  }

  // Why the present design has no whole-gear figures.
  withoutGear({ number, text }) {
    this.noGear = { number, text };
    this.draw();
  }

  drawGear(gear, pinned) {
    this.gear.className = this.stale(GEAR) ? "stale" : "";
    this.gear.replaceChildren();
    if (this.noGear && this.noGear.number === state.number) {
      this.gear.className = "";
      this.gear.append(this.heading("Whole gear, wave generator locked", ""), el("p", { class: "limit" }, `Not computed: ${this.noGear.text}`));
    } else if (gear) this.gear.append(this.heading("Whole gear, wave generator locked", ""), ...gearPanel(gear, pinned));
  }

  // Where the answers do not stand beside the sliders: four of them in a line that stays in sight.
  writeBrief({ stiffness, peaks, budget }) {
    const row = (key) => [...stiffness, ...peaks].find((entry) => entry.key === key);
    const cell = (head, unit, text, key, without) => el("div", { class: this.stale(key) ? "stale" : "" },
      el("dt", {}, head, unit ? ` ${unit}` : ""), el("dd", {}, text ?? "…"), without ? el("dd", { class: "limit" }, without) : "");
    const cells = BRIEF.map(row).map((entry) => cell(symbol(entry.symbol), entry.unit, entry.text, entry.key, entry.without));
    const total = budget?.rows.find((entry) => entry.key.endsWith("total"));
    document.getElementById("brief").replaceChildren(...cells, cell("Backlash", "arcsec", total?.text, DRAWN));
  }

  heading(text, unit) {
    return el("h2", {}, text, el("span", { class: "unit" }, unit));
  }

  // Beside other columns, and in a small window, bounds and places stand below their figure.
  get narrow() {
    return Boolean(this.seen.solid || this.seen.pinned || SMALL.matches);
  }

  head(third) {
    const cells = [el("th", { colspan: 2 }), el("th", {}, "fast model")];
    if (!this.narrow) cells.push(el("th", {}, third));
    if (this.seen.solid) cells.push(el("th", {}, this.seen.solid.old ? "solid, earlier" : "solid"));
    if (this.seen.pinned) cells.push(el("th", {}, "vs. pinned"));
    return el("thead", {}, el("tr", {}, ...cells));
  }

  row(row, part) {
    const busy = this.stale(row.key) ? "stale" : "";
    const value = el("td", { class: `value ${row.rough ? "rough" : ""}` }, row.text ? `${row.rough ? "≈\u2009" : ""}${row.text}` : "…");
    value.dataset.value = row.value ?? "";
    const cells = [el("td", { class: "sym" }, symbol(row.symbol)), el("td", { class: "what", title: row.name }, row.short || row.name), value];
    const below = (cell, text) => text && cell.append(el("br"), el("span", { class: "limit" }, text));
    const side = row.bounds ?? row.limit;
    if (this.narrow) below(value, side);
    else cells.push(el("td", { class: "side", title: row.half_pct }, side ?? ""));
    below(cells[1], row.at);
    below(cells[1], row.without);
    if (row.more) {
      cells[1].append(el("span", { class: "limit more" }, row.more));
      cells[1].title = `${row.name}: ${row.more}`;
    }
    if (this.seen.solid) cells.push(this.solidCell(row, part));
    if (this.seen.pinned) cells.push(this.pinnedCell(row, part));
    const line = el("tr", { class: busy, "data-key": row.key }, ...cells);
    line.classList.toggle("over", Boolean(row.over));
    return line;
  }

  solidCell(row, part) {
    const solved = this.seen.solid[part].find((other) => other.key === row.key);
    const cell = el("td", { class: `value solid ${this.seen.solid.old ? "stale" : ""}`, title: solved?.bounds }, solved?.text ?? "");
    if (solved?.bounds) cell.append(el("br"), el("span", { class: "limit" }, solved.bounds));
    return cell;
  }

  pinnedCell(row, part) {
    return differenceCell(row, this.seen.pinned[part].find((entry) => entry.key === row.key));
  }
}

// A row whose figure is still to come.
function waiting({ key, symbol, name, unit }) {
  return { key, symbol, name, unit };
}
