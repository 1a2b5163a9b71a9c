// The page: what hands do becomes a state, the state becomes a request, pictures come back.
import { compile } from "./engine.js";
import { MOST, Painter } from "./painter.js";
import { Gallery } from "./gallery.js";
import { lightAngles, lightCenter, orbit, zoom } from "./camera.js";
import { USUAL, fromHash, toHash } from "./link.js";

const SIZES = [256, 384, 512, 768, 1024];
/** Waits for the end of a word before it reads a formula, milliseconds. */
const TYPING = 200;
/** Radians per width of the picture, and per press of an arrow key. */
const TURN = Math.PI;
const STEP = Math.PI / 24;

const $ = (selector) => document.querySelector(selector);
const canvas = $("#picture");
const context = canvas.getContext("2d");
const formula = $("#formula");

let state = fromHash(location.hash);
/** For measurements: `?workers=2` in the address makes so many share every picture. */
const wanted = Math.floor(Number(new URLSearchParams(location.search).get("workers"))) || 0;
const workers = wanted > 0 ? Math.min(wanted, MOST) : null;
/** The same for the GPU: `?gpu=any` takes one that a processor plays, for any picture; `?gpu=off` none. */
const gpuWanted = new URLSearchParams(location.search).get("gpu");
/** The scene as the heart describes it: its own camera, light, parameters. */
let scene = null;
/** Formulas by the names of the gallery. */
const names = new Map();
let painter = null;
let gallery = null;
let coarse = null;
/** What is there of the whole picture, and who said what of it. */
let whole = null;
/** For whoever measures or tests: what was drawn last, and when. */
const log = { asked: 0, first: 0, side: 0, finished: 0, done: false, report: null, drawn: 0, refused: null, gpu: null };
window.antumbra = { log, state: () => structuredClone(state) };

const camera = () => state.camera ?? scene?.camera;
const light = () => state.light ?? (scene?.light && { center: scene.light.center, scale: 1 });

// Drawing

let pending = false;
/** Asks for the picture of the state, once per frame of the screen at most. */
function draw() {
  if (pending || !painter) return;
  pending = true;
  requestAnimationFrame(() => {
    pending = false;
    const { size, tolerance, set, overlay } = state;
    const request = { scene: state.scene, set, width: size, height: size, tolerance: 1 / tolerance };
    if (state.camera) request.camera = state.camera;
    if (state.light) request.light = state.light;
    if (state.floor !== null) request.floor = state.floor;
    painter.gpu = $("#gpu").checked ? (gpuWanted === "any" ? "any" : "auto") : "off";
    painter.draw(request, overlay);
    history.replaceState(null, "", toHash(state));
  });
}

function change(changes) {
  state = { ...state, ...changes };
  Object.assign(log, { asked: performance.now(), first: 0, finished: 0, done: false, refused: null, gpu: null });
  // What was said of a pixel was said of the picture before.
  $("#pixel").textContent = "";
  draw();
}

/** Another surface: what was chosen for the last one does not fit it. */
function choose(name) {
  formula.value = names.get(name) ?? name;
  change({ scene: name, set: {}, camera: null, light: null, floor: null });
}

/** The pixels as something to draw with. */
function canvasOf(pixels) {
  const side = Math.round(Math.sqrt(pixels.length / 4));
  const part = new OffscreenCanvas(side, side);
  part.getContext("2d").putImageData(new ImageData(pixels, side, side), 0, 0);
  return part;
}

