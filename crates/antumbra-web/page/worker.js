// Draws off the page's thread: first a coarse picture at once, then the whole, until the next request comes. Several workers share a
// whole picture: each proves its part of the tiles, and the first one joins them and does the rest.
import { Engine } from "./engine.js";
import { Machine, decide } from "./gpu.js";

/** A coarse picture should take about so many milliseconds; it has as many pixels as that allows. */
const COARSE_TIME = 120;
/** Sides of coarse pictures, in pixels. */
const COARSE = { least: 32, most: 160 };
/** What a coarse picture asks for: brackets of the light as wide as this. What it says is proved all the same. */
const COARSE_PROOF = { tolerance: 1 / 16, rectangles: 16 };
/** A coarse picture that takes longer gives way to the next request. */
const PATIENCE = 1000;
/** A picture that will take so many milliseconds is shared with other workers: to join a part takes a quarter of a second. */
const SHARE_FROM = 4000;
/** A picture that will take fewer milliseconds is not worth compiling kernels. */
const GPU_FROM = 500;
/** A GPU that would take so many times as long as the processor is left. */
const SLOW = 4;
/** Devices that are lost before no other one is asked for. */
const LOSSES = 3;
/** How much longer a picture of n times as many pixels takes: n to this power, for the paper's surfaces. */
const GROWTH = 0.6;
/** Work between two looks at the messages, and time between two pictures. */
const SLICE = 30;
const SHOW = 120;

let engine = null;
let next = null;
let running = false;
let shown = { id: 0, overlay: "", fine: false };
/** Parts that others have done of what is drawn, and who waits for one. */
let parts = [];
let wake = () => {};
/** The GPU, when it has passed the probe: a promise of `{ machine }`, or of `{ message }` that says why not. */
let gpu = null;
let losses = 0;
/** Milliseconds per pixel of the last coarse picture. */
let pace = 0.03;

const { port1, port2 } = new MessageChannel();
/** Lets waiting messages in. */
function breathe() {
  return new Promise((resolve) => {
    port1.onmessage = resolve;
    port2.postMessage(null);
  });
}

const actions = {
  start({ module }) {
    engine = new Engine(module);
    postMessage({ type: "ready" });
  },
  gallery() {
    postMessage({ type: "gallery", gallery: engine.gallery() });
  },
  draw: begin,
  assist: begin,
  stop: begin,
  join(part) {
    parts.push(part);
    wake();
  },
  overlay({ overlay }) {
    shown.overlay = overlay;
    if (shown.id > 0) show(shown.done);
  },
  inspect({ id, column, row }) {
    postMessage({ type: "pixel", asked: id, pixel: shown.fine ? engine.pixel(column, row) : null });
  },
  png() {
    const bytes = engine.png(shown.overlay);
    postMessage({ type: "png", bytes }, [bytes.buffer]);
  },
};

onmessage = ({ data }) => attempt(() => actions[data.type](data));

async function attempt(action) {
  try {
    await action();
  } catch (error) {
    // A trap: the module's memory is in an unknown state, and the page starts another worker.
    postMessage({ type: "failed", message: engine?.panic() || String(error) });
  }
}

/** Whatever is going on gives way to this. */
function begin(message) {
  next = message;
  wake();
  if (!running) run();
}

async function run() {
  const works = { draw, assist, stop() {} };
  running = true;
  while (next) {
    const message = next;
    next = null;
    postMessage({ type: "taken", count: message.count });
    await attempt(() => works[message.type](message));
    if (!next) postMessage({ type: "idle", count: message.count });
  }
  running = false;
}

/** Begins a picture that could be begun before, when it was coarse. */
function open(request) {
  const { error } = engine.open(request);
  if (error) throw new Error(error.message ?? String(error));
}

/** Proves a part of a picture that another worker draws. */
async function assist({ id, request, overlay, part }) {
  shown = { id, overlay, fine: true, part: part[0], tolerance: request.tolerance };
  open({ ...request, part });
  await finish(false);
  if (next) return;
  const state = engine.state();
  postMessage({ type: "part", id, state }, [state.buffer]);
  // From here on the first worker knows more.
  shown.id = 0;
}

/** Works and shows until the picture, or the part of it, is finished, or something else is to be done. */
async function finish(whole) {
  let last = performance.now();
  for (;;) {
    const done = engine.refine(SLICE);
    if (done || performance.now() - last > SHOW) {
      show(done && whole);
      last = performance.now();
    }
    if (done) return;
    await breathe();
    if (next) return;
  }
}

/** Asks for the GPU, and the heart whether it can be trusted. */
async function openGpu(software) {
  try {
    const machine = await Machine.open(software);
    const { name } = machine.about;
    engine.gpuOpen(machine.about);
    const { state, cases, message } = await decide(engine, machine);
    if (machine.lost && (losses += 1) < LOSSES) gpu = null;
    return state === "passed" ? { machine, name, cases } : { message };
  } catch (error) {
    return { message: error.message };
  }
}

/**
 * Lets the GPU prove what it can of the picture that was opened; tells whether it did, and why where it did not. For its probe and its
 * kernels nobody waits longer than the processor would take for all of it: they go on meanwhile, and the next picture has them.
 */
