// The middle: the part in 3-D. It is drawn here, in the browser, so it turns without asking anybody.

import { OrbitControls } from "./OrbitControls.js";
import { creases, mover, revolved } from "./shape.js";
import * as THREE from "./three.module.min.js";

const STEEL = 0xaeb7bf;

export class View {
  constructor(root, style) {
    this.root = root;
    this.options = { open: false, deformed: true };
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    root.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera, new THREE.HemisphereLight(0xffffff, 0xb9c0c8, 1.9));
    const key = new THREE.DirectionalLight(0xffffff, 1.5);
    key.position.set(-0.6, 0.8, 1);
    this.camera.add(key);
    const scale = new Uint8Array(1024).map((_, i) => (i % 4 === 3 ? 255 : style.scale[3 * (i >> 2) + (i % 4)]));
    const map = new THREE.DataTexture(scale, 256, 1);
    Object.assign(map, { colorSpace: THREE.SRGBColorSpace, magFilter: THREE.LinearFilter, needsUpdate: true });
    const side = THREE.DoubleSide;
    const back = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    this.coloured = new THREE.MeshLambertMaterial({ map, side, ...back });
    this.plain = new THREE.MeshLambertMaterial({ color: STEEL, side, ...back });
    this.part = new THREE.Mesh(new THREE.BufferGeometry(), this.plain);
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x1f2429, transparent: true, opacity: 0.55 }));
    this.mark = new THREE.Mesh(new THREE.SphereGeometry(1, 20, 14), new THREE.MeshBasicMaterial({ color: style.accent }));
    this.mark.visible = false;
    this.scene.add(this.part, this.lines, this.mark);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    Object.assign(this.controls, { enableDamping: true, dampingFactor: 0.12 });
    this.controls.addEventListener("change", () => (this.due = true));
    new ResizeObserver(() => this.resize()).observe(root);
    this.renderer.setAnimationLoop(() => this.step());
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
    const mesh = revolved(this.shape, this.options);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(mesh.position, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(mesh.normal, 3));
    geometry.setAttribute("uv", new THREE.BufferAttribute(mesh.uv, 2));
    geometry.setIndex(new THREE.BufferAttribute(mesh.index, 1));
    this.part.geometry.dispose();
    this.part.geometry = geometry;
    this.part.material = this.shape.direct ? this.coloured : this.plain;
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry();
    this.lines.geometry.setAttribute("position", new THREE.BufferAttribute(creases(this.shape, this.options), 3));
    this.markPeak();
    this.due = true;
  }

  // A dot at the peak, moved along with the node next to it.
  markPeak() {
    const { peak_at_mm: at, places } = this.shape;
    this.mark.visible = Boolean(at);
    if (!at) return;
    const [r, z] = [Math.hypot(at[0], at[1]), at[2]];
    let near = 0;
    for (let i = 0, best = Infinity; i < places.length / 2; i++) {
      const apart = (places[2 * i] - r) ** 2 + (places[2 * i + 1] - z) ** 2;
      if (apart < best) [best, near] = [apart, i];
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
    const d = this.framed;
    this.controls.target.set(0, 0, this.middle);
    this.camera.position.set(0.45 * d, -1.1 * d, this.middle + 0.85 * d);
    this.camera.zoom = 1;
    this.resize();
    this.controls.update();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    const half = (this.framed ?? 50) * 0.56;
    const [x, y] = width > height ? [(half * width) / height, half] : [half, (half * height) / width];
    Object.assign(this.camera, { left: -x, right: x, top: y, bottom: -y, near: -20 * half, far: 20 * half });
    this.camera.updateProjectionMatrix();
    this.due = true;
  }

  step() {
    this.controls.update();
    if (!this.due) return;
    this.due = false;
    this.renderer.render(this.scene, this.camera);
  }

  picture() {
    this.renderer.render(this.scene, this.camera);
    return this.renderer.domElement;
  }
}
