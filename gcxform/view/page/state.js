// What the page knows, and the parts of it that everything here needs.
export const view = { programs: [], chosen: null, colour: "kind", rapids: true, alone: -1, dark: false };

export const byId = (id) => document.getElementById(id);

export function made(kind, text) {
  const element = document.createElement(kind);
  element.textContent = text;
  return element;
}

export function button(where, name, act) {
  const element = made("button", name);
  element.type = "button";
  element.addEventListener("click", act);
  byId(where).append(element);
  return element;
}

// The program that is played: the last, which is what the machine is given.
export function main() {
  return view.programs[view.programs.length - 1];
}

// A point as it is drawn: from the middle of the first program.
export function fromMiddle(point) {
  return point.map((value, axis) => value - view.drawing.middle[axis]);
}
