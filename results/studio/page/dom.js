// Building the page: text enters as text only, so a design's name shows as its letters.

export function el(tag, props = {}, ...children) {
  return filled(document.createElement(tag), props, children);
}

export function svg(tag, props = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", tag), props, children);
}

function filled(node, props, children) {
  for (const [key, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else if (key === "value" || key === "disabled" || key === "hidden") node[key] = value;
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

// A symbol as the tables write it, "K_b,lobes": letter, then index.
export function symbol(text) {
  const [letter, index] = text.split("_");
  return el("span", { class: "symbol" }, el("i", {}, letter), index ? el("sub", {}, index) : null);
}

// Fixed decimals, true minus, groups of three from five digits on: as the report prints numbers.
export function grouped(value, decimals) {
  const [whole, rest] = Math.abs(value).toFixed(decimals).split(".");
  const spaced = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  const sign = value < 0 && Number(Math.abs(value).toFixed(decimals)) > 0 ? "\u2212" : "";
  return sign + spaced + (rest ? `.${rest}` : "");
}

// A difference, with its sign unless it prints as 0.
export function signed(change, decimals) {
  return (change > 0 && Number(change.toFixed(decimals)) > 0 ? "+" : "") + grouped(change, decimals);
}

export function download(data, name, type) {
  const address = URL.createObjectURL(new Blob([data], { type }));
  el("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

export function pick(accept, take) {
  const input = el("input", { type: "file", accept, hidden: true, id: "picker" });
  document.getElementById("picker")?.remove();
  input.addEventListener("change", () => input.files[0] && take(input.files[0]));
  document.body.append(input);
  input.click();
}
