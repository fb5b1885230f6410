// The left side: every key of the design with a slider and a number field.

import { el } from "./dom.js";
import { setAt, state, valueAt } from "./state.js";

export class Form {
  // changed(): a value was moved or typed; restructured(tables): a table came or went.
  constructor(root, { changed, restructured }) {
    Object.assign(this, { root, changed, restructured });
  }

  build(groups) {
    const folded = new Set([...this.root.querySelectorAll("details:not([open])")].map((d) => d.dataset.title));
    this.rows = new Map();
    this.root.replaceChildren(
      el("p", { id: "fault", class: "fault", role: "alert", hidden: true }),
      ...groups.map((group) => {
        const shut = folded.has(group.title);
        const rows = group.entries.map((entry) => this.row(entry));
        const box = el("details", { open: !shut }, el("summary", {}, group.title), ...rows, this.actions(group));
        box.dataset.title = group.title;
        return box;
      }),
    );
  }

  row(entry) {
    const value = valueAt(state.tables, entry.at);
    const fault = el("p", { class: "fault", role: "alert", hidden: true });
    const id = `f-${entry.key}`;
    const label = el("label", { for: id, title: entry.hint }, entry.label);
    const inputs = entry.kind === "choice" ? this.choice(entry, id, value)
      : entry.kind === "text" ? this.text(entry, id, value) : this.number(entry, id, value);
    const box = el("div", { class: `row ${entry.kind}` }, label, ...inputs, fault);
    box.dataset.key = entry.key;
    this.rows.set(entry.key, { box, fault });
    return box;
  }

  number(entry, id, value) {
    const field = el("input", { id, inputmode: "decimal", autocomplete: "off", value: value ?? "", placeholder: "none" });
    const slider = el("input", {
      type: "range", min: entry.low, max: entry.high, step: entry.step, "aria-label": entry.label, value: value ?? entry.low,
    });
    slider.addEventListener("input", () => {
      field.value = slider.value;
      this.put(entry, Number(slider.value));
    });
    field.addEventListener("input", () => {
      const text = field.value.trim().replace(",", ".");
      if (text === "" && entry.optional) return this.put(entry, undefined);
      const typed = Number(text);
      if (text === "" || !Number.isFinite(typed)) {
        return this.fault(entry.key, `${entry.key}: a number is needed${entry.unit ? ` in ${entry.unit}` : ""}`);
      }
      slider.value = typed;
      this.put(entry, typed);
    });
    return [slider, field, el("span", { class: "unit" }, entry.unit)];
  }

  choice(entry, id, value) {
    const options = entry.options.map((name) => el("option", { value: name }, name));
    const select = el("select", { id }, ...options);
    select.value = value;
    select.addEventListener("change", () => this.put(entry, select.value));
    return [select];
  }

  text(entry, id, value) {
    const field = el("input", { id, maxlength: 200, value: value ?? "", spellcheck: "false", autocomplete: "off" });
    field.addEventListener("input", () => this.put(entry, field.value));
    return [field];
  }

  put(entry, value) {
    setAt(state.tables, entry.at, value);
    this.changed();
  }

  // Tables that may come and go: segments, the keyway, the shaft's own material.
  actions(group) {
    const at = group.at.join(".");
    const tables = () => structuredClone(state.tables);
    const button = (words, change) => el("button", { class: "small", onclick: () => {
      const next = tables();
      change(next);
      this.restructured(next);
    } }, words);
    if (at === "shaft") {
      const made = [button("Add segment", (t) => t.shaft.segment.push({ ...t.shaft.segment.at(-1) }))];
      if (!state.tables.shaft.keyway) {
        made.push(button("Add keyway", (t) => {
          const last = t.shaft.segment.at(-1);
          const d = last.outer_diameter_mm;
          t.shaft.keyway = { width_mm: d / 4, depth_mm: (d - (last.inner_diameter_mm || 0)) / 8, length_mm: last.length_mm / 2 };
        }));
      }
      return el("p", { class: "actions" }, ...made);
    }
    if (at.startsWith("shaft.segment") && state.tables.shaft.segment.length > 1) {
      return el("p", { class: "actions" }, button("Remove segment", (t) => t.shaft.segment.splice(group.at[2], 1)));
    }
    if (at === "shaft.keyway") {
      return el("p", { class: "actions" }, button("Remove keyway", (t) => delete t.shaft.keyway));
    }
    if (at === "material.flexspline" && !state.tables.material.shaft) {
      return el("p", { class: "actions" }, button("Other material for the shaft", (t) => {
        t.material.shaft = { ...t.material.flexspline };
      }));
    }
    return null;
  }

  // One line at the field it concerns, or above the form where it concerns none.
  fault(key, text) {
    this.clear();
    const row = this.rows.get(key);
    const place = row ? row.fault : this.root.querySelector("#fault");
    place.textContent = text;
    place.hidden = false;
    row?.box.classList.add("bad");
    if (!row) return;
    row.box.closest("details").open = true;
    if (row.box.contains(document.activeElement)) place.scrollIntoView({ block: "nearest" });
  }

  clear() {
    for (const place of this.root.querySelectorAll(".fault")) place.hidden = true;
    for (const box of this.root.querySelectorAll(".bad")) box.classList.remove("bad");
  }
}