function onPicture({ id, fine, part, joined, done, tolerance, pixels, report, legend }) {
  const came = canvasOf(pixels);
  if (!fine) coarse = came;
  else {
    if (whole?.id !== id) whole = { id, canvas: new OffscreenCanvas(came.width, came.width), reports: [], legends: [] };
    // What a worker has not proved yet is transparent there.
    const all = whole.canvas.getContext("2d");
    if (done) all.clearRect(0, 0, came.width, came.width);
    all.drawImage(came, 0, 0);
    whole.reports[part] = report;
    if (joined) whole.reports = [report];
  }
  const size = fine ? came.width : Math.max(came.width, state.size);
  if (canvas.width !== size) canvas.width = canvas.height = size;
  context.imageSmoothingQuality = "high";
  if (coarse && !done) context.drawImage(coarse, 0, 0, size, size);
  if (fine) context.drawImage(whole.canvas, 0, 0);
  if (fine && done) coarse = whole.canvas;
  if (!fine && done) context.drawImage(coarse, 0, 0, size, size);
  $("#wait").hidden = true;
  if (id === painter.id && !log.first) Object.assign(log, { first: performance.now(), side: came.width });
  log.drawn += 1;
  Object.assign(log, { report, done: fine && done });
  if (log.done) log.finished = performance.now();
  tell(fine, done, fine ? together(whole.reports) : report, tolerance);
  if (!fine || part === 0) showLegend(legend);
}

/** What the GPU does, or why it does nothing. */
function onGpu({ state: what, name, cases, message, progress, ...share }) {
  log.gpu = { state: what, name, message, ...share };
  const trusted = name ? `${name} passed the probe of ${cases} cases` : "";
  const says = {
    opening: () => "Asking for a GPU that can be trusted …",
    waits: () => `${trusted} and is proving`,
    processor: () => `${trusted ? `${trusted}. ` : ""}The processor does it: ${message}`,
    proved: () =>
      `${trusted} and proved ${percent(share.settled, share.pixels)} of the pixels, ` +
      `${percent(share.narrow, share.brackets)} of their light in ${share.seconds.toFixed(1)} s`,
  };
  $("#gpu-says").textContent = says[what]();
  if (what !== "waits") return;
  $("#status").textContent = progress > 0 ? "Proving on the GPU …" : "Compiling kernels for the GPU …";
  const bar = $("#progress");
  bar.value = progress;
  bar.classList.remove("done");
}

/** What several workers report of their parts, as one report. */
function together(reports) {
  const all = Object.values(reports);
  const sum = (key) => all.reduce((total, report) => total + report[key], 0);
  const counters = ["proved_empty", "proved_hit", "proved_edge", "undecided", "brackets", "brackets_closed", "evaluations"];
  const totals = Object.fromEntries(counters.map((key) => [key, sum(key)]));
  const [slowest] = [...all].sort((a, b) => a.progress - b.progress);
  return { ...slowest, ...totals, progress: sum("progress") / Math.max(all.length, 1) };
}

const percent = (part, whole) => {
  if (whole === 0) return "100 %";
  const share = (100 * part) / whole;
  // Not all of them is not 100 %.
  return `${part === whole ? "100" : Math.min(share, 99.99).toFixed(share > 99 ? 2 : 1)} %`;
};

function tell(fine, done, report, tolerance) {
  const proved = report.proved_empty + report.proved_hit + report.proved_edge;
  const bar = $("#progress");
  bar.value = fine ? report.progress : 0;
  bar.classList.toggle("done", fine && done);
  $("#status").textContent = !fine
    ? "A coarse picture; each of its pixels is proved or says that it is not"
    : done
      ? `Proved: ${percent(proved, report.pixels)} of the pixels; the light to 1/${Math.round(1 / tolerance)} at ` +
        `${percent(report.brackets_closed, report.brackets)} of the hits`
      : `Proving: ${report.activity} …`;
  const seconds = report.seconds < 10 ? report.seconds.toFixed(1) : Math.round(report.seconds);
  const millions = (report.evaluations / 1e6).toFixed(1);
  const threads = report.threads > 1 ? `, ${report.threads} workers` : "";
  $("#numbers").textContent = fine ? `${seconds} s, ${millions} million evaluations${threads}` : "";
}

const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);

function showLegend(legend) {
  const list = $("#legend");
  list.hidden = legend.length === 0;
  list.replaceChildren(
    ...legend.map(({ color, meaning, pixels }) => {
      const line = document.createElement("li");
      const patch = document.createElement("i");
      patch.style.background = `rgb(${color.join(" ")})`;
      line.append(patch, `${meaning}: ${pixels}`);
      return line;
    }),
  );
}

