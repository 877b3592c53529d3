// A program: its columns and its text, which moves a line has, and which lines belong together.
import { column } from "./bytes.js";
import { lineOf, textOf } from "./lines.js";
import { pathOf, timesOf } from "./path.js";
import { view } from "./state.js";

export async function programOf(head, open) {
  const path = await pathOf(head.path, open, head.frames.map(({ tool }) => tool));
  const get = (section) => column(open, section);
  const program = {
    name: head.name, words: head.words, follows: head.follows, frames: head.frames, modes: head.modes, chain: head.chain ?? {}, path, text: textOf(head, open),
    mode: await get(head.mode), line: head.line ? Uint32Array.from(await get(head.line)) : null,
    from: head.from ? Int32Array.from(await get(head.from)) : null, sizes: [], sorts: [],
  };
  for (const each of head.sizes) program.sizes.push({ ...each, of: await get(each.of) });
  for (const each of head.sorts) program.sorts.push({ ...each, of: await get(each.of) });
  program.times = timesOf(path, head.speeds);
  const lineOfRow = (row) => (program.line ? program.line[path.block[row]] : path.block[row]);
  program.lineOfRow = lineOfRow;
  program.index = indexOf(path.count, lineOfRow, head.lines);
  program.rowsOf = (line) => membersOf(program.index, line);
  program.lineAt = (line) => lineOf(program.text, line);
  return program;
}

// Which of `count` things belong to each of `groups`: offsets, and the things in order.
function indexOf(count, groupOf, groups) {
  const first = new Uint32Array(groups + 2);
  for (let k = 0; k < count; k++) first[groupOf(k) + 2] += 1;
  for (let k = 2; k < first.length; k++) first[k] += first[k - 1];
  const order = new Uint32Array(count);
  for (let k = 0; k < count; k++) order[first[groupOf(k) + 1]++] = k;
  return { first, order };
}

function membersOf(index, group) {
  return Array.from(index.order.subarray(index.first[group], index.first[group + 1]));
}

// Lines of the source by lines of the output, and the other way.
export function linkAll() {
  const [source, output] = view.programs;
  if (!output?.from) return;
  source.linkOf = indexOf(output.from.length, (line) => output.from[line] + 1, source.text.count + 1);
}

export function linesLinked(nth, line) {
  const [source, output] = view.programs;
  if (!output?.from) return [];
  if (nth === 1) return output.from[line] >= 0 ? [output.from[line]] : [];
  return membersOf(source.linkOf, line + 1);
}
