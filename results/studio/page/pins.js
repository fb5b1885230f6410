// A pinned design: its answers stay, and every later figure is shown with its difference.

import { el } from "./dom.js";
import { differences, state } from "./state.js";

export class Pins {
  constructor({ figures, changed }) {
    Object.assign(this, { figures, changed });
    this.button = el("button", { id: "pin", title: "Keep these answers to compare with", onclick: () => this.toggle() }, "Pin");
    this.list = el("section", { id: "pinned", hidden: true });
    if (state.pinned) this.figures.pinned = state.pinned.answer;
    this.label();
  }

  toggle() {
    state.pinned = state.pinned ? null : { tables: structuredClone(state.good), answer: structuredClone(this.figures.of(state.goodNumber)) };
    this.figures.pinned = state.pinned?.answer ?? null;
    this.label();
    this.compare();
    this.changed();
  }

  label() {
    this.button.textContent = state.pinned ? "Unpin" : "Pin";
    this.button.setAttribute("aria-pressed", String(Boolean(state.pinned)));
  }

  // Which dimensions differ, then and now; figures pinned while still coming are filled in once.
  compare() {
    this.list.hidden = !state.pinned || state.broken;
    if (this.list.hidden) return;
    const dimensions = differences(state.pinned.tables, state.good);
    if (!dimensions.length) this.figures.pinned = state.pinned.answer = structuredClone(this.figures.of(state.goodNumber));
    const text = (value) => (value === undefined ? "absent" : typeof value === "object" ? Object.values(value).join(", ") : String(value));
    this.list.replaceChildren(el("h2", {}, el("span", {}, "Pinned: ", el("bdi", {}, state.pinned.tables.name))),
      dimensions.length ? el("table", {}, el("tbody", {}, ...dimensions.map(({ key, before, after }) =>
        el("tr", {}, el("td", {}, key), el("td", { class: "value" }, text(before)), el("td", {}, "→"), el("td", { class: "value" }, text(after))))))
        : el("p", { class: "limit" }, "No dimension differs."));
  }
}
