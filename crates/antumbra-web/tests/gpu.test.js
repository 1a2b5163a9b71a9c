// The page with a GPU: what WebGPU proves, what the page says of it, and what is left when it lies, fails or is lost. Needs what
// page.test.js needs. The GPU is one that the processor plays; a Chromium without it skips all this, and says so.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { WEBGPU, browse, finished, serve } from "./browser.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const program = process.env.ANTUMBRA ?? join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "debug/antumbra");
const folder = process.env.PAGE ?? join(root, "target/web");
/** Such an adapter compiles kernels for many seconds. */
const LONG = 600_000;

let server, browser, page, scratch;
let missing = null;
const closing = [];

before(async () => {
  scratch = mkdtempSync(join(tmpdir(), "antumbra-gpu-"));
  server = await serve(program, folder);
  browser = await browse({ acceptDownloads: true }, WEBGPU);
  page = browser.page;
  await page.goto(server.address);
  missing = await page.evaluate(async () => {
    if (!navigator.gpu) return "no WebGPU";
    return (await navigator.gpu.requestAdapter()) ? null : "no adapter for WebGPU";
  });
  if (missing) console.error(`SKIPPED: this Chromium has ${missing}, nothing was run with it`);
});

after(async () => {
  await browser?.close();
  server?.close();
  closing.forEach((close) => close());
  if (scratch) rmSync(scratch, { recursive: true, force: true });
});

/** A test that needs the adapter. */
const withGpu = (name, body) =>
  test(name, { timeout: LONG }, (t) => (missing ? t.skip(`SKIPPED: this Chromium has ${missing}`) : body(t)));

async function visit(address, hash, query = "?gpu=any") {
  await page.goto("about:blank");
  await page.goto(`${address}${query}${hash}`);
  await finished(page, LONG);
}

/** The page from a folder in which the browser's end was changed: something is broken on purpose. */
async function broken(name, ...changes) {
  const copy = join(scratch, name);
  cpSync(folder, copy, { recursive: true });
  const file = join(copy, "gpu.js");
  let text = readFileSync(file, "utf8");
  for (const [from, to] of changes) {
    assert.ok(text.includes(from), `${from} is not there any more`);
    text = text.replace(from, () => to);
  }
  writeFileSync(file, text);
  const other = await serve(program, copy);
  closing.push(other.close);
  return other.address;
}

const gpu = () => page.evaluate(() => window.antumbra.log.gpu);
const says = () => page.locator("#gpu-says").textContent();

/** Holds the page's PNG against the program's, which no GPU has touched. */
async function isTheProcessors(scene, size) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "PNG" }).click()]);
  const native = join(scratch, "native.png");
  execFileSync(program, ["render", scene, "--size", String(size), "--quiet", "-o", native]);
  assert.ok(readFileSync(await download.path()).equals(readFileSync(native)), `${scene}: other bytes`);
}

