// What the page costs, in numbers: node crates/antumbra-web/tests/measure.js [SIZE [ROUNDS]]. Needs what page.test.js needs.
//
// For each scene: milliseconds from a turn of the camera (a press of a key) to the first picture and to the whole proof, with one worker
// and with two; the whole proof with WebGPU and without, of the same picture in turns, by one worker and a GPU that the processor plays, and
// what of it is the heart's own time;
// then user time of the module, by Node's V8, against that of the program, one thread each, in turns.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { WEBGPU, browse, finished, serve } from "./browser.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const program = process.env.ANTUMBRA ?? join(root, "target/release/antumbra");
const folder = process.env.PAGE ?? join(root, "target/web");
const size = Number(process.argv[2] ?? 512);
const SCENES = ["orthocircle", "chubs", "kusner", "mcmullen"];
const ROUNDS = Number(process.argv[3] ?? 5);

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const wasm = readFileSync(join(folder, "antumbra.wasm"));
console.log(`antumbra.wasm: ${wasm.length} bytes, ${gzipSync(wasm, { level: 9 }).length} with gzip -9`);

const server = await serve(program, folder);
const { page, close } = await browse();
try {
  console.log(`\n| ${size} x ${size} | workers | first picture, ms | its side | proof, ms |\n|---|---|---|---|---|`);
  for (const scene of SCENES) {
    for (const workers of [1, 2]) {
      await page.goto("about:blank");
      await page.goto(`${server.address}?workers=${workers}#scene=${scene}&size=${size}`);
      await finished(page);
      await page.locator("#picture").focus();
      const [firsts, proofs, sides] = [[], [], []];
      for (let round = 0; round < ROUNDS; round += 1) {
        await page.keyboard.press("ArrowRight");
        await finished(page);
        const { asked, first, finished: end, side } = await page.evaluate(() => window.antumbra.log);
        firsts.push(first - asked);
        proofs.push(end - asked);
        sides.push(side);
      }
      console.log(`| ${scene} | ${workers} | ${median(firsts).toFixed(0)} | ${median(sides)} | ${median(proofs).toFixed(0)} |`);
    }
  }
} finally {
  await close();
}

const second = await browse({}, WEBGPU);
try {
  const { page } = second;
  console.log(`\n| ${size} x ${size}, by one worker | GPU's part, ms | the heart's rest, ms | proof with WebGPU, ms | without, ms | of that the heart's, ms | its evaluations, millions | GPU |\n|---|---|---|---|---|---|---|---|`);
  for (const scene of SCENES) {
    await page.goto("about:blank");
    await page.goto(`${server.address}?workers=1&gpu=any#scene=${scene}&size=${size}`);
    // The first time kernels are compiled.
    await finished(page, 600_000);
    const [parts, rests, withIt, without, alone] = [[], [], [], [], []];
    const evaluations = [0, 0];
    for (let round = 0; round < ROUNDS; round += 1) {
      for (const checked of [false, true]) {
        await page.evaluate(() => (window.antumbra.log.done = false));
        await page.locator("#gpu").setChecked(checked);
        await finished(page, 600_000);
        const { asked, finished: end, gpu, report } = await page.evaluate(() => window.antumbra.log);
        (checked ? withIt : without).push(end - asked);
        (checked ? rests : alone).push(1e3 * report.seconds);
        evaluations[checked ? 0 : 1] = (report.evaluations / 1e6).toFixed(2);
        if (checked) parts.push(gpu?.state === "proved" ? 1e3 * gpu.seconds : NaN);
      }
    }
    const says = await page.locator("#gpu-says").textContent();
    console.log(`| ${scene} | ${[parts, rests, withIt, without, alone].map((list) => median(list).toFixed(0)).join(" | ")} | ${evaluations.join(" / ")} | ${says} |`);
  }
} finally {
  await second.close();
  server.close();
}

const { Engine } = await import(join(folder, "engine.js"));
const module = new WebAssembly.Module(wasm);
/** Seconds of user time that something takes, of all threads of this process. */
const user = (work) => {
  const before = process.cpuUsage().user;
  work();
  return (process.cpuUsage().user - before) / 1e6;
};
const scratch = mkdtempSync(join(tmpdir(), "antumbra-measure-"));
const engine = new Engine(module);
const draw = (scene) => {
  engine.open({ scene, width: size, height: size });
  while (!engine.refine(1000));
};
console.log(`\n| ${size} x ${size}, one thread, user time | program, s | WebAssembly (V8), s | ratio |\n|---|---|---|---|`);
for (const scene of SCENES) {
  const [natives, ours] = [[], []];
  // The first time V8 still compiles.
  draw(scene);
  for (let round = 0; round < 3; round += 1) {
    const timed = ["-c", 'TIMEFORMAT=%U; time "$0" "$@"', program, "render", scene, "--size", String(size), "--threads", "1"];
    natives.push(Number(spawnSync("bash", [...timed, "--quiet", "-o", join(scratch, "p.png")], { encoding: "utf8" }).stderr.trim()));
    ours.push(user(() => draw(scene)));
  }
  const [native, own] = [median(natives), median(ours)];
  console.log(`| ${scene} | ${native.toFixed(2)} | ${own.toFixed(2)} | ${(own / native).toFixed(1)} |`);
}
rmSync(scratch, { recursive: true });
