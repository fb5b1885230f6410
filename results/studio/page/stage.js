// What stands around the 3-D part: which case, the colour scale, what was left out, and its PNG.

import { unpacked } from "./arrays.js";
import { colourBar } from "./colour_bar.js";
import { el, grouped } from "./dom.js";
import { state } from "./state.js";
import { View } from "./view.js";

const PATIENCE_MS = 400; // so long may colours of the design before stay: no flicker while a slider moves

// The part in 3-D; where the browser cannot draw it, one line instead.
function drawing(root, style) {
  try {
    return new View(root, style);
  } catch {
    root.append(el("p", { id: "no-picture" }, "This browser shows no 3-D picture (WebGL is off or missing). All figures are here."));
    return new NoView();
  }
}

class NoView {
  show() {}
  set() {}
  reset() {}
  picture() { return null; }
}

export class Stage {
  constructor(style, { view, chosen }) {
    this.style = style;
    this.number = 0;
    this.view = view;
    this.canvas = drawing(document.getElementById("canvas"), style);
    this.scale = document.getElementById("scale");
    this.caption = document.getElementById("caption");
    const choice = el("select", { id: "case", "aria-label": "Load case shown" },
      ...Object.entries(style.views).map(([key, words]) => el("option", { value: key }, words)));
    choice.value = view;
    choice.addEventListener("change", () => {
      this.view = choice.value;
      chosen(choice.value);
    });
    const toggle = (id, words, option, on) => {
      const box = el("input", { type: "checkbox", id });
      box.checked = on;
      box.addEventListener("change", () => this.canvas.set({ [option]: box.checked }));
      return el("label", { class: "check" }, box, words);
    };
    addEventListener("beforeprint", () => this.print());
    document.getElementById("stagebar").append(choice, toggle("open", "Cut open", "open", false),
      toggle("deformed", "Deformed", "deformed", true),
      el("button", { id: "reset", class: "small", onclick: () => this.canvas.reset() }, "Reset view"),
      this.busy = el("span", { id: "busy", role: "status" }));
  }

  get draws() {
    return this.canvas instanceof View;
  }

  // What is drawn by WebGL does not reach the paper; a picture of it does.
  print() {
    const part = this.canvas.picture();
    document.getElementById("printed")?.remove();
    if (part) document.getElementById("canvas").append(el("img", { id: "printed", alt: "", src: part.toDataURL() }));
  }

  // Bytes of the design `number`; those of another view or older than what is shown are left.
  take(buffer, { number, name }) {
    const shape = Object.assign(unpacked(buffer), { name });
    if (shape.view !== this.view || number < this.number) return;
    clearTimeout(this.waiting);
    const outline = shape.is === "profile" ? shape.places.join() : this.outline;
    const known = outline === this.outline;
    this.outline = outline;
    if (shape.is === "field" || this.shown?.view !== shape.view) return this.put(shape, number);
    if (!known) this.waiting = setTimeout(() => this.put(shape, number), PATIENCE_MS);
  }

  put(shape, number) {
    this.shown = shape;
    this.number = number;
    this.canvas.show(shape);
    this.working(shape.is === "profile");
    this.drawScale();
    this.root().dataset.shown = `${shape.is} ${shape.view} ${number}`;
    this.mark();
  }

  // Grey while it belongs to a design before; hidden if that is not even the one whose figures are shown.
  mark() {
    const root = this.root();
    root.dataset.number = state.number;
    root.classList.toggle("former", Boolean(this.shown) && this.number !== state.number);
    root.classList.toggle("foreign", Boolean(this.shown) && state.broken && this.number !== state.goodNumber);
  }

  root() {
    return document.getElementById("stage");
  }

  working(on, instead = "") {
    this.busy.textContent = on ? "computing the stress…" : instead;
  }

  drawScale() {
    const shape = this.shown;
    this.scale.hidden = shape.is !== "field";
    if (this.scale.hidden) return;
    const bar = colourBar(this.style.scale);
    bar.className = "bar";
    this.scale.replaceChildren(el("p", { class: "unit" }, "von Mises, MPa"),
      el("div", { class: "bars" }, bar, el("ol", {}, ...shape.ticks_MPa.map((tick) => el("li", {}, tick)))),
      el("p", { class: "peak", title: shape.excluded }, "● peak"));
    this.magnified = shape.view === "wave_generator"
      ? `Displacements drawn ${grouped(shape.magnification, 0)} times as large. ` : "";
    this.write();
  }

  say(leftOut, warnings, w0) {
    this.left = leftOut.length ? `Not in the fast model: ${leftOut.join(", ")}. ` : "";
    this.warnings = warnings;
    this.w0 = w0;
    this.beyond = [];
    this.write();
  }

  // A load torque at which the linear model is not valid.
  passed(lines) {
    this.beyond = lines;
    this.write();
  }

  write() {
    const seat = this.view === "wave_generator" ? `Seat, as wide as the ring and cylindrical, moved radially by w₀ cos 2φ, w₀ = ${grouped(this.w0 ?? 0, 3)} mm. ` : "";
    this.caption.replaceChildren(
      el("p", {}, seat, this.magnified ?? ""),
      this.left ? el("p", { id: "left-out", class: "note" }, this.left, "“Solve with holes” includes them.") : "",
      ...(this.warnings ?? []).map((line) => el("p", { class: "warning" }, `Unusual: ${line}`)),
      ...(this.beyond ?? []).map((line) => el("p", { class: "warning" }, line)));
  }

  // The part with its title and scale, on the page's own ground.
  png() {
    const part = this.canvas.picture();
    const k = part.width / part.clientWidth;
    const sheet = el("canvas", { width: part.width, height: part.height });
    const pen = sheet.getContext("2d");
    const style = getComputedStyle(document.body);
    pen.fillStyle = style.backgroundColor;
    pen.fillRect(0, 0, sheet.width, sheet.height);
    pen.drawImage(part, 0, 0);
    pen.fillStyle = style.color;
    pen.font = `600 ${15 * k}px ${style.fontFamily}`;
    pen.fillText(this.shown.name, 16 * k, 28 * k);
    pen.font = `${12 * k}px ${style.fontFamily}`;
    pen.fillText(`${this.style.views[this.view]}, von Mises stress in MPa`, 16 * k, 46 * k);
    const bar = this.scale.querySelector("canvas");
    if (bar && !this.scale.hidden) {
      const [x, y, h] = [sheet.width - 92 * k, 70 * k, Math.min(220 * k, sheet.height - 110 * k)];
      pen.drawImage(bar, x, y, 14 * k, h);
      const ticks = this.shown.ticks_MPa;
      ticks.forEach((tick, i) => pen.fillText(tick, x + 20 * k, y + 4 * k + (h * i) / (ticks.length - 1)));
    }
    return new Promise((done) => sheet.toBlob(done, "image/png"));
  }
}