withGpu("what it proves is never contradicted by the processor", async (t) => {
  await page.goto(`${server.address}?gpu=off#scene=sphere&size=64`);
  for (const [scene, floor, least] of [["chubs", true, 50], ["exp(x) + sin(3y) - 5/4 + x^2 + y^2 + z^2 = 0", false, 40]]) {
    const found = await page.evaluate(
      async ({ scene, floor }) => {
        const { compile, Engine } = await import("./engine.js");
        const { Machine, decide } = await import("./gpu.js");
        window.module ??= await compile("antumbra.wasm");
        const request = { scene, floor, width: 72, height: 72 };
        const planes = (engine) => {
          while (!engine.refine(1000));
          return engine.planes().map((name) => [name, Array.from(engine.npy(name))]);
        };
        const [alone, helped] = [new Engine(window.module), new Engine(window.module)];
        const machine = await Machine.open(true);
        helped.gpuOpen(machine.about);
        const probe = await decide(helped, machine);
        alone.open(request);
        helped.open(request);
        const refusal = helped.gpuBegin();
        const step = await decide(helped, machine);
        return { probe, refusal, step, alone: planes(alone), helped: planes(helped) };
      },
      { scene, floor },
    );
    assert.equal(found.probe.state, "passed", found.probe.message);
    assert.equal(found.refusal, "");
    assert.equal(found.step.state, "proved", found.step.message);
    const { settled, pixels, narrow, brackets } = found.step;
    const [alone, helped] = [found.alone, found.helped].map((planes) => new Map(planes.map(([name, bytes]) => [name, numbers(bytes)])));
    const verdicts = [alone, helped].map((planes) => planes.get("verdict"));
    let together = 0;
    // Bounds of the same number intersect.
    const meet = (lo, hi, at) =>
      assert.ok(alone.get(lo)[at] <= helped.get(hi)[at] && helped.get(lo)[at] <= alone.get(hi)[at], `${lo} of ${scene} at ${at}`);
    const lights = [...alone.keys()].filter((name) => /visible.*lo/.test(name));
    assert.ok(lights.length > 0 && verdicts[0].length === pixels);
    for (let at = 0; at < pixels; at += 1) {
      const [one, other] = verdicts.map((verdict) => verdict[at]);
      meet("coverage_lo", "coverage_hi", at);
      // 0 and 1 are proofs, of nothing and of a hit.
      if (one > 1 || other > 1) continue;
      assert.equal(one, other, `${scene} at ${at}`);
      together += 1;
      if (one === 0) continue;
      meet("t_lo", "t_hi", at);
      for (const lo of lights) meet(lo, lo.replace("lo", "hi"), at);
    }
    t.diagnostic(`${scene}: ${settled} of ${pixels} pixels, ${narrow} of ${brackets} brackets by the GPU; ${together} verdicts agree`);
    assert.ok(100 * settled >= least * pixels && 100 * narrow >= 80 * brackets, JSON.stringify(found.step));
    assert.notDeepEqual(found.alone, found.helped, "nothing was taken over");
  }
});

/** The numbers of a NumPy file. */
function numbers(bytes) {
  const file = Buffer.from(bytes);
  const from = 10 + file.readUInt16LE(8);
  const [, kind] = /'descr': '.?([a-z]\d)'/.exec(file.toString("latin1", 10, from));
  const kinds = { f8: Float64Array, f4: Float32Array, u1: Uint8Array, u4: Uint32Array, u2: Uint16Array };
  return new kinds[kind](new Uint8Array(file.subarray(from)).buffer);
}

withGpu("the page draws with it, says so, and does without it", async () => {
  await visit(server.address, "#scene=chubs&size=128");
  assert.equal((await gpu()).state, "proved", await says());
  assert.match(await says(), /passed the probe of 16384 cases and proved \d+\.\d % of the pixels, \d+(\.\d+)? % of their light in/);
  assert.match(await page.locator("#status").textContent(), /^Proved: 9\d(\.\d+)? % of the pixels/);
  assert.doesNotMatch(await page.evaluate(() => location.hash), /gpu/);
  await page.getByRole("checkbox", { name: "GPU, if it can be trusted" }).uncheck();
  await page.waitForFunction(() => window.antumbra.log.done && window.antumbra.log.gpu === null);
  assert.equal(await says(), "");
  await isTheProcessors("chubs", 128);
});

withGpu("a processor that plays the GPU is nothing to wait for", async () => {
  await visit(server.address, "#scene=sphere&size=64", "");
  assert.match(await says(), /^The processor does it: .*is a processor that plays the GPU/);
  await isTheProcessors("sphere", 64);
});

withGpu("a formula that it has no kernels for is the processor's", async () => {
  const scene = "tan(x/3) + y^2 + z^2 = 1";
  await visit(server.address, `#${new URLSearchParams({ scene, size: 96 })}`);
  assert.match(await says(), /passed the probe of 16384 cases\. The processor does it: the operator `tan` has no enclosure/);
  await isTheProcessors(scene, 96);
});

