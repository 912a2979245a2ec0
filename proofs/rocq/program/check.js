// The verified checker's two programs against each other and against orthocert-check, on
// certificates and on seeded mutants of them, and the realizers of BigInt against what they have to be:
//   node check.js NATIVE VERIFIED.JS ORTHOCERT-CHECK MUTANTS CERT.json..
"use strict";
const fs = require("fs"), os = require("os"), path = require("path");
const { spawnSync } = require("child_process");

const [, , native, script, exact, mutants, ...files] = process.argv;
const verify = require(path.resolve(script)).orthocert_verify;
let failures = 0;
const fail = (words) => { failures++; console.error(words); };

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
  ["tripteron", /"precision":\d+/, '"precision":8'],
  ["tripteron", /"precision":\d+/, '"precision":5000'],
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
const count = { accepted: 0, rejected: 0, "not covered": 0, "by theorem": 0, "of the exact checker alone": 0 };
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
      if (answer.startsWith("NOT COVERED")) count["not covered"]++;
      else if (answer === right) count[answer === "REJECTED" ? "rejected" : "accepted"]++;
      else if (right === "REJECTED" && isTheorem(texts[i])) count["by theorem"]++;
      else if (answer === "REJECTED") {
        count["of the exact checker alone"]++;
        console.log(`accepted by orthocert-check alone: ${texts[i].trim()}`);
      }
      else fail(`mutant: ${answer}, and ${right} by orthocert-check: ${texts[i]}`);
      if (i % 20 === 0 && verify(texts[i]) !== answer) fail(`mutant: ${answer} natively alone: ${texts[i]}`);
    });
  }
} finally {
  fs.rmSync(folder, { recursive: true });
}
console.log(`mutants: ${Object.entries(count).map(([name, n]) => `${n} ${name}`).join(", ")}`);
if (failures) process.exit(1);
