// What is drawn, as the part of the address after "#": readable, and only what differs from the usual.

export const USUAL = {
  scene: "chubs",
  set: {},
  camera: null,
  light: null,
  floor: null,
  tolerance: 255,
  overlay: "",
  size: 512,
};

/** Enough digits for the eye; the address stays short. */
const short = (x) => String(Number(x.toPrecision(6)));

export function toHash(state) {
  const query = new URLSearchParams({ scene: state.scene });
  const set = Object.entries(state.set).map(([name, value]) => `${name}:${short(value)}`);
  if (set.length > 0) query.set("set", set.join(","));
  if (state.camera) {
    const { eye, target, angle } = state.camera;
    query.set("camera", [...eye, ...target, angle].map(short).join(","));
  }
  if (state.light) query.set("light", [...state.light.center, state.light.scale].map(short).join(","));
  if (state.floor !== null) query.set("floor", state.floor ? "1" : "0");
  for (const key of ["tolerance", "size"]) {
    if (state[key] !== USUAL[key]) query.set(key, state[key]);
  }
  if (state.overlay) query.set("overlay", state.overlay);
  return `#${query}`;
}

/** The state that an address names; what it does not say, or says wrongly, is as usual. */
export function fromHash(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const numbers = (key, count) => {
    const list = (query.get(key) ?? "").split(",").map(Number);
    return list.length === count && list.every(Number.isFinite) ? list : null;
  };
  const within = (key, least, most) => {
    const value = Number(query.get(key));
    return Number.isInteger(value) && value >= least && value <= most ? value : USUAL[key];
  };
  const camera = numbers("camera", 7);
  const light = numbers("light", 4);
  const set = {};
  for (const pair of (query.get("set") ?? "").split(",")) {
    const [name, value] = pair.split(":");
    if (name && value && Number.isFinite(Number(value))) set[name] = Number(value);
  }
  const overlay = query.get("overlay") ?? "";
  return {
    scene: query.get("scene")?.trim() || USUAL.scene,
    set,
    camera: camera && { eye: camera.slice(0, 3), target: camera.slice(3, 6), angle: camera[6] },
    light: light && { center: light.slice(0, 3), scale: light[3] },
    floor: query.has("floor") ? query.get("floor") === "1" : null,
    tolerance: within("tolerance", 4, 65536),
    overlay: ["verdict", "shadow", "cost", "width"].includes(overlay) ? overlay : "",
    size: within("size", 32, 2048),
  };
}