function onScene({ scene: described }) {
  scene = described;
  clearError();
  const { title, about, parameters } = scene;
  const heading = document.createElement("strong");
  heading.textContent = title === "Formula" ? "" : title;
  const who = [about?.author, about?.year].filter(Boolean).join(", ");
  $("#about").replaceChildren(heading, who ? ` — ${who}. ` : " ", about?.history ?? "");
  document.title = `${title === "Formula" ? "Formula" : title} – Antumbra`;
  canvas.setAttribute("aria-label", `The surface ${title}`);
  showParameters(parameters);
  showLight();
}

// Errors

function onRefused({ error }) {
  log.refused = error;
  const { message, help, place } = error;
  $("#error").hidden = false;
  $("#reason").textContent = help ? `${sentence(message)}. ${sentence(help)}` : sentence(message);
  formula.setAttribute("aria-invalid", "true");
  const caret = $("#caret");
  caret.hidden = !place;
  if (place) caret.replaceChildren(...excerpt(formula.value, place));
  $("#status").textContent = "The picture is of the formula before";
}

/** The line of the formula that an error is in, with carets below it. */
function excerpt(text, [start, end]) {
  const first = text.lastIndexOf("\n", start - 1) + 1;
  const last = text.indexOf("\n", start) < 0 ? text.length : text.indexOf("\n", start);
  const room = 40;
  const from = Math.max(first, start - room + 8);
  const until = Math.min(last, from + room);
  const dots = from > first ? "… " : "";
  const line = dots + text.slice(from, until) + (until < last ? " …" : "");
  const carets = "^".repeat(Math.max(1, Math.min(end, until) - start));
  const mark = document.createElement("mark");
  mark.textContent = carets;
  return [`${line}\n${" ".repeat(dots.length + start - from)}`, mark];
}

function clearError() {
  $("#error").hidden = true;
  formula.removeAttribute("aria-invalid");
}

function onFailed({ message }) {
  $("#status").textContent = "This surface was too much: change something, or choose another one";
  console.error(message);
}

// The inspector

function onPixel({ asked, pixel }) {
  const line = $("#pixel");
  if (asked !== painter.id) return;
  if (!pixel) {
    line.textContent = "";
    return;
  }
  const bold = (text) => Object.assign(document.createElement("b"), { textContent: text });
  const parts = [bold(sentence(pixel.verdict))];
  if (pixel.t) {
    const [lo, hi] = pixel.t;
    parts.push(` at distance ${lo.toPrecision(9)} … ${hi.toPrecision(9)} (${(hi - lo).toExponential(0)} wide)`);
    parts.push(`, near (${pixel.point.map((x) => x.toFixed(3)).join(", ")})`);
  }
  pixel.visible.forEach(([lo, hi], k) => {
    const which = pixel.visible.length > 1 ? `light ${k + 1}` : "the light";
    parts.push(`; of ${which} it sees `, bold(`${(100 * lo).toFixed(2)} … ${(100 * hi).toFixed(2)} %`));
  });
  if (pixel.coverage[0] < 1 && pixel.coverage[1] > 0) {
    parts.push(`; covered ${(100 * pixel.coverage[0]).toFixed(0)} … ${(100 * pixel.coverage[1]).toFixed(0)} %`);
  }
  parts.push(`; ${pixel.evaluations} evaluations`);
  line.replaceChildren(...parts);
}

function inspect({ clientX, clientY }) {
  const box = canvas.getBoundingClientRect();
  const column = Math.floor(((clientX - box.left) / box.width) * canvas.width);
  const row = Math.floor(((clientY - box.top) / box.height) * canvas.height);
  if (column >= 0 && row >= 0) painter?.ask({ type: "inspect", id: painter.id, column, row });
}

// Hands on the picture

const fingers = new Map();

canvas.addEventListener("pointerdown", (event) => {
  fingers.set(event.pointerId, event);
  canvas.setPointerCapture(event.pointerId);
});

