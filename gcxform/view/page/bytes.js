// Packed columns become numbers again: what gcxform/view/packing.py did, undone.

export function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text);
  const octets = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) octets[k] = raw.charCodeAt(k);
  return octets;
}

export async function inflated(octets) {
  const stream = new Blob([octets]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The numbers of a column whose bytes are sorted by weight, as differences with folded signs.
export function unfolded(octets, head, at = 0) {
  const { n, width, order } = head;
  const found = new Float64Array(n);
  for (let plane = width - 1; plane >= 0; plane--) {
    const from = at + plane * n;
    for (let k = 0; k < n; k++) found[k] = found[k] * 256 + octets[from + k];
  }
  for (let k = 0; k < n; k++) {
    const fold = found[k];
    found[k] = fold % 2 ? -(fold + 1) / 2 : fold / 2;
  }
  for (let nth = 0; nth < order; nth++) {
    for (let k = 1; k < n; k++) found[k] += found[k - 1];
  }
  return found;
}

// A function that opens sections of the data.
export function opener(data) {
  return (section) => inflated(data.subarray(section.at, section.at + section.size));
}

export async function column(open, section) {
  const found = unfolded(await open(section), section);
  if (section.scale !== 1) {
    for (let k = 0; k < found.length; k++) found[k] *= section.scale;
  }
  return found;
}
