// The left side: every key of the design with a slider and a number field.

import { el } from "./dom.js";
import { setAt, state, valueAt } from "./state.js";

export class Form {
  // changed(): a value was moved or typed; broke(): what was typed is none; restructured(tables): a table came or went.
  constructor(root, { changed, broke, restructured }) {
    Object.assign(this, { root, changed, broke, restructured });
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
    const id = `f-${entry.key}`;
    const fault = el("p", { id: `${id}-fault`, class: "fault", role: "alert", hidden: true });
    const label = el("label", { for: id, title: entry.hint }, entry.label);
    const inputs = entry.kind === "choice" ? this.choice(entry, id, value)
      : entry.kind === "text" ? this.text(entry, id, value) : this.number(entry, id, value);
    const box = el("div", { class: `row ${entry.kind}` }, label, ...inputs, fault);
    box.dataset.key = entry.key;
    const field = inputs.find((input) => input.id === id);
    field.setAttribute("aria-describedby", fault.id);
    this.rows.set(entry.key, { box, field, fault, wrong: false });
    return box;
  }

  number(entry, id, value) {
    const field = el("input", { id, inputmode: "decimal", autocomplete: "off", value: value ?? "", placeholder: entry.usual === null ? "none" : "default" });
    const slider = el("input", {
      type: "range", min: entry.low, max: entry.high, step: entry.step, value: value ?? entry.usual ?? entry.low,
      "aria-label": entry.unit ? `${entry.label}, ${entry.unit}` : entry.label,
    });
    slider.addEventListener("input", () => {
      field.value = slider.value;
      this.rows.get(entry.key).wrong = false;
      this.put(entry, Number(slider.value));
    });
    field.addEventListener("input", () => {
      const row = this.rows.get(entry.key);
      const typed = field.value.trim() === "" && entry.optional ? undefined : read(field.value);
      row.wrong = Number.isNaN(typed);
      if (row.wrong) {
        this.broke();
        return this.fault(entry.key, `${entry.key}: a number is needed${entry.unit ? ` in ${entry.unit}` : ""}`);
      }
      slider.value = typed ?? entry.usual ?? entry.low;
      this.put(entry, typed);
    });
    // what was taken of "1,5" or "1 000" is shown
    field.addEventListener("change", () => {
      if (!this.rows.get(entry.key).wrong) field.value = valueAt(state.tables, entry.at) ?? "";
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
    const field = el("input", { id, dir: "auto", maxlength: 200, value: value ?? "", spellcheck: "false", autocomplete: "off" });
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
    if (at === "material.flexspline") {
      const others = [["shaft", "the shaft"], ["circular_spline", "the circular spline"], ["bearing", "races and balls"]];
      const made = others.filter(([key]) => !state.tables.material[key]).map(([key, name]) =>
        button(`Other material for ${name}`, (t) => { 
          const { name: called, youngs_modulus_GPa, poissons_ratio, ...rest } = t.material.flexspline;
          t.material[key] = { name: called, youngs_modulus_GPa, poissons_ratio, ...(key === "shaft" ? rest : {}) };
        }));
      return el("p", { class: "actions" }, ...made);
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
    if (!row) return;
    row.box.classList.add("bad");
    row.field.setAttribute("aria-invalid", "true");
    row.box.closest("details").open = true;
    if (row.box.contains(document.activeElement)) place.scrollIntoView({ block: "nearest" });
  }

  // All is well again, but for fields that hold no number.
  clear() {
    this.root.querySelector("#fault").hidden = true;
    for (const { box, field, fault, wrong } of this.rows.values()) {
      if (wrong) continue;
      fault.hidden = true;
      box.classList.remove("bad");
      field.removeAttribute("aria-invalid");
    }
  }
}

// A number as people write and paste it: a decimal comma, spaces between thousands, a true minus. NaN for anything else.
function read(text) {
  const plain = text.replace(/\s/g, "").replace("\u2212", "-");
  const dotted = plain.includes(".") ? plain : plain.replace(",", ".");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(dotted) ? Number(dotted) : NaN;
}