canvas.addEventListener("pointermove", (event) => {
  const before = fingers.get(event.pointerId);
  if (!before) {
    if (event.pointerType === "mouse") inspect(event);
    return;
  }
  if (!scene) return;
  const width = canvas.clientWidth;
  const [dx, dy] = [(event.clientX - before.clientX) / width, (event.clientY - before.clientY) / width];
  if (fingers.size === 2) {
    const [other] = [...fingers.values()].filter((f) => f.pointerId !== event.pointerId);
    const apart = (f) => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY) || 1;
    change({ camera: zoom(camera(), apart(before) / apart(event)) });
  } else if (event.shiftKey && light()) {
    moveLight(dx * 180, -dy * 180);
  } else {
    change({ camera: orbit(camera(), -dx * TURN, dy * TURN) });
  }
  fingers.set(event.pointerId, event);
});

for (const end of ["pointerup", "pointercancel"]) {
  canvas.addEventListener(end, (event) => {
    fingers.delete(event.pointerId);
    inspect(event);
  });
}
canvas.addEventListener("pointerleave", () => ($("#pixel").textContent = ""));

canvas.addEventListener(
  "wheel",
  (event) => {
    event.preventDefault();
    if (scene) change({ camera: zoom(camera(), Math.exp(Math.max(-0.3, Math.min(0.3, event.deltaY / 600)))) });
  },
  { passive: false },
);

canvas.addEventListener("keydown", (event) => {
  if (!scene || event.ctrlKey || event.metaKey || event.altKey) return;
  const turns = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };
  const turn = turns[event.key];
  if (turn && event.shiftKey) moveLight(...turn.map((x) => (x * 180) / Math.PI));
  else if (turn) change({ camera: orbit(camera(), ...turn) });
  else if (event.key === "+" || event.key === "=") change({ camera: zoom(camera(), 0.9) });
  else if (event.key === "-") change({ camera: zoom(camera(), 1 / 0.9) });
  else if (event.key === "0" || event.key === "Home") change({ camera: null });
  else return;
  event.preventDefault();
});

// Controls

function output(input, text) {
  input.parentElement.querySelector("output").value = text;
  input.setAttribute("aria-valuetext", text);
}

function moveLight(around, up) {
  const place = lightAngles(light().center, scene.camera.target);
  const turned = ((place.azimuth + around + 540) % 360) - 180;
  const elevation = Math.max(5, Math.min(88, place.elevation + up));
  setLight({ ...place, azimuth: turned, elevation });
}

function setLight(place, scale = light().scale) {
  change({ light: { center: lightCenter(place, scene.camera.target), scale } });
  showLight();
}

function showLight() {
  const now = light();
  const inputs = ["#azimuth", "#elevation", "#width"].map($);
  inputs.forEach((input) => (input.disabled = !now));
  $("#floor").checked = state.floor ?? scene.floor;
  if (!now) return;
  const place = lightAngles(now.center, scene.camera.target);
  const values = [place.azimuth, place.elevation, Math.log2(now.scale)];
  inputs.forEach((input, k) => (input.value = values[k]));
  output(inputs[0], `${Math.round(place.azimuth)}°`);
  output(inputs[1], `${Math.round(place.elevation)}°`);
  output(inputs[2], `${now.scale.toPrecision(2)} ×`);
}

for (const key of ["azimuth", "elevation"]) {
  $(`#${key}`).addEventListener("input", ({ target }) => {
    if (!scene) return;
    setLight({ ...lightAngles(light().center, scene.camera.target), [key]: Number(target.value) });
  });
}
$("#width").addEventListener("input", ({ target }) => {
  if (scene) setLight(lightAngles(light().center, scene.camera.target), 2 ** Number(target.value));
});
$("#floor").addEventListener("change", ({ target }) => change({ floor: target.checked }));

function showProof() {
  const [tolerance, size] = [$("#tolerance"), $("#size")];
  // 255 is the step of a picture of 8 bits.
  tolerance.value = Math.round(Math.log2(state.tolerance));
  output(tolerance, `1/${state.tolerance}`);
  const nearest = SIZES.reduce((a, b) => (Math.abs(b - state.size) < Math.abs(a - state.size) ? b : a));
  size.value = SIZES.indexOf(nearest);
  output(size, `${state.size}²`);
  for (const input of document.querySelectorAll("[name=overlay]")) input.checked = input.value === state.overlay;
}

