// The page as people meet it. Needs the page (crates/antumbra-web/build), the program (ANTUMBRA, by default target/debug/antumbra) and
// Chromium (CHROMIUM, by default /usr/bin/chromium):
//
//     npm ci --prefix crates/antumbra-web/tests && node --test crates/antumbra-web/tests/page.test.js
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { browse, finished, serve } from "./browser.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const program = process.env.ANTUMBRA ?? join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "debug/antumbra");
const folder = process.env.PAGE ?? join(root, "target/web");

let server, browser, page, scratch;
const complaints = [];

before(async () => {
  scratch = mkdtempSync(join(tmpdir(), "antumbra-page-"));
  server = await serve(program, folder);
  browser = await browse({ colorScheme: "dark", acceptDownloads: true });
  page = browser.page;
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
});

after(async () => {
  await browser?.close();
  server?.close();
  if (scratch) rmSync(scratch, { recursive: true, force: true });
});

/** Opens the page as somebody who comes by this link, and waits for the whole picture. */
async function visit(hash, query = "") {
  await page.goto("about:blank");
  await page.goto(`${server.address}${query}${hash}`);
  await finished(page);
}

const log = () => page.evaluate(() => window.antumbra.log);
/** The pixels of the canvas, in a word. */
const picture = async () => {
  const url = await page.evaluate(() => document.querySelector("#picture").toDataURL());
  return createHash("sha256").update(url).digest("hex");
};
const hash = () => page.evaluate(() => new URLSearchParams(location.hash.slice(1)).toString());

/** Sets a slider as a hand does, and waits for the whole picture. */
async function slide(label, value) {
  const slider = page.getByRole("slider", { name: label, exact: true });
  await page.evaluate(() => (window.antumbra.log.done = false));
  await slider.fill(String(value));
  await finished(page);
}

test("planes have the bits of the native ones", { timeout: 300_000 }, async (t) => {
  await page.goto(server.address);
  const scenes = [
    ["orthocircle", []],
    ["chubs", ["--floor"]],
    ["kusner", []],
    ["mcmullen", ["--light-scale", "4"]],
    ["links", []],
    ["exp(x) + sin(3y) + atan(z) cbrt(x y) - 5/4 + x^2 + y^2 + z^2 = 0", []],
  ];
  for (const [scene, options] of scenes) {
    const planes = join(scratch, "planes");
    const picture = join(scratch, "p.png");
    execFileSync(program, ["render", scene, "--size", "64", "--quiet", "-o", picture, "--planes", planes, ...options]);
    const scale = Number(options[options.indexOf("--light-scale") + 1]) || 1;
    const found = await page.evaluate(
      async ({ scene, floor, scale }) => {
        const { compile, Engine } = await import("./engine.js");
        window.compiled ??= await compile("antumbra.wasm");
        const engine = new Engine(window.compiled);
        const request = { scene, width: 64, height: 64, floor };
        const { light } = engine.open(request);
        if (scale !== 1) engine.open({ ...request, light: { center: light.center, scale } });
        while (!engine.refine(1000));
        return engine.planes().map((name) => [name, Array.from(engine.npy(name))]);
      },
      { scene, floor: options.includes("--floor"), scale },
    );
    const names = readdirSync(planes).filter((name) => name.endsWith(".npy")).sort();
    assert.deepEqual(found.map(([name]) => `${name}.npy`).sort(), names);
    for (const [name, bytes] of found) {
      assert.ok(readFileSync(join(planes, `${name}.npy`)).equals(Buffer.from(bytes)), `${name} of ${scene}`);
    }
    t.diagnostic(`${scene}: ${names.length} planes of 64 x 64 are the same bytes`);
    rmSync(planes, { recursive: true });
  }
});

test("Chubs are drawn, and counted as the program counts", async () => {
  await visit("#scene=chubs&size=128");
  const { report } = await log();
  const json = execFileSync(program, ["render", "chubs", "--size", "128", "--quiet", "--json", "-", "-o", join(scratch, "c.png")]);
  const native = JSON.parse(json);
  for (const [ours, theirs] of [["proved_hit", "proved_hit"], ["proved_empty", "proved_empty"], ["proved_edge", "proved_partly"]]) {
    assert.equal(report[ours], native[theirs], ours);
  }
  assert.equal(report.evaluations, native.evaluations);
  assert.match(await page.locator("#status").textContent(), /^Proved: \d+(\.\d+)? % of the pixels/);
  assert.ok(await page.evaluate(() => crossOriginIsolated), "the server isolates the page");
});

