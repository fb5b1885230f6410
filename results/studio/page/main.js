// Wiring: a moved slider goes out with a number, answers come back with it, older ones are left aside.

import { download, el, pick } from "./dom.js";
import { Figures } from "./figures.js";
import { Form } from "./form.js";
import { ask, Link } from "./link.js";
import { Measured } from "./measured.js";
import { Pins } from "./pins.js";
import { Stage } from "./stage.js";
import { differences, keep, kept, setAt, state } from "./state.js";
import { follow } from "./theme.js";
import { Work } from "./work.js";

const MB = 1e6;
const JSON_TYPE = "application/json";
const LOST = "Connection lost. Trying again; the design in this tab is kept.";
const REFUSED = "The server was restarted and does not know this browser yet: open the printed address in another tab. The design in this tab is kept.";
const notice = document.getElementById("notice");
const title = document.getElementById("name");
follow(document.getElementById("theme"));

const started = await ask("start");
const before = kept();
let opened = started;
if (before?.good) {
  try {
    opened = await ask("open", JSON.stringify(before.good), JSON_TYPE);
    Object.assign(state, { view: before.view, pinned: before.pinned });
  } catch {
    say("The design of this tab is no longer accepted; the design of the server is shown instead.");
  }
}

const figures = new Figures(document.getElementById("answers"), started.style);
const stage = new Stage(started.style, { view: state.view, chosen: (view) => { state.view = view; send(); } });
const form = new Form(document.getElementById("form"), { changed: send, broke, restructured: reopen });
const works = {};
for (const [kind, words, tip] of [
  ["solid", "Solve with holes (solid model)", "Tetrahedra, refined until the tolerance is met"],
  ["step", "STEP", "Both parts as CAD files"],
  ["report", "Report", "Full run with the solid model: report.pdf, and report.html with 3-D views"],
]) works[kind] = new Work({ kind, words, title: tip, start: startWork, stop: stopWork, done: (note, line) => finished(kind, note, line) });
const measured = new Measured(document.getElementById("measured"), started.largest_bytes.measured / MB, {
  upload: (file) => ask(`measured/${link.tab}`, file, "text/csv"), start: startWork, stop: stopWork, address });
works.diagnose = measured.work;
const pins = new Pins({ figures, changed: () => { keep(); figures.draw(); } });
figures.work.append(works.solid.button, works.solid.line, figures.agreement);
for (const kind of ["step", "report"]) {
  document.getElementById("made").append(el("span", {}, el("b", {}, works[kind].words), works[kind].line));
}
figures.root.append(pins.list);

document.getElementById("tools").append(
  ...started.style.kinds.map((kind) => el("button", { id: `new-${kind}`, onclick: () => open(`open?kind=${kind}`, "") }, `New ${kind}`)),
  el("button", { id: "load", onclick: () => pick(".toml", load) }, "Open"),
  el("button", { id: "save", onclick: save }, "Save"),
  works.step.button,
  el("button", { id: "png", disabled: !stage.draws, onclick: async () => download(await stage.png(), `${stem()}.png`, "image/png") }, "PNG"),
  works.report.button, pins.button);
for (const id of ["design", "measured"]) {
  document.getElementById(`tab-${id}`).addEventListener("click", () => {
    for (const other of ["design", "measured"]) {
      document.getElementById(other).hidden = other !== id;
      document.getElementById(`tab-${other}`).setAttribute("aria-selected", String(other === id));
    }
  });
}
title.addEventListener("input", () => { setAt(state.tables, ["name"], title.value); send(); });
for (const name of ["dragover", "drop"]) {
  document.getElementById("form").addEventListener(name, (event) => {
    event.preventDefault();
    if (name === "drop" && event.dataTransfer.files[0]) load(event.dataTransfer.files[0]);
  });
}

// In one column the answers come first, for the eye and for the Tab key.
const oneColumn = matchMedia("(max-width: 719px), (max-height: 559px)");
const place = () => document.querySelector("main")[oneColumn.matches ? "append" : "prepend"](form.root);
oneColumn.addEventListener("change", place);
place();

let coming = null;
let lostOnce = false;
adopt(opened);
const link = new Link({
  opened: () => {
    if (lostOnce) say("Connected again.", 3000);
    lostOnce = false;
    send();
  },
  lost: async () => {
    if (!lostOnce) say(LOST);
    lostOnce = true;
    ask("start").then(() => {}, ({ status }) => say(status === 403 ? REFUSED : LOST));
    state.number += 1; // what was under way is lost
    mark();
    for (const work of Object.values(works)) work.lost();
  },
  note: heard,
  bytes: (buffer) => stage.take(buffer, coming),
});

