// The verified checker's two programs against each other and against orthocert-check, on
// certificates and on seeded mutants of them, and the realizers of BigInt against what they have to be; and what
// orthocert, which is beside orthocert-check, exports to Rocq, against what the programs cover, and some of it in Rocq:
//   node check.js NATIVE VERIFIED.JS ORTHOCERT-CHECK MUTANTS CERT.json..
"use strict";
const fs = require("fs"), os = require("os"), path = require("path");
const { spawnSync } = require("child_process");
const { Worker } = require("worker_threads");

const [, , native, script, exact, mutants, ...files] = process.argv;
require(path.resolve(script));
const verify = globalThis.orthocert_verify;
let failures = 0;
const fail = (words) => { failures++; console.error(words); };
// What JavaScript has to answer, too: asked in a thread of its own, which at the end says what was answered otherwise.
const beside_this = new Worker(`
  const { parentPort, workerData } = require("worker_threads"), others = [];
  require(workerData);
  parentPort.on("message", ([text, right]) => {
    if (text === null) return parentPort.postMessage(others);
    const answer = globalThis.orthocert_verify(text);
    if (answer !== right) others.push(answer + " in JavaScript, for " + right + ": " + text);
  });
`, { eval: true, workerData: path.resolve(script) });
beside_this.on("error", (error) => { throw error; });
const in_javascript = (text, right) => beside_this.postMessage([text, right]);

// xorshift: the same draw on every run.
let state = 0x9e3779b9;
const random = (n) => {
  state ^= state << 13; state ^= state >>> 17; state ^= state << 5; state >>>= 0;
  return state % n;
};

// Realizers.
const f = new Function(fs.readFileSync(path.join(__dirname, "js/bigint.js"), "utf8") +
  ";return { oc_ediv, oc_emod, oc_shr, oc_shl, oc_sqrt, oc_abs, oc_sign, oc_compare, oc_to_int };")();
const integer = () => {
  let x = 0n;
  for (let bits = 1 + random(600); bits > 0; bits -= 16) x = (x << 16n) | BigInt(random(65536));
  return random(2) ? x : -x;
};
const root = (a) => { const r = f.oc_sqrt(a); return r * r <= a && a < (r + 1n) * (r + 1n); };
for (let i = 0; i < 20000; i++) {
  const a = integer(), b = integer() || 1n, k = random(300), p = 1n << BigInt(k);
  const q = f.oc_ediv(a, b), r = f.oc_emod(a, b), s = f.oc_shr(a, k);
  const right = a === q * b + r && r >= 0n && r < f.oc_abs(b) && s * p <= a && a < (s + 1n) * p &&
    f.oc_shl(a, k) === a * p && root(f.oc_abs(a)) && root(f.oc_abs(a) ** 2n) && (a === 0n || root(f.oc_abs(a) ** 2n - 1n)) &&
    f.oc_sign(a) === (a > 0n ? 1 : a < 0n ? -1 : 0) && f.oc_compare(a, b) === f.oc_sign(a - b);
  if (!right) fail(`realizers: ${a} ${b} ${k}`);
}
for (const a of [0x7fffffffn, -0x80000000n]) if (BigInt(f.oc_to_int(a)) !== a) fail("oc_to_int");
for (const a of [0x80000000n, -0x80000001n, 1n << 64n]) {
  let thrown = false;
  try { f.oc_to_int(a); } catch { thrown = true; }
  if (!thrown) fail(`oc_to_int(${a}) is cut off`);
}

// Certificates.
const natively = (paths) => {
  const run = spawnSync(native, paths, { encoding: "utf8", maxBuffer: 1 << 28 });
  return run.stdout.trim().split("\n");
};
const exactly = (file) => {
  const code = spawnSync(exact, [file]).status;
  return { 0: "CERTIFIED", 1: "REFUTED", 5: "REJECTED" }[code] ?? `exit ${code}`;
};
// Claims that Postulate.v answers whatever the tree: what the formal checker reads of it may be laxer.
const isTheorem = (text) => text.includes('"mechanism":{"orthoglide"') || text.includes('"claim":{"postulate"');
let covered = 0;
const answers = natively(files);
const read = [];
files.forEach((file, i) => {
  const text = fs.readFileSync(file, "latin1");
  const start = process.hrtime.bigint();
  const answer = verify(text);
  const time = Number(process.hrtime.bigint() - start) / 1e6;
  const right = exactly(file);
  console.log(`${path.basename(file, ".cert.json").padEnd(40)} ${answer.padEnd(10)} ${time.toFixed(1).padStart(7)} ms`);
  if (answer !== answers[i]) fail(`${file}: ${answers[i]} natively`);
  if (answer.startsWith("NOT COVERED")) return;
  covered++;
  read.push(text);
  if (answer !== right) fail(`${file}: ${right} by orthocert-check`);
});
console.log(`${covered} of ${files.length} certificates are covered, with one answer of all three`);
{
  const some = [...files.slice(0, 3), path.join(__dirname, "Makefile"), path.join(__dirname, "none")];
  const [own, other] = [[process.execPath, script], [native]].map(([program, ...more]) => {
    const { status, stdout } = spawnSync(program, [...more, ...some], { encoding: "utf8" });
    return `${stdout}exit ${status}`;
  });
  if (own !== other || !own.endsWith("REJECTED\nexit 5")) fail(`node verified.js says\n${own}\nand orthocert-verified\n${other}`);
}

