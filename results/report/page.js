// Turns the report's 3-D views. Scenes and their words are data in the page; vtk.js draws them.
const views = JSON.parse(document.getElementById("views").textContent);
const dark = window.matchMedia("(prefers-color-scheme: dark)");

function hasWebGL() {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl2"));
  } catch {
    return false;
  }
}

const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((v, i) => v - b[i]);

// ---------------------------------------------------------------- one view

class Turntable {
  constructor(element) {
    this.name = element.dataset.view;
    this.element = element;
    this.stage = element.querySelector(".stage");
    this.flag = element.querySelector(".mark");
    this.canvasBox = document.createElement("div");
    this.canvasBox.className = "canvas";
    this.canvasBox.style.cssText = "position:absolute;inset:0";
    this.stage.prepend(this.canvasBox);
    this.paintScale();
  }

  paintScale() {
    this.element.querySelector(".ramp").style.background = `linear-gradient(to top, ${views[this.name].ramp.join()})`;
    for (const tick of this.element.querySelectorAll(".tick")) {
      tick.style.bottom = `${100 * Number(tick.dataset.at)}%`;
    }
  }

  // Resolves when the scene stands; scenes load one after the other, they share vtk.js' array store.
  async load() {
    const base64Str = document.getElementById(`scene-${this.name}`).textContent;
    window.OfflineLocalView.load(this.canvasBox, { base64Str });
    this.window = window.renderWindow;
    const own = this.window.getRenderers()[0]; // the viewer's, empty; the scene brings another
    const drawn = (a) => a.getMapper()?.getInputData()?.getPoints()?.getNumberOfPoints() > 0;
    await until(() => this.window.getRenderers().some(
      (r) => r !== own && r.getActors().length > 0 && r.getActors().every(drawn)));
    this.window.removeRenderer(own);
    this.renderer = this.window.getRenderers()[0];
    this.camera = this.renderer.getActiveCamera();
    this.listen();
    this.paintGround();
    this.reset();
    new ResizeObserver(() => this.fit()).observe(this.stage);
    this.element.dataset.ready = "";
  }

  listen() {
    this.camera.onModified(() => this.placeFlag());
    let held = false; // the page scrolls over a view until somebody takes it
    this.stage.addEventListener("pointerdown", () => {
      held = true;
      this.stage.focus({ preventScroll: true });
    });
    this.stage.addEventListener("pointerleave", () => { held = false; });
    this.canvasBox.addEventListener("wheel", (e) => { if (!held) e.stopImmediatePropagation(); }, true);
    for (const kind of ["keypress", "keydown"]) {
      // vtk.js' own keys (w: wires, s: surface) would surprise here
      this.canvasBox.addEventListener(kind, (e) => {
        e.stopPropagation();
        if (kind === "keydown") this.key(e);
      }, true);
    }
    this.stage.addEventListener("keydown", (e) => this.key(e));
    this.element.querySelector(".reset").addEventListener("click", () => this.reset());
    const inner = this.canvasBox.querySelector("[tabindex]");
    if (inner) inner.tabIndex = -1;
    dark.addEventListener("change", () => this.paintGround());
  }

  key(event) {
    const turn = { ArrowLeft: [10, 0], ArrowRight: [-10, 0], ArrowUp: [0, -10], ArrowDown: [0, 10] }[event.key];
    if (turn) {
      this.camera.azimuth(turn[0]);
      this.camera.elevation(turn[1]);
      this.camera.orthogonalizeViewUp();
    } else if (event.key === "+" || event.key === "=") {
      this.camera.zoom(1.15);
    } else if (event.key === "-") {
      this.camera.zoom(1 / 1.15);
    } else if (event.key === "Home") {
      this.reset();
    } else {
      return;
    }
    event.preventDefault();
    this.draw();
  }

  reset() {
    const { focalPoint, position, viewUp } = views[this.name].camera;
    this.camera.setFocalPoint(...focalPoint);
    this.camera.setPosition(...position);
    this.camera.setViewUp(...viewUp);
    this.fit(true);
  }

  // The part's sphere fits the shorter side of the stage.
  fit(again = false) {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height) return;
    const wanted = views[this.name].camera.parallelScale * Math.max(1, height / width);
    if (again || this.scale === undefined) this.camera.setParallelScale(wanted);
    else this.camera.setParallelScale((this.camera.getParallelScale() * wanted) / this.scale);
    this.scale = wanted;
    this.window.getViews()[0].setSize(...[width, height].map((n) => Math.round(n * window.devicePixelRatio)));
    this.draw();
  }

  paintGround() {
    const colour = getComputedStyle(this.stage.parentElement).backgroundColor.match(/[\d.]+/g).map(Number);
    this.renderer.setBackground(...colour.slice(0, 3).map((c) => c / 255));
    this.draw();
  }

  draw() {
    this.renderer.resetCameraClippingRange();
    this.window.render();
    this.placeFlag();
  }

  placeFlag() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    const { at, normal } = views[this.name].mark;
    const eye = this.camera.getViewPlaneNormal();
    const up = this.camera.getViewUp();
    const right = cross(up, eye);
    const from = minus(at, this.camera.getFocalPoint());
    const pixels = height / 2 / this.camera.getParallelScale();
    const x = width / 2 + (pixels * dot(from, right)) / Math.hypot(...right);
    const trueUp = cross(eye, right);
    const y = height / 2 - (pixels * dot(from, trueUp)) / Math.hypot(...trueUp);
    this.flag.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    this.flag.style.visibility = "visible";
    this.flag.classList.toggle("left", x > 0.6 * width);
    this.flag.classList.toggle("behind", dot(normal, eye) < 0);
  }
}

// ---------------------------------------------------------------- all of them

function until(met) {
  return new Promise((resolve, reject) => {
    const began = performance.now();
    const look = () => {
      if (met()) resolve();
      else if (performance.now() - began > 60000) reject(new Error("the scene did not load"));
      else setTimeout(look, 20);
    };
    look();
  });
}

// vtk.js stands in the page as text and starts only where it can draw; it calls loadDataSet at its end.
function viewer() {
  return new Promise((resolve) => {
    window.global = window;
    window.loadDataSet = resolve;
    const script = document.createElement("script");
    script.type = "module";
    script.textContent = document.getElementById("viewer").textContent;
    document.head.append(script);
  });
}

async function start() {
  if (!hasWebGL()) return; // the pictures stay
  await viewer();
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