function adopt({ tables, form: groups }) {
  state.tables = tables;
  state.good = structuredClone(tables);
  title.value = tables.name;
  title.disabled = false;
  form.build(groups);
  keep();
}

function send() {
  state.number += 1;
  mark();
  link.say({ do: "want", number: state.number, tables: state.tables, view: state.view });
}

// Every figure and picture is grey unless it belongs to the present design.
function mark() {
  whatIsOld();
  pins.compare();
  figures.draw();
  stage.mark();
}

// A text that is no number: the present design has no figures.
function broke() {
  state.number += 1;
  state.broken = true;
  mark();
}

function heard(note) {
  if (note.is === "picture") coming = note;
  if (note.is === "progress") works[note.kind].progress(note.line);
  if (note.is === "ended") works[note.kind].ended(note);
  if (note.is === "refused") say(note.text);
  if (note.is === "answer") figures.show(note); // late ones too: while a slider moves, better than none
  if (note.number === state.number) heardOfThis(note);
  if (note.is === "answer" || note.is === "taken") pins.compare();
}

function heardOfThis(note) {
  if (note.is === "answer" && note.beyond) stage.passed(note.beyond);
  if (note.is === "fault" || note.is === "failed") {
    form.fault(note.key, note.text);
    if (note.question === "gear") figures.withoutGear(note);
    state.broken = note.is === "fault";
    mark();
    stage.working(false, state.broken ? "Shown: the last design that can be built." : "");
  }
  if (note.is === "taken") {
    form.clear();
    state.broken = false;
    state.goodNumber = note.number;
    notice.hidden = notice.hidden || notice.dataset.passing !== "yes";
    state.good = structuredClone(state.tables);
    keep();
    document.title = `${state.good.name} · flexspline studio`;
    stage.say(note.left_out, note.warnings, note.w0_mm);
    figures.agreement.replaceChildren(...note.agreement.split("`").map((text, i) => (i % 2 ? el("code", {}, text) : text)));
    works.solid.words = note.left_out.length ? "Solve with holes (solid model)" : "Solve with the solid model";
    if (!works.solid.running) works.solid.button.textContent = works.solid.words;
    stage.working(true);
    figures.show(note);
  }
}

function say(text, passing) {
  notice.textContent = text;
  notice.hidden = false;
  notice.dataset.passing = passing ? "yes" : "no";
  if (passing) setTimeout(() => { if (notice.textContent === text) notice.hidden = true; }, passing);
}

async function open(path, body, type) {
  try {
    adopt(await ask(path, body, type));
    notice.hidden = true;
    send();
  } catch (error) {
    say(error.message);
  }
}

function reopen(tables) {
  open("open", JSON.stringify(tables), JSON_TYPE);
}

function load(file) {
  const largest = started.largest_bytes.design;
  if (file.size > largest) return say(`${file.name}: ${file.size} bytes; a design file has at most ${largest / MB} MB`);
  open("open", file, "application/toml");
}

async function save() {
  try {
    download(await ask("text", JSON.stringify(state.tables), JSON_TYPE), `${stem()}.toml`, "application/toml");
  } catch (error) {
    form.fault(error.key, error.message);
  }
}

function stem() {
  return state.good.name.replace(/[^\p{L}\p{N}_-]+/gu, "-").replace(/^-+|-+$/g, "").slice(0, 60) || "design";
}

function startWork(kind) {
  const sent = link.say({ do: "job", kind, tables: state.tables });
  if (sent) works[kind].design = structuredClone(state.tables);
  return sent;
}

function stopWork(kind) {
  link.say({ do: "stop", kind });
}

function address(kind, name) {
  return `made/${link.tab}/${kind}/${name}`;
}

function finished(kind, note, line) {
  if (kind === "solid") {
    figures.solid = note.answer;
    line.textContent = `${note.solved.join("; ")}; ${note.wall_s.toFixed(1)} s`;
    whatIsOld();
    figures.draw();
    return;
  }
  const shown = note.files.filter((name) => /\.(pdf|html|step)$/.test(name));
  line.replaceChildren(...shown.map((name) => el("a", { href: address(kind, name), download: `${stem()}-${name}` }, name)));
}

// Answers of long work stay, marked, when the design has moved on.
function whatIsOld() {
  const moved = (kind) => works[kind].design && differences(works[kind].design, state.broken ? state.good : state.tables).length > 0;
  if (figures.solid) figures.solid.old = moved("solid");
  measured.old(Boolean(works.diagnose.design) && (state.broken || moved("diagnose")));
}