async function consult(id, forecast, wanted) {
  const began = performance.now();
  const say = (told) => postMessage({ type: "gpu", id, ...told });
  const any = wanted === "any";
  let working = any;
  let progress = 0;
  // A GPU that is at work is left where it would take several times as long, or hangs.
  const late = () => {
    const spent = performance.now() - began;
    return !any && spent >= forecast && (!working || spent > SLOW * forecast * progress);
  };
  const gone = () => next !== null || late();
  const woken = (resolve) => (wake = resolve);
  const timer = setInterval(() => wake(), 100);
  gpu ??= openGpu(any);
  let trusted = null;
  gpu.then((answer) => {
    trusted = answer;
    wake();
  });
  await breathe();
  if (!trusted) say({ state: "opening" });
  const light = !any && forecast < GPU_FROM;
  while (!trusted && !gone()) await new Promise(woken);
  const { machine, name, cases, message } = trusted ?? { message: "the GPU is still being asked" };
  const stays = (reason) => {
    clearInterval(timer);
    if (!next) say({ state: "processor", name, cases, message: reason });
    return false;
  };
  if (!machine || next) return stays(message);
  if (light) return stays("a picture as light as this one is left to it");
  const refusal = engine.gpuBegin();
  if (refusal) return stays(refusal);
  const told = (step) => {
    progress = step.progress;
    working ||= progress > 0;
    say({ state: "waits", name, cases, progress });
  };
  const step = await decide(engine, machine, { gone, woken, told });
  if (!step) {
    engine.gpuLeave();
    return stays(working ? "the GPU is slower than it" : "kernels for this formula are still being compiled");
  }
  if (machine.lost && (losses += 1) < LOSSES) gpu = null;
  if (step.state !== "proved") return stays(step.message);
  clearInterval(timer);
  say({ name, cases, ...step });
  return true;
}

async function draw({ id, request, overlay, thumbnail, workers, share, gpu: wanted }) {
  const began = performance.now();
  // It is probed while the coarse picture is drawn.
  if (wanted !== "off") gpu ??= openGpu(wanted === "any");
  parts = [];
  postMessage({ type: "phase", id, phase: "coarse" });
  const before = shown;
  shown = { id, overlay, fine: false };
  if (thumbnail) {
    const { error } = engine.open({ ...request, ...COARSE_PROOF });
    while (!error && !engine.refine(SLICE) && performance.now() - began < thumbnail);
    show(true);
    return;
  }
  const { width, height } = coarse(request);
  const scene = engine.open({
    ...request,
    width,
    height,
    tolerance: Math.max(request.tolerance, COARSE_PROOF.tolerance),
    rectangles: COARSE_PROOF.rectangles,
  });
  if (scene.error) {
    // The engine still has the picture before, which is not to be shown as one of this request.
    shown = { ...before, id: 0 };
    postMessage({ type: "refused", id, error: scene.error });
    return;
  }
  postMessage({ type: "scene", id, scene });
  const opened = performance.now();
  let done = false;
  while (!done) {
    done = engine.refine(SLICE);
    if (done || performance.now() - opened < PATIENCE) continue;
    show(false);
    await breathe();
    if (next) return;
  }
  pace = (performance.now() - opened) / (width * height);
  show(true);
  await breathe();
  if (next) return;

  const forecast = (performance.now() - opened) * ((request.width * request.height) / (width * height)) ** GROWTH;
  const whole = () => ({ id, overlay: shown.overlay, fine: true, part: 0, tolerance: request.tolerance });
  let helped = false;
  if (wanted !== "off") {
    postMessage({ type: "phase", id, phase: "fine" });
    open(request);
    shown = whole();
    helped = await consult(id, forecast, wanted);
    if (next) return;
  }
  // What a GPU leaves is not worth sharing.
  const shared = !helped && workers > 1 && (share || forecast > SHARE_FROM);
  postMessage({ type: "phase", id, phase: "fine", shared });
  if (shared) open({ ...request, part: [0, workers] });
  else if (wanted === "off") open(request);
  shown = whole();
  await finish(!shared);
  if (!shared) return;
  for (let missing = workers - 1; missing > 0 && !next; missing -= 1) {
    parts = parts.filter((part) => part.id === id);
    if (parts.length === 0) await new Promise((resolve) => (wake = resolve));
    const part = parts.shift();
    if (part?.id === id) engine.join(part.state);
    else missing += 1;
  }
  if (!next) {
    shown.joined = true;
    await finish(true);
  }
}

/** The size of a coarse picture: of the same shape, as large as the time allows. */
function coarse({ width, height }) {
  const shorter = Math.min(width, height);
  const side = Math.sqrt((COARSE_TIME / pace) * (shorter / Math.max(width, height)));
  const aim = Math.min(shorter, Math.max(COARSE.least, Math.min(COARSE.most, 16 * Math.floor(side / 16))));
  return { width: Math.round((width * aim) / shorter), height: Math.round((height * aim) / shorter) };
}

function show(done) {
  shown.done = done;
  const { id, overlay, fine, part, joined, tolerance } = shown;
  const report = engine.report();
  // Under a fine picture lies the coarse one: a pixel covers it when its light is known.
  const pixels = engine.pixels(overlay, fine && !done);
  const legend = overlay ? engine.legend(overlay) : [];
  postMessage({ type: "picture", id, fine, part, joined, done, tolerance, pixels, report, legend }, [pixels.buffer]);
}
