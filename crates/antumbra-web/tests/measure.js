// What the page costs, in numbers: node crates/antumbra-web/tests/measure.js [SIZE]. Needs what page.test.js needs.
//
// For each scene: milliseconds from a turn of the camera (a press of a key) to the first picture and to the whole proof, with one worker
// and with all; then seconds of the module against the program, one thread each, in one run, one after the other.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { browse, finished, serve } from "./browser.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const program = process.env.ANTUMBRA ?? join(root, "target/release/antumbra");
const folder = process.env.PAGE ?? join(root, "target/web");
const size = Number(process.argv[2] ?? 512);
const SCENES = ["orthocircle", "chubs", "kusner", "mcmullen"];
const ROUNDS = 5;

const median = (list) => list.toSorted((a, b) => a - b)[list.length >> 1];
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
  console.log(`\n| ${size} x ${size}, one thread | program, s | WebAssembly, s | ratio |\n|---|---|---|---|`);
  for (const scene of SCENES) {
    const [natives, ours] = [[], []];
    for (let round = 0; round < 3; round += 1) {
      const options = ["--size", String(size), "--threads", "1", "--quiet", "--json", "-", "-o", "/dev/null"];
      natives.push(JSON.parse(execFileSync(program, ["render", scene, ...options])).seconds);
      ours.push(
        await page.evaluate(
          async ({ scene, size }) => {
            const { compile, Engine } = await import("./engine.js");
            window.compiled ??= await compile("antumbra.wasm");
            const engine = new Engine(window.compiled);
            engine.open({ scene, width: size, height: size });
            while (!engine.refine(1000));
            return engine.report().seconds;
          },
          { scene, size },
        ),
      );
    }
    const [native, own] = [median(natives), median(ours)];
    console.log(`| ${scene} | ${native.toFixed(2)} | ${own.toFixed(2)} | ${(own / native).toFixed(1)} |`);
  }
} finally {
  await close();
  server.close();
}
