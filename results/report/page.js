// Turns the report's 3-D views. Scenes, colours and words are data in the page.

import { unpacked } from "./arrays.js";
import { colourBar } from "./colour_bar.js";
import { PartScene } from "./part_scene.js";

const { scale, views } = JSON.parse(document.getElementById("views").textContent);
const TURNS = { ArrowLeft: [10, 0], ArrowRight: [-10, 0], ArrowUp: [0, -10], ArrowDown: [0, 10] }; // degrees
const ZOOMS = { "+": 1.15, "=": 1.15, "-": 1 / 1.15 };

function canDraw() {
  try {
    return "DecompressionStream" in window && Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
}

// ---------------------------------------------------------------- a scene's bytes

async function sceneOf(name) {
  const text = atob(document.getElementById(`scene-${name}`).textContent);
  const bytes = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return unpacked(await new Response(stream).arrayBuffer());
}

// Points in mm: x, y, z of each, from all x, all y, all z in steps.
function positions({ places, low_mm: low, step_mm: step }) {
  const count = places.length / 3;
  const out = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; axis++) {
    for (let i = 0; i < count; i++) out[3 * i + axis] = low[axis] + step * places[axis * count + i];
  }
  return out;
}

// Stress over the peak, as places on the colour scale; what stands after the surface's points has none.
function colours({ along, levels }, count) {
  const out = new Float32Array(2 * count);
  along.forEach((level, i) => out.set([level / levels, 0.5], 2 * i));
  return out;
}

// ---------------------------------------------------------------- one view

class Turntable {
  constructor(element) {
    this.name = element.dataset.view;
    this.element = element;
    this.stage = element.querySelector(".stage");
    this.flag = element.querySelector(".mark");
    element.querySelector(".ramp").append(colourBar(scale));
    for (const tick of element.querySelectorAll(".tick")) tick.style.bottom = `${100 * Number(tick.dataset.at)}%`;
  }

  async load() {
    const shape = await sceneOf(this.name);
    const position = positions(shape);
    this.part = new PartScene(this.stage, scale);
    this.part.addSurface({ position, along: colours(shape, position.length / 3), index: shape.triangles });
    for (const [name, colour] of Object.entries(shape.lines)) {
      this.part.addLines({ position, index: shape[name] }, this.part.lineOf(colour));
    }
    this.part.drawn = () => this.placeFlag();
    this.listen();
    this.reset();
    this.element.dataset.ready = "";
  }

  listen() {
    let held = false; // the page scrolls over a view until somebody takes it
    this.stage.addEventListener("pointerdown", () => {
      held = true;
      this.stage.focus({ preventScroll: true });
    });
    this.stage.addEventListener("pointerleave", () => { held = false; });
    this.stage.addEventListener("wheel", (e) => { if (!held) e.stopPropagation(); }, true);
    this.stage.addEventListener("keydown", (e) => this.key(e));
    this.element.querySelector(".reset").addEventListener("click", () => this.reset());
  }

  key(event) {
    if (event.key in TURNS) this.part.turn(...TURNS[event.key]);
    else if (event.key in ZOOMS) this.part.zoomBy(ZOOMS[event.key]);
    else if (event.key === "Home") this.reset();
    else return;
    event.preventDefault();
  }

  reset() {
    this.part.look(views[this.name].camera);
  }

  placeFlag() {
    const { at, normal } = views[this.name].mark;
    const [x, y] = this.part.pixel(at);
    this.flag.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    this.flag.style.visibility = "visible";
    this.flag.classList.toggle("left", x > 0.6 * this.stage.clientWidth);
    this.flag.classList.toggle("behind", !this.part.faces(normal));
  }
}

// ---------------------------------------------------------------- all of them

async function start() {
  if (!canDraw()) return; // the pictures stay
  for (const element of document.querySelectorAll(".view")) {
    const figure = element.closest("figure");
    element.hidden = false;
    figure.classList.add("live");
    try {
      await new Turntable(element).load();
    } catch (error) {
      element.hidden = true; // the picture comes back
      figure.classList.remove("live");
      console.error(error);
    }
  }
  document.documentElement.dataset.views = "ready";
}

start();
