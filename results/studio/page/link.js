// The connection to the server: it comes back by itself, and says when it is away.

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 3000;

export class Link {
  constructor({ opened, lost, note, bytes }) {
    this.told = { opened, lost, note, bytes };
    this.wait = FIRST_WAIT_MS;
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) return this.told.bytes(data);
      const note = JSON.parse(data);
      if (note.is === "hello") {
        this.wait = FIRST_WAIT_MS;
        this.tab = note.tab;
        this.told.opened();
      } else this.told.note(note);
    };
    socket.onclose = () => {
      this.tab = null;
      this.told.lost();
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
    };
    this.socket = socket;
  }

  get isOpen() {
    return this.socket.readyState === WebSocket.OPEN && this.tab !== null;
  }

  say(note) {
    if (this.isOpen) this.socket.send(JSON.stringify(note));
    return this.isOpen;
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
