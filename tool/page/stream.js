// The connection to `sun2xp`: a WebSocket that is opened again when it ends. Messages are JSON (docs/monitor-web.md).

const RETRY_MS = 500;

/// If the page needs a token, the token is in the fragment of the address. Browsers send the fragment to no server.
export function token() {
  return new URLSearchParams(location.hash.slice(1)).get("token") ?? "";
}

export class Stream {
  /// `receivers` has a function for each type of message, and `link(connected, reason)`.
  constructor(receivers) {
    this.receivers = receivers;
    this.connect();
  }

  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const query = token() ? `?token=${encodeURIComponent(token())}` : "";
    this.socket = new WebSocket(`${scheme}://${location.host}/stream${query}`);
    this.socket.onmessage = (message) => this.receive(JSON.parse(message.data));
    this.socket.onopen = () => this.receivers.link(true, "");
    this.socket.onclose = () => {
      this.receivers.link(
        false,
        "sun2xp does not answer. Check that the command still runs, that the browser has the whole printed address, " +
          "and that few other pages of this command are open.",
      );
      setTimeout(() => this.connect(), RETRY_MS);
    };
  }

  receive(message) {
    // The server stops sending batches to a page that has not acknowledged 20 of them, the batches of one second. A
    // slow page therefore misses batches instead of showing them late.
    if (message.type === "batch") this.send({ received: message.number });
    this.receivers[message.type]?.(message);
  }

  /// Returns whether the connection is open. A message that is sent as the connection breaks may still be lost.
  send(message) {
    const open = this.socket.readyState === WebSocket.OPEN;
    if (open) this.socket.send(JSON.stringify(message));
    return open;
  }
}
