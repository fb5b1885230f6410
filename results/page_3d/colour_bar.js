// The stress scale: `scale` holds its 256 colours from 0 up, three bytes each.

export function colourBar(scale) {
  const bar = Object.assign(document.createElement("canvas"), { width: 1, height: 256 });
  const pen = bar.getContext("2d");
  for (let i = 0; i < 256; i++) {
    pen.fillStyle = `rgb(${scale.slice(3 * i, 3 * i + 3).join()})`;
    pen.fillRect(0, 255 - i, 1, 1);
  }
  return bar;
}
