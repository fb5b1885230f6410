// The design of this tab. It lives here, not in the server: a reload or a new server finds it again.

const KEPT = "flexspline-design";

export const state = {
  tables: null, // as sent; may be refused
  good: null, // the last that was accepted
  view: "wave_generator",
  number: 0, // of the present design: it grows with every change
  goodNumber: 0, // of `good`
  broken: false, // the present design cannot be built
  pinned: null, // { tables, answer }
};

export function valueAt(tables, at) {
  return at.reduce((table, key) => (table === undefined ? undefined : table[key]), tables);
}

export function setAt(tables, at, value) {
  const table = valueAt(tables, at.slice(0, -1));
  const key = at[at.length - 1];
  if (value === undefined) delete table[key];
  else table[key] = value;
}

export function keep() {
  const kept = { good: state.good, view: state.view, pinned: state.pinned };
  sessionStorage.setItem(KEPT, JSON.stringify(kept));
}

export function kept() {
  try {
    return JSON.parse(sessionStorage.getItem(KEPT));
  } catch {
    return null;
  }
}

// Dotted keys whose values differ between two designs, with both values.
export function differences(before, after, path = "") {
  if (typeof before !== "object" || typeof after !== "object" || !before || !after) {
    return before === after ? [] : [{ key: path, before, after }];
  }
  const keys = new Set([...Object.keys(before), ...Object.keys(after)]);
  return [...keys].flatMap((key) => {
    const inner = Array.isArray(before) ? `${path}[${key}]` : path ? `${path}.${key}` : key;
    return differences(before[key], after[key], inner);
  });
}
