// The heart, as WebAssembly exports it (crates/antumbra-web/src/abi.rs), with texts and bytes instead of addresses.

/** Compiles the module once; several workers can share what comes out. */
export function compile(url) {
  return WebAssembly.compileStreaming(fetch(url));
}

/** One studio: one scene, one render. */
export class Engine {
  #exports;
  #decoder = new TextDecoder();
  #encoder = new TextEncoder();

  constructor(module) {
    const instance = new WebAssembly.Instance(module, { page: { now: () => performance.now() } });
    this.#exports = instance.exports;
    this.#exports.begin();
  }

  #write(text) {
    this.#writeBytes(this.#encoder.encode(text));
  }

  #writeBytes(bytes) {
    const at = this.#exports.input(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, at, bytes.length).set(bytes);
  }

  /** A copy: memory moves when it grows. */
  #bytes(at) {
    return new Uint8Array(this.#exports.memory.buffer, at, this.#exports.output_length()).slice();
  }

  #json(at) {
    return JSON.parse(this.#decoder.decode(this.#bytes(at)));
  }

  gallery() {
    return this.#json(this.#exports.gallery());
  }

  /** Begins to draw; describes the scene, or has `error`. */
  open(request) {
    this.#write(JSON.stringify(request));
    return this.#json(this.#exports.open());
  }

  /** Takes a GPU, of which `about` tells what the heart asks: the probe is then to be decided. */
  gpuOpen(about) {
    this.#write(JSON.stringify(about));
    const refusal = this.#decoder.decode(this.#bytes(this.#exports.gpu_open()));
    if (refusal) throw new Error(refusal);
  }

  /** Begins to prove on the GPU what it can of the picture: to be decided. Else why the processor does all of it. */
  gpuBegin() {
    return this.#decoder.decode(this.#bytes(this.#exports.gpu_begin()));
  }

  /** Where that stands, and the orders to be carried out next. */
  gpuStep() {
    return this.#json(this.#exports.gpu_step());
  }

  /** What the order with that ticket answered: bytes, or an error. */
  gpuAnswer(ticket, answer) {
    const failed = answer instanceof Error;
    if (failed) this.#write(answer.message);
    else this.#writeBytes(answer);
    this.#exports.gpu_answer(ticket, failed ? 1 : 0);
  }

  /** Nobody wants to know any more what the GPU proves. */
  gpuLeave() {
    this.#exports.gpu_leave();
  }

  /** Works for about that time; tells whether the picture is finished. */
  refine(milliseconds) {
    return this.#exports.refine(milliseconds) === 1;
  }

  /** Everything that is known of the picture, for another engine to join. */
  state() {
    return this.#bytes(this.#exports.state());
  }

  /** Takes over a finished part of the picture. */
  join(state) {
    this.#writeBytes(state);
    const refusal = this.#decoder.decode(this.#bytes(this.#exports.join()));
    if (refusal) throw new Error(refusal);
  }

  report() {
    return this.#json(this.#exports.report());
  }

  /** Red, green, blue, opacity of every pixel; `overlay` may be ""; `lit` leaves out hits of whose light nothing is known. */
  pixels(overlay, lit) {
    this.#write(overlay);
    return new Uint8ClampedArray(this.#bytes(this.#exports.pixels(lit ? 1 : 0)).buffer);
  }

  legend(overlay) {
    this.#write(overlay);
    return this.#json(this.#exports.legend());
  }

  pixel(column, row) {
    return this.#json(this.#exports.pixel(column, row));
  }

  png(overlay) {
    this.#write(overlay);
    return this.#bytes(this.#exports.png());
  }

  planes() {
    return this.#json(this.#exports.planes());
  }

  npy(plane) {
    this.#write(plane);
    return this.#bytes(this.#exports.npy());
  }

  /** What went wrong, after a call that threw. */
  panic() {
    return this.#decoder.decode(this.#bytes(this.#exports.panic_message()));
  }
}