withGpu("an adapter that does not round as it should is refused", async (t) => {
  const fence = "bitcast<f32>(bitcast<u32>(x) ^ runtime_zero())";
  const faults = [["a sum", "fence(x - y)", "(fence(x - y) * 1.0000002)"]];
  const rewritten = await page.evaluate(async () => {
    const { compile, Engine } = await import("./engine.js");
    const { Machine, decide } = await import("./gpu.js");
    const engine = new Engine(await compile("antumbra.wasm"));
    const machine = await Machine.open(true);
    engine.gpuOpen(machine.about);
    return (await decide(engine, machine)).rewritten;
  });
  t.diagnostic(`without the fence so many cases differ: ${rewritten}`);
  // Where this compiler rewrites nothing, there is nothing to be found without the fence.
  if (rewritten.slice(0, 4).some((count) => count > 0)) faults.push(["the fence", fence, "x"]);
  for (const [name, from, to] of faults) {
    const address = await broken(name, ["code: text", `code: text.replaceAll(${JSON.stringify(from)}, ${JSON.stringify(to)})`]);
    await visit(address, "#scene=sphere&size=64");
    assert.match(await says(), /failed the start-up probe: .* instead of/, name);
    await isTheProcessors("sphere", 64);
  }
});

/** Before the dispatch of that number something else happens; the probe is the first one. */
const atRun = (number, what) => [
  "async run({ pipeline, binding, groups }) {",
  `async run({ pipeline, binding, groups }) {
    if ((globalThis.runs = (globalThis.runs ?? 0) + 1) === ${number}) ${what};`,
];

withGpu("a device that is lost in the middle leaves the processor's picture, and another one is asked for", async () => {
  const address = await broken("lost", atRun(4, "this.#device.destroy()"));
  await visit(address, "#scene=sphere&size=128");
  assert.match(await says(), /The processor does it: the GPU failed: .*lost/);
  await isTheProcessors("sphere", 128);
  await page.locator("#picture").focus();
  await page.evaluate(() => (window.antumbra.log.done = false));
  await page.keyboard.press("ArrowLeft");
  await finished(page, LONG);
  assert.equal((await gpu()).state, "proved", await says());
});

withGpu("what is not allowed is noticed before an answer is believed", async () => {
  // More groups than there may be: the kernel does not run.
  const address = await broken("invalid", atRun(3, "groups = 1e6"));
  await visit(address, "#scene=sphere&size=64");
  assert.match(await says(), /The processor does it: the GPU failed: /);
  await isTheProcessors("sphere", 64);
});

withGpu("nobody waits longer for a compiler than for the processor", async () => {
  const address = await broken(
    "slow",
    ["if (played && !software)", "if (false)"],
    ["const pipeline = this.#device", 'const pipeline = entry !== "probe" ? new Promise(() => {}) : this.#device'],
  );
  await visit(address, "#scene=chubs&size=384", "");
  assert.match(await says(), /passed the probe of 16384 cases\. The processor does it: kernels for this formula are still being compiled/);
  await isTheProcessors("chubs", 384);
});

withGpu("another picture does not wait for what it proves", async (t) => {
  await page.goto("about:blank");
  await page.goto(`${server.address}?gpu=any#scene=kusner&size=512`);
  await page.waitForFunction(() => window.antumbra?.log.gpu?.state === "waits", null, { timeout: LONG });
  const drawn = await page.evaluate(() => {
    location.hash = "#scene=sphere&size=64";
    return window.antumbra.log.drawn;
  });
  const begin = Date.now();
  await page.waitForFunction((drawn) => window.antumbra.log.drawn > drawn, drawn, { timeout: LONG });
  t.diagnostic(`a coarse picture of another surface after ${Date.now() - begin} ms`);
  await page.waitForFunction(() => window.antumbra.state().scene === "sphere" && window.antumbra.log.done, null, { timeout: LONG });
  assert.equal((await gpu()).state, "proved", await says());
});
