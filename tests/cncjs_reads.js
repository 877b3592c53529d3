// Where the moves of a program end by what CNCjs draws it with, printed as JSON.
const Toolpath = require("gcode-toolpath");

const ends = [];
const put = (at) => ends.push([at.x, at.y, at.z]);
const path = new Toolpath({
  addLine: (modal, from, to) => put(to),
  addArcCurve: (modal, from, to) => put(to),
});
path.loadFromFile(process.argv[2], (error, lines) => {
  if (error) throw error;
  console.log(JSON.stringify({ lines: lines.length, ends }));
});