test("workers that share a picture make the PNG that the program writes", async () => {
  await visit("#scene=chubs&size=128", "?workers=3");
  assert.equal((await log()).report.threads, 3);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "PNG" }).click()]);
  assert.equal(download.suggestedFilename(), "chubs.png");
  const native = join(scratch, "native.png");
  execFileSync(program, ["render", "chubs", "--size", "128", "--quiet", "-o", native]);
  assert.ok(readFileSync(await download.path()).equals(readFileSync(native)));
});

test("a drag turns the surface: coarse at once, then proved", async (t) => {
  await visit("#scene=kusner&size=256");
  const before = await picture();
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 300, box.y + 220, { steps: 5 });
  await page.mouse.up();
  await page.waitForFunction(() => /camera=/.test(location.hash));
  await finished(page);
  const { asked, first, finished: end } = await log();
  t.diagnostic(`first picture after ${(first - asked).toFixed(0)} ms, proof after ${(end - asked).toFixed(0)} ms`);
  assert.match(await hash(), /camera=/);
  assert.notEqual(await picture(), before);
});

test("keys turn, come nearer and go back", async () => {
  await visit("#scene=sphere&size=64&floor=1");
  const before = await picture();
  await page.locator("#picture").focus();
  for (const key of ["ArrowLeft", "ArrowUp", "+", "Shift+ArrowRight"]) await page.keyboard.press(key);
  await page.waitForFunction(() => /camera=.*light=/.test(location.hash));
  await finished(page);
  assert.notEqual(await picture(), before);
  await page.getByRole("button", { name: "Camera and light as they were" }).click();
  await page.waitForFunction(() => !/camera=|light=|floor=/.test(location.hash));
  await page.getByRole("checkbox", { name: "Floor" }).check();
  await page.waitForFunction(() => /floor=1/.test(location.hash));
  await finished(page);
  assert.equal(await picture(), before);
});

test("sliders of parameters, light and proof", async () => {
  await visit(`#${new URLSearchParams({ scene: "a = 1; x^2 + y^2 + a z^2 = 1", size: 64 })}`);
  const pictures = [await picture()];
  for (const [label, value, said] of [["a", 0.5, /set=a%3A0.5/], ["Around", 90, /light=/], ["Size", 2, /light=.*%2C4$|light=.*%2C4&/]]) {
    await slide(label, value);
    pictures.push(await picture());
    assert.match(await hash(), said, label);
    assert.notEqual(pictures.at(-1), pictures.at(-2), label);
  }
  await slide("Tolerance", 10);
  assert.match(await hash(), /tolerance=1024/);
  await page.getByRole("radio", { name: "Verdict" }).check({ force: true });
  await page.locator("#legend li").first().waitFor();
  assert.match(await page.locator("#legend").textContent(), /hit \(proved\): \d+/);
  assert.match(await hash(), /overlay=verdict/);
});

test("an error is shown under the place", async () => {
  await visit("#scene=sphere&size=64");
  const before = await picture();
  const box = page.getByRole("textbox", { name: "Formula" });
  await box.fill("x^2 + y^2 +\nfoo(z) = 1");
  await page.locator("#reason").waitFor();
  const [line, carets] = (await page.locator("#caret").textContent()).split("\n");
  assert.equal(line, "foo(z) = 1");
  assert.match(carets, /^\^+$/);
  assert.match(await page.locator("#reason").textContent(), /foo/);
  assert.equal(await box.getAttribute("aria-invalid"), "true");
  assert.equal(await picture(), before, "the last picture stays");
  await box.fill("x^2 + y^2 + 2z^2 = 1");
  await page.locator("#error").waitFor({ state: "hidden" });
  await finished(page);
  assert.notEqual(await picture(), before);
});

test("a link brings back the very picture", async () => {
  const state = { scene: "b = 0.3; x^2 + y^4 + z^2 = 1 - b x", set: "b:0.7", camera: "3,-4,2,0,0,0,30", light: "-2,-3,6,2", floor: 1, tolerance: 64, size: 96 };
  const link = `#${new URLSearchParams(state)}`;
  await visit(link);
  const [first, said] = [await picture(), await hash()];
  assert.equal(said, new URLSearchParams(state).toString().replace(/(&tolerance.*)(&size.*)|$/, "$1$2"));
  await visit(`#${said}`);
  assert.equal(await picture(), first);
  await page.evaluate(() => (location.hash = "#scene=sphere&size=64"));
  await page.waitForFunction(() => window.antumbra.state().scene === "sphere" && window.antumbra.log.done);
  assert.notEqual(await picture(), first);
});

