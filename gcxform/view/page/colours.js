// Colours that everybody can tell apart: viridis for sizes, those of Okabe and Ito for kinds.

export const OKABE_ITO = [
  [0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [213, 94, 0],
  [240, 228, 66], [128, 128, 128],
];
const VIRIDIS = [
  [68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137],
  [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37],
];
export const GREY = [140, 147, 156];
// How a move is drawn, beside its colour.
export const HIDDEN = 0;
export const DASHED = 128;
export const FULL = 255;

// A colour of viridis for a part from 0 to 1; in the dark from light to dark is turned about.
export function viridis(part) {
  const at = Math.min(1, Math.max(0, part)) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[low].map((value, k) => Math.round(value + (at - low) * (VIRIDIS[low + 1][k] - value)));
}

// A ramp that is seen on its ground: the end that would vanish is left out.
export function ramp(part, dark) {
  return viridis(dark ? 0.2 + 0.8 * part : 0.88 * part);
}

export function css(colour) {
  return `rgb(${colour.join(",")})`;
}

export function gradient(dark) {
  const stops = Array.from({ length: 9 }, (_, k) => css(ramp(k / 8, dark)));
  return `linear-gradient(90deg, ${stops.join(", ")})`;
}
