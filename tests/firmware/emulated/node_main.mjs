// A law as an ES module: node node_main.mjs LAW COUNTS FORCES
// The first count is where it begins; forces are written as float64.
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [law, from, to] = process.argv.slice(2);
const { init, step } = await import(pathToFileURL(law));
const bytes = readFileSync(from);
const counts = new Int32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
const state = init(counts[0]);
const forces = new Float64Array(counts.length - 1);
for (let k = 0; k < forces.length; k++) forces[k] = step(state, counts[k + 1]);
writeFileSync(to, forces);
