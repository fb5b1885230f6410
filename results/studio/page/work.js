// Long work: a button starts it, its lines are shown while it runs, and it can be stopped.

import { el } from "./dom.js";

export class Work {
  // start, stop: to the server. done(note): it ended well. said(text): its words, as they are shown.
  constructor({ kind, words, title, start, stop, done, said = (text) => text }) {
    Object.assign(this, { kind, words, start, stop, done, said, running: false });
    this.button = el("button", { id: `work-${kind}`, title, onclick: () => (this.running ? this.halt() : this.begin()) }, words);
    this.line = el("span", { class: "progress", role: "status", id: `progress-${kind}` });
  }

  begin() {
    if (!this.start(this.kind)) return;
    this.running = true;
    this.button.textContent = this.kind === "solid" || this.kind === "diagnose" ? "Stop" : `Stop ${this.words}`;
    this.button.classList.add("running");
    this.line.className = "progress";
    this.text = "starting…";
    this.began = Date.now();
    clearInterval(this.clock);
    this.clock = setInterval(() => this.tell(), 1000);
    this.tell();
  }

  halt() {
    this.text = "stopping…";
    this.tell();
    this.stop(this.kind);
  }

  progress(text) {
    this.text = this.said(text.replace(/^\[[^\]]*\]\s*/, ""));
    this.tell();
  }

  // The command's own stamps stand still between its lines; this clock does not.
  tell() {
    if (this.running) this.line.textContent = `${Math.round((Date.now() - this.began) / 1000)} s · ${this.text}`;
  }

  ended(note) {
    this.running = false;
    clearInterval(this.clock);
    this.button.textContent = this.words;
    this.button.classList.remove("running");
    this.line.className = note.state === "failed" ? "progress fault" : "progress";
    this.line.textContent = note.state === "done" ? "" : this.said(note.text);
    this.line.title = this.line.textContent;
    if (note.state === "done") this.done(note, this.line);
  }

  lost() {
    if (this.running) this.ended({ state: "failed", text: "the connection was lost; start it again" });
  }
}
