// From a meridian to the surface of revolution: places, normals and the stress as a texture coordinate.

const AROUND = 144; // steps about the axis
const SMOOTH = Math.cos((35 * Math.PI) / 180); // flatter corners of the meridian are shaded as round
const OPEN = (3 * Math.PI) / 2; // cut open: a quarter is taken away

// Positions, normals, place on the colour scale, and triangles; `open` leaves a quarter out and closes the cut.
export function revolved(shape, { open, deformed }) {
  const steps = open ? (AROUND * 3) / 4 : AROUND;
  const full = open ? OPEN : 2 * Math.PI;
  const rim = shape.rim;
  const edges = rim.length / 2;
  const normals = edgeNormals(shape, edges);
  const caps = open && shape.triangles ? shape.places.length / 2 : 0;
  const vertices = 2 * edges * (steps + 1) + 2 * caps;
  const out = new Mesh(vertices, 6 * edges * steps + (caps ? 2 * shape.triangles.length : 0));
  const moved = mover(shape, deformed ? shape.magnification ?? 0 : 0);
  for (let s = 0; s <= steps; s++) {
    const angle = (full * s) / steps;
    const at = moved(angle);
    for (let e = 0; e < edges; e++) {
      for (let end = 0; end < 2; end++) out.add(at, rim[2 * e + end], normals[4 * e + 2 * end], normals[4 * e + 2 * end + 1], 0);
    }
  }
  const row = 2 * edges;
  for (let s = 0; s < steps; s++) {
    for (let e = 0; e < edges; e++) {
      const a = s * row + 2 * e;
      out.triangle(a, a + row, a + 1); // counter-clockwise from outside: WebGL turns the normals of the others round
      out.triangle(a + 1, a + row, a + row + 1);
    }
  }
  if (caps) {
    for (const [angle, side] of [[0, -1], [OPEN, 1]]) {
      const first = out.count;
      const at = moved(angle);
      for (let i = 0; i < caps; i++) out.add(at, i, 0, 0, side);
      for (let t = 0; t < shape.triangles.length; t += 3) {
        const [a, b, c] = shape.triangles.subarray(t, t + 3);
        out.triangle(first + a, first + (side < 0 ? b : c), first + (side < 0 ? c : b));
      }
    }
  }
  return out;
}

class Mesh {
  constructor(vertices, indices) {
    this.position = new Float32Array(3 * vertices);
    this.normal = new Float32Array(3 * vertices);
    this.along = new Float32Array(2 * vertices);
    this.index = new Uint32Array(indices);
    this.count = 0;
    this.filled = 0;
  }

  // Normal in the meridian plane (nr, nz), or across it (side).
  add(at, node, nr, nz, side) {
    const i = this.count++;
    at.place(node, this.position, 3 * i);
    const { cos, sin } = at;
    this.normal[3 * i] = nr * cos - side * sin;
    this.normal[3 * i + 1] = nr * sin + side * cos;
    this.normal[3 * i + 2] = nz;
    this.along[2 * i] = at.stress(node);
    this.along[2 * i + 1] = 0.5;
  }

  triangle(a, b, c) {
    this.index[this.filled++] = a;
    this.index[this.filled++] = b;
    this.index[this.filled++] = c;
  }
}

// u_r = U cos nφ, u_θ = V sin nφ (n = 0: V), u_z = W cos nφ; von Mises² = direct cos² nφ + shear sin² nφ.
export function mover(shape, factor) {
  const { places, displacement: u, direct, shear, n = 0, peak_MPa: peak } = shape;
  return (angle) => {
    const cos = Math.cos(angle);
    const sin = Math.sin(angle);
    const along = Math.cos(n * angle);
    const across = n ? Math.sin(n * angle) : 1;
    return {
      cos,
      sin,
      place(i, into, at) {
        const r = places[2 * i] + (u ? factor * u[3 * i] * along : 0);
        const v = u && n ? factor * u[3 * i + 1] * across : 0;
        into[at] = r * cos - v * sin;
        into[at + 1] = r * sin + v * cos;
        into[at + 2] = places[2 * i + 1] + (u ? factor * u[3 * i + 2] * along : 0);
      },
      stress(i) {
        if (!direct) return 0;
        const square = n ? direct[i] * along ** 2 + shear[i] * across ** 2 : direct[i];
        return Math.min(Math.sqrt(square) / peak, 1);
      },
    };
  };
}

// (nr, nz) at both ends of each rim edge, outward: the mean of neighbours where the corner is flat.
function edgeNormals({ places, rim }, edges) {
  const flat = new Float32Array(2 * edges);
  const meets = new Map();
  for (let e = 0; e < edges; e++) {
    const [a, b] = [rim[2 * e], rim[2 * e + 1]];
    const dr = places[2 * b] - places[2 * a];
    const dz = places[2 * b + 1] - places[2 * a + 1];
    const length = Math.hypot(dr, dz) || 1;
    flat[2 * e] = dz / length;
    flat[2 * e + 1] = -dr / length;
    for (const node of [a, b]) meets.set(node, [...(meets.get(node) ?? []), e]);
  }
  const out = new Float32Array(4 * edges);
  for (let e = 0; e < edges; e++) {
    for (let end = 0; end < 2; end++) {
      let [nr, nz] = [flat[2 * e], flat[2 * e + 1]];
      for (const other of meets.get(rim[2 * e + end])) {
        const turn = flat[2 * other] * flat[2 * e] + flat[2 * other + 1] * flat[2 * e + 1];
        if (other !== e && turn > SMOOTH) {
          nr += flat[2 * other];
          nz += flat[2 * other + 1];
        }
      }
      const length = Math.hypot(nr, nz) || 1;
      out[4 * e + 2 * end] = nr / length;
      out[4 * e + 2 * end + 1] = nz / length;
    }
  }
  return out;
}

// Circles at the meridian's sharp corners, as pairs of points.
export function creases(shape, { open, deformed }) {
  const { places, rim } = shape;
  const turns = new Map();
  for (let e = 0; e < rim.length; e += 2) {
    const [a, b] = [rim[e], rim[e + 1]];
    const d = [places[2 * b] - places[2 * a], places[2 * b + 1] - places[2 * a + 1]];
    const length = Math.hypot(...d) || 1;
    for (const node of [a, b]) turns.set(node, [...(turns.get(node) ?? []), d.map((x) => x / length)]);
  }
  const sharp = [...turns].filter(([, [p, q]]) => q && p[0] * q[0] + p[1] * q[1] < SMOOTH).map(([node]) => node);
  const moved = mover(shape, deformed ? shape.magnification ?? 0 : 0);
  const steps = open ? (AROUND * 3) / 4 : AROUND;
  const out = new Float32Array(6 * steps * sharp.length);
  for (let s = 0, at = 0; s < steps; s++) {
    for (const step of [s, s + 1]) {
      const ring = moved((((open ? OPEN : 2 * Math.PI) * step) / steps));
      sharp.forEach((node, k) => ring.place(node, out, at + 6 * k + (step === s ? 0 : 3)));
    }
    at += 6 * sharp.length;
  }
  return out;
}
