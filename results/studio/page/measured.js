// The tab for measured data: drop a CSV in, read what the simulation gets wrong.

import { el, pick } from "./dom.js";
import { Work } from "./work.js";

const KINDS = [
  ["Torque sweep", "torque_Nm, angle_arcsec", "unit, cycle, time_s, temperature_C, input_angle_deg",
    "friction, hardening, clearance, drift, wear, creep, lag, errors of position"],
  ["End points", "unit, torque_Nm, angle_plus_arcsec, angle_minus_arcsec", "", "which units lie beyond the prediction, and possible causes"],
  ["Specimens", "specimen, stiffness_Nm_per_rad", "stiffness_std_Nm_per_rad, part, any design key",
    "material, a dimension that differs from the drawing, where the load enters"],
];

function guide() {
  const names = (text) => text.split(", ").flatMap((name, i) => [i ? ", " : "", name.includes(" ") ? name : el("code", {}, name)]);
  const heads = ["Measurement", "Columns", "Optional", "Can show"];
  return el("section", { id: "guide" }, el("h3", {}, "Columns of the file"),
    el("table", { class: "causes" }, el("thead", {}, el("tr", {}, ...heads.map((head) => el("th", {}, head)))),
      el("tbody", {}, ...KINDS.map(([kind, needed, optional, shows]) => el("tr", {}, el("td", {}, kind),
        el("td", {}, ...names(needed)), el("td", {}, ...(optional ? names(optional) : [])), el("td", {}, shows))))),
    el("p", { class: "limit" }, "Other units by suffix: _Nmm, _arcmin, _deg, _mrad, _rad, _K, _min, _h. Lines beginning with # are comments."));
}

export class Measured {
  // largestMB: of a file. upload(file): sends the bytes; start, stop as for any work; address(name): of a file that was made.
  constructor(root, largestMB, { upload, start, stop, address }) {
    Object.assign(this, { root, largestMB, upload, address });
    this.work = new Work({ kind: "diagnose", words: "Diagnose again", title: "With the present design",
      start, stop, done: (note) => this.show(note), said: (text) => text.replaceAll("measured.csv", this.file?.name ?? "") });
    this.work.button.hidden = true;
    this.name = el("span", { class: "limit" });
    const zone = el("div", { id: "drop" },
      el("p", {}, "Drop a CSV of measured data here, or ", el("button", { class: "small", onclick: () => pick(".csv,text/csv", (f) => this.take(f)) }, "choose a file")),
      el("p", { class: "limit" }, `Torque sweep, end points or specimens; at most ${largestMB} MB. Compared with the design on the left.`),
      el("p", {}, this.name, " ", this.work.button, " ", this.work.line));
    this.fault = el("p", { class: "fault", role: "alert", hidden: true, id: "measured-fault" });
    this.findings = el("div", { id: "findings" }, guide());
    this.told = false;
    root.append(zone, this.fault, this.findings);
    for (const name of ["dragover", "dragleave", "drop"]) {
      zone.addEventListener(name, (event) => {
        event.preventDefault();
        zone.classList.toggle("over", name === "dragover");
        if (name === "drop" && event.dataTransfer.files[0]) this.take(event.dataTransfer.files[0]);
      });
    }
  }

  async take(file) {
    this.refuse("");
    if (file.size > this.largestMB * 1e6) return this.refuse(`${file.name}: larger than ${this.largestMB} MB`);
    try {
      await this.upload(file);
    } catch (error) {
      return this.refuse(`${file.name}: ${error.message}`);
    }
    this.clear();
    this.file = file;
    this.name.textContent = file.name;
    this.work.button.hidden = false;
    this.work.begin();
  }

  refuse(text) {
    this.fault.textContent = text;
    this.fault.hidden = !text;
  }

  // Another file is diagnosed: nothing of the one before it stays below its name.
  clear() {
    this.told = false;
    this.findings.classList.remove("stale");
    this.findings.replaceChildren(guide());
  }

  // The design has moved on since: what stands here is of an earlier one.
  old(is) {
    this.findings.classList.toggle("stale", this.told && is);
  }

  show({ diagnosis: d, files }) {
    this.told = true;
    this.findings.classList.remove("stale");
    const list = (title, entries) => (entries.length ? [el("h3", {}, title), el("ul", {}, ...entries.map((line) => el("li", {}, line)))] : []);
    const causes = d.causes.map((c) => el("tr", {}, el("td", {}, c.title), el("td", { class: "value" }, c.magnitude),
      el("td", {}, c.sure), el("td", {}, c.others || "")));
    const heads = ["Cause", "Magnitude", "Confidence", d.causes.some((c) => c.others) ? "Not distinguished from" : ""];
    const keep = files.filter((name) => !name.endsWith(".png"));
    this.findings.replaceChildren(
      el("h2", { id: "verdict" }, d.verdict),
      el("p", {}, d.summary),
      d.causes.length ? el("table", { class: "causes" },
        el("thead", {}, el("tr", {}, ...heads.map((h) => el("th", {}, h)))),
        el("tbody", {}, ...causes)) : "",
      ...list("Unexplained", d.unexplained),
      d.gain ? el("p", {}, d.gain) : "",
      ...(d.next ? [el("h3", {}, "Measure next"), el("p", { id: "next" }, `${d.next[0]}: ${d.next[1]}`)] : []),
      ...list("Notes", d.notes),
      el("p", { class: "files" }, "Download: ", ...keep.map((name) => el("a", { href: this.address("diagnose", name), download: name }, name))),
      el("div", { class: "figures" }, ...files.filter((name) => name.endsWith(".png")).map((name) =>
        el("img", { src: `${this.address("diagnose", name)}?${Date.now()}`, alt: name.replace(".png", "").replaceAll("_", " ") }))));
  }
}