test("what is changed cancels what is drawn, and the page never waits", async (t) => {
  await page.goto("about:blank");
  await page.goto(`${server.address}#scene=gyroid&size=512`);
  await page.evaluate(() => {
    window.longest = 0;
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) window.longest = Math.max(window.longest, entry.duration);
    }).observe({ type: "longtask" });
  });
  await page.waitForFunction(() => window.antumbra?.log.first > 0, null, { timeout: 60_000 });
  await page.waitForTimeout(1500);
  const begin = Date.now();
  await page.evaluate(() => (location.hash = "#scene=sphere&size=64"));
  await page.waitForFunction(() => window.antumbra.state().scene === "sphere" && window.antumbra.log.done, null, { timeout: 20_000 });
  t.diagnostic(`another surface ${Date.now() - begin} ms after a heavy one; longest task of the page ${await page.evaluate(() => window.longest)} ms`);
  assert.ok((await page.evaluate(() => window.longest)) < 250);
});

test("a pixel tells what is proved of it", async () => {
  await visit("#scene=sphere&size=128");
  const box = await page.locator("#picture").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => document.querySelector("#pixel").textContent.startsWith("Hit (proved)"));
  assert.match(await page.locator("#pixel").textContent(), /at distance [\d.]+ … [\d.]+ .*of the light it sees [\d.]+ … [\d.]+ %/);
  await page.mouse.move(box.x + 30, box.y + 30);
  await page.waitForFunction(() => document.querySelector("#pixel").textContent.startsWith("Empty (proved)"));
});

test("the gallery draws itself and is chosen from", async () => {
  await visit("#scene=sphere&size=64");
  await page.getByRole("button", { name: "Gallery" }).click();
  await page.getByRole("searchbox", { name: "Find a surface" }).fill("cayley");
  const drawn = () => {
    const canvas = document.querySelector("#exhibits [data-name=orthocircle]");
    return canvas.getContext("2d").getImageData(40, 40, 1, 1).data[3] === 255;
  };
  await page.getByRole("button", { name: "Cayley cubic" }).waitFor();
  assert.equal(await page.locator("#exhibits li:visible").count(), 1);
  await page.getByRole("searchbox").fill("");
  await page.waitForFunction(drawn, null, { timeout: 60_000 });
  await page.getByRole("button", { name: "Cayley cubic" }).click();
  await page.waitForFunction(() => window.antumbra.state().scene === "cayley");
  await page.waitForFunction(() => /Cayley/.test(document.querySelector("#about").textContent));
  assert.equal(await page.locator("#gallery").isVisible(), false);
});

test("a phone: nothing is cut off, fingers turn and pinch, dark and light", async () => {
  const phone = await browse({ viewport: { width: 375, height: 812 }, hasTouch: true, isMobile: true, colorScheme: "light" });
  try {
    const { page } = phone;
    await page.goto(`${server.address}#scene=sphere&size=64&floor=1`);
    await finished(page);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 375);
    const paper = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
    const light = await paper();
    await page.emulateMedia({ colorScheme: "dark" });
    assert.notEqual(await paper(), light);
    const touch = await phone.context.newCDPSession(page);
    const fingers = async (...steps) => {
      for (const [type, ...points] of steps) {
        const touchPoints = points.map(([x, y], id) => ({ x, y, id }));
        await touch.send("Input.dispatchTouchEvent", { type, touchPoints });
      }
    };
    const eye = () => page.evaluate(() => window.antumbra.state().camera.eye);
    await fingers(["touchStart", [150, 200]], ["touchMove", [190, 210]], ["touchEnd"]);
    await page.waitForFunction(() => /camera=/.test(location.hash));
    const before = Math.hypot(...(await eye()));
    await fingers(["touchStart", [150, 200], [200, 200]], ["touchMove", [110, 200], [240, 200]], ["touchEnd"]);
    await page.waitForFunction((before) => Math.hypot(...window.antumbra.state().camera.eye) < 0.9 * before, before);
    await finished(page);
  } finally {
    await phone.close();
  }
});

test("everything has a name, and nobody complained", async () => {
  await visit("#scene=sphere&size=64");
  for (const [role, names] of Object.entries({
    button: ["Share", "PNG", "Gallery …", "Camera and light as they were"],
    slider: ["Around", "Height", "Size", "Tolerance", "Pixels"],
    radio: ["Picture", "Verdict", "Shadow", "Cost", "Bracket"],
    textbox: ["Formula"],
    checkbox: ["Floor", "GPU, if it can be trusted"],
    progressbar: ["Share of the picture that is done"],
  })) {
    for (const name of names) assert.equal(await page.getByRole(role, { name, exact: true }).count(), 1, `${role} ${name}`);
  }
  const focused = await page.evaluate(() => document.querySelector("#picture").tabIndex);
  assert.equal(focused, 0);
  assert.deepEqual(complaints, []);
});
