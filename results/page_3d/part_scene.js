// A part in 3-D as both pages show it: light, colours, parallel projection, turning by mouse, finger and key.

import { OrbitControls } from "./OrbitControls.js";
import * as THREE from "./three.module.min.js";

const HALF_OF_FULL = 0.5 * Math.PI; // half of what shows a matt surface in its own colour
const STEEPEST = Math.PI / 2 - 1e-3; // at the pole "up" has no direction
const BACK = { side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }; // or it would swallow lines on it

export class PartScene {
  // `scale`: the 256 colours of stress, three bytes each.
  constructor(root, scale) {
    this.root = root;
    this.half = 50;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    root.prepend(this.renderer.domElement);
    this.camera = new THREE.OrthographicCamera();
    this.camera.up.set(0, 0, 1);
    const lamp = new THREE.DirectionalLight(0xffffff, HALF_OF_FULL); // at the eye: what faces it has its colour in the scale
    lamp.position.set(0, 0, 1);
    this.camera.add(lamp, lamp.target);
    this.scene = new THREE.Scene();
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, HALF_OF_FULL));
    this.coloured = this.matt({ map: texture(scale) });
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    Object.assign(this.controls, { enableDamping: true, dampingFactor: 0.12 });
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.resize()).observe(root);
  }

  // Triangles with their place (0 to 1) on the colour scale; without normals, their own.
  addSurface({ position, along, index, normal }, material = this.coloured) {
    const shape = geometry(position, index);
    if (normal) shape.setAttribute("normal", new THREE.BufferAttribute(normal, 3));
    else shape.computeVertexNormals();
    shape.setAttribute("uv", new THREE.BufferAttribute(along, 2));
    return this.add(new THREE.Mesh(shape, material));
  }

  // Pairs of points as lines, drawn as `lineOf` says.
  addLines({ position, index }, line) {
    return this.add(new THREE.LineSegments(geometry(position, index), line));
  }

  matt(settings) {
    return new THREE.MeshLambertMaterial({ ...settings, ...BACK });
  }

  lineOf(color, opacity = 1) {
    return new THREE.LineBasicMaterial({ color, opacity, transparent: opacity < 1 });
  }

  addDot(color) {
    return this.add(new THREE.Mesh(new THREE.SphereGeometry(1, 20, 14), new THREE.MeshBasicMaterial({ color })));
  }

  add(thing) {
    this.scene.add(thing);
    this.draw();
    return thing;
  }

  remove(thing) {
    this.scene.remove(thing);
    thing.geometry.dispose();
  }

  // From the direction of `eye`, so that a ball of radius `half` about `centre` fits the picture.
  look({ centre, eye, half }) {
    this.controls.enableDamping = false;
    this.controls.update(); // what a drag has left to turn ends here
    this.controls.enableDamping = true;
    this.half = half;
    this.controls.target.set(...centre);
    this.camera.position.set(...eye).setLength(5 * half).add(this.controls.target);
    this.camera.zoom = 1;
    this.controls.update();
    this.resize();
  }

  // Degrees about the part's axis and towards its top.
  turn(about, up) {
    const away = this.camera.position.clone().sub(this.controls.target);
    const far = away.length();
    const a = Math.atan2(away.y, away.x) + (about * Math.PI) / 180;
    const e = Math.asin(away.z / far) + (up * Math.PI) / 180;
    const b = Math.max(-STEEPEST, Math.min(STEEPEST, e));
    away.set(Math.cos(a) * Math.cos(b), Math.sin(a) * Math.cos(b), Math.sin(b));
    this.camera.position.copy(this.controls.target).addScaledVector(away, far);
    this.controls.update();
  }

  zoomBy(factor) {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (!width || !height) return;
    const half = this.half / Math.min(width, height);
    const [x, y] = [half * width, half * height];
    Object.assign(this.camera, { left: -x, right: x, top: y, bottom: -y, near: -20 * this.half, far: 20 * this.half });
    this.camera.updateProjectionMatrix();
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(width, height);
    this.drawNow(); // the new canvas is empty
  }

  // Soon: once for all that changes until the next frame.
  draw() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.controls.update(); // a drag that dies away asks for the next frame
      this.drawNow();
    });
  }

  drawNow() {
    this.renderer.render(this.scene, this.camera);
    this.drawn?.();
  }

  // Pixels from the top left of a point in mm.
  pixel(point) {
    const { x, y } = new THREE.Vector3(...point).project(this.camera);
    return [((1 + x) / 2) * this.root.clientWidth, ((1 - y) / 2) * this.root.clientHeight];
  }

  // Whether a surface of this normal looks towards the eye.
  faces(normal) {
    return this.camera.getWorldDirection(new THREE.Vector3()).dot(new THREE.Vector3(...normal)) <= 0;
  }
}

function geometry(position, index) {
  const made = new THREE.BufferGeometry();
  made.setAttribute("position", new THREE.BufferAttribute(position, 3));
  if (index) made.setIndex(new THREE.BufferAttribute(index, 1));
  return made;
}

function texture(scale) {
  const colours = new Uint8Array(1024).map((_, i) => (i % 4 === 3 ? 255 : scale[3 * (i >> 2) + (i % 4)]));
  const made = new THREE.DataTexture(colours, 256, 1);
  return Object.assign(made, { colorSpace: THREE.SRGBColorSpace, magFilter: THREE.LinearFilter, needsUpdate: true });
}
