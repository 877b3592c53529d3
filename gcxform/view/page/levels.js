// Levels of detail: a chunk of corners without those that nobody could see.
import { FIELDS } from "./path.js";

export const CHUNK = 1 << 14; // corners

// How far the path would be off without each corner, by halving as Douglas and Peucker do (1973): a
// corner of a part counts no more than the one that divides the part. The farthest corner divides a
// part, or the middle one where that would leave nearly all on one side. Corners at `isFixed` stay.
export function importance(corners, first, last, isFixed) {
  const weight = new Float32Array(last - first + 1);
  weight[0] = weight[last - first] = Infinity;
  let from = first;
  for (let corner = first + 1; corner <= last; corner++) {
    if (corner === last || isFixed(corner)) {
      weight[corner - first] = Infinity;
      halve(corners, from, corner, Infinity, weight, first);
      from = corner;
    }
  }
  return weight;
}

function halve(corners, low, high, limit, weight, first) {
  if (high - low < 2) return;
  const [farthest, distance] = farthestOf(corners, low, high);
  if (distance === 0) return;
  const margin = (high - low) >> 3;
  const even = farthest - low > margin && high - farthest > margin;
  const corner = even ? farthest : (low + high) >> 1;
  const size = Math.min(distance, limit);
  weight[corner - first] = size;
  halve(corners, low, corner, size, weight, first);
  halve(corners, corner, high, size, weight, first);
}

function farthestOf(corners, low, high) {
  const [a, b] = [FIELDS * low, FIELDS * high];
  const [x, y, z] = [corners[a], corners[a + 1], corners[a + 2]];
  const [dx, dy, dz] = [corners[b] - x, corners[b + 1] - y, corners[b + 2] - z];
  const square = dx * dx + dy * dy + dz * dz || 1;
  let [best, most] = [(low + high) >> 1, -1];
  for (let at = a + FIELDS, corner = low + 1; corner < high; corner++, at += FIELDS) {
    const [px, py, pz] = [corners[at] - x, corners[at + 1] - y, corners[at + 2] - z];
    const part = Math.min(1, Math.max(0, (px * dx + py * dy + pz * dz) / square));
    const [ex, ey, ez] = [px - part * dx, py - part * dy, pz - part * dz];
    const away = ex * ex + ey * ey + ez * ez;
    if (away > most) [best, most] = [corner, away];
  }
  return [best, Math.sqrt(most)];
}

// Weights with which a colour is seen as far as it goes: a corner where it changes counts as much as
// the longer of the two stretches that it parts.
export function withTints(weight, corners, first, tintOf) {
  let [from, tint] = [0, tintOf(first + 1)];
  for (let k = 1; k < weight.length; k++) {
    const next = k + 1 < weight.length ? tintOf(first + k + 1) : -1;
    if (next === tint) continue;
    const size = distance(corners, first + from, first + k);
    weight[from] = Math.max(weight[from], size);
    weight[k] = Math.max(weight[k], size);
    [from, tint] = [k, next];
  }
  return weight;
}

function distance(corners, one, other) {
  const [a, b] = [FIELDS * one, FIELDS * other];
  return Math.hypot(corners[b] - corners[a], corners[b + 1] - corners[a + 1], corners[b + 2] - corners[a + 2]);
}

// The corners of a chunk that matter at a size in mm.
export function chosen(corners, first, last, weight, least) {
  let count = 0;
  for (let k = 0; k < weight.length; k++) count += weight[k] >= least;
  const found = new Float32Array(FIELDS * count);
  let at = 0;
  for (let k = 0; k < weight.length; k++) {
    if (weight[k] < least) continue;
    const from = FIELDS * (first + k);
    for (let field = 0; field < FIELDS; field++) found[at++] = corners[from + field];
  }
  return found;
}
