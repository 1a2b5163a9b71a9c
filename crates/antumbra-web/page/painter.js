// The workers and what they draw. Whoever asks for another picture does not wait for the last one: a worker that does not listen is
// replaced.

/** Milliseconds after which a worker that draws something older is replaced: in a coarse picture, and in a fine one. */
const PATIENCE = { coarse: 2500, fine: 150 };
/** Most workers, and most for pictures of more pixels than this: each holds a picture of its own, half a kilobyte for each pixel. */
export const MOST = 6;
/** Times that a worker that never came to be is tried again. */
const FAILURES = 3;
const LARGE = { pixels: 600_000, most: 2 };

/** As many as there are processors, within reason. */
export const WORKERS = Math.max(1, Math.min(MOST, navigator.hardwareConcurrency || 1));

/** One worker, that is there again when it had to be ended. */
class Hand {
  busy = false;
  /** It has something else to do, and has not said that it knows. */
  stale = false;
  #count = 0;
  #module;
  #hear;
  #worker;
  #ready;
  #waiting;
  #last = null;
  #failures = 0;

  constructor(module, hear) {
    this.#module = module;
    this.#hear = hear;
    this.replace();
  }

  replace() {
    this.#worker?.terminate();
    this.busy = this.stale = this.#ready = false;
    this.#waiting = [];
    const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
    worker.onmessage = ({ data }) => {
      // A worker that was ended may still have been heard.
      if (worker !== this.#worker) return;
      if (data.type === "ready") {
        this.#ready = true;
        this.#failures = 0;
        this.#waiting.splice(0).forEach(([message, transfer]) => this.ask(message, transfer));
      } else {
        if (data.type === "taken") this.stale = false;
        if (data.type === "idle" && data.count === this.#count) this.busy = false;
        this.#hear(data);
      }
    };
    worker.onerror = (event) => this.#hear({ type: "failed", message: event.message });
    worker.postMessage({ type: "start", module: this.#module });
    this.#worker = worker;
  }

  /** The same, after a failure: a worker that cannot even be loaded is not tried for ever. */
  recover() {
    this.#failures += 1;
    if (this.#failures <= FAILURES) this.replace();
  }

  /** What it was given last. */
  get last() {
    return this.#last;
  }

  ask(message, transfer = []) {
    if (!this.#ready) this.#waiting.push([message, transfer]);
    else this.#worker.postMessage(message, transfer);
  }

  /** Gives it something to do instead of what it does. */
  work(message) {
    this.stale = this.busy;
    this.busy = true;
    this.#count += 1;
    this.#last = message;
    this.ask({ ...message, count: this.#count });
  }

  close() {
    this.#worker.terminate();
  }
}

export class Painter {
  #lead;
  #helpers = [];
  #id = 0;
  #now = null;
  #phase = "idle";
  #impatience = 0;
  #lateness = 0;
  #handlers;
  #share;
  /** "auto", "any" (also one that a processor plays) or "off". */
  gpu = "off";

  /**
   * `module` is the compiled heart; `handlers` are functions by the type of a worker's message. `share` is for measurements: all workers
   * share every picture, however soon one of them would have it.
   */
  constructor(module, handlers, workers = WORKERS, share = false) {
    this.#handlers = handlers;
    this.#share = share;
    this.#lead = new Hand(module, (message) => this.#hear(message));
    for (let k = 1; k < workers; k += 1) {
      this.#helpers.push(new Hand(module, (message) => this.#hearHelper(message)));
    }
  }

  #hear(message) {
    if (message.type === "phase") {
      this.#phase = message.phase;
      if (message.id === this.#id) clearTimeout(this.#impatience);
      if (message.id === this.#id && message.shared) this.#dealOut();
    }
    if (message.type === "idle") this.#phase = this.#lead.busy ? this.#phase : "idle";
    if (message.type === "failed") this.#lead.recover();
    // What was drawn for an older request still shows where the hand is, unless it is refused or fine.
    if (message.id !== undefined && message.id !== this.#id && (message.fine || message.type !== "picture")) return;
    this.#handlers[message.type]?.(message);
  }

  #hearHelper(message) {
    if (message.type === "failed") {
      // Without its part there is no whole: the first worker draws all of it.
      this.#helpers.splice(0).forEach((hand) => hand.close());
      this.draw(this.#now.request, this.#now.overlay);
    } else if (message.id === this.#id) {
      if (message.type === "part") this.#lead.ask({ ...message, type: "join" }, [message.state.buffer]);
      else this.#handlers[message.type]?.(message);
    }
  }

  /** Gives the helpers their parts of the picture. */
  #dealOut() {
    const { workers } = this.#now;
    this.#helpers.slice(0, workers - 1).forEach((hand, k) => hand.work({ ...this.#now, type: "assist", part: [k + 1, workers] }));
  }

  /** Number of the picture that was asked for last. */
  get id() {
    return this.#id;
  }

  /** Draws this and nothing else. */
  draw(request, overlay, thumbnail = 0) {
    const most = request.width * request.height > LARGE.pixels ? LARGE.most : MOST;
    const workers = Math.min(most, this.#helpers.length + 1);
    const message = { type: "draw", id: ++this.#id, request, overlay, thumbnail, workers, share: this.#share, gpu: this.gpu };
    this.#now = message;
    clearTimeout(this.#impatience);
    const patience = PATIENCE[this.#phase];
    if (patience) {
      this.#impatience = setTimeout(() => {
        this.#lead.replace();
        this.#lead.work(message);
      }, patience);
    }
    const late = this.#helpers.filter((hand) => hand.busy);
    late.forEach((hand) => hand.work({ type: "stop" }));
    clearTimeout(this.#lateness);
    this.#lateness = setTimeout(() => {
      for (const hand of late.filter((hand) => hand.stale)) {
        const { last } = hand;
        hand.replace();
        // It may have been given its part of the picture while it did not listen.
        if (last?.type === "assist" && last.id === this.#id) hand.work(last);
      }
    }, PATIENCE.fine);
    this.#lead.work(message);
  }

  /** Shows what is known instead of the picture, or the picture again. */
  overlay(overlay) {
    if (this.#now) this.#now = { ...this.#now, overlay };
    for (const hand of [this.#lead, ...this.#helpers]) hand.ask({ type: "overlay", overlay });
  }

  /** A question to the worker that has the whole picture. */
  ask(message) {
    this.#lead.ask(message);
  }

  /** Ends it. */
  close() {
    clearTimeout(this.#impatience);
    for (const hand of [this.#lead, ...this.#helpers]) hand.close();
  }
}
