// The browser's GPU: does what the heart orders (crates/antumbra-web/src/remote.rs), in plain WebGPU. What is proved, and whether this GPU
// can be trusted with it, is the heart's business.

/** What can go wrong with an order; all of it is asked for before an answer is believed. */
const SCOPES = ["validation", "out-of-memory", "internal"];

/** Names of adapters that are a processor, where the browser does not say so. */
const SOFTWARE = /swiftshader|llvmpipe|lavapipe|basic render/i;

/** A device and what the heart keeps there, by its numbers. */
export class Machine {
  #device;
  #things = new Map();
  /** Batches are carried out one after the other, also those whose answer nobody waits for any more. */
  #last = Promise.resolve();
  #loss;
  /** Why it is gone, once it is. */
  lost = null;

  /** The most promising adapter. Throws an error that says why there is none; one that a processor plays only counts if `software`. */
  static async open(software = false) {
    if (!navigator.gpu) throw new Error("this browser has no WebGPU");
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
    if (!adapter) throw new Error("this browser offers no adapter");
    const { vendor, architecture, device, description, isFallbackAdapter } = adapter.info ?? {};
    const name = description || [vendor, architecture, device].filter(Boolean).join(" ") || "an adapter without a name";
    const played = Boolean(isFallbackAdapter ?? adapter.isFallbackAdapter) || SOFTWARE.test(name);
    if (played && !software) throw new Error(`${name} is a processor that plays the GPU`);
    const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
    const requiredLimits = { maxBufferSize, maxStorageBufferBindingSize };
    const about = { name, software: played, largest: Math.min(maxBufferSize, maxStorageBufferBindingSize) };
    return new Machine(await adapter.requestDevice({ label: "antumbra", requiredLimits }), about);
  }

  constructor(device, about) {
    this.#device = device;
    this.about = about;
    this.#loss = device.lost.then(({ reason, message }) => {
      this.lost = `the device was lost (${reason}): ${message}`;
      throw new Error(this.lost);
    });
    this.#loss.catch(() => {});
  }

  /** Carries out orders. The bytes that the last of them asks for, when nothing went wrong with any of them; else an error. */
  perform(orders) {
    const batch = this.#last.then(() => Promise.race([this.#carryOut(orders), this.#loss]));
    this.#last = batch.catch(() => {});
    return batch;
  }

  async #carryOut(orders) {
    if (this.lost) throw new Error(this.lost);
    for (const scope of SCOPES) this.#device.pushErrorScope(scope);
    let answer = new Uint8Array();
    let thrown = null;
    try {
      // Compilers work side by side.
      for (const order of orders) if (order.do === "pipeline") this.#things.set(order.id, this.#compile(order));
      for (const order of orders) answer = (await this[order.do]?.(order)) ?? answer;
    } catch (error) {
      thrown = error;
    }
    const errors = await Promise.all(SCOPES.map(() => this.#device.popErrorScope()));
    const error = errors.find(Boolean) ?? thrown;
    if (error) throw new Error(error.message);
    return answer;
  }

  #compile({ text, entry, constants }) {
    const module = this.#device.createShaderModule({ code: text });
    const compute = { module, entryPoint: entry, constants };
    const pipeline = this.#device.createComputePipelineAsync({ layout: "auto", compute });
    // Whoever binds it hears of it.
    pipeline.catch(() => {});
    return pipeline;
  }

  #submit(encode) {
    const encoder = this.#device.createCommandEncoder();
    encode(encoder);
    this.#device.queue.submit([encoder.finish()]);
  }

  /** WebGPU fills new buffers with zeros. */
  buffer({ id, bytes, uniform }) {
    const { UNIFORM, STORAGE, COPY_SRC, COPY_DST } = GPUBufferUsage;
    const usage = (uniform ? UNIFORM : STORAGE) | COPY_SRC | COPY_DST;
    this.#things.set(id, this.#device.createBuffer({ size: bytes, usage }));
  }

  free({ id }) {
    this.#things.get(id)?.destroy?.();
    this.#things.delete(id);
  }

  async bind({ id, pipeline, buffers }) {
    const layout = (await this.#things.get(pipeline)).getBindGroupLayout(0);
    const entries = buffers.map(([binding, buffer]) => ({ binding, resource: { buffer: this.#things.get(buffer) } }));
    this.#things.set(id, this.#device.createBindGroup({ layout, entries }));
  }

  write({ id, words }) {
    this.#device.queue.writeBuffer(this.#things.get(id), 0, new Uint32Array(words));
  }

  clear({ id }) {
    this.#submit((encoder) => encoder.clearBuffer(this.#things.get(id)));
  }

  copy({ from, to }) {
    const source = this.#things.get(from);
    this.#submit((encoder) => encoder.copyBufferToBuffer(source, 0, this.#things.get(to), 0, source.size));
  }

  async run({ pipeline, binding, groups }) {
    const kernel = await this.#things.get(pipeline);
    this.#submit((encoder) => {
      const pass = encoder.beginComputePass();
      pass.setPipeline(kernel);
      pass.setBindGroup(0, this.#things.get(binding));
      pass.dispatchWorkgroups(groups);
      pass.end();
    });
    await this.#device.queue.onSubmittedWorkDone();
  }

  async read({ id, bytes }) {
    const { MAP_READ, COPY_DST } = GPUBufferUsage;
    const copy = this.#device.createBuffer({ size: bytes, usage: MAP_READ | COPY_DST });
    try {
      this.#submit((encoder) => encoder.copyBufferToBuffer(this.#things.get(id), 0, copy, 0, bytes));
      // Rejected where the device is lost.
      await copy.mapAsync(GPUMapMode.READ);
      return new Uint8Array(copy.getMappedRange()).slice();
    } finally {
      copy.destroy();
    }
  }
}

/**
 * Carries out what the heart orders until its question is decided: its last step, or null where somebody wants something else.
 * `gone` tells whether that is so, `woken` is given a function to be called when it may be; `told` hears how far it is.
 */
export async function decide(engine, machine, { gone = () => false, woken = () => {}, told = () => {} } = {}) {
  for (;;) {
    const { orders, ...step } = engine.gpuStep();
    const work = machine.perform(orders);
    if (step.state !== "waits") {
      work.catch(() => {});
      return step;
    }
    told(step);
    let answer;
    const done = work.then((bytes) => (answer = bytes), (error) => (answer = error));
    while (answer === undefined && !gone()) await Promise.race([done, new Promise(woken)]);
    if (gone()) return null;
    engine.gpuAnswer(orders.at(-1).ticket, answer);
  }
}
