// One WebSocket to the server of this page, opened again whenever it breaks.

const FIRST_WAIT = 0.5; // s
const LONGEST_WAIT = 10; // s
const ENDED_WAIT = 30; // s, after the program ended: perhaps no other one ever starts
const ENDED_CODE = 1001; // close code (protocol/page.md)
const IDLE_LIMIT = 6; // s without a message, though one comes at least every second: the connection is dead
const TOKEN_KEY = "solepath-token";

// What the page says of the program behind it.
export const WORDS = {
  starting: "Connecting to solepath",
  startHelp: "",
  failed: "Not connected",
  whyClosed: "solepath cannot be reached",
  whyEnded: "solepath has ended",
  lost: "The connection to solepath is lost",
  again: "Connected again",
  retry: "Try now",
  finishes: true, // with the program the session has ended
  watchOnly: "This page may watch only. To report where you are, open the whole address that solepath printed: it holds the key.",
};

export class Connection {
  #socket = null;
  #failures = 0;
  #ended = false;
  #timer = 0;
  #idleTicks = 0;
  #token = claimToken();

  // take(message), changed(state, s until the next try); state is "connecting" | "open" | "closed" | "ended"
  constructor(take, changed) {
    Object.assign(this, { take, changed });
    // It counts ticks, not time: after the page slept, its messages are still queued behind the timer.
    setInterval(() => this.#listen(), 1000);
    addEventListener("online", () => this.retry());
    document.addEventListener("visibilitychange", () => document.hidden || this.retry());
    this.#open();
  }

  // Returns false while there is no connection: then nothing is sent.
  send(command) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(command));
    return true;
  }

  // Tries now, instead of at the end of the wait.
  retry() {
    if (this.#socket === null) this.#open();
  }

  #open() {
    clearTimeout(this.#timer);
    const address = new URL("ws", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    if (this.#token) address.searchParams.set("token", this.#token);
    this.changed("connecting", 0);
    const socket = new WebSocket(address);
    this.#socket = socket;
    this.#idleTicks = 0;
    socket.onmessage = ({ data }) => {
      this.#idleTicks = this.#failures = 0;
      this.#ended = false;
      this.take(JSON.parse(data));
    };
    socket.onopen = () => this.changed("open", 0);
    socket.onclose = ({ code }) => this.#closed(socket, code);
  }

  #closed(socket, code) {
    if (socket !== this.#socket) return;
    this.#socket = null;
    this.#failures += 1;
    this.#ended ||= code === ENDED_CODE;
    const wait = this.#ended ? ENDED_WAIT : Math.min(LONGEST_WAIT, FIRST_WAIT * 2 ** (this.#failures - 1));
    const spread = wait * (0.8 + 0.4 * Math.random());
    this.#timer = setTimeout(() => this.#open(), 1000 * spread);
    this.changed(this.#ended ? "ended" : "closed", spread);
  }

  #listen() {
    if (this.#socket === null) return;
    this.#idleTicks += 1;
    if (this.#idleTicks < IDLE_LIMIT) return;
    const dead = this.#socket;
    dead.close();
    this.#closed(dead);
  }
}

// The token of the address (#token=...), which is removed from the address, or else the token stored in this tab.
function claimToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get("token");
  try {
    if (given) sessionStorage.setItem(TOKEN_KEY, given);
    if (location.hash) history.replaceState(null, "", location.pathname + location.search);
    return given ?? sessionStorage.getItem(TOKEN_KEY);
  } catch {
    return given; // storage may be forbidden
  }
}
