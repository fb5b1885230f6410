// The connection to the server: it comes back by itself, and says when it is away.

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;
const SILENCE_MS = 15000; // every design is answered at once; after a sleep of the machine no answer and no error comes

export class Link {
  constructor({ opened, lost, note, bytes }) {
    this.told = { opened, lost, note, bytes };
    this.wait = FIRST_WAIT_MS;
    this.connect();
    addEventListener("online", () => this.isOpen || this.connect());
  }

  connect() {
    clearTimeout(this.later);
    if (this.socket) this.socket.onclose = this.socket.onmessage = null;
    this.socket?.close();
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) return this.told.bytes(data);
      const note = JSON.parse(data);
      if (note.number >= this.asked) clearTimeout(this.silence);
      if (note.is === "hello") {
        this.wait = FIRST_WAIT_MS;
        this.tab = note.tab;
        this.told.opened();
      } else this.told.note(note);
    };
    socket.onclose = () => this.lost();
    this.socket = socket;
    this.tab = null;
  }

  lost() {
    this.tab = null;
    clearTimeout(this.silence);
    this.told.lost();
    this.later = setTimeout(() => this.connect(), this.wait);
    this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
  }

  get isOpen() {
    return this.socket.readyState === WebSocket.OPEN && this.tab !== null;
  }

  say(note) {
    if (!this.isOpen) return false;
    this.socket.send(JSON.stringify(note));
    if (note.do === "want") {
      this.asked = note.number;
      clearTimeout(this.silence);
      this.silence = setTimeout(() => this.lost(), SILENCE_MS);
    }
    return true;
  }
}

// A request for JSON or text; a refusal is thrown with the server's own words.
export async function ask(path, body, type) {
  const options = body === undefined ? {} : { method: "POST", body, headers: { "Content-Type": type } };
  const reply = await fetch(path, options);
  const isJson = (reply.headers.get("Content-Type") || "").startsWith("application/json");
  const value = isJson ? await reply.json() : await reply.text();
  if (reply.ok) return value;
  throw Object.assign(new Error(isJson ? value.text : value.trim()), { key: isJson ? value.key : "", status: reply.status });
}
