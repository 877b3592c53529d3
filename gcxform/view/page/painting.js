// The colours of moves by what is asked, and the legend that says what they are.
import { GREY, OKABE_ITO, css, gradient, ramp } from "./colours.js";
import { paint } from "./drawing.js";
import { RAPID } from "./path.js";
import { byId, made, main, view } from "./state.js";

const KINDS = ["rapid", "line", "clockwise arc", "counter-clockwise arc"];

export function paintAll() {
  for (const program of view.programs) {
    const colourOf = colourer(program);
    paint(view.drawing, program.shown, (row) => (view.rapids || program.path.kind[row] !== RAPID ? colourOf(row) : null));
    const behind = view.programs.length > 1 && program !== main() && view.alone < 0;
    program.shown.uniforms.single.value = behind ? [...GREY.map((each) => each / 255), 1] : [0, 0, 0, 0];
    program.shown.uniforms.width.value = behind ? 1.2 : 2;
    program.shown.uniforms.behind.value = behind ? 1e-4 : 0;
  }
  showLegend();
}

function colourer(program) {
  const { path } = program;
  if (view.colour === "kind") return (row) => (path.kind[row] === RAPID ? GREY : OKABE_ITO[path.kind[row] - 1]);
  if (view.colour === "feed") return sized(program, path.feed, rangeOf("feed"));
  const size = program.sizes.find((each) => each.name === view.colour);
  if (size) return sized(program, size.of, rangeOf(view.colour));
  const sort = program.sorts.find((each) => each.name === view.colour);
  return sort ? (row) => OKABE_ITO[sort.of[row] % OKABE_ITO.length] : () => GREY;
}

function sized(program, values, [low, high]) {
  const span = high - low || 1;
  const plain = (row) => program.path.kind[row] === RAPID || !(values[row] >= 0);
  return (row) => (plain(row) ? GREY : ramp((values[row] - low) / span, view.dark));
}

function rangeOf(name) {
  let [low, high] = [Infinity, -Infinity];
  for (const { path, sizes } of view.programs) {
    const values = name === "feed" ? path.feed : sizes.find((each) => each.name === name)?.of ?? [];
    for (let row = 0; row < values.length; row++) {
      if (path.kind[row] === RAPID || !(values[row] >= 0)) continue;
      low = Math.min(low, values[row]);
      high = Math.max(high, values[row]);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

export function colourNames() {
  const names = new Set(["kind", "feed"]);
  for (const { sizes, sorts } of view.programs) for (const each of [...sizes, ...sorts]) names.add(each.name);
  return [...names];
}

export function showLegend() {
  const legend = byId("legend");
  legend.replaceChildren();
  const sort = view.programs.flatMap(({ sorts }) => sorts).find((each) => each.name === view.colour);
  const names = view.colour === "kind" ? KINDS : sort?.names;
  if (view.scene?.layers.errors?.visible) {
    const { factor, most } = view.scene;
    legend.append(made("div", `errors of the machine × ${factor}, largest ${Number((1000 * most).toPrecision(4))} um`));
  }
  if (names) {
    names.slice(0, 24).forEach((name, k) => {
      const colour = view.colour !== "kind" ? OKABE_ITO[k % OKABE_ITO.length] : k ? OKABE_ITO[k - 1] : GREY;
      const swatch = made("i", "");
      swatch.className = "swatch";
      swatch.style.background = css(colour);
      legend.append(swatch, made("span", name));
    });
    return;
  }
  const unit = view.programs.flatMap(({ sizes }) => sizes).find((each) => each.name === view.colour)?.unit ?? "";
  const [low, high] = rangeOf(view.colour);
  const bar = made("i", "");
  bar.className = "bar";
  bar.style.background = gradient(view.dark);
  const ends = made("span", "");
  ends.className = "ends";
  ends.append(made("span", `${Number(low.toPrecision(4))}`), made("span", `${view.colour} ${unit}`), made("span", `${Number(high.toPrecision(4))}`));
  legend.append(bar, ends);
}
