// node bunny_to_obj.js INDEX_JS: npm's `bunny` (positions and cells, counted from 0) as OBJ on standard output.
const { positions, cells } = require(require("path").resolve(process.argv[2]));
const lines = [
  ...positions.map((position) => `v ${position.join(" ")}`),
  ...cells.map((corners) => `f ${corners.map((corner) => corner + 1).join(" ")}`),
];
require("fs").writeFileSync(1, lines.join("\n") + "\n");
