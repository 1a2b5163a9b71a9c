// The camera as hands move it. It only chooses where to look from; what is seen is the heart's business.

/** Steepest angle above the horizontal plane, radians. */
const STEEPEST = 1.55;

function polar([x, y, z]) {
  const length = Math.hypot(x, y, z);
  return { length, azimuth: Math.atan2(y, x), elevation: Math.asin(Math.max(-1, Math.min(1, z / length))) };
}

function vector({ length, azimuth, elevation }) {
  const flat = length * Math.cos(elevation);
  return [flat * Math.cos(azimuth), flat * Math.sin(azimuth), length * Math.sin(elevation)];
}

const plus = (a, b) => a.map((x, k) => x + b[k]);
const minus = (a, b) => a.map((x, k) => x - b[k]);

/** Around the target: angles in radians, to the right and upwards. */
export function orbit(camera, right, up) {
  const away = polar(minus(camera.eye, camera.target));
  const elevation = Math.max(-STEEPEST, Math.min(STEEPEST, away.elevation + up));
  return { ...camera, eye: plus(camera.target, vector({ ...away, azimuth: away.azimuth + right, elevation })) };
}

/** Nearer or further, by a factor on the distance. */
export function zoom(camera, factor) {
  const away = minus(camera.eye, camera.target).map((x) => x * factor);
  return { ...camera, eye: plus(camera.target, away) };
}

/** A light as angles in degrees around what is looked at, and its distance. */
export function lightAngles(center, target) {
  const { length, azimuth, elevation } = polar(minus(center, target));
  return { length, azimuth: (azimuth * 180) / Math.PI, elevation: (elevation * 180) / Math.PI };
}

/** The middle of a light that stands there. */
export function lightCenter({ length, azimuth, elevation }, target) {
  return plus(target, vector({ length, azimuth: (azimuth * Math.PI) / 180, elevation: (elevation * Math.PI) / 180 }));
}
