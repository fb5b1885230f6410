// The middle: the part in 3-D. The browser draws it, so turning needs no request.

import { PartScene } from "./part_scene.js";
import { creases, mover, revolved } from "./shape.js";

const EYE = [0.45, -1.1, 0.85];

export class View extends PartScene {
  constructor(root, style) {
    super(root, style.scale);
    this.options = { open: false, deformed: true };
    this.edge = this.lineOf(style.ink, 0.55);
    this.plain = this.matt({ color: style.steel });
    this.mark = this.addDot(style.accent);
    this.mark.visible = false;
  }

  // A field or a bare profile; the camera keeps its place unless the size has changed much.
  show(shape) {
    this.shape = shape;
    this.rebuild();
    const size = this.size();
    if (!this.framed || size / this.framed > 1.3 || size / this.framed < 0.77) this.reset();
  }

  set(options) {
    Object.assign(this.options, options);
    if (this.shape) this.rebuild();
  }

  rebuild() {
    for (const former of [this.part, this.lines]) if (former) this.remove(former);
    this.part = this.addSurface(revolved(this.shape, this.options), this.shape.direct ? this.coloured : this.plain);
    this.lines = this.addLines({ position: creases(this.shape, this.options) }, this.edge);
    this.markPeak();
  }

  // A dot at the peak, moved along with the node next to it.
  markPeak() {
    const { peak_at_mm: at, places } = this.shape;
    this.mark.visible = Boolean(at);
    if (!at) return;
    const [r, z] = [Math.hypot(at[0], at[1]), at[2]];
    let near = 0;
    for (let i = 0, best = Infinity; i < places.length / 2; i++) {
      const distance = (places[2 * i] - r) ** 2 + (places[2 * i + 1] - z) ** 2;
      if (distance < best) [best, near] = [distance, i];
    }
    const out = [0, 0, 0];
    const angle = Math.atan2(at[1], at[0]);
    mover(this.shape, this.options.deformed ? this.shape.magnification : 0)(angle).place(near, out, 0);
    this.mark.position.set(...out);
    this.mark.scale.setScalar(this.size() * 0.008);
  }

  size() {
    let r = 0;
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < this.shape.places.length; i += 2) {
      r = Math.max(r, this.shape.places[i]);
      low = Math.min(low, this.shape.places[i + 1]);
      high = Math.max(high, this.shape.places[i + 1]);
    }
    this.middle = (low + high) / 2;
    return Math.hypot(2 * r, high - low);
  }

  reset() {
    this.framed = this.size();
    this.look({ centre: [0, 0, this.middle], eye: EYE, half: 0.56 * this.framed });
  }

  picture() {
    this.drawNow();
    return this.renderer.domElement;
  }
}
