// One worker and what it draws. Whoever asks for another picture does not wait for the last one: a worker that does not listen is
// replaced.

/** Milliseconds after which a worker that draws something older is replaced: in a coarse picture, and in a fine one. */
const PATIENCE = { coarse: 2500, fine: 150 };

export class Painter {
  #module;
  #worker;
  #ready = false;
  #id = 0;
  #phase = "idle";
  #waiting = null;
  #impatience = 0;
  #handlers;

  /** `module` is the compiled heart; `handlers` are functions by the type of a worker's message. */
  constructor(module, handlers) {
    this.#module = module;
    this.#handlers = handlers;
    this.#start();
  }

  #start() {
    this.#ready = false;
    this.#phase = "idle";
    this.#worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
    const worker = this.#worker;
    worker.onmessage = ({ data }) => worker === this.#worker && this.#hear(data);
    worker.onerror = (event) => this.#handlers.failed?.({ message: event.message });
    worker.postMessage({ type: "start", module: this.#module });
  }

  #hear(message) {
    if (message.type === "ready") {
      this.#ready = true;
      this.#send();
      return;
    }
    if (message.type === "phase") {
      this.#phase = message.phase;
      if (message.id === this.#id) clearTimeout(this.#impatience);
    }
    if (message.type === "failed") this.#replace();
    if (message.type === "picture" && message.fine && message.done) this.#phase = "idle";
    // What was drawn for an older request still shows where the hand is, unless it is refused or fine.
    if (message.id !== undefined && message.id !== this.#id && (message.fine || message.type !== "picture")) return;
    this.#handlers[message.type]?.(message);
  }

  #send() {
    if (this.#ready && this.#waiting) {
      this.#worker.postMessage(this.#waiting);
      this.#waiting = null;
    }
  }

  #replace() {
    clearTimeout(this.#impatience);
    this.#worker.terminate();
    this.#start();
  }

  /** Draws this and nothing else. */
  draw(request, overlay, thumbnail = 0) {
    const message = { type: "draw", id: ++this.#id, request, overlay, thumbnail };
    this.#waiting = message;
    this.#send();
    clearTimeout(this.#impatience);
    const patience = PATIENCE[this.#phase];
    if (patience) {
      this.#impatience = setTimeout(() => {
        this.#waiting = message;
        this.#replace();
      }, patience);
    }
  }

  /** A question to the worker before it is asked to draw, as soon as it is there. */
  begin(message) {
    this.#waiting = message;
    this.#send();
  }

  /** Another question to the worker. */
  ask(message) {
    if (this.#ready) this.#worker.postMessage(message);
  }

  /** Ends it. */
  close() {
    clearTimeout(this.#impatience);
    this.#worker.terminate();
  }
}