// Exports to Rocq: nothing but what the program does not cover is refused, and in its words. Files that cannot be
// read (exit 5), the program may not cover.
const orthocert = path.join(path.dirname(exact), "orthocert");
const agrees = (file, answer) => {
  const run = spawnSync(orthocert, ["export", "rocq", file], { encoding: "utf8", maxBuffer: 1 << 28 });
  const is_right = run.status === 0 ? !answer.startsWith("NOT COVERED")
    : run.status === 5 ? !["CERTIFIED", "REFUTED"].includes(answer)
    : run.status === 2 && (answer === "REJECTED" || answer.startsWith("NOT COVERED") && run.stderr.includes(answer.slice("NOT COVERED: ".length)));
  if (!is_right) fail(`${file}: ${answer}, and exported with exit ${run.status}: ${run.stderr}`);
  return run.stdout;
};
files.forEach((file, i) => agrees(file, answers[i]));
const made = fs.mkdtempSync(path.join(os.tmpdir(), "designs-"));
const design_files = ["", "kernel"].flatMap((folder) => {
  const all = path.join(__dirname, "../../../tests/designs", folder);
  return fs.readdirSync(all).filter((name) => name.endsWith(".toml")).map((name) => path.join(all, name));
});
const of_designs = design_files.map((design) => {
  const file = path.join(made, `${path.basename(design, ".toml")}.cert.json`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  return file;
}).filter((file) => fs.existsSync(file));
const of_design = natively(of_designs);
of_designs.forEach((file, i) => agrees(file, of_design[i]));
if (of_design.includes("REJECTED")) fail(`rejected: ${of_designs.filter((_, i) => of_design[i] === "REJECTED")}`);
// Two poses between which a platform that turns is singular.
const two_poses = ["hexapod-flat-refuted", "hexapod-yaw-refuted"].map((name) => fs.readFileSync(path.join(made, `${name}.cert.json`), "latin1"));
const one_of = path.join(made, "singular.json");
const two_answers = (text) => { fs.writeFileSync(one_of, text); return [exactly(one_of), natively([one_of])[0]]; };
// JavaScript's is that of the other program, which the thread compares.
const three_answers = (text) => { const [exact, formal] = two_answers(text); in_javascript(text, formal); return [exact, formal, formal]; };
// Ever nearer to the last number that is accepted, from one that is rejected, in JavaScript at both ends of what is left: that number.
const last_number = (text, rejected, accepted, steps, name, verdict = "CERTIFIED") => {
  const ends = [rejected, accepted], written = (x) => text(x.toFixed(15).replace(/\.?0+$/, ""));
  for (let i = 0; i < steps; i++) {
    const middle = (rejected + accepted) / 2, answers = two_answers(written(middle));
    if (new Set(answers).size > 1 || ![verdict, "REJECTED"].includes(answers[0])) fail(`${name} at ${middle}: ${answers}`);
    if (answers[0] === verdict) accepted = middle; else rejected = middle;
  }
  in_javascript(written(accepted), verdict);
  in_javascript(written(rejected), "REJECTED");
  if (steps > 1 && (rejected === ends[0] || accepted === ends[1])) fail(`${name}: no last number`);
  return written(accepted);
};
for (const [text, from, to] of [
  // of one sign; outside of the box, and of the orientations; of fewer coordinates, and of more; a strut between others
  [two_poses[0], /"singular":\[[^\]]*\]/, '"singular":["-0.2","-0.2","-0.2","-0.0364","0.0446","-0.0371"]'],
  [two_poses[0], '"point":["-0.2","-0.2","-0.2"', '"point":["-0.2","-0.2","0.2"'],
  [two_poses[0], '"singular":["-0.2","-0.2","0.2"', '"singular":["-0.2","-0.2","0.21"'],
  [two_poses[0], '"point":["-0.2","-0.2","-0.2"', '"point":["-0.3","-0.2","-0.2"'],
  [two_poses[0], '"0.076"', '"0.176"'],
  [two_poses[0], '"-0.0364"', '"-0.364"'],
  [two_poses[0], '"angle":"15"', '"angle":"5"'],
  [two_poses[0], '"0.076",', ""],
  [two_poses[0], '"0.076",', '"0.076","0.076",'],
  [two_poses[0], /,\{"drive"[^}]*\}\]/, "]"],
  [two_poses[0], /,(\{"drive"[^}]*\})\]/, ",$1,$1]"],
  [two_poses[0], /"singular":\[[^\]]*\]/, '"singular":[]'],
  [two_poses[1], '"-0.01745"', '"-0.01746"'],
  [two_poses[1], '"1.4281"', '"1.4282"'],
  [two_poses[1], '"1.4281"', '"0.7003"'],
  [two_poses[1], '"yaw":["70","110"]', '"yaw":["75","110"]'],
]) {
  const answers = three_answers(text.replace(from, to));
  if (text.replace(from, to) === text || answers.some((answer) => answer !== "REJECTED")) fail(`singular: ${answers}: ${from} ${to}`);
}
// Whatever is asked of it, and with tilts and torsions, whose tangents are no convex set.
for (const [text, from, to] of [
  [two_poses[0], "", ""],
  [two_poses[1], "", ""],
  [two_poses[0], '{"quantity":"joint_range","end":"min","bound":"0"}', '{"quantity":"one_to_one","end":"holds"}'],
  [two_poses[0], '{"quantity":"joint_range","end":"min","bound":"0"}', '{"quantity":"joint_speed","given":{"tool":["1"]},"end":"max","bound":"9"}'],
  [two_poses[0], '{"angle":"15"}', '{"tilt":{"tilt":"15","torsion":"9"}}'],
]) {
  const answers = three_answers(text.replace(from, to));
  if (answers.some((answer) => answer !== "REFUTED")) fail(`singular: ${answers}: ${from} ${to}`);
  else read.push(text.replace(from, to));
}
console.log("singular between two poses: five with one answer, and 16 refused");
// The same of legs that do not turn the platform, and of arms and sliders: between the points the last one that is of the other sign.
const vector_of = (...x) => `[${x.join(", ")}]`, two_points_of = (text) => text.match(/"point":\[(.*?)\].*"singular":\[(.*?)\]/).slice(1).map((l) => l.split(",").map((x) => +x.slice(1, -1)));
const crossed = (kind, legs, min, max, rest = "") => `[mechanism]\nkind = "${kind}"\n${rest}${legs.map((l) => `[[mechanism.legs]]\n${l}\n`).join("")}[workspace]\nmin = ${vector_of(...min)}\nmax = ${vector_of(...max)}\n`;
const crossed_strut = (a, b = a.map(() => 0)) => `drive = "strut"\nanchor = ${vector_of(...a)}\nplatform = ${vector_of(...b)}`;
const crossed_arm = (x, mode) => `drive = "arm"\nreference = [1, 0]\nanchor = [${x}, 0]\nplatform = [0, 0]\narm = 5\nlength = 6\nmode = "${mode}"`;
const crossed_slider = (x, mode) => `drive = "slider"\ndirection = [0, 1]\nanchor = [${x}, 0]\nplatform = [0, 0]\nlength = 12\nmode = "${mode}"`;
const bent_arms = fs.readFileSync(path.join(__dirname, "../../../tests/designs/kernel/planar-3-rrr.toml"), "utf8").replace(/min = \[.*?\]/, "min = [-1, -1]").replace(/max = \[\d.*?\]/, "max = [1, 1]").replace("[-15, 15]", "[-15, 75]");
const by_formulas = (joints, min, max) => `[mechanism]\nkind = "formulas"\ncoordinates = ["x", "y"]\n[mechanism.parameters]\nd = "10 ± 0.1"\n[mechanism.definitions]\nsquare = "y^2 + 1/9"\n${joints.map((j) => `[[mechanism.joints]]\n${j}\n`).join("")}[workspace]\nmin = ${vector_of(...min)}\nmax = ${vector_of(...max)}\n`;
for (const [name, design] of Object.entries({
  struts: crossed("translational", [[10, 0, 0], [-5, 8, 0], [-5, '"-8 ± 0.1"', 0]].map((a) => crossed_strut(a)), [-1, -1, -1], [1, 1, 2]),
  struts_in_the_plane: crossed("planar", [[0, 0], [10, 0]].map((a) => crossed_strut(a)), [4, -1], [6, 2]),
  arms: crossed("planar", [crossed_arm(-4, "-"), crossed_arm(4, "+")], [-1, 2], [1, 9]),
  sliders: crossed("planar", [crossed_slider(-10, "+"), crossed_slider(10, "-")], [-1, 0], ["1.5", 1]),
  arms_that_turn: bent_arms,
  coordinates_by_formulas: by_formulas(['rho = "sqrt(x^2 + square)"', 'rho = "-sqrt((x - d)^2 + square)"'], [4, -1], [6, 2]),
  rows_by_formulas: by_formulas(['row = ["x", "y"]', 'row = ["1", "square/d"]'], [4, -1], [6, 70]),
  a_divisor_by_formulas: by_formulas(['row = ["1/(x - 1/2)", "0"]', 'row = ["d", "square"]'], [-1, 0], [1, 1]),
})) {
  const toml = path.join(made, "crossed.toml"), file = path.join(made, "crossed.cert.json");
  fs.writeFileSync(toml, design.includes("[requirements]") ? design : `${design}[requirements]\njoint_force = { tool = 1, max = 1e9 }\n`);
  spawnSync(orthocert, ["verify", toml, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), [here, there] = two_points_of(text);
  agrees(file, verify(text));
  const moved = (x) => text.replace(/"singular":\[.*?\]/, `"singular":[${here.map((a, i) => `"${(a + x * (there[i] - a)).toFixed(12).replace(/\.?0+$/, "").replace(/^-0$/, "0")}"`)}]`);
  read.push(last_number(moved, 0, 1, 24, name, "REFUTED"));
  for (const mutant of [moved(-9), moved(9), text.replace(/"singular":\[".*?",?/, '"singular":['), text.replace(/"singular":\[/, '"singular":["0",'), text.replace(/"point":\[".*?",?/, '"point":[')]) {
    const answers = three_answers(mutant);
    if (mutant === text || answers.some((answer) => answer !== "REJECTED")) fail(`${name}: ${answers}: ${mutant}`);
  }
}
console.log("singular between two points of legs in any motion, and by formulas: eight machines, 192 points with one answer");
// In a cell of an atlas, whose parameter is in both points.
{
  const legs = [["10", "0", "0"], ["-5", "a", "0"], ["-5", "-8", "0"]].map((anchor) => ({ drive: "strut", anchor, platform: ["0", "0", "0"] }));
  const machine = { mechanism: { translational: legs }, workspace: { box: { min: ["-1", "-1", "-a"], max: ["1", "1", "a"] } }, require: [{ quantity: "transmission", end: "max", bound: "9" }] };
  for (const [here, there, answer] of [["-1", "1", "CERTIFIED"], ["-a", "a", "CERTIFIED"], ["-a", "a-6", "CERTIFIED"], ["-a", "a-14", "REJECTED"], ["-a", "7-a", "REJECTED"], ["-a", "a+1", "REJECTED"], ["-a", "2*a-14", "REJECTED"]]) {
    const text = JSON.stringify({ format: "orthocert/2", claim: { atlas: { parameters: [{ name: "a", min: "7", max: "8" }], machine, certified: "0", refuted: "1" } }, verdict: "certified",
      proof: { atlas: [{ refuted: { precision: 128, point: ["0", "0", here], fails: { singular: ["0", "0", there] } } }] }, provenance: { tool: "t", version: "1" } }) + "\n";
    const answers = three_answers(text);
    if (answers.some((a) => a !== answer)) fail(`singular in an atlas: ${answers}: ${here} ${there}`);
    else if (answer === "CERTIFIED") read.push(text);
  }
}
// Tolerances apart of struts of a platform that turns.
const made_as = fs.readFileSync(path.join(made, "hexapod-rubin-camera-as-made.cert.json"), "latin1");
const apart_by = /\[\[(-?\d+,){5}-?\d+\]\]\]\}\]/.exec(made_as)[0], apart_ends = /\}\},"([-+0]+)",/.exec(made_as)[1];
for (const [from, to] of [
  ['"places":3', '"places":2'], ['"places":3', '"places":4'], [/"y":\[\[(\d+)/, '"y":[[-$1'], [/"y":\[\[[^\]]*\],/, '"y":['],
  [apart_ends, apart_ends.slice(1)], [apart_ends, `${apart_ends}+`], [apart_ends, `x${apart_ends.slice(1)}`],
  [apart_by, "[[0,0,0,0,0,0]]]}]"], [apart_by, "[[1,0,0,0,0,0]]]}]"], [apart_by, "[]]}]"], [apart_by, apart_by.replace(/,-?\d+\]/, "]")],
  [apart_by, apart_by.replace("[[", "[[1,0,0,0,0,0],[")], ['"max":"227.7"', '"max":"237.7"'], ['"max":"472.9"', '"max":"482.9"'], ['"max":["11.4"', '"max":["211.4"'],
  ['"characteristic_length":"690"', '"characteristic_length":"6900"'], ['"bound":"2.9"', '"bound":"2.5"'],
]) {
  const answers = two_answers(made_as.replace(from, to));
  if (made_as.replace(from, to) === made_as || answers.some((answer) => answer !== "REJECTED")) fail(`as made: ${answers}: ${from} ${to}`);
}
for (const [from, to] of [["", ""], [apart_ends, apart_ends.replace("-", "0")], [apart_ends, apart_ends.replace("+", "-")], ['"bound":"2.9"', '"bound":"3.5"'], ['"max":"227.7"', '"max":"227.6"']]) {
  const answers = three_answers(made_as.replace(from, to));
  if (answers.some((answer) => answer !== "CERTIFIED")) fail(`as made: ${answers}: ${from} ${to}`);
}
read.push(made_as);
// The same in two wedges of directions, less ever more of a multiple; and a wedge that is none.
{
  const fan = (parts) => { const c = JSON.parse(made_as); for (const node of c.proof.tree.nodes) if (node.by) node.by = node.by.map(([i, e]) => i === 0 && e.tolerances ? [i, { fan: parts(e) }] : [i, e]); return JSON.stringify(c) + "\n"; };
  const two = (n, places = 28, b = [8, 1, 0, 0, 0, 0], c = [-1, 8, 2, 0, 0, 1]) => (e) => [[b, n, places, e], [c, n, places, e]];
  for (const [parts, right] of [[(e) => [[[1, 0, 0, 0, 0, 0], 0, 0, e]], 1], [two(0), 1], [two(9, 44, [1, 1, 1, 0, 0, 0], [0, 0, 0, -2, 1, 3]), 1], [two(1, 4), 0], [two(-1), 0], [two(1, 64), 0], [two(1, 40, [8, 1, 0, 0, 0]), 0], [() => [], 0],
    [(e) => [[[1, 0, 0, 0, 0, 0], 0, 0, { fan: two(0)(e) }]], 0]]) {
    const answers = three_answers(fan(parts));
    if (answers.some((answer, i) => right ? answer !== "CERTIFIED" : i ? ["CERTIFIED", "REFUTED"].includes(answer) : answer === "CERTIFIED")) fail(`fan as made: ${answers}: ${parts}`);
  }
  let [shown, not_shown] = [2 ** 8, 2 ** 10];
  for (let i = 0; i < 9; i++) {
    const n = Math.floor((shown + not_shown) / 2), answers = two_answers(fan(two(n)));
    if (new Set(answers).size > 1) fail(`fan as made: ${answers}: ${n}`);
    if (answers[0] === "CERTIFIED") shown = n; else not_shown = n;
  }
  agrees(one_of, natively([one_of])[0]);
  in_javascript(fan(two(shown)), "CERTIFIED");
  in_javascript(fan(two(not_shown)), "REJECTED");
  if (not_shown === 2 ** 10) fail(`fan as made: ${shown} and ${not_shown}`);
  read.push(fan(two(shown)));
}
console.log("fans at control points: with one answer at nine multiples");
console.log("tolerances apart of a platform that turns: five with one answer, and 17 refused");
// Accuracy of a platform that turns: of each part what shows it.
const one_pose = fs.readFileSync(path.join(made, "hexapod-accuracy.cert.json"), "latin1"), [first_part, second_part] = one_pose.match(/"accuracy":\[\{"y":\[\[[^}]*\},\d+,\d+\]/g);
for (const [from, to] of [
  [first_part, first_part.replace(/\},\d+,/, "},0,")], [first_part, first_part.replace(/\},\d+,/, "},-1,")], [first_part, first_part.replace(/\},\d+,/, "},64,")],
  [first_part, first_part.replace(/,\d+\]$/, ",17]")], [second_part, second_part.replace(/,\d+\]$/, ",64]")], [second_part, second_part.replace(/\},\d+,/, "},9,")],
  [first_part, first_part.replace("[[", "[[-")], [second_part, second_part.replace("[[", "[[-")], [first_part, first_part.replace(/\[\[[^\]]*\],/, "[")],
  [second_part, first_part], [/,\[2,\{"control":\{"accuracy".*?\]\}\}\]/, ""], ['{"control":{"accuracy"', '{"control":{"rank"'],
  ['"joint_error":["0.001"]', '"joint_error":["0.01"]'], ['"joint_error":["0.001"]', '"joint_error":["-0.001"]'], ['"max_angle":["0.05"]', '"max_angle":["0.01"]'],
  ['"max_angle":["0.05"]', '"max_angle":["180"]'], ['"max_angle":["0.05"]', '"max_angle":["0"]'], ['"bound":"0.01"', '"bound":"0.001"'], ['"bound":"0.01"', '"bound":"0"'],
  ['"end":"max","bound":"0.01"', '"end":"min","bound":"0.01"'], ['"given":{"joint_error"', '"leg":1,"given":{"joint_error"'], ['"max":"-22.949"', '"max":"-22.9"'],
  [/,\{"drive":"strut"(?:(?!"drive").)*"-10\.459","-4\.884","0"\]\}/, ""],
]) {
  const answers = two_answers(one_pose.replace(from, to));
  if (one_pose.replace(from, to) === one_pose || answers.some((answer) => answer !== "REJECTED")) fail(`one pose: ${answers}: ${from} ${to}`);
}
for (const [from, to] of [["", ""], ['"joint_error":["0.001"]', '"joint_error":["0.0009"]'], ['"joint_error":["0.001"]', '"joint_error":["0"]'], ['"max":"-22.949"', '"max":"-22.9491"'], ['"angle":"5"', '"angle":"4"']]) {
  const answers = three_answers(one_pose.replace(from, to));
  if (answers.some((answer) => answer !== "CERTIFIED")) fail(`one pose: ${answers}: ${from} ${to}`);
}
read.push(one_pose);
// Ever nearer to the last number with which it is shown: in space, in the plane and about a point, with tolerances at either end, and of many cells, 2 % from what is seen.
for (const [name, edits, numbers] of [
  ["hexapod-accuracy", [["platform = [1, 11.5, 0]", 'platform = ["1 ± 0.001", "11.5 ± 0.002", "0 ± 0.001"]'], ["max = 0.01, max_angle = 0.05", "max = 0.015, max_angle = 0.08"]],
    [["bound", 0.005], ["joint_error", 0.02], ["max_angle", 0.04]]],
  ["hexapod-accuracy", [["max = 0.01, max_angle = 0.05", "max = 0.0052, max_angle = 0.0295"]], []],
  ["planar-3-rpr", [["[0, 400]", '["0 ± 0.1", "400 ± 0.1"]'], ["[0, -100]", '["0 ± 0.1", "-100 ± 0.05"]'], [/transmission.*/, "accuracy = { joint_error = 0.02, max = 1, max_angle = 0.5 }"]],
    [["bound", 0.1], ["max_angle", 0.1]]],
  ["spherical-3-ups", [["[150, 0, -150]", '["150 ± 0.05", "0 ± 0.05", -150]'], [", -50, 0]", ', "-50 ± 0.03", "0 ± 0.02"]'], [/transmission.*/, "accuracy = { joint_error = 0.02, max = 1, max_angle = 0.2 }"]],
    [["bound", 0.1], ["joint_error", 0.2], ["max_angle", 0.1]]],
]) {
  const design = path.join(made, `${name}.toml`), file = path.join(made, `${name}-near.cert.json`);
  fs.writeFileSync(design, edits.reduce((text, [from, to]) => text.replace(from, to), fs.readFileSync(path.join(__dirname, "../../../tests/designs/kernel", `${name}.toml`), "utf8")));
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), claimed = text.indexOf('"accuracy"'), own = two_answers(text);
  if (own.some((answer) => answer !== "CERTIFIED")) fail(`${name}: ${own}`);
  for (const [number, beyond] of numbers) {
    const [all, head, stated] = new RegExp(`("${number}":\\[?)"([\\d.]+)"`).exec(text.slice(claimed));
    const with_ = (x) => text.slice(0, claimed) + text.slice(claimed).replace(all, `${head}"${x}"`);
    read.push(last_number(with_, beyond, +stated, 12, `${name}, ${number}`));
  }
}
console.log("accuracy of platforms that turn: nine and 96 numbers with one answer, and 23 refused");
// Accuracy of legs in any motion, arms and sliders, of platforms that turn or not, and beside angles of legs; of mechanisms by formulas.
let located = 0, not_located = 0;
for (const [name, claim, numbers, from, to] of [
  ["kernel/five-bar", "max = 0.5", [["bound", 0.005], ["joint_error", 0.2]], /arm = ([\d.]+)/g, 'arm = "$1 ± 0.01"'],
  ["kernel/five-bar", "max = 0.06", [["bound", 0.001]]],
  ["rotary-delta-linuxcnc", "max = 0.05", [["bound", 0.001], ["joint_error", 0.2]]],
  ["kernel/planar-3-rrr", "max = 0.5, max_angle = 0.5", [["bound", 0.005], ["max_angle", 0.005]]],
  ["kernel/planar-3-prr", "max = 0.2, max_angle = 0.2", [["bound", 0.002], ["joint_error", 0.2], ["max_angle", 0.002]]],
  ["delta-leg-angle", "max = 0.02", [["bound", 0.001], ["joint_error", 0.2]], /$/, "\n[requirements]\nleg_angle = { max = 80 }"],
  ["kernel/linear-delta-formulas", "max = 0.1", [["bound", 0.001], ["joint_error", 0.2]]],
  ["kernel/orthoglide-formulas", "max = 0.02", [["bound", 0.001]], "l = 312", 'l = "312 ± 0.002"'],
]) {
  const design = path.join(made, "located.toml"), file = path.join(made, "located.cert.json");
  const [head] = fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").split("[requirements]"), own = from ? head.replace(from, to) : head;
  fs.writeFileSync(design, `${own}${own.includes("[requirements]") ? "" : "\n[requirements]"}\naccuracy = { joint_error = 0.002, ${claim} }\n`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), claimed = text.indexOf('"accuracy"'), evidence = /\{"accuracy":\[\{"y":\[\[[^}]*\},\d+,\d+\]\}/.exec(text)[0];
  for (const [number, beyond] of numbers) {
    const [all, before, stated] = new RegExp(`("${number}":\\[?)"([\\d.]+)"`).exec(text.slice(claimed));
    read.push(last_number((x) => text.slice(0, claimed) + text.slice(claimed).replace(all, `${before}"${x}"`), beyond, +stated, 14, `${name}, ${number}`));
    located += 14;
  }
  for (const [part, other] of [
    [evidence, evidence.replace(/\},\d+,/, "},0,")], [evidence, evidence.replace(/\},\d+,/, "},-1,")], [evidence, evidence.replace(/\},(\d+),/, "},9$1,")], [evidence, evidence.replace(/\[\[.*?\]\]/, (y) => y.replace(/-?[1-9]\d*/g, (n) => `${-n}`))], [evidence, evidence.replace(/,\d+\]\}$/, ",17]}")],
    [evidence, evidence.replace(/\[\[[^\]]*\],/, "[")], [evidence, '"test"'], ['"joint_error":["0.002"]', '"joint_error":["-0.002"]'], ['"joint_error":["0.002"]', '"joint_error":["90"]'], [/("accuracy".*?"end":)"max"/, '$1"min"'],
    ['"given":{"joint_error"', '"leg":1,"given":{"joint_error"'], [/("max_angle":)\["[^"]*"\]/, '$1["0"]'], [/("max_angle":)\["[^"]*"\]/, '$1["180"]'], ['"given":{"joint_error":["0.002"]', '"given":{"tool":["0.002"]'],
  ]) {
    const wrong = text.replace(part, other);
    if (wrong === text) continue;
    const answers = two_answers(wrong);
    if (answers.some((answer) => answer !== "REJECTED")) fail(`${name}, accuracy: ${answers}: ${part} ${other}`); else not_located++;
  }
}
console.log(`accuracy of legs in any motion and of formulas: ${located} numbers with one answer, and ${not_located} refused`);
// Joint accelerations of platforms that turn, and a stiffness for each joint, at bounds ever nearer to the last with which they are certified.
const accelerates = "joint_acceleration = { speed = 50, acceleration = 1000, max = 1500 }", is_stiff = (joints, min) => `stiffness = { joint = [3, ${joints}], min = ${min} }`;
const no_acceleration = [[/,"test"\]/, ',"divided"]'], [/,"test"\]/, ',{"control":"test"}]'], ['"speed":["', '"speed":["-'], ['"acceleration":["', '"acceleration":["-']];
const no_stiffness = ["", '"3","3",', '"-3",', '"0",'].map((first) => ['"joint":["3",', `"joint":[${first}`]);
for (const [name, more, beyond, wrong] of [
  ["hexapod-forces", "", 0.8, no_acceleration], ["planar-3-rpr", accelerates, 0.8, no_acceleration], ["spherical-3-ups", accelerates, 0.8, no_acceleration],
  ["planar-3-rpr", is_stiff('"sqrt(10)", 4', 0.5), 3, no_stiffness], ["hexapod-linuxcnc", is_stiff("4, 5, 6, 7, 8", 0.01), 90, no_stiffness],
  ["hexa-type", is_stiff("4, 5, 6, 7, 8", 0.000001), 90, no_stiffness], ["five-bar-formulas", is_stiff("4", 0.000001), 900, no_stiffness.slice(1)],
]) {
  const design = path.join(made, `${name}.toml`), file = path.join(made, `${name}.cert.json`);
  fs.writeFileSync(design, `${fs.readFileSync(path.join(__dirname, "../../../tests/designs/kernel", `${name}.toml`), "utf8")}\n${more}\n`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), [, stated] = /"(?:speed|joint)":\["[^\]]*\]\},"end":"\w+","bound":"([\d.]+)"/.exec(text);
  read.push(last_number((b) => text.replace(`"bound":"${stated}"`, `"bound":"${b}"`), beyond * stated, +stated, 16, name));
  for (const [from, to] of wrong) {
    const answers = three_answers(text.replace(from, to));
    if (text.replace(from, to) === text || answers[0] !== "REJECTED" || answers.some((answer) => ["CERTIFIED", "REFUTED"].includes(answer))) fail(`${name}: ${answers}: ${from} ${to}`);
  }
}
console.log("accelerations of three platforms that turn, and four with a stiffness for each joint: 112 bounds with one answer, and 27 refused");
// Loads: of sliders, arms and struts, in space and in the plane, with tolerances, at bounds ever nearer to the last with which they are certified.
let loads = 0, no_loads = 0;
for (const [name, force, stated, edits] of [
  ["delta-parallel-margin", "10, 5, -100", 83, []], ["delta-parallel-margin", '10, "-5", 100', 83, [[/length = 333/g, 'length = "333 ± 0.1"'], [/direction = \[0, 0, 1\]/g, 'direction = ["0 ± 0.001", "0 ± 0.001", 1]']]],
  ["upu-struts", '"sqrt(2)", -3, 9', 9.5, []], ["tripteron", "1, 2, -3", 9, []], ["kernel/upu-base-axes", "1, -3, 9", 9.5, []], ["rotary-delta-speed", "0, 2, -10", 90, []], ["kernel/five-bar", "1, -3", 495, []], ["orthoglide-prototype", "0, 1, 3", 9, [["[requirements]", '[requirements]\ntransmission = { max = 2 }']]],
]) {
  const design = path.join(made, "load.toml"), file = path.join(made, "load.cert.json");
  const own_text = fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").replace(/\[requirements\][^]*/, "[requirements]\n");
  fs.writeFileSync(design, `${edits.reduce((text, [from, to]) => text.replace(from, to), own_text)}\nload = { force = [${force}], max = ${stated} }\n`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), own = three_answers(text);
  if (own.some((answer) => answer !== "CERTIFIED")) fail(`load of ${name}: ${own}`);
  read.push(last_number((b) => text.replace(`"end":"max","bound":"${stated}"`, `"end":"max","bound":"${b}"`), 0.3 * stated, stated, 14, `load of ${name}`)), loads += 14;
  for (const [from, to] of [
    [/"force":\[[^\]]*\]/, (all) => all.replace(/"[^"]*"/g, '"0"')], [/"force":\[/, '"force":["1",'], [/"force":\["[^"]*",/, '"force":['], [`"bound":"${stated}"`, '"bound":"0"'], [`"bound":"${stated}"`, `"bound":"-${stated}"`],
    ['"quantity":"load",', '"quantity":"load","leg":4,'], ['"end":"max","bound"', '"end":"min","bound"'], ['{"force":', '{"tool":'], [/\[2,("test"|"negative"|\{"tolerances")/, "[0,$1"],
  ]) {
    const wrong = text.replace(from, to), answers = three_answers(wrong);
    if (wrong === text || answers.some((answer) => ["CERTIFIED", "REFUTED"].includes(answer))) fail(`load of ${name}: ${answers}: ${from} ${to}`);
    no_loads++;
  }
}
console.log(`loads: ${loads} bounds with one answer, and ${no_loads} refused`);
// Accelerations of joints: arms and sliders of platforms that turn or not, and of the closed design.
let hastened = 0, not_hastened = 0;
const planar_leg = (drive) => (x) => drive === "strut" ? `drive = "strut"\nanchor = [${x}, 0]\nplatform = [0, 0]`
  : `drive = "slider"\ndirection = [1, 0]\nanchor = [${x}, 0]\nplatform = [0, 0]\nlength = "8 ± 0.01"\nmode = "${x < 5 ? "-" : "+"}"`;
const hasty = (drives) => crossed("planar", drives.map((drive, i) => planar_leg(drive)(10 * i)), [4, 3], [6, 5]);
for (const [name, certified, refuted, from, to, beside = ""] of [
  ["kernel/five-bar", 5, 0.1], ["kernel/five-bar", 5, 0.1, /arm = ([\d.]+)/g, 'arm = "$1 ± 0.01"'], ["rotary-delta-linuxcnc", 20, 1], ["kernel/planar-3-rrr", 5, 0.01], ["kernel/planar-3-prr", 20, 1],
  ["kernel/hexaglide-type", 200, 1], ["kernel/linapod-six-type", 20, 1], ["two sliders", 20, 1], ["two struts", 20, 1], ["a slider and a strut", 20, 1], ["orthoglide-cube-all", 20, 1, "", "", "transmission = { max = 2 }\n"],
]) {
  const design = path.join(made, "hastened.toml"), file = path.join(made, "hastened.cert.json");
  const head = name.startsWith("two") || name.startsWith("a ") ? hasty({ "two sliders": ["slider", "slider"], "two struts": ["strut", "strut"] }[name] ?? ["slider", "strut"])
    : fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").split("[requirements]")[0], own = from ? head.replace(from, to) : head;
  if (from && own === head) fail(`${name}: nothing to replace`);
  for (const [verdict, stated] of [["CERTIFIED", certified], ["REFUTED", refuted]]) {
    fs.writeFileSync(design, `${own}\n[requirements]\njoint_acceleration = { acceleration = 1, speed = 1, max = ${stated} }\n${beside}`);
    spawnSync(orthocert, ["verify", design, "-o", file]);
    const text = fs.readFileSync(file, "latin1"), claimed = text.indexOf('"joint_acceleration"'), said = `${name}, acceleration, ${verdict}`;
    const with_ = (number) => (x) => text.slice(0, claimed) + text.slice(claimed).replace(new RegExp(`("${number}":\\[?)"[\\d.]+"`), `$1"${x}"`);
    const beyond = verdict === "CERTIFIED" ? [["bound", 0.0001], ["acceleration", 9e4], ["speed", 9e4]] : [["bound", certified], ["acceleration", 0], ["speed", 0]];
    read.push(last_number(with_("bound"), beyond[0][1], stated, 14, said, verdict));
    hastened += 14;
    // Of what refutes at a great speed, or acceleration, the other may be zero.
    for (const [number, end] of beyond.slice(1)) for (let k = 0; k <= 4; k++) {
      const answers = two_answers(with_(number)(`${1 + (end - 1) * k / 4}`));
      if (new Set(answers).size > 1) fail(`${said}, ${number}: ${answers}`); else hastened++;
    }
    for (const [part, other] of [
      ['"acceleration":["1"]', '"acceleration":["-1"]'], ['"speed":["1"]', '"speed":["-1"]'], ['"speed":["1"]', '"speeds":["1"]'], [/("joint_acceleration".*?"end":)"max"/, '$1"min"'], ['"given":{"acceleration"', '"leg":9,"given":{"acceleration"'],
      [`"bound":"${stated}"`, '"bound":"0"'], [`"bound":"${stated}"`, '"bound":"-9"'], ['"speed":["1"]', '"speed":["1","1"]'], ...verdict === "CERTIFIED"
        ? [[/\[1,"test"\]/, '[1,{"lower":{"places":2,"y":[[1,0],[0,1]]}}]'], [/,\[1,"test"\]/, ""], [/\[1,"test"\]/, '[1,"negative"]']]
        : [[/"directions":\[\[[^\]]*\]/, '"directions":[[0]'], [/"directions":\[\[[^\]]*\]/, (d) => d.replace(/-?\d+/g, "0")], [/("directions":\[\[)/, "$11,"], [/"test":\d+/, '"test":0'], [/"test":\d+/, '"test":99']],
    ]) {
      const wrong = text.replace(part, other);
      if (wrong === text) continue;
      const answers = two_answers(wrong);
      if (answers.some((answer) => answer !== "REJECTED")) fail(`${said}: ${answers}: ${part} ${other}`); else not_hastened++;
    }
  }
}
console.log(`joint accelerations of legs in any motion: ${hastened} numbers with one answer, and ${not_hastened} refused`);
// Loads and angles of legs beside what is asked of whole machines: bodies, couples, accelerations, accuracy, two points, and determinants of struts.
let joined = 0, no_joined = 0;
for (const [name, requirements, most, wrong, steps] of [
  ["kernel/upu-base-axes", 'transmission = { max = "1.25" }\nconstraint_margin = { min = "0.8" }\nload = { force = [1, -3, 9], max = 9.5 }', "9.5", 'constraint_margin = { min = "0.99" }', 8],
  ["tripteron", "one_to_one = true\nload = { force = [1, 2, -3], max = 9 }", "9", "", 8],
  ["upu-struts", 'parallel_margin = { min = "0.1" }\nload = { force = [1, -3, 9], max = 9.5 }', "9.5", 'parallel_margin = { min = "0.99" }', 8],
  ["delta-parallel-margin", "joint_acceleration = { speed = 100, acceleration = 1000, max = 9000 }\nleg_angle = { max = 80 }\nload = { force = [10, 5, -100], max = 83 }", "83", "joint_acceleration = { speed = 100, acceleration = 1000, max = 100 }", 14],
  ["delta-parallel-margin", "load = { force = [10, 5, -100], max = 83 }\naccuracy = { joint_error = 0.01, max = 1 }", "83", "accuracy = { joint_error = 0.01, max = 0.001 }", 14],
  ["orthoglide-prototype-whole", "load = { force = [0, 1, 3], max = 9 }\nleg_angle = { max = 75 }", "9", "clearance = { min = 200 }", 0],
]) {
  const design = path.join(made, "parts.toml"), file = path.join(made, "parts.cert.json");
  const made_of = (requirements) => {
    const text = fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8");
    fs.writeFileSync(design, name.includes("whole") ? text.replace("[requirements]", `[requirements]\n${requirements}`) : text.replace(/\[requirements\][^]*/, `[requirements]\n${requirements}\n`));
    spawnSync(orthocert, ["verify", design, "-o", file]);
    const made_text = fs.readFileSync(file, "latin1");
    agrees(file, verify(made_text));
    return made_text;
  };
  const text = made_of(requirements), own = three_answers(text);
  if (own.some((answer) => answer !== "CERTIFIED")) fail(`parts of ${name}: ${own}`);
  if (steps) read.push(last_number((b) => text.replace(`"end":"max","bound":"${most}"`, `"end":"max","bound":"${b}"`), 0.3 * most, +most, steps, `parts of ${name}`)), joined += steps;
  const fails = [requirements.replace(/(load = .*max = )[\d.]*/, (_, all) => `${all}${most / 100}`)];
  if (wrong) fails.push(name.includes("whole") ? null : requirements.replace(new RegExp(`^${wrong.split(" ")[0]} = .*$`, "m"), wrong));
  for (const requirements of fails.filter((x) => x)) {
    const text = made_of(requirements), answers = three_answers(text);
    if (answers.some((answer) => answer !== "REFUTED")) fail(`parts of ${name}: ${answers}: ${requirements}`);
    else read.push(text);
    for (const by of [-1, 1, 2, 9]) {
      const other = text.replace(/"fails":\{"obligation":\[(\d+)/, (all, i) => all.replace(i, Math.max(0, +i + by))), answers = three_answers(other);
      if (new Set(answers).size > 1 || answers[0] === "CERTIFIED") fail(`parts of ${name}: ${answers}: ${by}`);
      no_joined++;
    }
  }
  for (const [from, to] of [['"load","given"', '"load","leg":4,"given"'], [/"force":\["[^"]*",/, '"force":['], [/(\{"quantity":"load".*?"\})/, "$1,$1"], [/\[([1-9]),"test"/, '[$1,"negative"']]) {
    const other = text.replace(from, to), answers = three_answers(other);
    if (other !== text && answers.some((answer) => answer !== "REJECTED")) fail(`parts of ${name}: ${answers}: ${from} ${to}`);
    no_joined++;
  }
}
// Determinants of struts in the plane, beside those of a slider too; serial singularities these have none.
for (const [name, legs] of Object.entries({ struts: [[0, 0], [10, 0]].map((a) => crossed_strut(a)), "a strut and a slider": [crossed_strut([0, 0]), crossed_slider(10, "-")] })) {
  const design = path.join(made, "parts.toml"), file = path.join(made, "parts.cert.json");
  for (const [min, right] of [["0.3", "CERTIFIED"], ["0.99", "REFUTED"]]) {
    fs.writeFileSync(design, `${crossed("planar", legs, [4, 1], [6, 2])}[requirements]\nparallel_margin = { min = "${min}" }\nload = { force = [1, 2], max = 90 }\n`);
    spawnSync(orthocert, ["verify", design, "-o", file]);
    const text = fs.readFileSync(file, "latin1"), own = three_answers(text), at = (b) => text.replace(`"bound":"${min}"`, `"bound":"${b}"`);
    agrees(file, own[1]);
    if (own.some((answer) => answer !== right)) fail(`${name}: ${own}`);
    read.push(right === "CERTIFIED" ? last_number(at, 0.99, 0.3, 14, name) : last_number(at, 0.3, 0.99, 14, name, "REFUTED")), joined += 14;
    for (const quantity of ["serial_margin", "leg_angle"]) {
      const answers = three_answers(text.replace('"quantity":"parallel_margin"', `"quantity":"${quantity}"`).replace('"end":"min"', quantity === "leg_angle" ? '"end":"max"' : '"end":"min"'));
      if (answers.some((answer) => answer !== "REJECTED")) fail(`${name}: ${answers}: ${quantity}`);
      no_joined++;
    }
  }
}
console.log(`loads beside other requirements: ${joined} bounds with one answer, and ${no_joined} others`);
// Refutations: of quantities on machines of each kind, at bounds ever nearer to the last with which the witness refutes; and in no directions, or others.
const refutations = [
  ["skew-guides", "joint_force = { tool = 10, max = 1 }", 90], ["skew-guides", "joint_acceleration = { speed = 50, acceleration = 1000, max = 10 }", 9000],
  ["upu-struts", "joint_force = { tool = 10, max = 1 }", 90], ["upu-struts", "joint_acceleration = { speed = 50, acceleration = 1000, max = 10 }", 9000],
  ["tripteron", "joint_force = { tool = 10, max = 1 }", 90], ["tripteron", "joint_acceleration = { speed = 50, acceleration = 1000, max = 10 }", 9000],
  ["kernel/four-guides", "stiffness = { joint = [3, 4, 5, 6], min = 90 }", 0.01], ["kernel/hexapod-linuxcnc", "stiffness = { joint = [3, 4, 5, 6, 7, 8], min = 90 }", 0.01],
  ["kernel/hexapod-linuxcnc", "joint_force = { tool = 10, max = 1 }", 90], ["kernel/hexapod-linuxcnc", "joint_speed = { tool = 10, max = 1 }", 90],
  ["kernel/planar-3-rpr", "joint_force = { tool = 10, max = 1 }", 90], ["kernel/spherical-3-ups", "joint_speed = { tool = 10, max = 1 }", 90],
  ["kernel/planar-3-prr", "joint_force = { tool = 10, max = 1 }", 90],
  ["kernel/hexapod-joints", "clearance = { min = 9 }", 0.1], ["kernel/hexapod-joints", null, 40, "base_joint"], ["kernel/hexapod-joints", null, 40, "platform_joint"],
  ["kernel/linear-delta-formulas", "transmission = { max = 1.01 }", 9], ["kernel/linear-delta-formulas", "transmission = { min = 0.99 }", 0.1], ["kernel/linear-delta-formulas", "conditioning = { max = 1.01 }", 9],
  ["kernel/linear-delta-formulas", "joint_range = { max = 300 }", 900], ["kernel/linear-delta-formulas", "joint_force = { tool = 10, max = 1 }", 90], ["kernel/linear-delta-formulas", "joint_speed = { tool = 10, max = 1 }", 90],
  ["kernel/linear-delta-formulas", "stiffness = { joint = [3, 4, 5], min = 90 }", 0.01], ["kernel/agile-eye", "transmission = { max = 1.01 }", 9], ["kernel/agile-eye", "joint_force = { tool = 10, max = 1 }", 90],
  ["kernel/georg-v-type", "transmission = { max = 0.01 }", 9000],
  ...["skew-guides", "upu-struts", "tripteron", "orthoglide-tolerance", "rotary-delta-speed"].map((name) => [name, "load = { force = [1, 2, -10], max = 1 }", 900]), ["kernel/five-bar", "load = { force = [1, -3], max = 1 }", 9000],
  ...["planar-3-rpr", "hexapod-linuxcnc", "spherical-3-ups"].map((name) => [`kernel/${name}`, "joint_acceleration = { speed = 50, acceleration = 1000, max = 10 }", 90000]),
];
let no_refutations = 0;
for (const [name, requirement, beyond, joint] of refutations) {
  const design = path.join(made, "refuted.toml"), file = path.join(made, "refuted.cert.json");
  const [head] = fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").split("[requirements]");
  const own = joint === undefined ? head : head.replace(new RegExp(`(${joint} = .*max = )\\d+`), "$12");
  fs.writeFileSync(design, `${own}\n[requirements]\n${requirement ?? "clearance = { min = 0.1 }"}\n`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), quantity = joint ?? requirement.split(" ")[0];
  const [all, before, stated] = new RegExp(`("quantity":"${quantity}"(?:,"leg":1)?(?:,"given":\\{[^}]*\\})?,"end":"\\w+","bound":)"([\\d.]+)"`).exec(text);
  const nearest = last_number((b) => text.replace(all, `${before}"${b}"`), beyond, +stated, 12, `${name}, ${quantity}`, "REFUTED"), [, number, directions] = /"obligation":\[(\d+),(\[.*?\])\]\}\}\}/.exec(text);
  const with_ = (number, directions) => nearest.replace(/"obligation":\[\d+,\[.*?\]\]\}\}\}/, `"obligation":[${number},${directions}]}}}`);
  const zero = directions.replace(/-?\d+/g, "0"), others = directions.replace(/(\[\[?)-?(\d+),/, "$1-7$2,"), more = directions === "[]" ? "[[1]]" : directions.replace(/\]\]$/, ",1]]");
  for (const wrong of [with_(0, directions), with_(+number + 90, directions), with_(+number + 1, directions), with_(number, zero), with_(number, others), with_(number, more), with_(number, directions === "[]" ? "[[0]]" : "[]")]) {
    const answers = three_answers(wrong);
    if (new Set(answers).size > 1) fail(`${name}, ${quantity}: ${answers}: ${wrong.slice(wrong.indexOf('"fails"'))}`);
    no_refutations += answers[0] === "REJECTED";
  }
  read.push(nearest);
}
console.log(`refutations: ${12 * refutations.length} bounds of ${refutations.length} with one answer, and ${no_refutations} refused`);
// Accuracy: what refutes there does here, where the sum of all legs is one polynomial, and here at bounds that are up to a fifth greater too.
let at_accuracy = 0, no_accuracy = 0, skew;
for (const [name, angle, part, changed] of [
  ["skew-guides"], ["upu-struts"], ["tripteron"], ["orthoglide-tolerance"],
  ["kernel/planar-3-rpr", 0.1], ["kernel/hexapod-accuracy", 0.03], ["kernel/hexapod-rubin-camera-as-made", 0.1], ["kernel/spherical-3-ups", 0.001],
  ["rotary-delta-linuxcnc"], ["kernel/five-bar"], ["kernel/five-bar", 0, /arm = ([\d.]+)/g, 'arm = "$1 ± 0.001"'], ["kernel/planar-3-rrr", 0.1], ["kernel/hexaglide-type", 0.1], ["kernel/planar-3-prr", 0.1],
  ["delta-leg-angle", 0, /$/, "\n[requirements]\nleg_angle = { max = 80 }"], ["kernel/linear-delta-formulas"], ["kernel/orthoglide-formulas"], ["kernel/orthoglide-formulas", 0, "l = 312", 'l = "312 ± 0.002"'],
]) {
  const design = path.join(made, "refuted.toml"), file = path.join(made, "refuted.cert.json");
  const [head] = fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").split("[requirements]");
  const own = part ? head.replace(part, changed) : head;
  if (part && own === head) fail(`${name}: nothing to replace`);
  fs.writeFileSync(design, `${own}${own.includes("[requirements]") ? "" : "\n[requirements]"}\naccuracy = { joint_error = 0.002, max = 0.0001${angle ? `, max_angle = ${angle}` : ""} }\n`);
  spawnSync(orthocert, ["verify", design, "-o", file]);
  // About a point there is no other place: by the angle.
  const text = fs.readFileSync(file, "latin1"), by = name.includes("spherical") ? `"max_angle":["${angle}"]` : '"bound":"0.0001"', with_ = (x) => text.replace(by, by.replace(/[\d.]+/, x.toFixed(15).replace(/\.?0+$/, "")));
  let refuted = angle && name.includes("spherical") ? angle : 0.0001, rejected = 60, farthest = 0;
  for (let i = 0; i < 14; i++) {
    const middle = Math.sqrt(refuted * rejected), [there, here] = two_answers(with_(middle));
    if (there === "REFUTED") refuted = middle; else rejected = middle;
    if (here === "REFUTED") farthest = Math.max(farthest, middle);
    if (there === "REFUTED" && here !== "REFUTED") fail(`${name}, accuracy at ${middle}: ${here}`); else at_accuracy++;
  }
  if (farthest > 1.2 * refuted) fail(`${name}, accuracy: refuted at ${farthest}`);
  for (const [x, answer] of [[refuted, "REFUTED"], [1.3 * refuted, "REJECTED"]]) {
    const answers = three_answers(with_(x));
    if (answers.some((a) => a !== answer)) fail(`${name}, accuracy at ${x}: ${answers}`);
  }
  const nearest = with_(refuted);
  read.push(nearest);
  if (name === "skew-guides") skew = text;
  for (const [from, to] of [
    [/"obligation":\[\d+/, '"obligation":[0'], [/"obligation":\[\d+/, '"obligation":[9'], [/"obligation":\[(\d+),\[\[.*?\]\]/, '"obligation":[$1,[[0,0,0]]'], [/\]\]\}\}\}/, ",1]]}}}"], [/("obligation":\[\d+,)\[.*?\]\]/, "$1[]]"],
    ['"joint_error":["', '"joint_error":["-'], [by, by.replace(/[\d.]+/, "-1")], [by, by.replace(/[\d.]+/, "0")], ['"max_angle":["', '"max_angle":["18'],
  ]) {
    const wrong = nearest.replace(from, to);
    if (wrong === nearest) continue;
    const answers = two_answers(wrong);
    if (answers.some((a) => a !== "REJECTED")) fail(`${name}, accuracy: ${answers}: ${from} ${to}`); else no_accuracy++;
  }
}
// In a cell of an atlas: the bound is a parameter, or a length is. Of wide cells the exact checker shows more.
{
  const { claim: { machine }, proof: { witness } } = JSON.parse(skew);
  const cell = (parameter, bound, length) => {
    machine.require[0].bound = bound;
    machine.mechanism.translational[0].length = length;
    return JSON.stringify({ format: "orthocert/2", claim: { atlas: { parameters: [parameter], machine, certified: "0", refuted: "1" } }, verdict: "certified",
      proof: { atlas: [{ refuted: witness }] }, provenance: { tool: "t", version: "1" } }) + "\n";
  };
  const b = (min, max) => ({ name: "b", min, max }), r = (max) => ({ name: "r", min: "310", max });
  for (const [text, exactly, here = exactly] of [
    [cell(b("0.001", "0.002"), "b", "310"), "CERTIFIED"], [cell(b("0.0001", "0.0035"), "b", "310"), "CERTIFIED"], [cell(b("0.001", "0.01"), "b", "310"), "REJECTED"], [cell(b("0.01", "0.02"), "b", "310"), "REJECTED"],
    [cell(r("310.0001"), "0.001", "r"), "CERTIFIED"], [cell(r("312"), "0.01", "r"), "REJECTED"], [cell(r("310.0001"), "0.01", "r"), "REJECTED"],
    [cell(r("312"), "0.001", "r"), "CERTIFIED", "REJECTED"],
  ]) {
    const answers = three_answers(text);
    if (answers.some((a, i) => a !== (i === 0 ? exactly : here))) fail(`accuracy in an atlas: ${answers}: ${text}`);
  }
  read.push(cell(b("0.001", "0.002"), "b", "310"), cell(r("310.0001"), "0.001", "r"));
}
console.log(`accuracy refuted: 18 machines, ${at_accuracy} bounds, and ${no_accuracy} refused`);
// Tolerances apart of mechanisms by formulas: the last bound with which the tree shows what is claimed; and by other evidence.
let by_formulas_apart = 0;
for (const [name, edits, from, to] of [
  ["five-bar-formulas", [["r = 90", 'r = "90 ± 3"']], [/"end":"max","bound":"300"/, '"300"', 100], 300],
  ["linear-delta-formulas", [["333 ± 0.01", "333 ± 1"], ["r = 174.75", 'r = "174.75 ± 1"'], [/joint_range.*/, ""]], [/"end":"max","bound":"1.4"/, '"1.4"', 1.39], 1.4],
  ["orthoglide-formulas", [["l = 312", 'l = "313.5 ± 1"'], [/transmission = .*/, "conditioning = { max = 4 }"]], [/"end":"max","bound":"4"/, '"4"', 1.5], 4],
]) {
  const design = path.join(made, "apart.toml"), file = path.join(made, "apart.cert.json");
  fs.writeFileSync(design, edits.reduce((text, [from, to]) => text.replace(from, to), fs.readFileSync(path.join(__dirname, `../../../tests/designs/kernel/${name}.toml`), "utf8")));
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), own = three_answers(text), apart = text.match(/\{"tolerances"/g)?.length ?? 0;
  agrees(file, own[1]);
  if (!apart || own.some((answer) => answer !== "CERTIFIED")) fail(`apart, ${name}: ${own}, ${apart} times`);
  read.push(last_number((b) => text.replace(from[0], (all) => all.replace(from[1], `"${b}"`)), from[2], to, 12, `apart, ${name}`));
  for (const [from, to] of [[/(\{"tolerances":\[.*?,")([-+0<=>])/, (_, all, end) => `${all}${end === "+" ? "-" : "+"}`], [/(\{"tolerances":\[.*?,"[-+0<=>])/, "$1+"], [/(\{"tolerances":\[.*?,"[-+0<=>]*",\[\[)/, "$10,"], [/(\{"tolerances":\[.*?,"[-+0<=>]*",\[\[)-?(\d)/, "$19$2"]]) {
    const other = text.replace(from, to), answers = three_answers(other);
    if (other === text || new Set(answers).size > 1) fail(`apart, ${name}: ${answers}: ${from} ${to}`);
  }
  by_formulas_apart += 16;
}
console.log(`tolerances apart by formulas: ${by_formulas_apart} with one answer`);
// Tolerances halved at the root of a tree, above twice its nodes: at bounds ever nearer to the last with which they are certified, and beyond that of the tree alone.
for (const [name, m, numbers, beyond, further] of [
  ["orthoglide-tolerance", 3, 3, 0.8, 0], ["planar-3-prr", 3, 3, 0.8, 1], ["five-bar", 2, 2, 0.8, 1], ["hexapod-rubin-camera-as-made", 6, 36, 0.8, 17], ["five-bar-formulas", 2, 1, 0.8, 0],
]) {
  const text = fs.readFileSync(path.join(made, `${name}.cert.json`), "latin1"), nodes = /"nodes":\[(.*)\]\}\},"prov/.exec(text)[1];
  const halved = (j, lower = nodes, upper = nodes) => text.replace(`"nodes":[${nodes}]`, `"nodes":[{"split":${m + j}},${[lower, upper].filter((x) => x).join()}]`);
  const [, stated] = /"end":"max","bound":"([\d.]+)"/.exec(text);
  for (const whole of [text, halved(further)])
    last_number((b) => whole.replace(`"bound":"${stated}"`, `"bound":"${b}"`), beyond * stated, +stated, m > 3 ? 1 : 20, `${name} halved`);
  for (const wrong of [halved(numbers), halved(further, nodes, ""), halved(further, "", nodes), halved(further, nodes, `${nodes},${nodes}`)]) {
    const answers = three_answers(wrong);
    if (answers.some((answer) => answer !== "REJECTED")) fail(`${name} halved: ${answers}`);
  }
  read.push(halved(further));
}
for (const name of ["hexapod-accuracy", "orthoglide-prototype-whole"]) {
  const whole = fs.readFileSync(path.join(made, `${name}.cert.json`), "latin1").replace(/"nodes":\[(.*)\]\}\},"prov/, (_, nodes) => `"nodes":[{"split":${name === "hexapod-accuracy" ? 6 : 3}},${nodes},${nodes}]}},"prov`);
  const answers = three_answers(whole);
  if (answers.some((answer) => answer !== "REJECTED")) fail(`${name} halved: ${answers}`);
}
console.log("tolerances halved: five trees and 162 bounds with one answer, and 22 refused");
// Directions of one scale, and directions apart: what shows the widest tolerances.
const widest = (name, on) => {
  const folder = fs.mkdtempSync(path.join(made, "widest-"));
  spawnSync(orthocert, ["tolerance", path.join(__dirname, `../../../tests/designs/${name}.toml`), "--on", on, "-o", folder]);
  return fs.readFileSync(path.join(folder, `tolerance-${on}-certified.cert.json`), "latin1");
};
const scaled = widest("orthoglide-as-built", "direction"), plain = widest("orthoglide-as-built", "anchor"), both = widest("orthoglide-wide-tolerance", "direction");
// Three directions at 60 degrees, with as much of what says that a direction is in a wedge as a power of two may be: with less than three of them it is too much.
const with_three = (k) => {
  const all = JSON.parse(plain), step = all.proof.tree.nodes.flatMap((node) => node.by ?? []).find(([, e]) => e.tolerances?.[0].lower);
  step[1] = { fan: [[8, 0, 0], [4, 7, 0], [-4, 7, 0]].map((c) => [c, 2 ** k, 40, JSON.parse(JSON.stringify(step[1]))]) };
  return `${JSON.stringify(all)}\n`;
};
const fanned = with_three([...Array(41).keys()].reverse().find((k) => verify(with_three(k)) === "CERTIFIED"));
const one_scale = /"([-+0<=>]*1[-+01<=>]*)",\[/.exec(scaled)[1], places_of = (c, text) => [...text.matchAll(c)].map((x) => x.index);
const put = (text, at, c) => text.slice(0, at) + c + text.slice(at + 1);
let any = 0;
for (const to of ["0", "-", "+"]) for (const at of places_of(/1/g, one_scale)) {
  const answers = three_answers(scaled.replaceAll(`"${one_scale}"`, `"${put(one_scale, at, to)}"`));
  if (new Set(answers).size > 1) fail(`of one scale: ${answers}: ${to} at ${at}`); else any++;
}
for (const text of [scaled, plain, fanned, both]) {
  const answers = three_answers(text);
  if (answers.some((answer) => answer !== "CERTIFIED")) fail(`directions: ${answers}`);
}
// The parts of the first fan, changed: refused, or with one answer.
const with_fan = (change) => {
  const all = JSON.parse(fanned), by = all.proof.tree.nodes.flatMap((node) => node.by ?? []).find(([, e]) => e.fan);
  change(by[1].fan);
  return `${JSON.stringify(all)}\n`;
};
if (with_fan(() => {}) !== fanned) fail("directions: another text");
for (const change of [
  (fan) => fan.splice(0), (fan) => fan.splice(1), (fan) => fan.pop(), (fan) => { fan[0][0].pop(); }, (fan) => { fan[0][1] = -1; }, (fan) => { fan[0][2] = 64; },
  (fan) => { fan[0][2] = 0; }, (fan) => { fan[0][3].tolerances[2][0].pop(); }, (fan) => { fan[0][3].tolerances[2] = []; },
]) {
  const answers = three_answers(with_fan(change));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`directions: ${answers}: ${change}`);
}
for (const change of [
  (fan) => { fan[0][1] = 0; }, (fan) => { fan[0][2]++; }, (fan) => { fan[0][2]--; }, (fan) => { fan[1][0] = fan[1][0].map((n) => -n); }, (fan) => { fan[0][0][0]++; }, (fan) => fan.reverse(),
  (fan) => { fan[0][3].tolerances[2] = [[0, 0, 0]]; }, (fan) => { fan[0][3].tolerances[2] = [[1, 0, 0]]; }, (fan) => fan.push(fan[0]), (fan) => { fan[2][3].tolerances[1] = fan[0][3].tolerances[1]; },
]) {
  const answers = three_answers(with_fan(change));
  if (new Set(answers).size > 1) fail(`directions: ${answers}: ${change}`); else any++;
}
for (const to of [...places_of(/[-+0<=>]/g, one_scale).map((at) => put(one_scale, at, "1")), one_scale.replace("1", "2"), one_scale.replace("1", "")]) {
  const answers = three_answers(scaled.replaceAll(`"${one_scale}"`, `"${to}"`));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`of one scale: ${answers}: ${to}`);
}
read.push(scaled, fanned, both);
console.log(`directions of one scale, and apart: three certificates and ${any} others with one answer, and ${places_of(/[-+0<=>]/g, one_scale).length + 11} refused`);
// Fans about all that is at vertices, each bound of a condition number by itself, and rank with the workspace's own inequality: at bounds ever nearer to the last.
let by_parts = 0, no_parts = 0;
{
  const steps_of = (text, change) => {
    const all = JSON.parse(text);
    for (const node of all.proof.tree.nodes) node.by = node.by?.map(([i, e]) => [i, change(e, i)]);
    return `${JSON.stringify(all)}\n`;
  };
  const design_of = (name, requirements) => {
    const design = path.join(made, "parts.toml"), file = path.join(made, "parts.cert.json");
    fs.writeFileSync(design, fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").replace(/\[requirements\][^]*/, `[requirements]\n${requirements}\n`));
    spawnSync(orthocert, ["verify", design, "-o", file]);
    return fs.readFileSync(file, "latin1");
  };
  const nearest = (text, stated, beyond, steps, name) => {
    const answers = three_answers(text);
    if (answers.some((answer) => answer !== "CERTIFIED")) fail(`${name}: ${answers}`);
    read.push(last_number((b) => text.replaceAll(`"bound":"${stated}"`, `"bound":"${b}"`), beyond, stated, steps, name));
    by_parts += steps;
  };
  const refused = (texts, name) => {
    for (const text of texts) {
      const answers = three_answers(text);
      if (answers.some((answer) => ["CERTIFIED", "REFUTED"].includes(answer))) fail(`${name}: ${answers}: ${text.slice(text.indexOf('"by"'), text.indexOf('"by"') + 300)}`);
      no_parts++;
    }
  };
  // Of all directions, and of two halves of them, with a multiple of what says so.
  const one_part = (e) => ({ fan: [[[1, 0, 0], 0, 0, e]] }), two_parts = (n, places) => (e) => ({ fan: [[[8, 1, 0], n, places, e], [[-1, 8, 2], n, places, e]] });
  const halves = (e, part = (e) => e) => e.tolerances ? { between: [e.tolerances[0].conditioning[1], e.tolerances[0].conditioning[0].places, [],
      part({ tolerances: [{ lower: e.tolerances[0].conditioning[0] }, e.tolerances[1], [e.tolerances[2][0]]] }), part({ tolerances: ["test", e.tolerances[1], [e.tolerances[2][1]]] })] }
    : { between: [e.conditioning[1], e.conditioning[0].places, [], part({ lower: e.conditioning[0] }), part("test")] };
  const is_conditioned = (e) => e.conditioning || e.tolerances?.[0].conditioning;
  const conditions = design_of("orthoglide-as-built-tight", "conditioning = { max = 3.92 }"), plainly = design_of("linear-delta-klipper-cylinder", "conditioning = { max = 4 }");
  for (const [name, text, stated, beyond] of [["as built", conditions, 3.92, 3.8], ["plainly", plainly, 4, 1.1]]) {
    for (const [i, part] of [(e) => e, one_part, two_parts(1, 24)].entries()) nearest(steps_of(text, (e) => is_conditioned(e) ? halves(e, part) : e), stated, beyond, 10, `between, ${name}, ${i}`);
    const with_ = (change) => steps_of(text, (e) => { if (!is_conditioned(e)) return e; const all = halves(e); change(all.between); return all; });
    refused([
      (b) => b.reverse(), (b) => { b[0][0] = -b[0][0]; }, (b) => b[0].pop(), (b) => b[0].push(0), (b) => { b[1] = 64; }, (b) => { b[1]++; }, (b) => { [b[3], b[4]] = [b[4], b[3]]; }, (b) => { b[4] = b[3]; }, (b) => b.pop(), (b) => b.splice(2, 1), (b) => { b[2] = [[]]; }, (b) => { b[2] = 0; },
      (b) => { b[3] = { between: b.slice() }; }, (b) => { b[3] = { fan: [] }; }, (b) => { b[4] = { fan: [[[1, 0, 0], -1, 0, b[4]]] }; }, (b) => { b[4] = { control: b[4] }; }, (b) => { b[3] = { fan: [[[1, 0], 0, 0, b[3]]] }; },
      (b) => { b[3] = { fan: [[[1, 0, 0], 0, 0, { fan: [[[1, 0, 0], 0, 0, b[3]]] }]] }; }, (b) => { b[4] = { fan: [[[1, 0, 0], 0, 0, { between: b.slice() }]] }; },
    ].map(with_), `between, ${name}`);
    refused([steps_of(text, (e) => is_conditioned(e) ? one_part(e) : e), steps_of(text, (e) => is_conditioned(e) ? one_part(halves(e)) : e)], `fan about conditioning, ${name}`);
  }
  // With a mu that is of each machine its own: by so much of all quantities of a leg, each with its row.
  const weighted = (n, end, d, change = () => {}) => steps_of(conditions, (e) => {
    if (!is_conditioned(e)) return e;
    const [y, mu] = e.conditioning ?? e.tolerances[0].conditioning, ends = end.repeat(30), own = (i, j) => Math.floor(j / 10) === i ? n * (j % 3 - 1) : 0;
    const between = [mu.map((m) => m * 2 ** 20), y.places + 20, [0, 1, 2].map((i) => [...ends].map((_, j) => own(i, j))),
      { tolerances: [{ lower: y }, ends, [[8, 8, 8], d]] }, { tolerances: ["test", ends, [[8, 8, 8]]] }];
    change(between);
    return { between };
  });
  for (const [n, end, d] of [[0, "0", [0, 0, 0]], [9999, "-", [0, 0, 0]], [-99999, "+", [5, -7, 1]], [99999, "0", [16, 0, -3]]]) nearest(weighted(n, end, d), 3.92, 3.8, 20, `between, ${n} with each row`);
  nearest(weighted(9999, "0", [0, 0, 0], (b) => { b[3] = b[3].tolerances[0]; }), 3.92, 3.8, 20, "between, all machines below"), nearest(weighted(9999, "0", [1, 2, 3], (b) => { b[4] = "test"; }), 3.92, 3.8, 20, "between, all machines above");
  refused([
    (b) => b[2].pop(), (b) => b[2][0].pop(), (b) => b[2].push(b[2][0]), (b) => { b[2][0][10] = 1; }, (b) => b[3].tolerances[2].pop(), (b) => b[4].tolerances[2].push([0, 0, 0]), (b) => b[3].tolerances[2][1].pop(), (b) => { b[0][0] = 0; },
    (b) => { b[3] = { fan: [[[1, 0, 0], 0, 0, b[3]]] }; }, (b) => { b[4] = { fan: [[[1, 0, 0], 0, 0, b[4]]] }; }, (b) => { b[2][0][0] = 2 ** 40; },
  ].map((change) => weighted(9999, "0", [0, 0, 0], change)), "between, with each row");
  const signed = three_answers(conditions.replace(/"by":\[\[\d+/, '"by":[[-'));
  if (signed.some((answer) => answer !== "REJECTED")) fail(`a sign alone: ${signed}`);
  const bounded = design_of("linear-delta-klipper-cylinder", 'transmission = { min = "0.3", max = 9 }\nstiffness = { joint = 3, min = "0.001" }');
  const is_of_form = (e) => e === "test" || e.lower || e.rank || e.inside?.[0].lower || e.inside?.[0] === "test" || e.inside?.[0].rank;
  for (const [i, part] of [one_part, two_parts(1, 12)].entries()) {
    const text = steps_of(bounded, (e, number) => number < 3 && is_of_form(e) ? part(e) : e);
    if (text === bounded) fail("no fan");
    nearest(text, 9, 1.01, 10, `fan, psi_max, ${i}`), nearest(text, 0.3, 0.99, 10, `fan, psi_min, ${i}`), nearest(text, 0.001, 3, 10, `fan, stiffness, ${i}`);
  }
  refused([[], [[[1, 0, 0], -1, 0]], [[[1, 0, 0], 0, 64]], [[[1, 0], 0, 0]], [[[1, 0, 0, 0], 0, 0]]].map((parts) =>
    steps_of(bounded, (e, number) => number < 3 && is_of_form(e) ? { fan: parts.map((p) => [...p, e]) } : e)), "fan");
  const ranked = design_of("linear-delta-klipper-cylinder", "parallel_margin = { min = 0.1 }"), identity = { y: [[0, 0, 1], [0, 1, 0], [1, 0, 0]], places: 0 };
  const inside = (n, places, then = (e) => e) => steps_of(ranked, (e, number) => number === 0 ? then({ inside: [e.inside?.[0] ?? e, n, places] }) : e);
  let accepted = 0;
  for (const then of [(e) => e, one_part]) for (const [n, places] of [[0, 0], [1, 40], [1, 12], [1, 8], [1, 4], [1, 1], [1, 0], [9, 0], [-1, 0], [1, 64]]) {
    const answers = three_answers(inside(n, places, then));
    accepted += answers[0] === "CERTIFIED";
    if (new Set(answers).size > 1) fail(`rank inside: ${answers}: ${n} ${places}`); else by_parts++;
  }
  if (accepted < 2) fail("rank inside is never shown");
  // About the rows divided by B, which all parts are about or none.
  const about = (e) => e.inside?.[0] ?? e.tolerances?.[0] ?? e, is_divided = (e) => about(e) === "divided" || about(e).lower_divided !== undefined;
  const divided = (name, change) => {
    const text = fs.readFileSync(path.join(__dirname, `../../certificates/${name}.cert.json`), "latin1"), changed = steps_of(text, (e, number) => is_divided(e) ? change(e, number) : e);
    if (text === changed) fail(`divided: ${name}`);
    return changed;
  };
  for (const [name, least, beyond_least, greatest, beyond_greatest] of [["orthoglide-tolerance", 0.5, 0.6, 2, 1.8], ["orthoglide-formulas", 0.5, 0.6, 2, 1.8], ["planar-3-prr", 0.4, 0.401, 0.95, 0.949],
      ["linear-delta-klipper-cylinder", 0.52, 0.521, 1.4, 1.399]]) for (const [i, part] of [one_part, two_parts(1, 24)].entries()) {
    nearest(divided(name, part), least, beyond_least, 9, `fan about divided, least, ${name}, ${i}`), nearest(divided(name, part), greatest, beyond_greatest, 9, `fan about divided, greatest, ${name}, ${i}`);
  }
  refused([[], [[[1, 0, 0], -1, 0]], [[[1, 0, 0], 0, 64]], [[[1, 0], 0, 0]]].map((parts) => divided("orthoglide-tolerance", (e) => ({ fan: parts.map((p) => [...p, e]) }))), "fan about divided");
  refused([divided("orthoglide-tolerance", (e) => ({ fan: [[[1, 0, 0], 0, 0, e === "divided" ? { lower_divided: { y: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], places: 0 } } : "divided"]] })),
    divided("orthoglide-tolerance", (e) => ({ fan: [[[1, 0, 0], 0, 0, e === "divided" ? e : { rank: e.lower_divided }]] }))], "fan about divided");
  for (const mixed of [(e) => [e, "test"], (e) => ["test", e]]) {
    const [first, second] = mixed("divided"), text = divided("orthoglide-tolerance", (e) => e === "divided" ? { fan: [[[8, 1, 0], 0, 0, first], [[-1, 8, 2], 0, 0, second]] } : e), answers = three_answers(text);
    if (answers.slice(1).some((answer) => answer !== 'NOT COVERED: evidence "fan" about "divided" and other rows is not covered by the verified checker')) fail(`fan about two forms of rows: ${answers}`);
    fs.writeFileSync(one_of, text);
    agrees(one_of, answers[1]);
  }
}
console.log(`parts: ${by_parts} bounds with one answer, and ${no_parts} refused`);
// Components of directions that are 0 as they are written; places; and what is accepted, and not covered.
{
  const written = (mechanism, workspace, require, by) => `${JSON.stringify({ format: "orthocert/2", claim: { machine: { mechanism, workspace, require } }, verdict: "certified",
    proof: { tree: { precision: 46, nodes: [{ by }] } }, provenance: { tool: "hand", version: "1" } })}\n`;
  const unit = (n, places, least = 1) => ({ y: [...Array(n)].map((_, i) => [...Array(n)].map((_, j) => i === j ? least : 0)), places }), at = (k, x, n = 3) => [...Array(n)].map((_, i) => i === k ? x : "0");
  const slider = (direction, k) => ({ drive: "slider", direction, anchor: at(k, "-1"), platform: at(0, "0"), length: "2", mode: "+" });
  const sliders = (direction) => ({ translational: [slider(direction, 0), slider(at(1, "1"), 1), slider(at(2, "1.5"), 2)] });
  const strut = (k) => ({ drive: "strut", anchor: at(k, "-2", 2), platform: ["0", "0"] });
  const box = (n) => ({ box: { min: Array(n).fill("-0.1"), max: Array(n).fill("0.1") } }), round = { cylinder: { center: ["0", "0"], radius: "0.1", z: ["-0.1", "0.1"] } };
  // Of definitions that have the one before them twice.
  const squares = (n) => ({ formulas: { coordinates: ["x"], parameters: [], definitions: [["d0", "x"], ...[...Array(n)].map((_, i) => [`d${i + 1}`, `d${i}*(d${i}-1)/2`])], joints: [{ rho: `x+d${n}` }] } });
  const bounded = [{ quantity: "joint_range", leg: 1, end: "max", bound: "1" }];
  const long = { min: "0.9", max: "1" }, off = { min: "-0.01", max: "0.01" }, rank = (places, least) => ({ rank: unit(3, places, least) });
  const apart = (direction, ends) => written(sliders(direction), box(3), [], [[0, { tolerances: [rank(1), ends, [[1, 1, 1]]] }]]);
  for (const [text, exact_answer, answer] of [
    [apart([long, "0", "0"], "1"), "CERTIFIED"], [apart([long, off, "0"], "10"), "CERTIFIED"], [apart([long, "0.01", "0"], "1"), "REJECTED"], [apart([long, { min: "0.01", max: "0.02" }, "0"], "10"), "REJECTED"],
    [written(sliders(at(0, "1")), box(3), [], [[0, rank(63, 2 ** 40)]]), "CERTIFIED"], [written(sliders(at(0, "1")), box(3), [], [[0, rank(64, 2 ** 40)]]), "REJECTED"],
    [written(sliders(at(0, "1")), round, [], [[0, { inside: [rank(1), 1, 10] }]]), "CERTIFIED"],
    [written({ planar: { legs: [strut(0), strut(1)] } }, box(2), [{ quantity: "parallel_margin", end: "min", bound: "0.9" }], [[0, { rank: unit(2, 1) }], [1, "test"]]), "CERTIFIED"],
    [written(squares(6), box(1), bounded, [[0, { rank: unit(1, 0) }], [1, "test"]]), "CERTIFIED"],
    [written(squares(50), box(1), bounded, [[0, { rank: unit(1, 0) }], [1, "test"]]), "CERTIFIED", "NOT COVERED: a mechanism of more than 32768 operations, with its definitions written out,"],
  ]) {
    const answers = three_answers(text);
    if (answers[0] !== exact_answer || answers[1] !== answers[2] || !answers[1].startsWith(answer ?? exact_answer)) fail(`${answers}: ${text}`);
    if (exact_answer !== "REJECTED") agrees(one_of, answers[1]);
  }
}
// Two points, or poses, with the same joint coordinates: legs whose joints in the base are in one plane, or on a line as those on the platform, and mirror images there.
{
  const inverse = (m) => {
    const n = m.length, a = m.map((row, i) => [...row, ...row.map((_, j) => +(i === j))]);
    for (let i = 0; i < n; i++) {
      const p = a.slice(i).reduce((best, row, k) => Math.abs(row[i]) > Math.abs(a[best][i]) ? i + k : best, i);
      [a[i], a[p]] = [a[p], a[i]];
      const pivot = a[i][i];
      a[i] = a[i].map((x) => x / pivot);
      for (let k = 0; k < n; k++) if (k !== i) { const by = a[k][i]; a[k] = a[k].map((x, j) => x - by * a[i][j]); }
    }
    return a.map((row) => row.slice(n));
  };
  // At a pose with two or three coordinates of place and the tangents of half angles after them, in 2^s of length.
  const twin = (claim, lengths, point, other, s, places) => any_twin(claim, lengths, point, other, other.map((_, k) => k < places ? 1 : 2 ** s), 1e-6);
  const any_twin = (claim, lengths, point, other, units, h) => {
    const off = (k, h) => other.map((x, i) => +x + (i === k ? h : 0));
    const rates = other.map((_, k) => lengths(off(k, 1e-6)).map((x, i) => (x - lengths(off(k, -1e-6))[i]) / 2e-6));
    const y = inverse(rates[0].map((_, i) => rates.map((row) => row[i]))).map((row, k) => row.map((x) => Math.round(x * units[k] * 2 ** 20)));
    const end = (sign) => JSON.stringify(other.map((x) => (+x + sign * h).toFixed(6).replace(/\.?0+$/, "")));
    return `{"format":"orthocert/2","claim":{"machine":${claim}},"verdict":"refuted","proof":{"witness":{"precision":160,"point":${JSON.stringify(point)},"fails":{"same":` +
      `{"obligation":1,"least":${end(-1)},"greatest":${end(1)},"inverse":{"y":${JSON.stringify(y)},"places":20}}}}},"provenance":{"tool":"t","version":"1"}}\n`;
  };
  const struts = (legs) => `"legs":[${legs.map(([a, p]) => `{"drive":"strut","anchor":${JSON.stringify(a)},"platform":${JSON.stringify(p)}}`)}]`;
  const asks = '"require":[{"quantity":"one_to_one","end":"holds"}]';
  const at_base = [["-1", "0", "0"], ["1", "-0.5", "0"], ["0.2", "1", "0"]], in_space = at_base.map((a) => [a, ["0", "0", "0"]]);
  const on_a_line = [["-1", "-0.5"], ["0.2", "0.3"], ["1", "0.4"]];
  const hexapod = [[1, -0.2], [1, 0.2], [-0.3, 0.9], [-0.6, 0.8], [-0.6, -0.8], [-0.3, -0.9]].map(([x, y], i) => [x, y, [[0.5, -0.6], [0.5, 0.6], [0.2, 0.5], [-0.5, 0.1], [-0.5, -0.1], [0.2, -0.5]][i]]);
  const turned_along = ([x, y, z], [p, q]) => { const n = x * x + y * y + z * z; return [((1 - n + 2 * x * x) * p + 2 * (x * y - z) * q), 2 * (x * y + z) * p + (1 - n + 2 * y * y) * q, 2 * (x * z - y) * p + 2 * (y * z + x) * q].map((t) => t / (1 + n)); };
  const twins = [
    twin(`{"mechanism":{"translational":${struts(in_space).slice(7)}},"workspace":{"box":{"min":["-1","-1","-1"],"max":["1","1","1"]}},${asks}}`,
      ([x, y, z]) => at_base.map(([a, b]) => Math.hypot(x - a, y - b, z)), ["0.1", "0.2", "0.8"], ["0.1", "0.2", "-0.8"], 1, 3),
    twin(`{"mechanism":{"planar":{${struts(on_a_line.map(([a, p]) => [[a, "0"], [p, "0"]]))},"characteristic_length":"1"}},"workspace":{"box":{"min":["-0.3","-1.2"],"max":["0.3","1.1"]}},"orientation":{"range":["-20","20"]},${asks}}`,
      ([x, y, t]) => on_a_line.map(([a, p]) => Math.hypot(x + p * (1 - t * t) / (1 + t * t) - a, y + p * 2 * t / (1 + t * t))), ["0.1", "-0.7", "0.05"], ["0.1", "0.7", "-0.05"], 1, 2),
    ...['{"angle":"20"}', '{"tilt":{"tilt":"20","torsion":"9"}}', '{"roll_pitch_yaw":{"roll":["-20","20"],"pitch":["-20","20"],"yaw":["-9","9"]}}'].map((set) =>
      twin(`{"mechanism":{"spatial":{${struts(hexapod.map(([x, y, p]) => [[`${x}`, `${y}`, "0"], [`${p[0]}`, `${p[1]}`, "0"]]))},"characteristic_length":"1"}},"workspace":{"box":{"min":["-0.2","-0.2","-1.2"],"max":["0.2","0.2","1.2"]}},"orientation":${set},${asks}}`,
        ([x, y, z, ...c]) => hexapod.map(([a, b, p]) => { const t = set.includes("roll") ? turned_by(c, p) : turned_along(c, p); return Math.hypot(x + t[0] - a, y + t[1] - b, z + t[2]); }),
        ["0.05", "0.02", "0.9", "0.03", "0.06", "0.01"], ["0.05", "0.02", "-0.9", "-0.03", "-0.06", "0.01"], 1, 3)),
  ];
  // Legs in the plane: a joint's coordinate, of an arm its angle; and a pose with those of another one, by Newton's steps.
  const leg_of = (l) => {
    const [ax, ay, px, py, u, v] = [...l.anchor, ...l.platform, ...(l.direction ?? l.reference ?? ["0", "0"])].map(Number), sign = l.mode === "-" ? -1 : 1, L = +l.length;
    return ([x, y, t = 0]) => {
      const c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t), w = [x + c * px - s * py - ax, y + s * px + c * py - ay], n = Math.hypot(u, v) || 1;
      const along = (w[0] * u + w[1] * v) / n, across = (w[1] * u - w[0] * v) / n;
      if (l.drive === "slider") return along - sign * Math.sqrt(L * L - across * across);
      if (l.drive === "strut") return Math.hypot(...w);
      const r = +l.arm, N = along * along + across * across, f = (N + r * r - L * L) / (2 * r), eta = sign * Math.sqrt(N - f * f);
      return Math.atan2(f * across - eta * along, f * along + eta * across);
    };
  };
  const other_pose = (joints, point, x) => {
    const to = joints(point.map(Number));
    for (let i = 0; i < 40; i++) {
      const rates = x.map((_, k) => { const at = (h) => joints(x.map((a, j) => j === k ? a + h : a)); const [a, b] = [at(1e-6), at(-1e-6)]; return a.map((c, j) => (c - b[j]) / 2e-6); });
      const y = inverse(rates[0].map((_, j) => rates.map((row) => row[j]))), d = joints(x).map((c, j) => c - to[j]);
      x = x.map((a, k) => a - y[k].reduce((sum, e, j) => sum + e * d[j], 0));
    }
    return x;
  };
  const in_motion = (legs, kind, box, rest, point, start, requires = '"require":[{"quantity":"one_to_one","end":"holds"}]') => {
    const joints = (x) => legs.map((l) => leg_of(l)(x)), other = other_pose(joints, point, start).map((x) => x.toFixed(7)), arms = legs[0].drive === "arm";
    const s = 1 + Math.floor(Math.log2(Math.max(...legs.flatMap((l) => l.drive === "strut" ? [...l.anchor, ...l.platform] : l.drive === "arm" ? [l.arm, l.length] : [l.length]).map((x) => Math.abs(x)))));
    const units = other.map((_, k) => arms ? (k < 2 ? 2 ** -s : 1) : k < 2 ? 1 : 2 ** s);
    return any_twin(`{"mechanism":{"planar":{"legs":${JSON.stringify(legs)}${kind}}},"workspace":{"box":${box}}${rest},${requires}}`, joints, point, other, units, 1e-4);
  };
  const arm = (anchor, platform, mode) => ({ drive: "arm", axis: [], reference: ["1", "0"], anchor, platform, arm: "5", length: "6", mode });
  const slider = (x, mode) => ({ drive: "slider", direction: ["0", "1"], anchor: [x, "0"], platform: ["0", "0"], length: "12", mode });
  const turning_arms = [[["-8", "0"], ["-1", "0"], "-"], [["8", "0"], ["1", "0"], "+"], [["0", "9"], ["0", "1"], "+"]].map((l) => arm(...l));
  const turning_sliders = [["-10", "-1", "+"], ["10", "1", "-"], ["9", "3", "-"]].map(([x, p, mode]) => ({ ...slider(x, mode), platform: [p, "0"] }));
  const written = (coordinates, definitions, joints, box, joint_values, point, other) => any_twin(
    `{"mechanism":{"formulas":{"coordinates":${JSON.stringify(coordinates)},"parameters":[],"definitions":${JSON.stringify(definitions)},"joints":${JSON.stringify(joints.map((rho) => ({ rho })))}}},"workspace":{"box":${box}},${asks}}`,
    joint_values, point, other, other.map(() => 1), 1e-4);
  twins.push(
    in_motion([arm(["-4", "0"], ["0", "0"], "-"), arm(["4", "0"], ["0", "0"], "+")], "", '{"min":["-1","0.1"],"max":["1","10"]}', "", ["0.3", "9"], [0, 1]),
    in_motion([slider("-10", "+"), slider("10", "-")], "", '{"min":["-9","-9"],"max":["9","9"]}', "", ["1", "0"], [-1, 3]),
    in_motion(turning_arms, ',"characteristic_length":"2"', '{"min":["-2","1"],"max":["2","4"]}', ',"orientation":{"range":["-70","70"]}', ["-1.34", "1.78", "-0.17"], [-1.16, 2.83, -0.55]),
    in_motion(turning_sliders, ',"characteristic_length":"2"', '{"min":["-2","1"],"max":["2","8"]}', ',"orientation":{"range":["-70","70"]}', ["1.23", "4.75", "0.3"], [-0.28, 6.58, 0.07]),
    in_motion([["0", "0"], ["10", "0"]].map((anchor) => ({ drive: "strut", anchor, platform: ["0", "0"] })), "", '{"min":["4","-2"],"max":["6","2"]}', "", ["5", "1"], [5, -1]),
    twins[0].replace(asks, '"require":[{"quantity":"one_to_one","end":"holds"},{"quantity":"load","given":{"force":["1","0","0"]},"end":"max","bound":"9"}]'),
    written(["x", "y"], [["d", "x-3"]], ["sqrt(x^2+y^2)", "sqrt(d^2+y^2)/2"], '{"min":["1","-2"],"max":["2","2"]}', ([x, y]) => [Math.hypot(x, y), Math.hypot(x - 3, y) / 2], ["1.5", "1"], ["1.5", "-1"]),
    written(["x", "y", "z"], [["square", "z^2"], ["q", "square/(x+2)"]], ["-x", "y+q", "square*q^2"], '{"min":["-1","-1","-2"],"max":["1","1","2"]}', ([x, y, z]) => [-x, y + z * z / (x + 2), z ** 6 / (x + 2) ** 2], ["0.5", "0.1", "1"], ["0.5", "0.1", "-1"]),
  );
  function turned_by([r, p, w], [x, y]) {
    const [cr, sr, cp, sp, cw, sw] = [r, p, w].flatMap((t) => [(1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)]), a = [x, y * cr, y * sr], b = [cp * a[0] + sp * a[2], a[1], cp * a[2] - sp * a[0]];
    return [cw * b[0] - sw * b[1], sw * b[0] + cw * b[1], b[2]];
  }
  let no_twins = 0;
  twins.forEach((text, i) => {
    read.push(text);
    const answers = three_answers(text);
    if (answers.some((answer) => answer !== "REFUTED")) fail(`twins ${i}: ${answers}`);
    agrees(one_of, answers[1]);
    const box = /"least":\["(-?[\d.]+)",.*?"greatest":\["(-?[\d.]+)"/.exec(text);
    for (const [from, to] of [
      ['"obligation":1', '"obligation":0'], ['"obligation":1', '"obligation":2'], [/"y":\[\[-?(\d+)/, '"y":[[9$1'], [/"y":\[\[[^\]]*\],/, '"y":['], [/"y":\[\[/, '"y":[[1,'], [/"y":(\[\[[^\]]*\]),/, '"y":$1,[1],'],
      ['"places":20', '"places":18'], ['"places":20', '"places":19'], [`"least":["${box[1]}"`, `"least":["${box[2]}"`], [`"greatest":["${box[2]}"`, `"greatest":["9"`], [`"least":["${box[1]}"`, `"least":["${+(+box[1] + 0.75 * (box[2] - box[1])).toFixed(7)}"`],
      [/"least":\["[^"]*",/, '"least":['], [/"point":\["[^"]*"/, '"point":["0.5"'], [/"least":(\[.*?\]),"greatest":(\[.*?\])/, '"least":$2,"greatest":$1'], ['"max":["0.3"', '"max":["0.05"'], ['"max":["0.2"', '"max":["0.01"'], ['"max":["1"', '"max":["0"'],
      ['{"quantity":"one_to_one","end":"holds"}', '{"quantity":"joint_range","end":"min","bound":"0"}'],
    ]) {
      const wrong = text.replace(from, to);
      if (wrong === text) continue;
      const answers = three_answers(wrong);
      if (answers.some((answer) => answer !== "REJECTED")) fail(`twins ${i}: ${answers}: ${from} ${to}`); else no_twins++;
    }
  });
  console.log(`two poses with the same joint coordinates: ${twins.length} with one answer, and ${no_twins} refused`);
}
const are_covered = of_design.filter((answer) => !answer.startsWith("NOT COVERED")).length;
console.log(`designs: ${are_covered} of ${of_designs.length} certificates are proved again, and exported to Rocq, the others refused in the same words`);
fs.rmSync(made, { recursive: true });

// In Rocq: the exported certificate prints the file's bytes, and with one digit changed is no proof; of each kind of subject, and refuted.
const in_rocq = fs.mkdtempSync(path.join(os.tmpdir(), "rocq-"));
const proves = (text, more = "") => {
  const file = path.join(in_rocq, "one.cert.json"), source = path.join(in_rocq, "Exported.v");
  fs.writeFileSync(file, text);
  fs.writeFileSync(source, agrees(file, natively([file])[0]) + more);
  return spawnSync("coqc", ["-q", "-Q", path.join(__dirname, ".."), "Orthocert", source], { encoding: "utf8", maxBuffer: 1 << 28 });
};
const instances = path.join(__dirname, "../instances"), committed = path.join(__dirname, "../../certificates");
for (const [name, from, to] of [
  ["upu-struts", '"bound":"1.25"', '"bound":"1.15"'],
  ["five-bar", '"bound":"300"', '"bound":"100"'],
  ["planar-3-rpr", '"bound":"480"', '"bound":"440"'],
  ["five-bar-formulas", '"bound":"300"', '"bound":"200"'],
  ["delta-joint-speed-refuted", '"bound":"1850"', '"bound":"1950"'],
  ["orthoglide-prototype", '"bound":"0.5"', '"bound":"0.6"'],
  ["postulate-2", '"psi_max":"2"', '"psi_max":"3"'],
  ["NoCube", '"bound":"1.5"', '"bound":"2.5"'],
  ["Atlas", /"certified":"[^"]*"/, '"certified":"1/3"'],
]) {
  const file = [instances, committed].map((folder) => path.join(folder, `${name}.cert.json`)).find((file) => fs.existsSync(file));
  const text = fs.readFileSync(file, "latin1");
  const whole = proves(text, '\nEval vm_compute in String.concat "" (print the_certificate).\n');
  const printed = /= "((?:[^"]|"")*)"/.exec(whole.stdout)?.[1].replaceAll('""', '"');
  if (whole.status !== 0 || printed !== text) fail(`${name}: in Rocq ${whole.status === 0 ? "another text" : whole.stderr}`);
  const wrong = text.replace(from, to);
  const run = proves(wrong);
  if (wrong === text || run.status !== 1 || !run.stderr.includes('"accept the_certificate = true"')) fail(`${name}, wrong, in Rocq: ${run.stderr}`);
}
fs.rmSync(in_rocq, { recursive: true });
console.log("in Rocq: nine certificates are accepted as they are, and not with a digit changed");

// What is no number, or beyond a limit, though nothing depends on it: refused by all three.
const plane = (x, y, z) => `{"drive":"planar","direction":["${x}","${y}","${z}"]}`;
const undefined_ = (x) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":{"translational":[${plane(1, 0, 0)},` +
  `${plane(0, 1, 0)},${plane(0, 0, 1)}]},"workspace":{"box":{"min":["${x}","0","0"],"max":["${x}","0","0"]}},` +
  `"require":[{"quantity":"transmission","end":"min","bound":"2"}]}},"verdict":"refuted","proof":{"witness":{"precision":64,` +
  `"point":["${x}","0","0"],"fails":{"obligation":[1,[[1,1,1]]]}}},"provenance":{"tool":"t","version":"1"}}\n`;
const wrong = [undefined_("1/0"), undefined_("sqrt(-1)")];
for (const [name, from, to] of [
  ["orthoglide-prototype", '"offset":"0"', '"offset":"1/0"'],
  ["orthoglide-prototype", '"offset":"0"', '"offset":"sqrt(-1)"'],
  // Each part of what shows accuracy.
  ["orthoglide-prototype-whole", '"joint_error":["0.01"]', '"joint_error":["0.02"]'],
  ["orthoglide-prototype-whole", '"joint_error":["0.01"]', '"joint_error":["-0.01"]'],
  ["orthoglide-prototype-whole", '"bound":"0.114"', '"bound":"0.1"'],
  ["orthoglide-prototype-whole", '"bound":"0.114"', '"bound":"114"'],
  ["orthoglide-prototype-whole", '"accuracy":[{"y":[[4', '"accuracy":[{"y":[[-4'],
  ["orthoglide-prototype-whole", /("accuracy":\[\{"y":[^}]*\}),\d+/, "$1,-1"],
  ["orthoglide-prototype-whole", /("accuracy":\[\{"y":[^}]*\}),\d+/, "$1,64"],
  ["orthoglide-prototype-whole", /("accuracy":\[\{"y":[^}]*\},\d+),0/, "$1,1"],
  ["orthoglide-prototype-whole", /("accuracy":\[\{"y":[^}]*"places":)2/, "$11"],
  ["orthoglide-prototype-whole", /\[18,\{"accuracy":.*?,0\]\}\],?/, ""],
  // What of a closed design is no theorem.
  ["orthoglide-cube-all", '"bound":"258"', '"bound":"256"'],
  ["orthoglide-cube-all", '"bound":"-1"', '"bound":"1"'],
  ["orthoglide-cube-all", '"bound":"5"', '"bound":"4"'],
  ["orthoglide-cube-all", '"bound":"0.1"', '"bound":"0.6"'],
  ["orthoglide-cube-all", '"bound":"40"', '"bound":"30"'],
  ["orthoglide-cube-all", '"bound":"1500"', '"bound":"1100"'],
  ["orthoglide-cube-all", '[18,"test"]', '[17,"test"]'],
  ["orthoglide-cube-all", '[5,"test"],', ""],
  ["orthoglide-cube-all", '"side":"200"', '"side":"-200"'],
  ["orthoglide-cube-all", '"cube"],[5', '"cube"],[6'],
  // Angles at joints, of less and of more than 90 degrees, and bodies, of a platform that turns.
  ["hexapod-joints", '"bound":"14"', '"bound":"12"'],
  ["hexapod-joints", '"bound":"14"', '"bound":"0"'],
  ["hexapod-joints", '"bound":"14"', '"bound":"181"'],
  ["hexapod-joints", '"bound":"14"', '"bound":"140"'],
  ["hexapod-joints", '"bound":"23"', '"bound":"21"'],
  ["hexapod-joints", '"axis":["22","-2","20"]', '"axis":["0","0","0"]'],
  ["hexapod-joints", '"axis":["22","-2","20"]', '"axis":["22","-2"]'],
  ["hexapod-joints", '"axis":["22","-2","20"]', '"axis":["-22","2","-20"]'],
  ["hexapod-joints", '"platform_joint"', '"base_joint"'],
  ["hexapod-joints", '"end":"min","bound":"0.4"', '"end":"min","bound":"4"'],
  ["hexapod-joints", '"end":"min","bound":"0.4"', '"end":"min","bound":"-1"'],
  ["hexapod-joints", '"radius":"1"', '"radius":"0"'],
  ["hexapod-joints", '"trim":["4","2"]', '"trim":["4","2"],"offset":["0","0","1"]'],
  ["hexapod-joints", /"direction":\{"y":\[\[[^\]]*\]/, '"direction":{"y":[[0,0,0,0,0,0,0]'],
  ["tripteron", /"precision":\d+/, '"precision":8'],
  ["tripteron", /"precision":\d+/, '"precision":5000'],
  ["tripteron", /"nodes":\[(.*)\]\}\},"prov/, '"nodes":[{"split":3},$1,$1]}},"prov'],
]) {
  const file = files.find((file) => path.basename(file, ".cert.json") === name);
  const text = file && fs.readFileSync(file, "latin1");
  if (!text || text.replace(from, to) === text) fail(`${name} is not there, or has no ${from}`);
  else wrong.push(text.replace(from, to));
}
const aside = fs.mkdtempSync(path.join(os.tmpdir(), "wrong-"));
wrong.forEach((text, i) => {
  const file = path.join(aside, `${i}.json`);
  fs.writeFileSync(file, text);
  const all = [verify(text), natively([file])[0], exactly(file)];
  if (all.some((answer) => answer !== "REJECTED")) fail(`${all}: ${text}`);
});
fs.rmSync(aside, { recursive: true });

// A root of zero is a number, and one of less is none.
const root_of = fs.mkdtempSync(path.join(os.tmpdir(), "root-")), planar = fs.readFileSync(path.join(committed, "planar-3-rpr.cert.json"), "latin1");
for (const [x, is] of [["sqrt(0)", true], ["sqrt(2-sqrt(4))", true], ["sqrt(sqrt(2)-sqrt(2))", true], ["sqrt(1-sqrt(2)*sqrt(1/2))", true],
  ["sqrt(-1)", false], ["sqrt(-1/10^64/10^64/10^64)", false]]) {
  const file = path.join(root_of, "one.json"), text = planar.replace('"anchor":["0"', `"anchor":["${x}"`);
  fs.writeFileSync(file, text);
  const all = [verify(text), natively([file])[0], exactly(file)];
  if (text === planar || all.some((answer) => answer !== (is ? "CERTIFIED" : "REJECTED"))) fail(`${x}: ${all}`);
}
fs.rmSync(root_of, { recursive: true });

// No cube: each way to fail, at bounds ever nearer to the last with which it is shown, where one bit decides.
const triple = (x, y, z) => `["${x}","${y}","${z}"]`;
const sliders = (length) => [0, 1, 2].map((i) => `{"drive":"slider","direction":${triple(...[0, 1, 2].map((k) => +(k === i)))},` +
  `"anchor":${triple(0, 0, 0)},"platform":${triple(0, 0, 0)},"length":${length},"mode":"+"}`);
const struts = [[1, 0], [-1, 2], [-1, -2]].map(([x, y]) => `{"drive":"strut","anchor":${triple(200 * x, 100 * y, 0)},` +
  `"platform":${triple(50 * x, 30 * y, 0)},"base_axis":${triple(-y, 2 * x, 0)}}`);
const three = sliders('"310"'), toleranced = sliders('{"min":"309.9","max":"310.1"}');
const mixed = [three[0], struts[1], plane("0", "3", "1")];
const about = (quantity, end, more = "") => (b) => [`{"quantity":"${quantity}"${more},"end":"${end}","bound":"${b}"}`];
const noCube = (legs, center, requirements, fails, offset) => `{"format":"orthocert/2","claim":{"no_cube":{"machine":{"mechanism":` +
  `{"translational":[${legs}]},"workspace":{"box":{"min":[${center.map((x) => `"${x - 3}"`)}],"max":[${center.map((x) => `"${x + 2}"`)}]}},` +
  `"require":[${requirements}]},"side":"40"}},"verdict":"certified","proof":{"tree":{"precision":32,"nodes":[{"fails":${fails},` +
  `"at":[${offset}]}]}},"provenance":{"tool":"t","version":"1"}}\n`;
const ways = [
  [toleranced, [110, 110, 110], about("transmission", "max"), '{"obligation":[0,[[10,-9,1]]]}', 1, 4],
  [mixed, [60, 40, 190], about("transmission", "max"), '{"obligation":[0,[[5,-7,3]]]}', 0.05, 40],
  [toleranced, [110, 110, 110], about("transmission", "min"), '{"obligation":[1,[[3,3,4]]]}', 0.1, 4],
  [three, [120, 110, 100], about("transmission", "min"), '{"row":[1,1]}', 0.1, 4],
  [mixed, [60, 40, 190], about("transmission", "min"), '{"row":[1,0]}', 0.5, 2],
  [mixed, [60, 40, 190], about("transmission", "min"), '{"row":[1,1]}', 0.5, 2],
  [mixed, [60, 40, 190], about("transmission", "min"), '{"row":[1,2]}', 0.5, 2],
  [three, [110, 110, 110], about("conditioning", "max"), '{"obligation":[1,[[1,1,1],[1,-1,0]]]}', 1.01, 9],
  [toleranced, [90, 80, 70], about("joint_range", "min", ',"leg":2'), '{"obligation":[1,[]]}', -400, 400],
  [mixed, [60, 40, 190], about("joint_range", "max"), '{"obligation":[2,[]]}', -400, 400],
  [toleranced, [90, 80, 70], about("joint_speed", "max", ',"given":{"tool":["100"]}'), '{"obligation":[3,[]]}', 50, 300],
  [three, [90, 80, 70], about("serial_margin", "min"), '{"obligation":[1,[]]}', 0.2, 1],
  [toleranced, [110, 110, 110], about("parallel_margin", "min"), '{"obligation":[1,[]]}', 0.2, 3],
  [mixed, [60, 40, 190], about("parallel_margin", "min"), '{"obligation":[1,[]]}', 0.01, 3],
  [mixed, [60, 40, 190], about("stiffness", "min", ',"given":{"joint":["3"]}'), '{"obligation":[1,[[1,2,-3]]]}', 0.1, 9],
  [struts, [20, 10, 300], about("constraint_margin", "min"), '{"obligation":[1,[[1,2,20]]]}', 0.01, 2],
];
const beside = fs.mkdtempSync(path.join(os.tmpdir(), "cubes-"));
const one = path.join(beside, "one.json");
const all = (text) => {
  fs.writeFileSync(one, text);
  const [formal] = natively([one]);
  in_javascript(text, formal);
  return [formal, exactly(one)];
};
// Ever nearer to the last bound with which what is made of it is accepted.
const narrowed = (text, low, high, steps = 40) => {
  const seen = new Set();
  const answer = (b) => {
    const certificate = text(String(+b.toFixed(12)));
    const [formal, right] = all(certificate);
    if (formal !== right) fail(`${formal}, and ${right} by orthocert-check: ${certificate}`);
    seen.add(right);
    return right;
  };
  let [from, to] = [low, high];
  const first = answer(from);
  answer(to);
  for (let i = 0; i < steps; i++) {
    const middle = (from + to) / 2;
    if (answer(middle) === first) from = middle;
    else to = middle;
  }
  if (seen.size !== 2) fail(`${[...seen]} alone: ${text("0")}`);
};
for (const [legs, center, bound, fails, low, high] of ways)
  narrowed((b) => noCube(legs, center, bound(b), fails, [8, -3, 5]), low, high);
// Beyond reach, by one of three legs, and by half the side and no more.
for (const [x, at, right] of [[301, 8, "CERTIFIED"], [301, 0, "REJECTED"], [301, 9, "REJECTED"], [301, -8, "REJECTED"], [400, 0, "CERTIFIED"]]) {
  const text = noCube(three, [0, x, 0], about("transmission", "max")(9), '"reach"', [0, at, 0]);
  if (all(text).some((answer) => answer !== right)) fail(`reach: ${all(text)}: ${text}`);
}
for (const [legs, fails, offset] of [
  [[three[0], three[1], plane(0, 0, 0)], '"reach"', [0, 0, 0]], // a plane without a direction
  [three, '{"row":[0,0]}', [0, 0, 0]],
  [three, '{"obligation":[7,[[1,1,1]]]}', [0, 0, 0]],
  [three, '{"obligation":[0,[[0,0,0]]]}', [0, 0, 0]],
  [three, '{"obligation":[0,[[1,1]]]}', [0, 0, 0]],
  [three, '{"obligation":[0,[]]}', [0, 0, 0]],
  [three, '"reach"', [0, 0]],
]) {
  const text = noCube(legs, [0, 400, 0], about("transmission", "max")(9), fails, offset);
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`no cube: ${all(text)}: ${text}`);
}
console.log(`no cube: ${ways.length} ways to fail, with one answer at 42 bounds each`);

// Bodies that keep their distance, and one that does not, in the same way.
const along = (leg, offset) => `{"on":"leg","leg":${leg},"radius":"10","trim":["30","45"]${offset ? `,"offset":${triple(...offset)}` : ""}}`;
const fixed = (on, from, to) => `{"on":"${on}","from":${triple(...from)},"to":${triple(...to)},"radius":"15/2"}`;
const box = `{"box":{"min":${triple(-20, -20, -20)},"max":${triple(30, 30, 30)}}}`;
const cylinder = `{"cylinder":{"center":["0","0"],"radius":"20","z":["-20","20"]}}`;
const clear = (legs, workspace, bodies, proof, verdict) => (b) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":` +
  `{"translational":[${legs}]},"workspace":${workspace},"bodies":[${bodies}],"require":[{"quantity":"clearance","end":"min",` +
  `"bound":"${b}"}]}},"verdict":"${verdict}","proof":${proof},"provenance":{"tool":"t","version":"1"}}\n`;
const y = (rows) => `{"y":${JSON.stringify(rows)},"places":3}`;
const tree = (evidence) => `{"tree":{"precision":32,"nodes":[{"by":[[0,{"rank":${y([[8, 0, 0], [0, 8, 0], [0, 0, 8]])}}],${evidence}]}]}}`;
const direction = (g) => `{"direction":${y(g)}}`;
const steady = direction([[8, 0, 0, 0], [-8, 0, 0, 0], [1, 0, 0, 0]]), turning = direction([[8, 1, 0, 0], [-9, 0, 1, 0], [0, 0, 0, 1]]);
const legged = [along(1), along(2, [0, 0, -20])], legs = [three, toleranced];
const witness = (point, fails, machine = "") => `{"witness":{"precision":512,"point":${triple(...point)}${machine},"fails":${fails}}}`;
const apart = [
  [clear(three, box, legged, tree(`[1,${steady}]`), "certified"), 0, 60],
  [clear(toleranced, box, legged, tree(`[1,${turning}]`), "certified"), 0, 60],
  [clear(toleranced, cylinder, legged, tree(`[1,{"inside":[${turning},1,9]}]`), "certified"), 0, 60],
  [clear(toleranced, cylinder, [along(3), fixed("base", [60, 90, 0], [80, 90, -100])], tree(`[1,${direction([[3, 0, 0, 0], [8, 0, 0, 0], [0, 0, 0, 0]])}]`), "certified"), 0, 90],
  [clear(three, box, [fixed("base", [0, 0, 99], [50, 0, 99]), fixed("platform", [0, 0, 0], [3, 4, 5])],
    tree(`[1,${direction([[0, 0, 0, 0], [0, 0, 0, 0], [-8, 0, 0, 0]])}]`), "certified"), 0, 90],
  [clear([struts[0], struts[1], struts[2]], box.replaceAll('"-20"]', '"300"]').replaceAll('"30"]', '"320"]'), [along(1), fixed("platform", [0, 0, 5], [0, 0, 90])],
    `{"tree":{"precision":32,"nodes":[{"by":[[0,{"rank":${y([[-8, 0, 2], [4, -7, 2], [4, 7, 2]])}}],[1,${direction([[-7, 0, 0, 0], [0, 0, 0, 0], [4, 0, 0, 0]])}]]}]}}`, "certified"), 0, 90],
  [clear(three, box, legged, witness([1, 2, 3], '{"obligation":[1,[[7,8,9]]]}'), "refuted"), 0, 120],
  [clear(toleranced, box, [legged[0], fixed("platform", [0, 50, 0], [1, 80, 9])],
    witness([1, 2, 3], '{"obligation":[1,[[1,2,3]]]}', ',"machine":["310","309.9","310.1"]'), "refuted"), 0, 300],
  [clear([struts[0], struts[1], struts[2]], box.replaceAll('"-20"]', '"300"]').replaceAll('"30"]', '"320"]'), [along(1), fixed("base", [0, 0, 5], [0, 0, 90])],
    witness([1, 2, 303], '{"obligation":[1,[[1,2,3]]]}'), "refuted"), 0, 900],
  // Beside each other on one leg, neither of them, one, or both as far from the leg as they are.
  [clear(three, box, [along(1, [0, -40, 0]), along(1, [0, 40, 0])], tree('[1,"test"]'), "certified"), 0, 90],
  [clear(toleranced, cylinder, [along(2), along(2, [30, 10, 40])], tree('[1,{"inside":["test",1,9]}]'), "certified"), 0, 90],
  [clear([struts[0], struts[1], struts[2]], box.replaceAll('"-20"]', '"300"]').replaceAll('"30"]', '"320"]'), [along(1, [0, 50, 0]), along(1)],
    `{"tree":{"precision":32,"nodes":[{"by":[[0,{"rank":${y([[-8, 0, 2], [4, -7, 2], [4, 7, 2]])}}],[1,"test"]]}]}}`, "certified"), 0, 90],
  [clear(toleranced, box, [along(1, [20, -40, 0]), along(1, [0, 40, 9])],
    witness([1, 2, 3], '{"obligation":[1,[]]}', ',"machine":["310","309.9","310.1"]'), "refuted"), 0, 120],
  [clear([struts[0], struts[1], struts[2]], box.replaceAll('"-20"]', '"300"]').replaceAll('"30"]', '"320"]'), [along(1, [0, 50, 0]), along(1)],
    witness([1, 2, 303], '{"obligation":[1,[]]}'), "refuted"), 0, 120],
];
for (const [text, low, high] of apart) narrowed(text, low, high);
for (const text of [
  clear(three, box, legged, tree(`[1,${direction([[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])}]`), "certified"),
  clear(three, box, legged, tree(`[1,${direction([[-8, 0, 0, 0], [8, 0, 0, 0], [0, 0, 0, 0]])}]`), "certified"),
  clear(three, box, legged, tree(`[1,"test"]`), "certified"),
  clear(three, box, [along(1), along(1)], tree(`[1,${steady}]`), "certified"),
  clear(three, box, [along(1), along(4)], tree(`[1,${steady}]`), "certified"),
  clear([three[0], three[1], plane(0, 0, 1)], box, [along(1), along(3)], tree(`[1,${steady}]`), "certified"),
  clear([three[0], three[1], plane(0, 0, 1)], box, [along(3), along(3, [0, 50, 0])], tree('[1,"test"]'), "certified"),
  clear(three, box, [along(1), along(1, [0, 50, 0])], tree(`[1,${steady}]`), "certified"),
  clear(three, box, [along(1), along(1, [0, 50, 0])], tree('[1,"negative"]'), "certified"),
  clear(three, box, [along(1), along(1, [50, 0, 0])], tree('[1,"test"]'), "certified"),
  clear(three, box, [along(1), along(1, [0, 0, 0])], tree('[1,"test"]'), "certified"),
  clear(three, box, [along(1), along(2).replace('"10"', '"-10"')], tree(`[1,${steady}]`), "certified"),
  clear(three, box, [along(1), along(2).replace('"30"', '"-30"')], tree(`[1,${steady}]`), "certified"),
  clear(three, box, legged, witness([1, 2, 3], '{"obligation":[1,[[10,8,9]]]}'), "refuted"),
  clear(three, box, legged, witness([1, 2, 3], '{"obligation":[1,[[0,0,0]]]}'), "refuted"),
]) {
  const answers = all(text("1"));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`clearance: ${answers}: ${text("1")}`);
}
console.log(`clearance: ${apart.length} pairs of bodies, with one answer at 42 bounds each`);

// Quantities of single legs, in the same way.
const asks = (legs, workspace, requirement, proof) => (b) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":` +
  `{"translational":[${legs}]},"workspace":${workspace},"require":[${requirement(b)}]}},"verdict":"certified","proof":${proof},` +
  `"provenance":{"tool":"t","version":"1"}}\n`;
const all_struts = [struts[0], struts[1], struts[2]];
const far = box.replaceAll('"-20"]', '"300"]').replaceAll('"30"]', '"320"]');
const of_struts = (evidence) => `{"tree":{"precision":32,"nodes":[{"by":[[0,{"rank":${y([[-8, 0, 2], [4, -7, 2], [4, 7, 2]])}}],${evidence}]}]}}`;
const moves = (leg, a, v) => about("joint_acceleration", "max", `,"leg":${leg},"given":{"acceleration":["${a}"],"speed":["${v}"]}`);
const accelerations = [
  [asks(three, box, moves(1, 9000, 1200), tree('[1,"test"]')), 9000, 30000],
  [asks(toleranced, box, moves(3, 0, 1200), tree('[1,"test"]')), 1, 30000],
  [asks(toleranced, cylinder, moves(2, 9000, 0), tree('[1,{"inside":["test",1,9]}]')), 9000, 30000],
  [asks(all_struts, far, moves(2, 9000, 1200), of_struts('[1,"test"]')), 9000, 30000],
];
for (const [text, low, high] of accelerations) narrowed(text, low, high);
for (const text of [
  asks(three, box, moves(1, -1, 0), tree('[1,"test"]')),
  asks(three, box, moves(1, 0, -1), tree('[1,"test"]')),
  asks(three, box, moves(4, 1, 1), tree('[1,"test"]')),
  asks(three, box, moves(0, 1, 1), tree('[1,"test"]')),
  asks(three, box, moves(1, 1, 1), tree('[1,"negative"]')),
  asks(three, box, about("joint_acceleration", "min", `,"given":{"acceleration":["1"],"speed":["1"]}`), tree('[1,"test"],[2,"test"],[3,"test"]')),
  asks(three, box, about("joint_acceleration", "max", `,"given":{"acceleration":["1"]}`), tree('[1,"test"],[2,"test"],[3,"test"]')),
  asks(three, box, about("joint_acceleration", "max", `,"given":{"tool":["1"]}`), tree('[1,"test"],[2,"test"],[3,"test"]')),
]) {
  const answers = all(text("30000"));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`joint_acceleration: ${answers}: ${text("30000")}`);
}
for (const b of ["0", "-1"]) {
  const text = asks(three, box, moves(1, 0, 0), tree('[1,"test"]'))(b);
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`joint_acceleration: ${all(text)}: ${text}`);
}
console.log(`joint_acceleration: ${accelerations.length} legs, with one answer at 42 bounds each`);

// Forces: a matrix Y near A is evidence.
const holds_force = (leg, tool) => about("joint_force", "max", `,"leg":${leg},"given":{"tool":["${tool}"]}`);
const lower = (rows) => `{"lower":${y(rows)}}`;
const whole = lower([[5, 0, 0], [0, 5, 0], [0, 0, 5]]), slanted = lower([[5, 1, 0], [0, 5, 1], [1, 0, 4]]);
const forces = [
  [asks(three, box, holds_force(1, 56), tree(`[1,${whole}]`)), 56, 300],
  [asks(toleranced, box, holds_force(3, 0.01), tree(`[1,${slanted}]`)), 0.01, 0.1],
  [asks(toleranced, cylinder, holds_force(2, 56), tree(`[1,{"inside":[${whole},1,9]}]`)), 56, 300],
  [asks([three[0], three[1], plane(0, 0, 1)], box, holds_force(3, 56), tree(`[1,${lower([[5, 0, 0], [0, 5, 0], [0, 0, 8]])}]`)), 56, 300],
  [asks(all_struts, far, holds_force(2, 56), of_struts(`[1,${lower([[-6, 0, 5], [3, -5, 5], [3, 5, 5]])}]`)), 56, 3000],
];
for (const [text, low, high] of forces) narrowed(text, low, high);
for (const text of [
  asks(three, box, holds_force(1, 0), tree(`[1,${whole}]`)),
  asks(three, box, holds_force(1, -56), tree(`[1,${whole}]`)),
  asks(three, box, holds_force(4, 56), tree(`[1,${whole}]`)),
  asks(three, box, holds_force(1, 56), tree('[1,"test"]')),
  asks(three, box, holds_force(1, 56), tree(`[1,${whole.replace("lower", "lower_divided")}]`)),
  asks(three, box, holds_force(1, 56), tree(`[1,${lower([[0, 0, 0], [0, 0, 0], [0, 0, 0]])}]`)),
  asks(three, box, holds_force(1, 56), tree(`[1,${lower([[-5, 0, 0], [0, -5, 0], [0, 0, -5]])}]`)),
  // More joints than coordinates.
  asks([...three, plane(0, 0, 1)], box, holds_force(1, 56), tree(`[1,${lower([[5, 0, 0], [0, 5, 0], [0, 0, 5], [0, 0, 1]])}]`)
    .replace("[0,0,8]", "[0,0,8],[0,0,0]")),
]) {
  const answers = all(text("1000"));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`joint_force: ${answers}: ${text("1000")}`);
}
console.log(`joint_force: ${forces.length} legs, with one answer at 42 bounds each`);

// One matrix for all cells, which are two: any others on one of them show nothing of both.
const same = (b) => '{"quantity":"one_to_one","end":"holds"}';
const by_chords = (chords, steps) => `{"tree":{"precision":32,${chords ? `"chords":${y(chords)},` : ""}"nodes":[{"by":[[0,{"rank":${y([[8, 0, 0], [0, 8, 0], [0, 0, 8]])}}]],` +
  `"split":1},{"by":[${steps}]},{"by":[${steps}]}]}}`;
const near = [[8, 0, 0], [0, 8, 0], [0, 0, 8]];
const sized = (leg) => box.replaceAll('"-20"]', `"${-leg}"]`);
for (const [legs, workspace, chords, steps, right] of [
  [three, box, near, '[1,"chords"]', "CERTIFIED"],
  [three, box, [[8, 1, 0], [0, 7, 0], [-1, 0, 9]], '[1,"chords"]', "CERTIFIED"],
  [toleranced, cylinder, near, '[1,{"inside":["chords",1,9]}]', "CERTIFIED"],
  [[three[0], three[1], plane(0, 0, 1)], box, near, '[1,"chords"]', "CERTIFIED"],
  [[...three, plane(0, 0, 1)], box, [...near, [0, 0, 0]], '[1,"chords"]', "REJECTED"],
  [three, box, [[0, 0, 0], [0, 0, 0], [0, 0, 0]], '[1,"chords"]', "REJECTED"],
  [three, box, near.map((row) => row.map((n) => -n)), '[1,"chords"]', "REJECTED"],
  [three, box, [[8, 0, 0], [0, 8, 0]], '[1,"chords"]', "REJECTED"],
  [three, box, null, '[1,"chords"]', "REJECTED"],
  [three, box, near, '[1,"test"]', "REJECTED"],
  [three, box, near, `[1,{"rank":${y(near)}}]`, "REJECTED"],
  [three, box, near, `[1,{"lower":${y(near)}}]`, "REJECTED"],
]) {
  const text = asks(legs, workspace, same, by_chords(chords, steps))("");
  const answers = all(text);
  if (answers.some((answer) => answer !== right)) fail(`one_to_one: ${answers}: ${text}`);
  if (right === "CERTIFIED") read.push(text);
}
for (const wrong of ['"end":"holds","bound":"1"', '"end":"min","bound":"1"', '"leg":1,"end":"holds"', '"given":{"tool":["1"]},"end":"holds"']) {
  const text = asks(three, box, same, by_chords(near, '[1,"chords"]'))("").replace('"end":"holds"', wrong);
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`one_to_one: ${all(text)}: ${text}`);
}
console.log("one_to_one: with one answer");

// Positions near P: errors of the joints, and tolerances of lengths, directions and places, by which joint coordinates are derived.
const between = (x) => `{"min":"${+(x - 0.01).toFixed(3)}","max":"${+(x + 0.01).toFixed(3)}"}`;
const vague = three.map((leg) => leg.replace('"0","0","0"', `"0",${between(0)},"0"`).replace('"direction":["1","0",', `"direction":["1",${between(0.02)},`));
const vague_struts = all_struts.map((leg) => leg.replace('"platform":["50"', `"platform":[${between(50)}`).replace(/"base_axis":\["-?\d+"/, `"base_axis":[${between(-2)}`));
const all_between = (...x) => `[${x.map(between)}]`;
const loose = [0, 1, 2].map((i) => `{"drive":"slider","direction":${all_between(...[0, 1, 2].map((k) => +(k === i)))},"anchor":${all_between(0.5, -0.25, 0.3)},` +
  `"platform":${all_between(0.2, 0.1, -0.1)},"length":${between(310)},"mode":"+"}`);
const vague_plane = `{"drive":"planar","direction":["0",${between(0.1)},"1"]}`;
const off = (error) => about("accuracy", "max", `,"given":{"joint_error":["${error}"]}`);
const accuracy = (rows, kappa, q = 0) => `{"accuracy":[${y(rows)},${kappa},${q}]}`;
const nearly = accuracy(near, 1), near_struts = accuracy([[-6, 0, 5], [3, -5, 5], [3, 5, 5]], 1);
const accuracies = [
  [asks(three, box, off(0.01), tree(`[1,${nearly}]`)), 0.01, 0.1],
  [asks(toleranced, box, off(0), tree(`[1,${nearly}]`)), 0.01, 3],
  [asks(toleranced, cylinder, off(0.01), tree(`[1,{"inside":[${accuracy([[7, 1, 0], [0, 8, -1], [1, 0, 8]], 2)},1,5]}]`)), 0.01, 3],
  [asks(vague, box, off(0.001), tree(`[1,${nearly}]`)), 0.01, 12],
  [asks(loose, box, off(0.01), tree(`[1,${accuracy(near, 2)}]`)), 0.1, 20],
  [asks([three[0], vague[1], vague_plane], box, off(0.01), tree(`[1,${accuracy([[8, 0, 0], [0, 8, 0], [0, 1, 8]], 3)}]`)), 0.01, 9],
  [asks(all_struts, far, off(0.01), of_struts(`[1,${near_struts}]`)), 0.01, 1],
  [asks(vague_struts, far, off(0.01), of_struts(`[1,${near_struts}]`)), 0.01, 3],
  // Errors that are so large that what is near the cell is too far from it.
  [asks(three, box, off(4), tree(`[1,${nearly}]`)), 4, 12],
];
for (const [text, low, high] of accuracies) narrowed(text, low, high);
for (const text of [
  asks(three, box, off(-0.01), tree(`[1,${nearly}]`)),
  asks(three, box, off(0.6), tree(`[1,${nearly}]`)),
  asks(toleranced, box, off(0.45), tree(`[1,${nearly}]`)),
  asks(three, box, about("accuracy", "max"), tree(`[1,${nearly}]`)),
  asks(three, box, about("accuracy", "min", ',"given":{"joint_error":["0"]}'), tree(`[1,${nearly}]`)),
  asks(three, box, about("accuracy", "max", ',"given":{"tool":["0"]}'), tree(`[1,${nearly}]`)),
  asks(three, box, about("accuracy", "max", ',"given":{"joint_error":["0"],"max_angle":["1"]}'), tree(`[1,${nearly}]`)),
  asks(three, box, about("accuracy", "max", ',"leg":1,"given":{"joint_error":["0"]}'), tree(`[1,${nearly}]`)),
  ...[accuracy(near, 0), accuracy(near, -1), accuracy(near, 8), accuracy(near, 1, 1), accuracy(near.map((row) => row.map((n) => -n)), 1),
    accuracy([[0, 0, 0], [0, 0, 0], [0, 0, 0]], 1), accuracy([[8, 0, 0], [0, 8, 0], [0, 0, 0]], 1), accuracy([[8, 0, 0], [0, 8, 0]], 1), accuracy(near.map((row) => [...row, 0]), 1),
    `{"lower":${y(near)}}`, `{"rank":${y(near)}}`, '"test"', '"chords"'].map((evidence) => asks(three, box, off(0.01), tree(`[1,${evidence}]`))),
  // Evidence of accuracy shows nothing else.
  asks(three, box, about("transmission", "min"), tree(`[1,${nearly}]`)),
  // More joints than coordinates, and legs that do not reach what is near.
  asks([...three, plane(0, 0, 1)], box, off(0.01), tree(`[1,${accuracy([...near, [0, 0, 0]], 1)}]`).replace("[0,0,8]", "[0,0,8],[0,0,0]")),
  asks(sliders('"43"'), box, off(0.01), tree(`[1,${nearly}]`)),
]) {
  const answers = all(text("0.5"));
  if (answers.some((answer) => answer !== "REJECTED")) fail(`accuracy: ${answers}: ${text("0.5")}`);
}
for (const b of ["0", "-1"]) {
  const text = asks(three, box, off(0), tree(`[1,${nearly}]`))(b);
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`accuracy: ${all(text)}: ${text}`);
}
console.log(`accuracy: ${accuracies.length} machines, with one answer at 42 bounds each`);
// Atlases: a bound and lengths that are parameters, of which the bound decides.
const tied = sliders('{"min":"r-0.1","max":"r+1/10"}');
const by_lower = { by: [[0, { lower: { y: [[8, 0, 0], [0, 8, 0], [0, 0, 8]], places: 3 } }]] };
const proved = { certified: { precision: 40, nodes: [by_lower] } };
const witnessed = (point, machine, fails) => ({ refuted: { precision: 64, point, ...(machine && { machine }), fails } });
const failing = witnessed(["28*r/310", "28*r/310", "28*r/310"], ["r", "r-0.1", "r"], { obligation: [0, [[0, 1, -1]]] });
const psi_and_r = [{ name: "psi", min: "1.02", max: "1.5" }, { name: "r", min: "308", max: "312" }];
const some = [{ split: 0 }, { split: 0 }, { split: 0 }, failing, "undecided", "undecided", { split: 1 }, proved, proved];
const atlas = ({ parameters = psi_and_r, legs = tied, workspace = box, bound = "psi", certified = "1/2", refuted = "1/8", cells = some }) =>
  `{"format":"orthocert/2","claim":{"atlas":{"parameters":${JSON.stringify(parameters)},"machine":{"mechanism":{"translational":[${legs}]},` +
  `"workspace":${workspace},"require":[{"quantity":"transmission","end":"max","bound":"${bound}"}]},"certified":"${certified}","refuted":"${refuted}"}},` +
  `"verdict":"certified","proof":{"atlas":${JSON.stringify(cells)}},"provenance":{"tool":"t","version":"1"}}\n`;
const with_cell = (i, cell) => some.map((old, k) => (k === i ? cell : old));
const [psi, r] = psi_and_r;
const round = `{"cylinder":{"center":["0","0"],"radius":"r/15","z":["-r/15","20"]}}`;
const atlases = [
  [{}, "CERTIFIED"],
  [{ certified: "0", refuted: "1/9" }, "CERTIFIED"],
  [{ cells: ["undecided"], certified: "0", refuted: "0" }, "CERTIFIED"],
  [{ workspace: round, cells: [{ split: 0 }, "undecided", proved], refuted: "0" }, "CERTIFIED"],
  [{ bound: "sqrt(psi*psi)" }, "CERTIFIED"],
  // What cancels does so by slopes, and not in a tree of inputs.
  [{ bound: "psi+(r-r)/9" }, "CERTIFIED", "REJECTED"],
  [{ bound: "psi^2/psi" }, "CERTIFIED", "REJECTED"],
  // The tree of cells, and the shares that they have.
  [{ certified: "3/5" }, "REJECTED"], [{ refuted: "1/7" }, "REJECTED"], [{ certified: "-1" }, "REJECTED"], [{ certified: "1/0" }, "REJECTED"], [{ refuted: "psi-psi" }, "REJECTED"],
  [{ certified: "sqrt(1/4)" }, "REJECTED"], [{ cells: [] }, "REJECTED"], [{ cells: some.slice(1) }, "REJECTED"], [{ cells: some.slice(0, -1) }, "REJECTED"],
  [{ cells: [...some, "undecided"] }, "REJECTED"], [{ cells: with_cell(0, { split: 2 }) }, "REJECTED"], [{ cells: with_cell(0, { split: 1 }) }, "REJECTED"],
  [{ cells: [...Array(61).fill({ split: 0 }), ...Array(62).fill("undecided")], certified: "0", refuted: "0" }, "REJECTED"],
  [{ cells: [...Array(60).fill({ split: 0 }), ...Array(61).fill("undecided")], certified: "0", refuted: "0" }, "CERTIFIED"],
  // Parameters.
  [{ parameters: [psi] }, "REJECTED"], [{ parameters: [psi, psi, r] }, "REJECTED"], [{ parameters: [psi, r, { ...r, name: "psi" }] }, "REJECTED"],
  [{ parameters: [psi, r, { ...r, name: "s" }] }, "CERTIFIED"], [{ parameters: [psi, r, { ...r, name: "s" }, { ...r, name: "t" }] }, "REJECTED"],
  [{ parameters: [], legs: three, bound: "2", cells: [proved], refuted: "0" }, "REJECTED"], [{ parameters: [psi, { ...r, name: "sqrt" }], legs: three }, "REJECTED"],
  [{ parameters: [psi, { ...r, max: "308" }] }, "REJECTED"], [{ parameters: [psi, { ...r, max: "307" }] }, "REJECTED"], [{ parameters: [psi, { ...r, max: "312*psi" }] }, "REJECTED"],
  [{ parameters: [psi, { ...r, max: "sqrt(97344)" }] }, "REJECTED"], [{ parameters: [psi, { ...r, name: "1r" }] }, "REJECTED"], [{ parameters: [psi, { ...r, max: "311+1" }] }, "CERTIFIED"],
  // What is said of cells, for some values and not for all.
  [{ cells: with_cell(4, proved), certified: "9/16" }, "REJECTED"], [{ cells: with_cell(4, failing), refuted: "1/4" }, "REJECTED"], [{ cells: with_cell(7, failing) }, "REJECTED"],
  [{ parameters: [{ ...psi, max: "2" }, r] }, "REJECTED"], [{ bound: "psi-0.2" }, "REJECTED"], [{ bound: "psi+0.1" }, "REJECTED"], [{ bound: "phi" }, "REJECTED"], [{ bound: "1/(psi-1.3)" }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["30*r/310", "28", "28"], ["r", "r", "r"], { obligation: [0, [[0, 1, -1]]] })) }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["28", "28", "28"], ["r", "310", "r"], { obligation: [0, [[0, 1, -1]]] })) }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["28", "28", "28"], ["r", "r"], { obligation: [0, [[0, 1, -1]]] })) }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["28", "28", "28"], ["r", "r", "r"], { obligation: [0, []] })) }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["28", "28", "28"], ["r", "r", "r"], { row: [0, 1] })) }, "REJECTED"],
  [{ cells: with_cell(3, witnessed(["28", "28", "28"], ["r", "r", "r"], "reach")) }, "REJECTED"],
  [{ cells: with_cell(7, { certified: { precision: 31, nodes: [by_lower] } }) }, "REJECTED"], [{ cells: with_cell(7, { certified: { precision: 40, nodes: [{}] } }) }, "REJECTED"],
  // Tolerances are halved in cells, of which there are three, but not names.
  ...[3, 5].map((split) => [{ cells: with_cell(7, { certified: { precision: 40, nodes: [{ split }, by_lower, by_lower] } }) }, "CERTIFIED"]),
  [{ cells: with_cell(7, { certified: { precision: 40, nodes: [{ split: 6 }, by_lower, by_lower] } }) }, "REJECTED"],
  [{ legs: sliders('"r"'), cells: [{ split: 0 }, "undecided", proved], refuted: "0" }, "CERTIFIED"],
  [{ legs: sliders('"r"'), cells: [{ split: 0 }, "undecided", { certified: { precision: 40, nodes: [{ split: 3 }, by_lower, by_lower] } }], refuted: "0" }, "REJECTED"],
  // Ends of tolerances in the wrong order, for some values; and a workspace that there is not.
  [{ legs: sliders('{"min":"r","max":"310"}') }, "REJECTED"], [{ legs: sliders('{"min":"r","max":"r"}') }, "REJECTED"],
  [{ workspace: box.replace('"-20"', '"r-310"').replace('"30"', '"0"') }, "REJECTED"],
];
for (const [parts, right, exact = right] of atlases) {
  const text = atlas(parts), answers = all(text);
  if (answers.some((answer, i) => answer !== (i ? exact : right))) fail(`atlas: ${answers}, and not ${right}: ${text}`);
}
read.push(atlas({}), atlas(atlases[3][0]));
console.log(`atlases: ${atlases.length}, with the answers that they have to have`);

