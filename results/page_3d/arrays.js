// Arrays from bytes, as results/page_3d/arrays.py packs them: a head, then what it lists.

const KINDS = { float32: Float32Array, uint32: Uint32Array, uint16: Uint16Array };

export function unpacked(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let at = 4 + length;
  for (const [name, kind, shape] of head.arrays) {
    const count = shape.reduce((a, b) => a * b, 1);
    head[name] = new KINDS[kind](buffer, at, count);
    at += 4 * Math.ceil(head[name].byteLength / 4);
  }
  return head;
}