$("#tolerance").addEventListener("input", ({ target }) => {
  const bits = Number(target.value);
  change({ tolerance: bits === 8 ? 255 : 2 ** bits });
  showProof();
});
$("#size").addEventListener("input", ({ target }) => {
  change({ size: SIZES[Number(target.value)] });
  showProof();
});
for (const input of document.querySelectorAll("[name=overlay]")) {
  input.addEventListener("change", () => {
    state.overlay = input.value;
    history.replaceState(null, "", toHash(state));
    // The same picture in other colours: nothing is drawn anew.
    painter?.overlay(state.overlay);
  });
}

$("#gpu").checked = gpuWanted !== "off";
$("#gpu").addEventListener("change", () => {
  $("#gpu-says").textContent = "";
  change({});
});

function showParameters(parameters) {
  const section = $("#parameters");
  section.hidden = parameters.length === 0;
  const there = [...section.querySelectorAll("input")];
  const same = there.length === parameters.length && parameters.every(({ name }, k) => there[k].name === name);
  if (!same) {
    section.replaceChildren(
      ...parameters.map(({ name, min, max }) => {
        const label = document.createElement("label");
        label.className = "slider";
        const input = Object.assign(document.createElement("input"), { type: "range", name, min, max, step: (max - min) / 200 });
        const caption = Object.assign(document.createElement("span"), { textContent: name });
        label.append(caption, input, document.createElement("output"));
        input.addEventListener("input", () => {
          output(input, Number(input.value).toPrecision(3));
          change({ set: { ...state.set, [name]: Number(input.value) } });
        });
        return label;
      }),
    );
  }
  for (const { name, value } of parameters) {
    const input = section.querySelector(`input[name="${CSS.escape(name)}"]`);
    const now = Object.hasOwn(state.set, name) ? state.set[name] : value;
    if (document.activeElement !== input) input.value = now;
    output(input, now.toPrecision(3));
  }
}

let typing = 0;
formula.addEventListener("input", () => {
  clearTimeout(typing);
  typing = setTimeout(() => {
    if (formula.value.trim()) change({ scene: formula.value, set: {}, camera: null, light: null });
  }, TYPING);
});

$("#choose").addEventListener("click", () => gallery?.open());
$("#reset").addEventListener("click", () => change({ camera: null, light: null, floor: null }));
$("#controls").addEventListener("submit", (event) => event.preventDefault());

$("#share").addEventListener("click", async () => {
  const button = $("#share");
  try {
    await navigator.clipboard.writeText(location.href);
    button.textContent = "Copied";
  } catch {
    button.textContent = "In the address bar";
  }
  setTimeout(() => (button.textContent = "Share"), 1600);
});

$("#save").addEventListener("click", () => painter?.ask({ type: "png" }));
function onPng({ bytes }) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
  link.download = `${names.has(state.scene) ? state.scene : "antumbra"}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

addEventListener("hashchange", () => {
  // Only where the address was changed by hand or by a link: the page's own changes are replacements.
  state = fromHash(location.hash);
  formula.value = names.get(state.scene) ?? state.scene;
  showProof();
  change({});
});

// Beginning

showProof();
try {
  const module = await compile("antumbra.wasm");
  $("#wait").textContent = "Drawing …";
  const handlers = { picture: onPicture, scene: onScene, refused: onRefused, failed: onFailed, pixel: onPixel, png: onPng, gpu: onGpu };
  handlers.gallery = ({ gallery: exhibits }) => {
    for (const { name, formula } of exhibits) names.set(name, formula);
    gallery = new Gallery(module, exhibits, choose);
    formula.value = names.get(state.scene) ?? state.scene;
    change({});
  };
  painter = new Painter(module, handlers, workers ?? undefined, workers !== null);
  painter.ask({ type: "gallery" });
} catch (error) {
  $("#wait").textContent = `This browser cannot draw here: ${error.message}`;
}