// Tolerances apart, in the same way: wide ones, of lengths, and of all that legs have.
const apartly = (e, ends, ...directions) => `{"tolerances":[${e},"${ends}",${JSON.stringify(directions)}]}`;
const wide = sliders('{"min":"307","max":"313"}'), mixed_ends = "-0+0-+00--0+-+0+-0+0-0+--0+0-+";
const one_leaf = (...steps) => `{"tree":{"precision":40,"nodes":[{"by":[${steps}]}]}}`;
const by_rank = `[0,{"rank":${y(near)}}]`, identity = `{"lower":${y(near)}}`, turned_y = `{"lower":${y([[7, 1, 0], [0, 8, -1], [1, 0, 8]])}}`;
const struts_rank = `[0,{"rank":${y([[-8, 0, 2], [4, -7, 2], [4, 7, 2]])}}]`;
const [a, b, c] = [[1, 1, 1], [3, -2, 0], [0, 0, 0]];
const tools = ',"given":{"tool":["56"]}', moving = ',"given":{"acceleration":["9000"],"speed":["1200"]}', joint = ',"given":{"joint":["3"]}';
const apart_tolerances = [
  [asks(wide, box, about("transmission", "max"), one_leaf(`[0,${apartly(identity, "-0+", a)}]`)), 1.01, 3],
  [asks(loose, box, about("transmission", "max"), one_leaf(`[0,${apartly(turned_y, mixed_ends, b)}]`)), 1.01, 3],
  [asks(wide, cylinder, about("transmission", "max"), one_leaf(`[0,{"tolerances":[{"inside":[${identity},1,9]},"00+",[[1,2,3]]]}]`)), 1.01, 3],
  [asks(wide, box, about("transmission", "min"), one_leaf(by_rank, `[1,${apartly('"test"', "+0-", a)}]`)), 0.2, 1],
  [asks(loose, box, about("transmission", "min"), one_leaf(by_rank, `[1,${apartly('"test"', mixed_ends, b)}]`)), 0.2, 1],
  [asks(wide, cylinder, about("transmission", "min"), one_leaf(by_rank, `[1,${apartly('{"inside":["test",1,9]}', "---", a)}]`)), 0.2, 1],
  [asks(wide, box, about("transmission", "min"), one_leaf(by_rank, `[1,${apartly('"test"', "000", c)}]`)), 0.2, 1],
  [asks(wide, box, about("conditioning", "max"), one_leaf(by_rank, `[1,${apartly(`{"conditioning":[${y(near)},[4,0,0,0]]}`, "0-0", a, b)}]`)), 1.01, 9],
  [asks(loose, cylinder, about("conditioning", "max"), one_leaf(by_rank, `[1,${apartly(`{"inside":[{"conditioning":[${y(near)},[4,0,0,0]]},1,9]}`, mixed_ends, a, b)}]`)), 1.01, 9],
  [asks(wide, box, about("joint_range", "min", ',"leg":2'), one_leaf(by_rank, `[1,${apartly('"test"', "0-+")}]`)), -400, 0],
  [asks(loose, box, about("joint_range", "max", ',"leg":1'), one_leaf(by_rank, `[1,${apartly('"test"', mixed_ends)}]`)), -400, 0],
  [asks(loose, cylinder, about("joint_range", "max", ',"leg":3'), one_leaf(by_rank, `[1,${apartly('{"inside":["test",3,9]}', mixed_ends)}]`)), -400, 0],
  [asks(wide, box, about("joint_speed", "max", ',"leg":1' + tools), one_leaf(by_rank, `[1,${apartly('"test"', "+++")}]`)), 56, 90],
  [asks(loose, box, about("joint_acceleration", "max", ',"leg":2' + moving), one_leaf(by_rank, `[1,${apartly('"test"', mixed_ends)}]`)), 9000, 30000],
  [asks(wide, box, about("serial_margin", "min", ',"leg":2'), one_leaf(by_rank, `[1,${apartly('"test"', "-+0")}]`)), 0.1, 1],
  [asks(loose, box, about("parallel_margin", "min"), one_leaf(by_rank, `[1,${apartly('"test"', mixed_ends)}]`)), 0.1, 1],
  [asks([wide[1], wide[0], wide[2]], box, about("parallel_margin", "min"), one_leaf(`[0,{"rank":${y([near[1], near[0], near[2]])}}]`, `[1,${apartly('"negative"', "0+-")}]`)), 0.1, 1],
  [asks(loose, box, about("stiffness", "min", joint), one_leaf(by_rank, `[1,${apartly(identity, mixed_ends, a)}]`)), 0.1, 3],
  [asks(loose, box, about("joint_force", "max", ',"leg":2' + tools), one_leaf(by_rank, `[1,${apartly(turned_y.replace('"places":3', '"places":4'), mixed_ends, b)}]`)), 56, 3000],
  [asks(wide, box, about("joint_force", "max", ',"leg":1' + tools), one_leaf(by_rank, `[1,${apartly(lower([[5, 0, 0], [0, 5, 0], [0, 0, 5]]), "0-+", a)}]`)), 56, 300],
  [asks(wide, cylinder, about("joint_force", "max", ',"leg":3' + tools), one_leaf(by_rank, `[1,${apartly(`{"inside":[${whole},1,9]}`, "00+", a)}]`)), 56, 300],
  [asks(wide, box, about("joint_range", "max", ',"leg":1'), one_leaf(`[0,${apartly(`{"rank":${y(near)}}`, "0-+", a)}]`, '[1,"test"]')), -400, 0],
  [asks(vague_struts, far, about("transmission", "min"), one_leaf(struts_rank, `[1,${apartly('"test"', "-0+0", a)}]`)), 0.05, 1],
  [asks(vague_struts, far, about("joint_range", "max"), one_leaf(struts_rank, ...[1, 2, 3].map((i) => `[${i},${apartly('"test"', "0-+0")}]`))), 300, 600],
  [asks([three[0], vague[1], vague_plane], box, about("transmission", "max"), one_leaf(`[0,${apartly(identity, "0-", a)}]`)), 1.01, 3],
];
for (const [text, low, high] of apart_tolerances) {
  if (all(text(String(low)))[1] === all(text(String(high)))[1]) fail(`tolerances: one answer at ${low} and ${high}: ${text("?")}`);
  // Squares in derivatives are products here, which rounds otherwise: not to the last bit.
  narrowed(text, low, high, 18);
}
// Of second order, all quantities or one of three: second derivatives are by other formulas here.
const by_second = (text, which) => text.replace(/,"([-+0]+)",\[/g, (_, ends) => `,"${[...ends].map((end, i) => which(i) ? "<>="["-+0".indexOf(end)] : end).join("")}",[`);
let of_second_order = 0;
for (const [text, low, high] of apart_tolerances) for (const which of [() => true, (i) => i % 3 === 1]) {
  const curved = (b) => by_second(text(b), which);
  // A determinant has more second derivatives by thirty numbers than orthocert-check takes.
  if (/parallel_margin/.test(curved("0")) && /"[<=>]{30}"/.test(curved("0"))) continue;
  if (!/"[-+0]*[<=>]/.test(curved("1"))) fail(`of second order: none: ${curved("?")}`);
  if (all(curved(String(low)))[1] === all(curved(String(high)))[1]) fail(`of second order: one answer at ${low} and ${high}: ${curved("?")}`);
  narrowed(curved, low, high, 12);
  of_second_order++;
}
console.log(`tolerances of second order: ${of_second_order} machines, with one answer at 14 bounds each`);
const shown_apart = (step, legs = wide, workspace = box) => asks(legs, workspace, about("transmission", "max"), one_leaf(`[0,${step}]`))("3");
if (all(shown_apart(apartly(identity, "-0+", a))).some((answer) => answer !== "CERTIFIED")) fail("tolerances: none");
for (const text of [
  ...["", "-0", "-0+-", "-0x", "-0 ", "<=", "<=><", "<=1", "<=≥"].map((ends) => shown_apart(apartly(identity, ends, a))),
  shown_apart(apartly(identity, "", a), three), shown_apart(apartly(identity, "000", a), three),
  shown_apart(apartly(identity, "-0+")), shown_apart(apartly(identity, "-0+", a, a)), shown_apart(apartly(identity, "-0+", [1, 1])), shown_apart(apartly(identity, "-0+", [1, 1, 1, 1])),
  shown_apart(apartly(apartly(identity, "-0+", a), "-0+", a)), shown_apart(`{"inside":[${apartly(identity, "-0+", a)},1,9]}`, wide, cylinder),
  shown_apart(apartly(`{"inside":[${identity},1,9]}`, "-0+", a)), shown_apart(apartly(`{"inside":[${identity},-1,9]}`, "-0+", a), wide, cylinder),
  shown_apart(apartly(identity.replace("lower", "lower_divided"), "-0+", a)), shown_apart(apartly(identity.replace("lower", "rank"), "-0+", a)),
  shown_apart(apartly(lower([[8, 0, 0], [0, 8, 0], [0, 0, -8]]), "-0+", a)), shown_apart(apartly('"test"', "-0+", a)), shown_apart(apartly('"outside"', "-0+", a)),
  asks(wide, box, about("transmission", "min"), one_leaf(by_rank, `[1,${apartly('"divided"', "-0+", a)}]`))("0.2"),
  asks(wide, box, same, by_chords(near, `[1,${apartly('"chords"', "-0+", a)}]`))(""),
  asks(toleranced, box, off(0.01), one_leaf(by_rank, `[1,${apartly(nearly, "-0+", a)}]`))("1"),
  asks(wide, box, about("joint_range", "max", ',"leg":1'), one_leaf(by_rank, `[1,${apartly('"test"', "-0+", a)}]`))("0"),
  clear(wide, box, legged, one_leaf(by_rank, `[1,${apartly(steady, "-0+", a)}]`), "certified")("1"),
  atlas({ cells: with_cell(7, { certified: { precision: 40, nodes: [{ by: [[0, { tolerances: [by_lower.by[0][1], "000", [[1, 1, 1]]] }]] }] } }) }),
]) {
  const answers = all(text);
  if (answers.some((answer) => answer !== "REJECTED")) fail(`tolerances: ${answers}: ${text}`);
}
console.log(`tolerances: ${apart_tolerances.length} machines, with one answer at 20 bounds each`);
for (const [text, low, high] of [...apart, ...accelerations, ...forces, ...accuracies, ...apart_tolerances])
  read.push(...[low, high].map((b) => text(String(b))).filter((text) => all(text)[0] !== "REJECTED"));
// Machines that are singular at a pose, in fractions, and those that are only nearly so.
const strut = (anchor, platform) => `{"drive":"strut","anchor":[${anchor}],"platform":[${platform}]}`;
const quote = (...x) => x.map((x) => `"${x}"`).join(",");
const singular = (mechanism, workspace, orientation, point, machine = []) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":{${mechanism}},` +
  `"workspace":{"box":{"min":[${quote(...workspace[0])}],"max":[${quote(...workspace[1])}]}}${orientation ? `,"orientation":${orientation}` : ""},"require":[]}},` +
  `"verdict":"refuted","proof":{"witness":{"precision":64,"point":[${quote(...point)}]${machine.length ? `,"machine":[${quote(...machine)}]` : ""},` +
  `"fails":"dependent"}},"provenance":{"tool":"t","version":"1"}}\n`;
const six = [["0.98481", "-0.17365"], ["0.98481", "0.17365"], ["-0.34202", "0.93969"], ["-0.64279", "0.76604"], ["-0.64279", "-0.76604"], ["-0.34202", "-0.93969"]];
const hexapod = (platform, ...pose) => singular(`"spatial":{"legs":[${six.map(([x, y], i) => strut(quote(x, y, 0), platform(x, y, i)))}],"characteristic_length":"1/2"}`,
  [["-0.2", "-0.2", "0.8"], ["0.2", "0.2", "1.2"]], '{"angle":"15"}', ...pose);
const centre = [0, 0, 1, 0, 0, 0], aside_ = ["0.1", "-1/7", "1.05", "0.03", "1/30", "-0.1"];
const half = (more) => (x, y, i) => quote(`${x}/2`, `${y}/2${i === 5 ? more : ""}`, 0);
const ranged = (x, y, i) => i === 5 ? `"${x}/2",{"min":"-0.5","max":"-0.4"},"0"` : quote(`${x}/2`, `${y}/2`, 0);
const flat = (joints, point) => singular(`"planar":{"legs":[${joints.map((b, i) => strut(quote(...[[1, 0], [-1, "0.1"], [0, 1]][i]), quote(...b)))}],"characteristic_length":"1/2"}`,
  [["-0.1", "-0.1"], ["0.1", "0.1"]], '{"range":["-5","5"]}', point);
const cube = [[-1, -1, 0], [1, 1, 2]];
const about_axis = (z) => singular(`"translational":[${[[1, 0], [0, 1], [-1, 1]].map(([x, y]) => strut(quote(x, y, 1), quote(0, 0, 0)))}]`, cube, "", ["0.1", "0.2", z]);
const guided = (x, y, at = 1) => singular(`"translational":[${[[x, 0], [`-${x}`, 0], [0, y]].map(([x, y]) =>
  `{"drive":"slider","direction":${triple(0, 0, 2)},"anchor":${triple(x, y, 0)},"platform":${triple(0, 0, 0)},"length":"5","mode":"+"}`)}]`, cube, "", [0, 0, at]);
const arms = (axis) => singular(`"translational":[${[0, 1, 2].map(() => `{"drive":"arm","axis":${axis},"reference":${triple(0, 0, 1)},"anchor":${triple(-1, 0, 0)},` +
  `"platform":${triple(0, 0, 0)},"arm":"5","length":"5","mode":"+"}`)}]`, cube, "", [0, 0, 0]);
const poses = [
  [hexapod(half(""), centre), 1], [hexapod(half(""), aside_), 1], [hexapod(() => quote("0.3", "0.1", "-0.2"), aside_), 1],
  [hexapod((x, y, i) => quote(`1/2-0.2*${i}`, 0, 0), aside_), 1], [hexapod(ranged, aside_, ["-0.469845"]), 1],
  [flat([["0.3", "0.1"], ["0.3", "0.1"], ["0.3", "0.1"]], ["0.1", "0.05", "1/50"]), 1],
  [about_axis("1"), 1], [guided(3, 0), 1],
  [hexapod(half(`+1/1${"0".repeat(30)}`), aside_), 0], [hexapod(half("+sqrt(2)"), aside_), 0], [hexapod(() => quote("sqrt(2)/4", "0.1", 0), centre), 0],
  [hexapod((x, y, i) => quote(`${y}/2`, `${x}/3`, i % 2 ? "0.1" : 0), aside_), 0], [hexapod(half(""), [0, 0, "1.21", 0, 0, 0]), 0], [hexapod(half(""), [0, 0, 1, "0.14", 0, 0]), 0],
  [hexapod(half(""), centre.slice(1)), 0], [hexapod(half(""), [...centre, 0]), 0], [hexapod(half(""), centre, [0]), 0],
  ...["-0.46984", "-0.51", "-0.3999"].map((x) => [hexapod(ranged, aside_, [x]), 0]), [hexapod(ranged, aside_), 0],
  [flat([["0.3", "0.1"], ["0.3", "0.1"], ["0.1", "0.1"]], [0, 0, 0]), 0], [about_axis("1.001"), 0],
  [guided(3, 4), 0], [guided("2.9", 0), 0], [guided(5, 0), 0], [guided(3, 0, 3), 0], [arms(triple(0, 1, 0)), 0],
];
for (const [text, right] of poses) {
  const answers = all(text);
  if (answers.some((answer) => answer !== (right ? "REFUTED" : "REJECTED"))) fail(`dependent: ${answers}: ${text}`);
  if (right) read.push(text);
}
console.log(`singular at a pose: ${poses.length}, with one answer`);

// Joint coordinates by formulas that no two points of a box share: by one matrix, of any obligation's number.
const mapped = (joints, require, chords, nodes, b = "0") => `{"format":"orthocert/2","claim":{"machine":{"mechanism":{"formulas":{"coordinates":["x","y"],` +
  `"parameters":[["b",${/^\{/.test(b) ? b : quote(b)}]],"definitions":[["s","b*x*y"]],"joints":[${joints}]}},"workspace":{"box":{"min":["-1","-1"],"max":["1","1/2"]}},"require":[${require}]}},` +
  `"verdict":"certified","proof":{"tree":{"precision":40,${chords ? `"chords":{"y":${JSON.stringify(chords)},"places":1},` : ""}"nodes":[{"by":[${nodes}]}]}},"provenance":{"tool":"t","version":"1"}}\n`;
const rho = (...formulas) => formulas.map((f) => `{"rho":"${f}"}`);
const alone = '{"quantity":"one_to_one","end":"holds"}', ranges = [["min", -9], ["max", 9]].map(([end, b]) => `{"quantity":"joint_range","leg":1,"end":"${end}","bound":"${b}"}`);
const diagonal = [[2, 0], [0, 2]], full = '[0,{"rank":{"y":[[2,0],[0,2]],"places":1}}]', bent = rho("x+s", "y");
narrowed((b) => mapped(bent, alone, diagonal, `${full},[1,"chords"]`, b), 0, 4);
narrowed((b) => mapped(rho("x-y", "x+y+s", "3*y"), alone, [[2, -2], [2, 2], [0, 0]], `[0,{"rank":{"y":[[2,-2],[2,2],[0,0]],"places":1}}],[1,"chords"]`, b), 0, 9);
for (const [text, right] of [
  [mapped(bent, [ranges[0], alone, ranges[1]], diagonal, `${full},[1,"test"],[2,"chords"],[3,"test"]`), 1],
  [mapped(bent, [alone, ...ranges], diagonal, `${full},[1,"chords"],[2,"test"],[3,"test"]`, '{"min":"-1/9","max":"1/9"}'), 1],
  [mapped(bent, [alone, ...ranges], diagonal, `${full},[1,"test"],[2,"chords"],[3,"test"]`), 0],
  [mapped(bent, [ranges[0], alone, ranges[1]], diagonal, `${full},[1,"test"],[3,"chords"],[2,"test"]`), 0],
  [mapped(bent, alone, diagonal, `${full},[1,"test"]`), 0],
  [mapped(bent, alone, diagonal, full), 0],
  [mapped(bent, alone, null, `${full},[1,"chords"]`), 0],
  [mapped(bent, alone, [[-2, 0], [0, -2]], `${full},[1,"chords"]`), 0],
  [mapped(bent, alone, [[2, 0], [0, 0]], `${full},[1,"chords"]`), 0],
  [mapped([bent[0], '{"row":["0","1"]}'], alone, diagonal, `${full},[1,"chords"]`), 0],
  [mapped(rho("x^2+s", "y"), alone, diagonal, `${full},[1,"chords"]`), 0],
  [mapped(bent, alone.replace(',"end"', ',"leg":1,"end"'), diagonal, `${full},[1,"chords"]`), 0],
  [mapped(bent, [alone, alone], diagonal, `${full},[1,"chords"],[2,"chords"]`), 0],
]) {
  const answers = all(text);
  if (answers.some((answer) => answer !== (right ? "CERTIFIED" : "REJECTED"))) fail(`one to one: ${answers}: ${text}`);
  if (right) read.push(text);
}
console.log("one to one by formulas: 2 mechanisms, with one answer at 42 bounds each");

// Platforms that turn: condition numbers at control points, and positions in a cylinder.
const about_z = (legs, evidence) => (b) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":{"planar":{"legs":[${legs}],"characteristic_length":"100"}},` +
  `"workspace":{"box":{"min":["-50","-50"],"max":["50","50"]}},"orientation":{"range":["-20","20"]},"require":[{"quantity":"conditioning","end":"max","bound":"${b}"}]}},` +
  `"verdict":"certified","proof":{"tree":{"precision":40,"nodes":[{"by":[[0,{"control":{"rank":${y([[0, -8, -8], [8, 8, -8], [-8, 0, -8]])}}}],[1,{"control":${evidence}}]]}]}},` +
  `"provenance":{"tool":"t","version":"1"}}\n`;
const rooted = (k) => `${k}*sqrt(3)`;
const three_struts = [[[0, 400], [rooted(50), 50]], [[rooted("-200"), -200], [rooted("-50"), 50]], [[rooted(200), -200], [0, -100]]]
  .map(([a, b]) => strut(quote(...a), quote(...b)));
const by_mu = (mu) => `{"conditioning":[${y([[0, -8, -8], [8, 8, -8], [-8, 0, -8]])},${JSON.stringify(mu)}]}`;
for (const mu of [[6, 0, 0, 0], [5, 1, 0, 0], [4, 0, -1, 1]]) narrowed(about_z(three_struts, by_mu(mu)), 1.01, 4);
for (const [mu, bound] of [[[0, 0, 0, 0], 4], [[-6, 0, 0, 0], 4], [[6, 7, 0, 0], 4], [[9, 0, 0, 0], 4], [[6, 0, 0], 4], [[6, 0, 0, 0, 0], 4], [[6, 0, 0, 0], "0.9"], [[6, 0, 0, 0], "1"]]) {
  const text = about_z(three_struts, by_mu(mu))(bound);
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`conditioning: ${all(text)}: ${text}`);
}
const boxed = fs.readFileSync(files.find((file) => path.basename(file) === "hexapod-linuxcnc.cert.json"), "latin1");
const rounded = (radius, bottom = "17", top = "23") => boxed.replace(/"workspace":\{"box":\{.*?\}\}/, `"workspace":{"cylinder":{"center":["0","0"],"radius":"${radius}","z":["${bottom}","${top}"]}}`);
narrowed(rounded, 1, 30, 12);
for (const text of [rounded(0), rounded(-1), rounded(1, "23", "17"), rounded(1, "19", "sqrt(-1)"), about_z(three_struts, by_mu([6, 0, 0, 0]))(4).replace(/"box":\{.*?\}/, '"cylinder":{"center":["0","0"],"radius":"1","z":["0","0"]}')])
  if (all(text).some((answer) => answer !== "REJECTED")) fail(`cylinder: ${all(text)}: ${text}`);
read.push(about_z(three_struts, by_mu([5, 1, 0, 0]))(4), rounded(1));
console.log("platforms that turn: condition numbers and a cylinder, with one answer at 140 bounds");

// No two poses of a platform that turns with the same lengths of its legs: by one matrix of vectors and their moments about the origin.
const one_matrix = [[7014779,-1316736,7024484,4844769,3421156,-2754124], [-6614091,-1248862,7027172,4849384,-3370265,2752146], [-3887084,-4625532,9019619,270393,-5441807,-2747787], [2561394,6213510,7991965,-4962758,-2196775,2388783], [-2493336,6200246,8103067,-4883129,2167995,-2412308], [3726498,-4703572,9106296,324384,5268643,2744455]];
const full_pose = '[0,{"control":{"rank":{"y":[[3,0,2,3,0,-2],[-3,0,2,3,0,2],[-1,-3,2,-1,-3,-2],[2,3,2,-2,-3,2],[-2,3,2,-2,3,-2],[1,-3,2,-1,3,2]],"places":3}}}]';
const posed = (angle, reach, require, steps, matrix = one_matrix) => boxed.replace(/"workspace".*/s, `"workspace":{"box":{"min":["-${reach}","-${reach}","16"],"max":["${reach}","${reach}","24"]}},` +
  `"orientation":{"angle":"${angle}"},"require":[${require}]}},"verdict":"certified","proof":{"tree":{"precision":50,${matrix ? `"chords":{"y":${JSON.stringify(matrix)},"places":25},` : ""}` +
  `"nodes":[{"by":[${steps}]}]}},"provenance":{"tool":"t","version":"1"}}\n`);
const pose_range = (leg, bound) => `{"quantity":"joint_range","leg":${leg},"end":"min","bound":"${bound}"}`, chords = '{"control":"chords"}', by_test = '{"control":"test"}';
narrowed((b) => posed(b, 4, alone, `${full_pose},[1,${chords}]`), 1, 60, 14);
narrowed((b) => posed(15, b, alone, `${full_pose},[1,${chords}]`), 1, 40, 14);
narrowed((b) => posed(15, b, alone, `${full_pose},[1,{"control":{"turned":["chords",1,3]}}]`), 1, 40, 14);
for (const [text, right] of [
  [posed(12, 3, [pose_range(1, 1), alone, pose_range(2, 1)], `${full_pose},[1,${by_test}],[2,${chords}],[3,${by_test}]`), 1],
  [posed(12, 3, [pose_range(1, 1), alone, pose_range(2, 1)], `${full_pose},[1,${by_test}],[3,${chords}],[2,${by_test}]`), 0],
  [posed(12, 3, alone, full_pose), 0],
  [posed(12, 3, alone, `${full_pose},[1,${by_test}]`), 0],
  [posed(12, 3, alone, `${full_pose},[1,${chords}]`, null), 0],
  [posed(12, 3, alone, `${full_pose},[1,${chords}]`, one_matrix.map((row) => row.map((n) => -n))), 0],
  [posed(12, 3, alone, `${full_pose},[1,${chords}]`, one_matrix.map((row) => [...row.slice(0, 5), 0])), 0],
  [posed(12, 3, alone, `${full_pose},[1,${chords}]`, one_matrix.slice(1)), 0],
  [posed(90, 3, alone, `${full_pose},[1,${chords}]`), 0],
]) {
  const answers = all(text);
  if (answers.some((answer) => answer !== (right ? "CERTIFIED" : "REJECTED"))) fail(`poses: ${answers}: ${text}`);
  if (right) read.push(text);
}
console.log("one to one of platforms that turn: with one answer at 48 bounds");

// The same of legs in any motion, and of struts with other sets of orientations: an entry of the one matrix is moved until it shows nothing.
let moved_entries = 0;
const once = fs.mkdtempSync(path.join(os.tmpdir(), "once-"));
for (const name of ["kernel/five-bar", "kernel/planar-3-prr", "kernel/planar-3-rpr", "kernel/planar-3-rrr", "kernel/spherical-3-ups", "kernel/hexapod-rubin-m2", "kernel/hexaglide-type", "rotary-delta-speed", "delta-leg-angle", "orthoglide-prototype"]) {
  const design = path.join(once, "once.toml"), file = path.join(once, "once.cert.json");
  fs.writeFileSync(design, fs.readFileSync(path.join(__dirname, "../../../tests/designs", `${name}.toml`), "utf8").replace(/^one_to_one.*$/m, "").replace("[requirements]", "[requirements]\none_to_one = true"));
  spawnSync(orthocert, ["verify", design, "-o", file]);
  const text = fs.readFileSync(file, "latin1"), places = +text.match(/"chords":\{"y":.*?"places":(\d+)\}/)[1];
  const edited = (change) => text.replace(/"chords":\{"y":(.*?),"places"/, (_, y) => `"chords":{"y":${JSON.stringify(change(JSON.parse(y)))},"places"`);
  for (const sign of name.includes("hexa") ? [] : [1, -1]) {
    narrowed((b) => edited(([[a, ...row], ...rows]) => [[a + sign * Math.round(+b * 2 ** places), ...row], ...rows]), 0, 64, 9);
    moved_entries += 9;
  }
  for (const [mutant, right] of [[text, 1], [edited((rows) => rows.map((row) => row.map((n) => -n))), 0], [edited((rows) => rows.slice(1)), 0], [edited((rows) => rows.map(([a, ...row]) => [0, ...row])), 0],
    [text.replace(/"chords":\{.*?\},/, ""), 0], [text.replace(/,?\[\d+,(\{"control":)?"chords"\}?\]/, ""), 0], [text.replace(/"(angle|tilt|torsion)":"/, '"$1":"9'), 0], [text.replace(/"(range|roll)":\["-/, '"$1":["-16'), 0]]) {
    if (mutant === text && !right) continue;
    const answers = all(mutant);
    if (answers.some((answer) => answer !== (right ? "CERTIFIED" : "REJECTED"))) fail(`once: ${answers}: ${mutant}`);
  }
  agrees(file, verify(text));
  if (text.length < 5000) read.push(text);
}
fs.rmSync(once, { recursive: true });
console.log(`one to one of legs in any motion: with one answer at ${moved_entries} matrices`);

// Distances from parallel singularities of any legs, and a stiffness for each joint.
const asked = (legs, box, requirement, proof, verdict = "certified") => (b) => `{"format":"orthocert/2","claim":{"machine":{"mechanism":{"translational":[${legs}]},` +
  `"workspace":{"box":{"min":${triple(...box[0])},"max":${triple(...box[1])}}},"require":[${requirement(b)}]}},"verdict":"${verdict}","proof":${proof},"provenance":{"tool":"t","version":"1"}}\n`;
const by_steps = (Y, ...steps) => `{"tree":{"precision":40,"nodes":[{"by":[[0,{"rank":${y(Y)}}],${steps}]}]}}`;
const planes = [plane(3, 1, 0), plane(0, "sqrt(7)", 1), plane(1, 0, 3)], unit = [[8, 0, 0], [0, 8, 0], [0, 0, 8]], here_ = [[0, 0, 0], [1, 2, 3]], above = [[-20, -20, 300], [20, 20, 310]];
const margin = (b) => `{"quantity":"parallel_margin","end":"min","bound":"${b}"}`, leaning = [[-8, 0, 2], [4, -7, 2], [4, 7, 2]];
narrowed(asked(planes, here_, margin, by_steps(unit, '[1,"test"]')), 0.1, 2);
narrowed(asked([planes[1], planes[0], planes[2]], here_, margin, by_steps([unit[1], unit[0], unit[2]], '[1,"negative"]')), 0.1, 2);
narrowed(asked(struts, above, margin, by_steps(leaning, '[1,"test"]')), 0.01, 2);
narrowed(asked([struts[0], struts[2], struts[1]], above, margin, by_steps([leaning[0], leaning[2], leaning[1]], '[1,"negative"]')), 0.01, 2);
narrowed(asked([planes[0], struts[1], planes[2]], above, margin, witness([1, 2, 305], '{"obligation":[1,[]]}'), "refuted"), 0.1, 2);
const stiff = (...joints) => (b) => `{"quantity":"stiffness","given":{"joint":[${quote(...joints)}]},"end":"min","bound":"${b}"}`;
const stiffly = (Y) => `[1,{"lower":${y(Y)}}]`;
narrowed(asked(planes, here_, stiff(3, "5", "sqrt(50)"), by_steps(unit, stiffly(unit))), 0.1, 9);
narrowed(asked(toleranced, [[-20, -20, -20], [30, 30, 30]], stiff(9, 4, 5), by_steps(unit, stiffly([[16, 0, 0], [0, 14, 0], [0, 0, 15]]))), 0.1, 9);
for (const [joints, right] of [[[3, 5, 7], 1], [[3, 5], 0], [[3, 5, 7, 9], 0], [[3, 0, 7], 0], [[3, -5, 7], 0], [["1/10", 5, 7], 0], [[], 0]]) {
  const text = asked(planes, here_, stiff(...joints), by_steps(unit, stiffly(unit)))(1), answers = all(text);
  if (answers.some((answer) => answer !== (right ? "CERTIFIED" : "REJECTED"))) fail(`stiffness of each: ${answers}: ${text}`);
  if (right) read.push(text);
}
read.push(asked(planes, here_, margin, by_steps(unit, '[1,"test"]'))(0.5));
console.log("parallel margins of any legs, and a stiffness for each joint: 7 machines, with one answer at 42 bounds each");
fs.rmSync(beside, { recursive: true });

// Pavings, by the program beside orthocert-check: of each kind of node, and mutants of them.
const designs = path.join(__dirname, "../../../tests/designs");
const pavings = fs.mkdtempSync(path.join(os.tmpdir(), "pavings-"));
const delta = ["--box", "-170,170,-170,170,-30,220"];
const paved = [
  ["linear-delta-klipper-box", "--precision", "25", ...delta],
  ["delta-conditioning", "--precision", "25", ...delta],
  ["delta-parallel-margin", "--precision", "25", ...delta],
  ["delta-serial-margin", "--precision", "25", ...delta],
  ["delta-joint-speed", "--precision", "25", ...delta],
  ["upu-struts", "--precision", "60", "--box", "-300,300,-300,300,100,400"],
  ["orthoglide-310", "--precision", "25", "--box", "-150,150,-150,150,-150,151"],
  ["orthoglide-as-built", "--precision", "25", "--box", "-150,150,-150,150,-150,150"],
  ["linear-delta-klipper-box", "--coordinates", "z", "--precision", "4", "--box", "-60,60,-60,60,-200,400"],
  ["linear-delta-klipper-box", "--coordinates", "z,x", "--precision", "10", "--box", "-60,60,-60,60,-200,400"],
].map(([design, ...options], i) => {
  const file = path.join(pavings, `${i}.paving`);
  const run = spawnSync(path.join(path.dirname(exact), "orthocert"), ["pave", path.join(designs, `${design}.toml`), ...options, "-o", file, "-q"]);
  if (run.status === null || !fs.existsSync(file)) fail(`no paving of ${design}: ${run.stderr}`);
  return fs.readFileSync(file);
});
const of_all = (file, bytes) => {
  fs.writeFileSync(file, bytes);
  return [natively([file])[0], exactly(file)];
};
const own = path.join(pavings, "own.paving");
const damaged = (bytes) => {
  const header = bytes.indexOf(10) + 1, last = bytes.lastIndexOf("{");
  const at = random(4) ? header + random(last - header) : random(bytes.length);
  const cut = [bytes.subarray(0, at), bytes.subarray(at)];
  switch (random(4)) {
    case 0: return Buffer.concat([cut[0], cut[1].subarray(1)]);
    case 1: return Buffer.concat([cut[0], bytes.subarray(header + random(last - header)).subarray(0, 1), cut[1]]);
    case 2: return Buffer.concat([cut[0], Buffer.from([random(256)]), cut[1].subarray(1)]);
    default: return Buffer.concat([cut[0], Buffer.from([cut[1][0] ^ 1 << random(8)]), cut[1].subarray(1)]);
  }
};
// Steps where there are none, obligations that fail nowhere, parts that are left out, and what follows the last line.
const after_header = (bytes, ...more) => { const at = bytes.indexOf(10) + 1; return Buffer.concat([bytes.subarray(0, at), Buffer.from(more), bytes.subarray(at)]); };
const renamed = (bytes, from, to) => Buffer.from(bytes.toString("latin1").replace(from, to), "latin1");
const few = { accepted: 0, rejected: 0, "not covered": 0 };
paved.forEach((bytes, i) => {
  const answers = of_all(own, bytes);
  if (!verify(bytes.toString("latin1")).startsWith("NOT COVERED")) fail(`paving ${i}: covered by verified.js`);
  if (answers.some((answer) => answer !== "CERTIFIED")) fail(`paving ${i}: ${answers}`);
  for (const wrong of [
    Buffer.concat([bytes, Buffer.from("\n")]), bytes.subarray(0, bytes.length - 1), after_header(bytes, 4), after_header(bytes, 0x1f), after_header(bytes, 0x10),
    renamed(bytes, /"inner_share":"\d+/, "$&1"), renamed(bytes, /"boundary_share":"/, "$&1"), renamed(bytes, /"inner":/, "$&1"), renamed(bytes, /"depth":\d+/, '"depth":2'),
    renamed(bytes, /"precision":\d+/, '"precision":2000'), renamed(bytes, /"bound":"/, "$&0"), renamed(bytes, /"(box":\{"min":\[)"[^"]*/, '"$1"1000'),
    renamed(bytes, ',"provenance"', ',"symmetry":"permutations","provenance"'), renamed(bytes, ',"symmetry":"permutations"', ""), renamed(bytes, '"y"]', '"x"]'), renamed(bytes, '["z"', '["x","z"'),
  ].filter((wrong) => !wrong.equals(bytes))) {
    const answers = of_all(own, wrong);
    if (answers.some((answer) => answer !== "REJECTED")) fail(`paving ${i}: ${answers}: ${JSON.stringify(wrong.toString("latin1"))}`);
  }
});
for (let i = 0; i < Number(mutants) / 4; i++) {
  const bytes = damaged(paved[i % paved.length]);
  const [answer, right] = of_all(own, bytes);
  if (answer.startsWith("NOT COVERED")) few["not covered"]++;
  else if (answer === right) few[answer === "REJECTED" ? "rejected" : "accepted"]++;
  else fail(`mutant ${i} of a paving: ${answer}, and ${right} by orthocert-check: ${JSON.stringify(bytes.toString("latin1"))}`);
}
fs.rmSync(pavings, { recursive: true });
console.log(`pavings: ${paved.length}, with one answer; mutants: ${Object.entries(few).map(([name, n]) => `${n} ${name}`).join(", ")}`);

// Mutants: one number, key or element of a certificate is another.
const edited = (text) => {
  const certificate = JSON.parse(text);
  const places = [];
  const walk = (value) => {
    for (const key of Object.keys(value)) {
      if (key === "provenance" || key === "format") continue;
      places.push([value, key]);
      if (typeof value[key] === "object") walk(value[key]);
    }
  };
  walk(certificate);
  const [holder, key] = places[random(places.length)];
  const value = holder[key];
  if (typeof value === "number") holder[key] = random(2) ? value + random(5) - 2 : -value;
  else if (typeof value === "string" && /[0-9]/.test(value)) {
    const digits = [...value.matchAll(/[0-9]/g)];
    const at = digits[random(digits.length)].index;
    holder[key] = value.slice(0, at) + random(10) + value.slice(at + 1);
  } else if (typeof value === "string") {
    const others = ["test", "divided", "min", "max", "+", "-", "negative", "Q1", "Q2", "certified", "refuted"];
    holder[key] = others[random(others.length)];
  } else if (Array.isArray(value) && value.length) {
    const i = random(value.length), j = random(value.length);
    if (random(2)) value.splice(i, 1);
    else [value[i], value[j]] = [value[j], value[i]];
  } else if (!Array.isArray(holder)) delete holder[key];
  return JSON.stringify(certificate) + "\n";
};
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "mutants-"));
const count = { accepted: 0, rejected: 0, "not covered": 0, "by theorem": 0, "atlases here alone": 0, "of the exact checker alone": 0 };
try {
  const paths = [], texts = [];
  for (let i = 0; i < Number(mutants); i++) {
    texts.push(edited(read[i % read.length]));
    paths.push(path.join(folder, `${i}.json`));
    fs.writeFileSync(paths[i], texts[i]);
  }
  for (let from = 0; from < paths.length; from += 500) {
    natively(paths.slice(from, from + 500)).forEach((answer, k) => {
      const i = from + k, right = exactly(paths[i]);
      agrees(paths[i], answer);
      if (answer.startsWith("NOT COVERED")) count["not covered"]++;
      else if (answer === right) count[answer === "REJECTED" ? "rejected" : "accepted"]++;
      else if (right === "REJECTED" && isTheorem(texts[i])) count["by theorem"]++;
      // Names are coordinates of slopes here, and inputs there.
      else if (right === "REJECTED" && texts[i].includes('"claim":{"atlas":')) count["atlases here alone"]++;
      else if (answer === "REJECTED") {
        count["of the exact checker alone"]++;
        console.log(`accepted by orthocert-check alone: ${texts[i].trim()}`);
      }
      else fail(`mutant: ${answer}, and ${right} by orthocert-check: ${texts[i]}`);
      if (i % 20 === 0) in_javascript(texts[i], answer);
    });
  }
} finally {
  fs.rmSync(folder, { recursive: true });
}
console.log(`mutants: ${Object.entries(count).map(([name, n]) => `${n} ${name}`).join(", ")}`);
beside_this.on("message", (others) => {
  others.forEach(fail);
  process.exit(failures ? 1 : 0);
});
in_javascript(null);
